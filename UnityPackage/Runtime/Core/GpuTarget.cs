// SPDX-License-Identifier: MIT
using QuickSes.Interop;
using System;
using System.Numerics;

namespace QuickSes
{
    /// <summary>A qses_gpu_target. Main thread only.</summary>
    internal sealed unsafe class GpuTarget : IGpuTarget
    {
        private readonly GpuTargetHandle _handle = new GpuTargetHandle();

        public GpuTarget()
        {
            IntPtr target;
            QuickSesException.ThrowUnlessOk(NativeMethods.qses_gpu_target_create(&target));
            _handle.Take(target);
        }

        public QuickSesError SetLook(int atoms, ReadOnlySpan<uint> colors, ReadOnlySpan<Vector2> texcoords,
            ReadOnlySpan<byte> visible)
        {
            NativeGpuLook look = NativeDefaults.GpuLook();
            look.AtomCount = (ulong)atoms;
            fixed (uint* ofColors = colors)
            fixed (Vector2* ofTexcoords = texcoords)
            fixed (byte* ofVisible = visible)
            {
                look.Colors = (byte*)ofColors;
                look.Texcoords = (float*)ofTexcoords;
                look.Visible = ofVisible;
                return QuickSesError.FromLastCall(NativeMethods.qses_gpu_target_set_look(_handle, &look));
            }
        }

        public QuickSesError Submit(KeptMesh mesh, in NativeGpuBuffers buffers)
        {
            QuickSesStatus status;
            fixed (NativeGpuBuffers* given = &buffers)
                status = NativeMethods.qses_gpu_target_submit(_handle, mesh.Handle, given, null);
            return status == QuickSesStatus.Busy
                ? new QuickSesError(status, "") // may be so in every frame
                : QuickSesError.FromLastCall(status);
        }

        public GpuTargetStatus GetStatus()
        {
            NativeGpuStatus native = NativeDefaults.GpuStatus();
            QuickSesException.ThrowUnlessOk(NativeMethods.qses_gpu_target_status(_handle, &native));
            QuickSesError error = native.Status == QuickSesStatus.Ok
                ? default
                : new QuickSesError(native.Status, NativeText.Read(native.Message));
            return new GpuTargetStatus(
                error, native.Submitted, native.Done, (int)native.Waiting, native.Stopped != 0);
        }

        public void Dispose() => _handle.Dispose();
    }

    /// <summary>quickses_gpu.h.</summary>
    internal sealed unsafe class GpuLibrary : IGpuLibrary
    {
        public MeshDelivery Delivery => MeshDelivery.Device;

        public IntPtr EventFunction => NativeMethods.qses_gpu_event_function();

        public bool IsUsable(GpuGraphics graphics, out string reason)
        {
            if (!NativeLibraryCheck.IsGpuUsable(out reason))
                return false;
            QuickSesStatus status = NativeMethods.qses_gpu_check_graphics(graphics);
            reason = status == QuickSesStatus.Ok ? "" : NativeText.LastError();
            return status == QuickSesStatus.Ok;
        }

        public bool WorksWith(SurfaceBackend backend) => backend == SurfaceBackend.Cuda;

        public bool IsOnGpuOnly(KeptMesh mesh) => !mesh.View.IsInHostMemory;

        public QuickSesError Download(KeptMesh mesh) => QuickSesError.FromLastCall(mesh.Download());

        public IGpuTarget NewTarget() => new GpuTarget();

        public int NextEvent()
        {
            int number;
            QuickSesException.ThrowUnlessOk(NativeMethods.qses_gpu_next_event(&number));
            return number;
        }
    }
}
