// SPDX-License-Identifier: MIT
// What a context computes, at once or over time.
using QuickSes.Interop;
using System;
using System.Threading;

namespace QuickSes
{
    public sealed partial class SurfaceContext
    {
        /// <summary>
        /// Computes the surface and waits for it: for tools and tests rather than for the main thread of a game.
        /// </summary>
        /// <param name="settings">What is computed; levels and frame budget are for <see cref="Begin"/>.</param>
        /// <param name="mesh">The mesh; it ends views of older ones. Empty unless Ok.</param>
        /// <returns>Ok, OutOfMemory, TooFine, DeviceError, InternalError, or Cancelled.</returns>
        public unsafe QuickSesStatus Compute(in SurfaceSettings settings, out SurfaceMeshView mesh)
        {
            ThrowIfDisposed();
            settings.ThrowIfUninitialised();
            NativeMesh native = NativeDefaults.Mesh();
            QuickSesStatus status;
            fixed (NativeSettings* given = &settings.Native)
                status = NativeMethods.qses_compute(_handle, given, &native);
            mesh = status == QuickSesStatus.Ok ? NewView(native) : default;
            return Check(status);
        }

        /// <summary>
        /// Starts computing the surface of the atoms as they are now, level after level, and returns at once. Atoms may
        /// be set for the next job meanwhile. A new job replaces the one that runs, whose coarsest level is still
        /// finished; only the newest waits. What goes wrong later is told by <see cref="Poll"/>.
        /// </summary>
        /// <returns>Ok or OutOfMemory.</returns>
        public unsafe QuickSesStatus Begin(in SurfaceSettings settings)
        {
            ThrowIfDisposed();
            settings.ThrowIfUninitialised();
            fixed (NativeSettings* given = &settings.Native)
                return Check(NativeMethods.qses_begin(_handle, given));
        }

        /// <summary>How the job stands. Any thread, at any time before Dispose.</summary>
        public unsafe void Poll(out SurfaceProgress progress)
        {
            ThrowIfDisposed();
            NativeProgress native = NativeDefaults.Progress();
            QuickSesException.ThrowUnlessOk(NativeMethods.qses_poll(_handle, &native));
            progress = new SurfaceProgress(native);
        }

        /// <summary>
        /// The finest level that was finished since the last call; false (and an empty mesh) if there is none, which is
        /// cheap to ask. True ends the views of older meshes; this one stays valid while further levels and jobs run.
        /// </summary>
        public unsafe bool TryCollect(out SurfaceMeshView mesh)
        {
            ThrowIfDisposed();
            NativeMesh native = NativeDefaults.Mesh();
            QuickSesStatus status = NativeMethods.qses_collect(_handle, &native);
            mesh = status == QuickSesStatus.Ok ? NewView(native) : default;
            if (status != QuickSesStatus.NothingNew)
                QuickSesException.ThrowUnlessOk(status);
            return status == QuickSesStatus.Ok;
        }

        /// <summary>
        /// The mesh of the last <see cref="TryCollect"/> or <see cref="Compute"/> that succeeded, if any.
        /// </summary>
        public unsafe bool TryGetMesh(out SurfaceMeshView mesh)
        {
            ThrowIfDisposed();
            NativeMesh native = NativeDefaults.Mesh();
            QuickSesStatus status = NativeMethods.qses_context_mesh(_handle, &native);
            mesh = status == QuickSesStatus.Ok ? new SurfaceMeshView(this, _generation, native) : default;
            if (status != QuickSesStatus.NoResult)
                QuickSesException.ThrowUnlessOk(status);
            return status == QuickSesStatus.Ok;
        }

        /// <summary>
        /// The finest level that was finished since the last call, where it is on the CUDA device; where nothing is new,
        /// the mesh of the last collection or computation. Made with <see cref="SurfaceSettings.Delivery"/> Device or
        /// Both, else an exception says so. False if nothing was made yet. It ends views of older meshes.
        /// </summary>
        public unsafe bool TryCollectDevice(out SurfaceDeviceMesh mesh)
        {
            ThrowIfDisposed();
            NativeDeviceMesh native = NativeDefaults.DeviceMesh();
            QuickSesStatus status = NativeMethods.qses_collect_device(_handle, &native);
            mesh = status == QuickSesStatus.Ok ? new SurfaceDeviceMesh(native) : default;
            if (status == QuickSesStatus.Ok)
                NewView(native.Mesh);
            else if (status != QuickSesStatus.NoResult)
                QuickSesException.ThrowUnlessOk(status);
            return status == QuickSesStatus.Ok;
        }

        /// <summary>
        /// Moves the mesh of the last <see cref="TryCollect"/> or <see cref="Compute"/> that succeeded, and its report,
        /// into <paramref name="kept"/>, without a copy; what that held before comes back to the context it was from.
        /// The context has no mesh then, and views of it have ended. What was wanted on the device
        /// (<see cref="SurfaceSettings.Delivery"/>) is kept there. Throws if the mesh was wanted nowhere.
        /// </summary>
        /// <returns>Whether there was a mesh; if not, nothing has changed.</returns>
        public bool Keep(KeptMesh kept)
        {
            ThrowIfDisposed();
            if (kept == null)
                throw new ArgumentNullException(nameof(kept));
            QuickSesStatus status = kept.TakeFrom(_handle);
            if (status == QuickSesStatus.NoResult)
                return false;
            QuickSesException.ThrowUnlessOk(status);
            Interlocked.Increment(ref _generation);
            return true;
        }

        /// <summary>
        /// Ends the job that runs as soon as it can and drops the one that waits; a <see cref="Compute"/> or
        /// <see cref="Estimate"/> on another thread returns Cancelled. Returns at once. Any thread, at any time before Dispose.
        /// </summary>
        public void Cancel()
        {
            ThrowIfDisposed();
            QuickSesException.ThrowUnlessOk(NativeMethods.qses_cancel(_handle));
        }

        /// <summary>
        /// Waits until no job runs or waits, at most for the given time; negative: without limit. False: the time was
        /// over.
        /// </summary>
        public unsafe bool Wait(double milliseconds = -1)
        {
            ThrowIfDisposed();
            int finished;
            QuickSesException.ThrowUnlessOk(NativeMethods.qses_wait(_handle, milliseconds, &finished));
            return finished != 0;
        }

        /// <summary>
        /// Predicts the mesh of settings.Spacing and the memory for it, without making it. Waits for a running job. The
        /// last mesh stays valid.
        /// </summary>
        /// <returns>Ok, OutOfMemory, TooFine, DeviceError, InternalError, or Cancelled.</returns>
        public unsafe QuickSesStatus Estimate(in SurfaceSettings settings, out SurfaceSizeEstimate estimate)
        {
            ThrowIfDisposed();
            settings.ThrowIfUninitialised();
            NativeSizeEstimate native = NativeDefaults.SizeEstimate();
            QuickSesStatus status;
            fixed (NativeSettings* given = &settings.Native)
                status = NativeMethods.qses_estimate(_handle, given, &native);
            estimate = new SurfaceSizeEstimate(native);
            return Check(status);
        }

        /// <summary>What was done for the last mesh; false if there is none.</summary>
        public unsafe bool TryGetReport(out SurfaceReport report)
        {
            ThrowIfDisposed();
            NativeReport native = NativeDefaults.Report();
            QuickSesStatus status = NativeMethods.qses_context_report(_handle, &native);
            report = new SurfaceReport(native);
            if (status != QuickSesStatus.NoResult)
                QuickSesException.ThrowUnlessOk(status);
            return status == QuickSesStatus.Ok;
        }

        /// <summary>
        /// Switches the timing of single stages on or off (default): see <see cref="SurfaceReport.GetStage"/>.
        /// </summary>
        public void EnableStageTimes(bool enabled)
        {
            ThrowIfDisposed();
            QuickSesException.ThrowUnlessOk(NativeMethods.qses_set_stage_times(_handle, enabled ? 1 : 0));
        }

        private SurfaceMeshView NewView(in NativeMesh native) =>
            new SurfaceMeshView(this, Interlocked.Increment(ref _generation), native);
    }
}
