// SPDX-License-Identifier: MIT
// The functions of quickses_gpu.h.
using System;
using System.Runtime.InteropServices;

namespace QuickSes.Interop
{
    internal static unsafe partial class NativeMethods
    {
        /// <summary>QSES_GPU_ABI_VERSION of the header these declarations were written after.</summary>
        public const uint GpuAbiVersion = 1;

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern uint qses_gpu_abi_version();

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_gpu_check_graphics(GpuGraphics graphics);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_gpu_target_create(IntPtr* target);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern void qses_gpu_target_destroy(IntPtr target);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_gpu_target_set_look(GpuTargetHandle target, NativeGpuLook* look);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_gpu_target_submit(
            GpuTargetHandle target, KeptMeshHandle kept, NativeGpuBuffers* buffers, int* gpuEvent);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_gpu_target_status(GpuTargetHandle target, NativeGpuStatus* status);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_gpu_next_event(int* gpuEvent);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern IntPtr qses_gpu_event_function();
    }
}
