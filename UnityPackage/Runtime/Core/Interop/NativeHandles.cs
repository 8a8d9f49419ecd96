// SPDX-License-Identifier: MIT
using Microsoft.Win32.SafeHandles;
using System;

namespace QuickSes.Interop
{
    /// <summary>
    /// What the library handed out and takes back once: by Dispose, or by the finalizer of a forgotten one. A call that
    /// is under way on another thread delays it.
    /// </summary>
    internal abstract class NativeHandle : SafeHandleZeroOrMinusOneIsInvalid
    {
        protected NativeHandle() : base(ownsHandle: true)
        {
        }

        public void Take(IntPtr pointer) => SetHandle(pointer);

        public void ThrowIfClosed(string owner)
        {
            if (IsClosed)
                throw new ObjectDisposedException(owner);
        }
    }

    internal sealed class ContextHandle : NativeHandle
    {
        protected override bool ReleaseHandle()
        {
            NativeMethods.qses_context_destroy(handle);
            return true;
        }
    }

    internal sealed class KeptMeshHandle : NativeHandle
    {
        protected override bool ReleaseHandle()
        {
            NativeMethods.qses_kept_mesh_destroy(handle);
            return true;
        }
    }

    internal sealed class GpuTargetHandle : NativeHandle
    {
        protected override bool ReleaseHandle()
        {
            NativeMethods.qses_gpu_target_destroy(handle);
            return true;
        }
    }

    internal sealed class StructureHandle : NativeHandle
    {
        protected override bool ReleaseHandle()
        {
            NativeMethods.qses_structure_close(handle);
            return true;
        }
    }

    internal sealed class TrajectoryHandle : NativeHandle
    {
        protected override bool ReleaseHandle()
        {
            NativeMethods.qses_trajectory_close(handle);
            return true;
        }
    }
}
