// SPDX-License-Identifier: MIT
using System;
using System.Runtime.InteropServices;
using Unity.Collections;
using Unity.Collections.LowLevel.Unsafe;
using Unity.Profiling;
using UnityEngine;
using UnityEngine.Rendering;

namespace QuickSes
{
    /// <summary>
    /// Copies a computed surface into a <see cref="Mesh"/>: straight from native memory, without garbage, and without
    /// the engine checking or measuring it again. Main thread only. Use one for one mesh, frame after frame.
    /// </summary>
    /// <remarks>
    /// The mesh gets streams of vertices (0: position and normal; 1: colour, white if the surface has none; 2: texture
    /// coordinate 1, if the surface has them), one submesh of triangles with 32-bit indices, and the surface's own bounds. Its numbers are those the
    /// atoms were given in: Unity's, if they were, with the front faces outside.
    /// </remarks>
    public sealed class SurfaceMeshUploader : IDisposable
    {
        private const MeshUpdateFlags Unchecked = MeshUpdateFlags.DontValidateIndices |
            MeshUpdateFlags.DontResetBoneBounds | MeshUpdateFlags.DontNotifyMeshUsers |
            MeshUpdateFlags.DontRecalculateBounds;

        private static readonly ProfilerMarker s_marker = new ProfilerMarker("QuickSES.Upload");

        private static readonly VertexAttributeDescriptor[] s_layout =
        {
            new VertexAttributeDescriptor(VertexAttribute.Position, VertexAttributeFormat.Float32, 3),
            new VertexAttributeDescriptor(VertexAttribute.Normal, VertexAttributeFormat.Float32, 3),
            new VertexAttributeDescriptor(VertexAttribute.Color, VertexAttributeFormat.UNorm8, 4, 1)
        };

        private static readonly VertexAttributeDescriptor[] s_layoutWithTexcoord =
        {
            s_layout[0], s_layout[1], s_layout[2],
            new VertexAttributeDescriptor(VertexAttribute.TexCoord1, VertexAttributeFormat.Float32, 2, 2)
        };

        private readonly UnmanagedBuffer<uint> _white = new UnmanagedBuffer<uint>();
        private Mesh _mesh; // whose buffers the next four describe
        private VertexAttributeDescriptor[] _layout;
        private int _vertexCapacity;
        private int _indexCapacity;
#if ENABLE_UNITY_COLLECTIONS_CHECKS
        private AtomicSafetyHandle _safety; // of the views of native memory; the engine needs one to read them
        private bool _hasSafety;
#endif

        /// <summary>Releases what the editor keeps for its checks. The mesh is the caller's.</summary>
        public void Dispose()
        {
            _mesh = null;
            _white.Dispose();
#if ENABLE_UNITY_COLLECTIONS_CHECKS
            if (!_hasSafety)
                return;
            _hasSafety = false;
            AtomicSafetyHandle.CheckDeallocateAndThrow(_safety);
            AtomicSafetyHandle.Release(_safety);
#endif
        }

        /// <summary>Replaces the content of a mesh. Throws without having changed it.</summary>
        /// <param name="view">Of the layout <see cref="SurfaceVertexLayout.Interleaved"/>; may be empty.</param>
        /// <param name="mesh">Readable (its default).</param>
        /// <param name="padBuffers">
        /// False: as many vertices and indices as the surface has. True: buffers only grow, which spares the engine
        /// new ones while sizes vary; then <see cref="Mesh.vertexCount"/> counts unused vertices at the end as well.
        /// </param>
        public unsafe void Upload(in SurfaceMeshView view, Mesh mesh, bool padBuffers = false)
        {
            if (mesh == null)
                throw new ArgumentNullException(nameof(mesh));
            int vertexCount = view.VertexCount, indexCount = checked(3 * view.TriangleCount);
            if (vertexCount > 0 && view.VertexLayout != SurfaceVertexLayout.Interleaved)
                throw new ArgumentException("must have interleaved vertices", nameof(view));
            if (!view.IsValid)
                throw new ArgumentException("has ended: a newer mesh was collected", nameof(view));
            using (s_marker.Auto())
            {
                bool texcoords = view.HasTexcoords;
                Reserve(mesh, texcoords ? s_layoutWithTexcoord : s_layout, vertexCount, indexCount, padBuffers);
                if (vertexCount > 0)
                {
                    SetVertices<VectorPair>(mesh, view.Vertices, 0);
                    SetVertices<uint>(mesh,
                        view.HasColors ? view.Colors : MemoryMarshal.AsBytes(White(vertexCount)), 1);
                    if (texcoords)
                        SetVertices<Vector2>(mesh, MemoryMarshal.AsBytes(view.Texcoords), 2);
                    mesh.SetIndexBufferData(View<uint>(view.IndicesPointer, indexCount), 0, 0, indexCount, Unchecked);
                }
                var bounds = new Bounds();
                (float X, float Y, float Z) low = view.BoundsMin, high = view.BoundsMax;
                bounds.SetMinMax(new Vector3(low.X, low.Y, low.Z), new Vector3(high.X, high.Y, high.Z));
                var submesh = new SubMeshDescriptor(0, indexCount) { bounds = bounds, vertexCount = vertexCount };
                mesh.SetSubMesh(0, submesh, Unchecked);
                mesh.bounds = bounds;
                mesh.MarkModified(); // the flags keep the engine from telling renderers about the new bounds
            }
        }

        private void Reserve(Mesh mesh, VertexAttributeDescriptor[] layout, int vertices, int indices, bool padBuffers)
        {
            bool isKnown = _mesh == mesh;
            bool hasVertices = isKnown && _layout == layout && Suffices(_vertexCapacity, vertices, padBuffers);
            bool hasIndices = isKnown && Suffices(_indexCapacity, indices, padBuffers);
            if (!isKnown)
                mesh.subMeshCount = 1;
            if (!hasVertices)
            {
                _vertexCapacity = padBuffers ? Padded(vertices) : vertices;
                mesh.SetVertexBufferParams(_vertexCapacity, layout);
            }
            if (!hasIndices)
            {
                _indexCapacity = padBuffers ? Padded(indices) : indices;
                mesh.SetIndexBufferParams(_indexCapacity, IndexFormat.UInt32);
            }
            _mesh = mesh;
            _layout = layout;
        }

        private static bool Suffices(int capacity, int needed, bool padBuffers) =>
            padBuffers ? capacity >= needed : capacity == needed;

        private static int Padded(int count) => (int)Math.Min(count + (long)count / 4, int.MaxValue);

        private unsafe void SetVertices<T>(Mesh mesh, ReadOnlySpan<byte> bytes, int stream) where T : unmanaged
        {
            int count = bytes.Length / sizeof(T);
            fixed (byte* first = bytes)
                mesh.SetVertexBufferData(View<T>(first, count), 0, 0, count, stream, Unchecked);
        }

        private ReadOnlySpan<uint> White(int count)
        {
            if (_white.Length < count)
                _white.Resize(count).Fill(uint.MaxValue);
            return _white.Span.Slice(0, count);
        }

        private struct VectorPair
        {
            public Vector3 Position;
            public Vector3 Normal;
        }

        private unsafe NativeArray<T> View<T>(void* memory, int length) where T : unmanaged
        {
            NativeArray<T> view =
                NativeArrayUnsafeUtility.ConvertExistingDataToNativeArray<T>(memory, length, Allocator.None);
#if ENABLE_UNITY_COLLECTIONS_CHECKS
            if (!_hasSafety)
            {
                _safety = AtomicSafetyHandle.Create();
                _hasSafety = true;
            }
            NativeArrayUnsafeUtility.SetAtomicSafetyHandle(ref view, _safety);
#endif
            return view;
        }
    }
}
