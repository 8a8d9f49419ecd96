// SPDX-License-Identifier: MIT
using QuickSes.Interop;
using System;
using UnityEngine;
using UnityEngine.Rendering;

namespace QuickSes
{
    /// <summary>
    /// A mesh of a component's own whose buffers CUDA writes, with some room: in C# its vertices are zeros. Main thread
    /// only.
    /// </summary>
    internal sealed class GpuMesh : IDisposable
    {
        private static uint s_generation;

        private readonly Mesh _mesh;
        private readonly MeshStyle _style;
        private readonly GpuMeshPlan _plan;
        private readonly int _vertexCapacity;
        private readonly int _indexCapacity;
        private readonly NativeGpuBuffers _buffers;
        private int _indexCount; // of the submesh
        private AtomLook _look;

        /// <param name="view">The first it is for.</param>
        /// <param name="style">Of its vertices.</param>
        /// <param name="plan">How it is drawn.</param>
        public GpuMesh(in SurfaceMeshView view, MeshStyle style, GpuMeshPlan plan)
        {
            _style = style;
            _plan = plan;
            _vertexCapacity = MeshWriter.WithRoom(view.VertexCount);
            _indexCapacity = checked(3 * MeshWriter.WithRoom(view.TriangleCount));
            _indexCount = plan == GpuMeshPlan.WholeBuffers ? _indexCapacity : 0;
            _mesh = SurfaceMesh.MakeMesh("Molecular Surface (GPU)"); // not dynamic: Direct3D would share it with the CPU
            try
            {
                MakeBuffers(SurfaceMeshUploader.BoundsOf(view));
                _buffers = Describe();
            }
            catch // the engine has no such buffers, or no memory for them
            {
                SurfaceMesh.DestroyMesh(_mesh);
                throw;
            }
        }

        /// <summary>null: somebody destroyed it.</summary>
        public Mesh Mesh => _mesh;

        public MeshStyle Style => _style;

        /// <summary>Where meshes are to be submitted to.</summary>
        public ref readonly NativeGpuBuffers Buffers => ref _buffers;

        /// <summary>Of what was drawn last, in the coordinates of the mesh; for the renderer with WholeBuffers.</summary>
        public Bounds Bounds { get; private set; }

        /// <summary>Whether bounds are those of the renderer.</summary>
        public bool HasBoundsInRenderer => _plan == GpuMeshPlan.WholeBuffers;

        /// <summary>How what is in it looks.</summary>
        public GivenLook Given { get; private set; }

        /// <summary>Of the atoms of what is in it; held.</summary>
        public AtomLook Look
        {
            get => _look;
            private set
            {
                value?.Hold();
                _look?.Release();
                _look = value;
            }
        }

        /// <summary>
        /// Whether it is as it was made, as far as that can be asked: else the engine has made other buffers.
        /// </summary>
        public bool IsIntact =>
            _mesh != null && MeshWriter.AreIntact(_mesh, _style.Layout, _vertexCapacity, _indexCount);

        public bool Suffices(in SurfaceMeshView view, MeshStyle style, GpuMeshPlan plan) =>
            view.VertexCount <= _vertexCapacity && 3L * view.TriangleCount <= _indexCapacity && FitsTo(style, plan);

        /// <summary>Whether it would be made the same, but for its size.</summary>
        public bool FitsTo(MeshStyle style, GpuMeshPlan plan) => _style.Equals(style) && _plan == plan && IsIntact;

        /// <summary>What was submitted is what is drawn from now on.</summary>
        public void Draw(in SurfaceMeshView view, AtomLook look, GivenLook given)
        {
            Look = look;
            Given = given;
            Bounds = SurfaceMeshUploader.BoundsOf(view);
            if (_plan == GpuMeshPlan.WholeBuffers)
                return;
            _indexCount = 3 * view.TriangleCount;
            MeshWriter.SetSubMesh(_mesh, Bounds, view.VertexCount, _indexCount);
        }

        public void Dispose()
        {
            SurfaceMesh.DestroyMesh(_mesh);
            Look = null;
        }

        private void MakeBuffers(Bounds bounds)
        {
            _mesh.vertexBufferTarget |= GraphicsBuffer.Target.Raw; // of default usage, so that CUDA can write it
            _mesh.indexBufferTarget |= GraphicsBuffer.Target.Raw;
            _mesh.SetVertexBufferParams(_vertexCapacity, _style.Layout);
            _mesh.SetIndexBufferParams(_indexCapacity, IndexFormat.UInt32);
            MeshWriter.SetSubMesh(_mesh, bounds, _vertexCapacity, _indexCount);
            _mesh.UploadMeshData(false); // the buffers are there from now on
        }

        // Asking for the buffers waits for the thread that draws, so it is done once.
        private NativeGpuBuffers Describe()
        {
            NativeGpuBuffers buffers = NativeDefaults.GpuBuffers();
            buffers.Graphics = GpuDelivery.Graphics;
            buffers.Vertices = VertexBuffer(MeshStyle.SurfaceStream);
            if (_style.HasAtoms)
                buffers.Owners = VertexBuffer(MeshStyle.AtomStream);
            else
                buffers.Colors = VertexBuffer(MeshStyle.AtomStream);
            if (_style.HasTexcoords)
                buffers.Texcoords = VertexBuffer(MeshStyle.TexcoordStream);
            buffers.Indices = (ulong)_mesh.GetNativeIndexBufferPtr().ToInt64();
            buffers.VertexCapacity = (ulong)_vertexCapacity;
            buffers.IndexCapacity = (ulong)_indexCapacity;
            buffers.Generation = ++s_generation;
            buffers.ClearRest = _plan == GpuMeshPlan.WholeBuffers ? 1 : 0;
            return buffers;
        }

        private ulong VertexBuffer(int stream) => (ulong)_mesh.GetNativeVertexBufferPtr(stream).ToInt64();
    }

    /// <summary>
    /// What of an <see cref="AtomLook"/> was given to a target, or is in a mesh: equal as long as nothing is new.
    /// </summary>
    internal readonly struct GivenLook : IEquatable<GivenLook>
    {
        private readonly AtomLook _look;
        private readonly bool _hasAtoms;
        private readonly uint _colors, _visible, _texcoords;

        /// <param name="look">As it is now.</param>
        /// <param name="hasAtoms">Whether colours and what is hidden are the shader's business.</param>
        public GivenLook(AtomLook look, bool hasAtoms)
        {
            _look = look;
            _hasAtoms = hasAtoms;
            _colors = hasAtoms ? 0 : look.ColorsVersion;
            _visible = hasAtoms ? 0 : look.VisibleVersion;
            _texcoords = look.TexcoordsVersion;
        }

        public bool Equals(GivenLook other) => _look == other._look && _hasAtoms == other._hasAtoms &&
            _colors == other._colors && _visible == other._visible && _texcoords == other._texcoords;

        public override bool Equals(object other) => other is GivenLook given && Equals(given);

        public override int GetHashCode() => (int)(_colors + 31 * _visible + 961 * _texcoords);
    }
}
