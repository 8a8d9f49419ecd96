// SPDX-License-Identifier: MIT
using QuickSes.Interop;
using System;

namespace QuickSes
{
    /// <summary>
    /// A mesh in memory of a <see cref="SurfaceContext"/> or a <see cref="KeptMesh"/>; nothing is copied. It ends with
    /// the next <see cref="SurfaceContext.TryCollect"/>, <see cref="SurfaceContext.TryCollectDevice"/>,
    /// <see cref="SurfaceContext.Compute"/> or <see cref="SurfaceContext.Keep"/> that succeeds there, of a kept mesh
    /// also with <see cref="KeptMesh.Clear"/> and <see cref="KeptMesh.Download"/>, and with Dispose: asking an ended
    /// view for memory throws. Spans and pointers that were taken before can't tell, so don't keep them; and keep the
    /// context or kept mesh itself alive while they are used. <c>default</c> is an empty mesh. V is the number of
    /// vertices, T that of triangles; lengths are in Å, in the coordinates the atoms were given in.
    /// </summary>
    public readonly unsafe struct SurfaceMeshView
    {
        internal SurfaceMeshView(IMeshHolder holder, int generation, in NativeMesh native)
        {
            _holder = holder;
            _generation = generation;
            _native = native;
        }

        private const uint InterleavedBytes = 6 * sizeof(float);

        private readonly IMeshHolder _holder;
        private readonly int _generation;
        private readonly NativeMesh _native;

        /// <summary>Whether the memory may still be looked at.</summary>
        public bool IsValid => _holder == null || _holder.IsCurrent(_generation);

        /// <summary>
        /// Whether its arrays are there. Those of a mesh that is on a CUDA device only are empty, its numbers are there:
        /// see <see cref="KeptMesh.Download"/>.
        /// </summary>
        public bool IsInHostMemory => _native.VertexCount == 0 || _native.Positions != null;

        /// <summary>V.</summary>
        public int VertexCount => checked((int)_native.VertexCount);

        /// <summary>T.</summary>
        public int TriangleCount => checked((int)_native.TriangleCount);

        /// <summary><see cref="SurfaceSettings.Tag"/> of the job or computation.</summary>
        public uint Tag => _native.Tag;

        /// <summary>0 is the coarsest.</summary>
        public int Level => (int)_native.Level;

        /// <summary>Levels there are with the settings: the finest is LevelCount - 1.</summary>
        public int LevelCount => (int)_native.LevelCount;

        /// <summary>Å, of the level.</summary>
        public float Spacing => _native.Spacing;

        /// <summary>Box of the vertices, Å; all 0 for an empty mesh.</summary>
        public (float X, float Y, float Z) BoundsMin =>
            (_native.BoundsMin[0], _native.BoundsMin[1], _native.BoundsMin[2]);

        /// <summary>The other corner of the box.</summary>
        public (float X, float Y, float Z) BoundsMax =>
            (_native.BoundsMax[0], _native.BoundsMax[1], _native.BoundsMax[2]);

        /// <summary>How the vertices lie in memory.</summary>
        public SurfaceVertexLayout VertexLayout =>
            _native.VertexBytes == 0 ? SurfaceVertexLayout.Separate :
            _native.VertexBytes == InterleavedBytes ? SurfaceVertexLayout.Interleaved : SurfaceVertexLayout.Compact;

        /// <summary>
        /// Bytes from one vertex to the next in <see cref="Vertices"/>: interleaved 24, compact 16; else 0.
        /// </summary>
        public int VertexBytes => (int)_native.VertexBytes;

        /// <summary>Whether there is a colour per vertex.</summary>
        public bool HasColors => _native.Colors != null;

        /// <summary>Whether there are texture coordinates, wherever the mesh is.</summary>
        public bool HasTexcoords => _native.HasTexcoords != 0;

        /// <summary>Whether there are kinds of patch.</summary>
        public bool HasPatches => _native.Patches != null;

        /// <summary>
        /// V x <see cref="VertexBytes"/> bytes: positions and normals. Interleaved and compact layouts only.
        /// </summary>
        public ReadOnlySpan<byte> Vertices
        {
            get
            {
                if (_native.VertexBytes == 0 && _native.VertexCount != 0)
                    throw new InvalidOperationException(
                        "The vertices are in separate arrays: use Positions and Normals.");
                return new ReadOnlySpan<byte>(Valid(_native.Positions),
                    IsInHostMemory ? Length(_native.VertexCount, _native.VertexBytes) : 0);
            }
        }

        /// <summary>V x 3, Å. Separate layout only.</summary>
        public ReadOnlySpan<float> Positions => Separate(_native.Positions);

        /// <summary>V x 3, unit length, outward. Separate layout only.</summary>
        public ReadOnlySpan<float> Normals => Separate(_native.Normals);

        /// <summary>V x 4: red, green, blue, alpha; empty if there are none.</summary>
        public ReadOnlySpan<byte> Colors => Attribute<byte>(_native.Colors, 4);

        /// <summary>V x 2; empty if they were not asked for.</summary>
        public ReadOnlySpan<float> Texcoords => Attribute<float>(_native.Texcoords, 2);

        /// <summary>
        /// V: the atom whose van der Waals surface is nearest, a 0-based index into the positions given to
        /// <see cref="SurfaceContext.SetAtoms"/>, always in range; empty with <see cref="SurfaceSettings.WithoutOwners"/>.
        /// </summary>
        public ReadOnlySpan<uint> Owners => Attribute<uint>(_native.Owners, 1);

        /// <summary>V kinds of patch; empty if they were not asked for.</summary>
        public ReadOnlySpan<SurfacePatch> Patches =>
            new ReadOnlySpan<SurfacePatch>(Valid(_native.Patches), HasPatches ? Length(_native.VertexCount, 1) : 0);

        /// <summary>T x 3 vertex numbers.</summary>
        public ReadOnlySpan<uint> Indices =>
            new ReadOnlySpan<uint>(Valid(_native.Indices), _native.Indices == null ? 0 : Length(_native.TriangleCount, 3));

        /// <summary>
        /// With <see cref="SurfaceSettings.HardEdges"/>: of the last vertices, as many as there are numbers, which vertex
        /// each of them stands for on the other side of its crease, in ascending order; else empty.
        /// </summary>
        public ReadOnlySpan<uint> Repeated =>
            new ReadOnlySpan<uint>(Valid(_native.Repeated), Length((uint)_native.RepeatedCount, 1));

        /// <summary>
        /// The connected pieces of the surface in the order of their first vertices; empty unless
        /// <see cref="SurfaceSettings.Components"/>. Those of the whole surface where atoms or cavities are left out.
        /// Areas and volumes add up to those of <see cref="SurfaceReport"/>, if those come from the normals.
        /// </summary>
        public ReadOnlySpan<SurfaceComponent> Components =>
            new ReadOnlySpan<SurfaceComponent>(Valid(_native.Components), Length(_native.ComponentCount, 1));

        /// <summary>
        /// V: the number of the vertex's component, a place in <see cref="Components"/>; empty unless
        /// <see cref="SurfaceSettings.ComponentIds"/>.
        /// </summary>
        public ReadOnlySpan<uint> ComponentIds => Attribute<uint>(_native.ComponentIds, 1);

        /// <summary>
        /// The atoms that line each component, rising: those that own its vertices. Needs
        /// <see cref="SurfaceSettings.ComponentIds"/>; it allocates. What is left out of the mesh has none.
        /// </summary>
        public uint[][] GetComponentAtoms()
        {
            Valid(null);
            var starts = new uint[_native.ComponentCount + 1];
            uint[] atoms;
            fixed (NativeMesh* mesh = &_native)
            fixed (uint* first = starts)
            {
                QuickSesException.ThrowUnlessOk(
                    NativeMethods.qses_component_atoms(mesh, first, null, UIntPtr.Zero));
                atoms = new uint[starts[starts.Length - 1]];
                fixed (uint* all = atoms)
                    if (atoms.Length > 0)
                        QuickSesException.ThrowUnlessOk(
                            NativeMethods.qses_component_atoms(mesh, first, all, (UIntPtr)atoms.Length));
            }
            var found = new uint[_native.ComponentCount][];
            for (int k = 0; k < found.Length; ++k)
            {
                found[k] = new uint[starts[k + 1] - starts[k]];
                Array.Copy(atoms, (int)starts[k], found[k], 0, found[k].Length);
            }
            return found;
        }

        /// <summary>
        /// Å² of the surface that belong to each of the atoms, in the order they were given in; empty unless
        /// <see cref="SurfaceSettings.AtomAreas"/>. They add up to <see cref="SurfaceReport.Area"/>. Of SAS and VDW they
        /// are exact; of SES and Gaussian surfaces, what of each triangle is nearest to the atom. Those of the whole
        /// surface where atoms are hidden.
        /// </summary>
        public ReadOnlySpan<double> AtomAreas =>
            new ReadOnlySpan<double>(Valid(_native.AtomAreas), checked((int)_native.AtomCount));

        /// <summary>
        /// The first vertex's position, for copies without spans. In all layouts; null for an empty mesh, and for one that is
        /// not in host memory.
        /// </summary>
        public float* PositionsPointer => (float*)Valid(_native.Positions);

        /// <summary>The first index; null where <see cref="PositionsPointer"/> is.</summary>
        public uint* IndicesPointer => (uint*)Valid(_native.Indices);

        private ReadOnlySpan<float> Separate(float* first)
        {
            if (_native.VertexBytes != 0)
                throw new InvalidOperationException("The vertices are interleaved: use Vertices and VertexBytes.");
            return Attribute<float>(first, 3);
        }

        private ReadOnlySpan<T> Attribute<T>(void* first, uint perVertex) where T : unmanaged =>
            new ReadOnlySpan<T>(Valid(first), first == null ? 0 : Length(_native.VertexCount, perVertex));

        private static int Length(uint count, uint each) => checked((int)((ulong)count * each));

        private void* Valid(void* memory)
        {
            if (!IsValid)
            {
                _holder.ThrowIfDisposed();
                throw new InvalidOperationException("This view has ended: a newer mesh was collected or computed.");
            }
            return memory;
        }
    }
}
