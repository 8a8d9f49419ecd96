// SPDX-License-Identifier: MIT
using QuickSes.Interop;
using System;
using System.Threading;

namespace QuickSes
{
    /// <summary>
    /// A mesh that is held for longer than the context that computed it would (<see cref="SurfaceContext.Keep"/>), also
    /// longer than the context itself: to be shown, painted and picked in. Meant to be filled again and again: its
    /// memory goes back to the context it came from, and nothing is allocated.
    /// <para>Threads: one at a time may change it (Keep, <see cref="Download"/>, <see cref="Clear"/>,
    /// <see cref="Dispose"/>), and then no other may use it; any number may look at it at a time. Contexts may compute
    /// meanwhile.</para>
    /// <para>Errors: wrong arguments throw. Garbage: none, unless something is wrong.</para>
    /// </summary>
    public sealed unsafe class KeptMesh : IMeshHolder, IDisposable
    {
        private readonly KeptMeshHandle _handle = new KeptMeshHandle();
        private int _generation; // views of older meshes have ended
        private NativeMesh _mesh = NativeDefaults.Mesh();

        /// <summary>An empty one. Throws if the native library can't be used.</summary>
        public KeptMesh()
        {
            NativeLibraryCheck.ThrowIfUnusable();
            IntPtr kept;
            QuickSesException.ThrowUnlessOk(NativeMethods.qses_kept_mesh_create(&kept));
            _handle.Take(kept);
        }

        /// <summary>The mesh; an empty one if nothing is kept.</summary>
        public SurfaceMeshView View
        {
            get
            {
                ThrowIfDisposed();
                return new SurfaceMeshView(this, Volatile.Read(ref _generation), _mesh);
            }
        }

        /// <summary>
        /// Brings a mesh that is on a CUDA device only (<see cref="MeshDelivery.Device"/>) into host memory, and waits for
        /// that: then all questions are answered. Does nothing if it is there, or empty. Ends views if it does something.
        /// </summary>
        /// <returns>Ok, NoResult (nothing is kept), OutOfMemory or DeviceError.</returns>
        public QuickSesStatus Download()
        {
            ThrowIfDisposed();
            QuickSesStatus status = NativeMethods.qses_kept_mesh_download(_handle);
            if (status == QuickSesStatus.InvalidArgument)
                throw QuickSesException.FromLastCall(status);
            if (status == QuickSesStatus.Ok && !View.IsInHostMemory)
                Renew();
            return status;
        }

        /// <summary>What was done for the mesh; false if nothing is kept.</summary>
        public bool TryGetReport(out SurfaceReport report)
        {
            ThrowIfDisposed();
            NativeReport native = NativeDefaults.Report();
            QuickSesStatus status = NativeMethods.qses_kept_mesh_report(_handle, &native);
            report = new SurfaceReport(native);
            if (status != QuickSesStatus.NoResult)
                QuickSesException.ThrowUnlessOk(status);
            return status == QuickSesStatus.Ok;
        }

        /// <summary>
        /// Values of vertices out of those of the atoms that own them: colours (4 bytes), texture coordinates (8), or
        /// anything of 4, 8, 12 or 16 bytes.
        /// </summary>
        /// <param name="perAtom">As many as the mesh was made of atoms.</param>
        /// <param name="first">The first vertex.</param>
        /// <param name="perVertex">Room for the values of vertices first, first + 1, ...: all of it is filled.</param>
        public void Paint<T>(ReadOnlySpan<T> perAtom, int first, Span<T> perVertex) where T : unmanaged
        {
            ThrowIfDisposed();
            ThrowIfNegative(first);
            fixed (T* from = perAtom, to = perVertex)
                QuickSesException.ThrowUnlessOk(NativeMethods.qses_kept_mesh_paint(_handle, from, (UIntPtr)sizeof(T),
                    (UIntPtr)perAtom.Length, (uint)first, (uint)perVertex.Length, to));
        }

        /// <summary>
        /// Those of the triangles first, first + 1, ... whose three vertices all have owners that are visible.
        /// </summary>
        /// <param name="visible">One byte per atom of the mesh, 0 for hidden.</param>
        /// <param name="first">The first triangle.</param>
        /// <param name="count">How many are looked at.</param>
        /// <param name="indices">Room for 3 * count vertex numbers; all of it may be written to.</param>
        /// <returns>How many triangles are left: 3 times as many vertex numbers were written.</returns>
        public int Filter(ReadOnlySpan<byte> visible, int first, int count, Span<uint> indices)
        {
            ThrowIfDisposed();
            ThrowIfNegative(first);
            if (count < 0 || indices.Length / 3 < count)
                throw new ArgumentException($"has room for {indices.Length / 3} triangles, but count is {count}",
                    nameof(indices));
            uint kept;
            fixed (byte* mask = visible)
            fixed (uint* to = indices)
                QuickSesException.ThrowUnlessOk(NativeMethods.qses_kept_mesh_filter(
                    _handle, mask, (UIntPtr)visible.Length, (uint)first, (uint)count, to, &kept));
            return (int)kept;
        }

        /// <summary>
        /// The first triangle that a ray meets, from either side; false: none. Some tens of microseconds with
        /// <see cref="SurfaceSettings.Pickable"/>; without, all triangles are looked at.
        /// </summary>
        /// <param name="origin">In the coordinates the atoms were given in.</param>
        /// <param name="direction">The same; of any length but 0.</param>
        /// <param name="visible">Empty, or as of <see cref="Filter"/>: triangles left out there let rays through.</param>
        /// <param name="hit">Where.</param>
        public bool TryPick((float X, float Y, float Z) origin, (float X, float Y, float Z) direction,
            ReadOnlySpan<byte> visible, out SurfaceHit hit)
        {
            ThrowIfDisposed();
            float* from = stackalloc float[3] { origin.X, origin.Y, origin.Z };
            float* along = stackalloc float[3] { direction.X, direction.Y, direction.Z };
            NativeHit native = NativeDefaults.Hit();
            fixed (byte* mask = visible)
                QuickSesException.ThrowUnlessOk(NativeMethods.qses_kept_mesh_pick(
                    _handle, from, along, mask, (UIntPtr)visible.Length, &native));
            hit = new SurfaceHit(native);
            return native.Found != 0;
        }

        /// <summary>Gives the memory back to the context it came from. Views have ended.</summary>
        public void Clear()
        {
            ThrowIfDisposed();
            NativeMethods.qses_kept_mesh_clear(_handle);
            Renew();
        }

        /// <summary>Gives the memory back. May be called twice.</summary>
        public void Dispose() => _handle.Dispose();

        internal KeptMeshHandle Handle => _handle;

        /// <summary>What <see cref="SurfaceContext.Keep"/> does.</summary>
        internal QuickSesStatus TakeFrom(ContextHandle context)
        {
            ThrowIfDisposed();
            QuickSesStatus status = NativeMethods.qses_keep(context, _handle);
            if (status == QuickSesStatus.Ok)
                Renew();
            return status;
        }

        bool IMeshHolder.IsCurrent(int generation) =>
            !_handle.IsClosed && Volatile.Read(ref _generation) == generation;

        void IMeshHolder.ThrowIfDisposed() => ThrowIfDisposed();

        private void ThrowIfDisposed() => _handle.ThrowIfClosed(nameof(KeptMesh));

        private static void ThrowIfNegative(int first)
        {
            if (first < 0)
                throw new ArgumentOutOfRangeException(nameof(first), first, "must not be negative");
        }

        private void Renew()
        {
            NativeMesh mesh = NativeDefaults.Mesh();
            QuickSesException.ThrowUnlessOk(NativeMethods.qses_kept_mesh_view(_handle, &mesh));
            _mesh = mesh;
            Interlocked.Increment(ref _generation);
        }
    }
}
