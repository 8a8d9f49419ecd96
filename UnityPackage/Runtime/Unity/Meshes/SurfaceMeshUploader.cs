// SPDX-License-Identifier: MIT
using System;
using UnityEngine;

namespace QuickSes
{
    /// <summary>
    /// Copies a computed surface into a <see cref="Mesh"/>: straight from native memory, without garbage, and without
    /// the engine checking or measuring it again. Main thread only. Use one for one mesh, frame after frame.
    /// </summary>
    /// <remarks>
    /// The mesh gets three streams of vertices: position and normal; colour (white if the surface has none); texture
    /// coordinate 1 if the surface has it. It has one submesh of triangles with 32-bit indices, and the surface's own
    /// bounds. Its numbers are those the atoms were given in: Unity's, if they were, with the front faces outside. If
    /// somebody else changed the buffers of the mesh meanwhile, they are set up again.
    /// </remarks>
    public sealed class SurfaceMeshUploader : IDisposable
    {
        private readonly MeshWriter _writer = new MeshWriter();
        private readonly UnmanagedBuffer<uint> _white = new UnmanagedBuffer<uint>();

        /// <summary>Releases what the editor keeps for its checks. The mesh is the caller's.</summary>
        public void Dispose()
        {
            _writer.Dispose();
            _white.Dispose();
        }

        /// <summary>Replaces the content of a mesh.</summary>
        /// <param name="view">
        /// Of the layout <see cref="SurfaceVertexLayout.Interleaved"/> or <see cref="SurfaceVertexLayout.Compact"/>, in
        /// host memory (else InvalidOperationException, and the mesh stays as it is); may be empty.
        /// </param>
        /// <param name="mesh">Readable (its default).</param>
        /// <param name="padBuffers">
        /// False: as many vertices and indices as the surface has. True: buffers only grow, which spares the engine
        /// new ones while sizes vary; then <see cref="Mesh.vertexCount"/> counts unused vertices at the end as well.
        /// </param>
        public unsafe void Upload(in SurfaceMeshView view, Mesh mesh, bool padBuffers = false)
        {
            if (mesh == null)
                throw new ArgumentNullException(nameof(mesh));
            SurfaceArrays.ThrowUnlessInHostMemory(view);
            int vertexCount = view.VertexCount, indexCount = checked(3 * view.TriangleCount);
            if (vertexCount > 0 && view.VertexLayout == SurfaceVertexLayout.Separate)
                throw new ArgumentException("must have interleaved or compact vertices", nameof(view));
            if (!view.IsValid)
                throw new ArgumentException("has ended: a newer mesh was collected", nameof(view));
            var style = new MeshStyle(view.VertexLayout == SurfaceVertexLayout.Compact, false, view.HasTexcoords);
            _writer.Reserve(mesh, style, vertexCount, indexCount, padBuffers);
            if (vertexCount > 0)
            {
                _writer.WriteVertices(
                    MeshStyle.SurfaceStream, style.SurfaceBytes, view.PositionsPointer, 0, vertexCount);
                if (!view.HasColors)
                    _white.Resize(vertexCount).Fill(uint.MaxValue);
                fixed (byte* colors = view.Colors)
                    _writer.WriteVertices(MeshStyle.AtomStream, MeshStyle.AtomBytes,
                        view.HasColors ? colors : (void*)_white.Pointer, 0, vertexCount);
                fixed (float* texcoords = view.Texcoords)
                    if (view.HasTexcoords)
                        _writer.WriteVertices(
                            MeshStyle.TexcoordStream, MeshStyle.TexcoordBytes, texcoords, 0, vertexCount);
                _writer.WriteIndices(view.IndicesPointer, 0, indexCount);
            }
            _writer.Finish(BoundsOf(view), vertexCount, indexCount);
        }

        internal static Bounds BoundsOf(in SurfaceMeshView view)
        {
            var bounds = new Bounds();
            (float X, float Y, float Z) low = view.BoundsMin, high = view.BoundsMax;
            bounds.SetMinMax(new Vector3(low.X, low.Y, low.Z), new Vector3(high.X, high.Y, high.Z));
            return bounds;
        }
    }
}
