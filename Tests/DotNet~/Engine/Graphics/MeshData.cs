// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;
using System.Collections.Generic;
using Unity.Collections;
using Unity.Collections.LowLevel.Unsafe;
using UnityEngine.Rendering;

namespace UnityEngine
{
    public sealed unsafe partial class Mesh
    {
        public static MeshDataArray AcquireReadOnlyMeshData(Mesh mesh)
        {
            if (mesh == null)
                throw new ArgumentNullException(nameof(mesh), "Mesh is null");
            mesh.RequireAlive("AcquireReadOnlyMeshData");
            mesh.RequireReadable("vertex");
            return new MeshDataArray(mesh.Buffers.Share(), null, false);
        }

        public static MeshDataArray AcquireReadOnlyMeshData(Mesh[] meshes)
        {
            foreach (Mesh mesh in meshes ?? throw new ArgumentNullException(nameof(meshes), "Mesh array is null"))
                mesh.RequireReadable("vertex");
            return new MeshDataArray(null, Array.ConvertAll(meshes, mesh => mesh.Buffers.Share()), false);
        }

        public static MeshDataArray AllocateWritableMeshData(int meshCount)
        {
            if (meshCount == 1)
                return new MeshDataArray(MeshBuffers.Create(), null, true);
            var many = new MeshBuffers[meshCount];
            for (int i = 0; i < meshCount; ++i)
                many[i] = MeshBuffers.Create();
            return new MeshDataArray(null, many, true);
        }

        public static void ApplyAndDisposeWritableMeshData(MeshDataArray data, Mesh mesh,
            MeshUpdateFlags flags = MeshUpdateFlags.Default)
        {
            if (mesh == null)
                throw new ArgumentNullException(nameof(mesh), "Mesh is null");
            if (data.Length != 1)
                throw new InvalidOperationException(
                    $"MeshDataArray length must be 1 to apply to one mesh, was {data.Length}");
            mesh.RequireReadable("vertex");
            mesh.Adopt(data.BuffersOf(0).Share(), flags);
            data.Dispose();
        }

        public static void ApplyAndDisposeWritableMeshData(MeshDataArray data, Mesh[] meshes,
            MeshUpdateFlags flags = MeshUpdateFlags.Default)
        {
            if (data.Length != meshes.Length)
                throw new InvalidOperationException($"MeshDataArray length ({data.Length}) must match destination " +
                    $"meshes array length ({meshes.Length})");
            for (int i = 0; i < meshes.Length; ++i)
                meshes[i].Adopt(data.BuffersOf(i).Share(), flags);
            data.Dispose();
        }

        /// <summary>Snapshots; those of one mesh make no garbage.</summary>
        public struct MeshDataArray : IDisposable
        {
            private MeshBuffers _one;
            private MeshBuffers[] _many;
#if ENABLE_UNITY_COLLECTIONS_CHECKS
            private readonly AtomicSafetyHandle _safety;
#endif

            internal MeshDataArray(MeshBuffers one, MeshBuffers[] many, bool isWritable)
            {
                _one = one;
                _many = many;
#if ENABLE_UNITY_COLLECTIONS_CHECKS
                _safety = AtomicSafetyHandle.Create();
                if (!isWritable)
                {
                    AtomicSafetyHandle.SetAllowSecondaryVersionWriting(_safety, false);
                    AtomicSafetyHandle.UseSecondaryVersion(ref _safety);
                }
#endif
            }

            public readonly int Length => _one != null ? 1 : _many?.Length ?? 0;

            public readonly MeshData this[int index]
            {
                get
                {
                    if ((uint)index >= (uint)Length)
                        throw new IndexOutOfRangeException($"Index {index} is out of range of '{Length}' Length.");
#if ENABLE_UNITY_COLLECTIONS_CHECKS
                    AtomicSafetyHandle.CheckReadAndThrow(_safety);
                    return new MeshData { _buffers = BuffersOf(index), _safety = _safety };
#else
                    return new MeshData { _buffers = BuffersOf(index) };
#endif
                }
            }

            public void Dispose()
            {
#if ENABLE_UNITY_COLLECTIONS_CHECKS
                AtomicSafetyHandle.CheckDeallocateAndThrow(_safety);
                AtomicSafetyHandle.Release(_safety);
#endif
                for (int i = 0; i < Length; ++i)
                    BuffersOf(i).Release();
                _one = null;
                _many = null;
            }

            internal readonly MeshBuffers BuffersOf(int index) => _one ?? _many[index];
        }

        public struct MeshData
        {
            internal MeshBuffers _buffers;
#if ENABLE_UNITY_COLLECTIONS_CHECKS
            internal AtomicSafetyHandle _safety;
#endif

            public readonly int vertexCount => Readable.VertexCount;

            public readonly int vertexBufferCount => Readable.Layout.UsedStreams;

            public readonly IndexFormat indexFormat => Readable.IndexFormat;

            public int subMeshCount
            {
                readonly get => Readable.SubMeshes.Count;
                set
                {
                    List<SubMeshDescriptor> subMeshes = Writable.SubMeshes;
                    subMeshes.Clear();
                    for (int i = 0; i < value; ++i)
                        subMeshes.Add(default);
                }
            }

            public readonly bool HasVertexAttribute(VertexAttribute attr) =>
                Readable.Layout.TryFind(attr, out _, out _);

            public readonly int GetVertexBufferStride(int stream) => Readable.Layout.StrideOf(stream);

            public readonly int GetVertexAttributeOffset(VertexAttribute attr)
            {
                Readable.Layout.TryFind(attr, out _, out int offset);
                return offset;
            }

            public readonly int GetVertexAttributeStream(VertexAttribute attr) =>
                Readable.Layout.TryFind(attr, out VertexAttributeDescriptor found, out _) ? found.stream : -1;

            public readonly SubMeshDescriptor GetSubMesh(int index) => Readable.SubMeshes[index];

            public readonly void GetVertices(NativeArray<Vector3> outVertices) =>
                CopyInto(outVertices, VertexAttribute.Position, VertexAttributeFormat.Float32, 3);

            public readonly void GetNormals(NativeArray<Vector3> outNormals) =>
                CopyInto(outNormals, VertexAttribute.Normal, VertexAttributeFormat.Float32, 3);

            public readonly void GetColors(NativeArray<Color32> outColors) =>
                CopyInto(outColors, VertexAttribute.Color, VertexAttributeFormat.UNorm8, 4);

            public readonly void GetColors(NativeArray<Color> outColors) =>
                CopyInto(outColors, VertexAttribute.Color, VertexAttributeFormat.Float32, 4);

            public readonly void GetUVs(int channel, NativeArray<Vector2> outUVs) =>
                CopyInto(outUVs, VertexAttribute.TexCoord0 + channel, VertexAttributeFormat.Float32, 2);

            public readonly NativeArray<T> GetVertexData<T>(int stream = 0) where T : struct
            {
                MeshBuffers buffers = Readable;
                if (stream < 0 || stream >= buffers.Layout.UsedStreams)
                    throw new ArgumentOutOfRangeException(nameof(stream), $"There are {buffers.Layout.UsedStreams}.");
                return ViewOf<T>(buffers.Stream(stream), buffers.StreamBytes(stream));
            }

            public readonly NativeArray<T> GetIndexData<T>() where T : struct =>
                ViewOf<T>(Readable.Indices, Readable.IndexBytes);

            public readonly void GetIndices(NativeArray<int> outIndices, int submesh, bool applyBaseVertex = true)
            {
                SubMeshDescriptor range = Readable.SubMeshes[submesh];
                if (outIndices.Length < range.indexCount)
                    throw new InvalidOperationException(
                        $"Not enough space in output buffer (need {range.indexCount}, has {outIndices.Length})");
                for (int i = 0; i < range.indexCount; ++i)
                    outIndices[i] = (int)_buffers.Index((long)range.indexStart + i) +
                        (applyBaseVertex ? range.baseVertex : 0);
            }

            public readonly void SetVertexBufferParams(int vertexCount,
                params VertexAttributeDescriptor[] attributes) => Writable.SetVertexParams(vertexCount, attributes);

            public readonly void SetVertexBufferParams(int vertexCount,
                NativeArray<VertexAttributeDescriptor> attributes) => Writable.SetVertexParams(vertexCount,
                new ReadOnlySpan<VertexAttributeDescriptor>(attributes.GetUnsafeReadOnlyPtr(), attributes.Length));

            public readonly void SetIndexBufferParams(int indexCount, IndexFormat format) =>
                Writable.SetIndexParams(indexCount, format);

            public readonly void SetSubMesh(int index, SubMeshDescriptor desc,
                MeshUpdateFlags flags = MeshUpdateFlags.Default) =>
                Writable.SetSubMesh(index, desc, (flags & MeshUpdateFlags.DontRecalculateBounds) == 0);

            private readonly MeshBuffers Readable
            {
                get
                {
#if ENABLE_UNITY_COLLECTIONS_CHECKS
                    AtomicSafetyHandle.CheckReadAndThrow(_safety);
#endif
                    return _buffers;
                }
            }

            private readonly MeshBuffers Writable
            {
                get
                {
#if ENABLE_UNITY_COLLECTIONS_CHECKS
                    AtomicSafetyHandle.CheckWriteAndThrow(_safety);
#endif
                    return _buffers;
                }
            }

            private readonly NativeArray<T> ViewOf<T>(void* data, long bytes) where T : struct
            {
                int size = UnsafeUtility.SizeOf<T>();
                if (bytes % size != 0)
                    throw new ArgumentException($"A mesh buffer of {bytes} bytes is no whole number of {typeof(T)}, " +
                        $"which has {size}.");
                var view = NativeArrayUnsafeUtility.ConvertExistingDataToNativeArray<T>(data, (int)(bytes / size),
                    Allocator.None);
#if ENABLE_UNITY_COLLECTIONS_CHECKS
                NativeArrayUnsafeUtility.SetAtomicSafetyHandle(ref view, _safety);
#endif
                return view;
            }

            private readonly void CopyInto<T>(NativeArray<T> buffer, VertexAttribute attribute,
                VertexAttributeFormat format, int dimension) where T : struct
            {
                MeshBuffers buffers = Readable;
                if (!HasVertexAttribute(attribute))
                    throw new InvalidOperationException($"Mesh data does not have {attribute} vertex component");
                if (buffer.Length < buffers.VertexCount)
                    throw new InvalidOperationException(
                        $"Not enough space in output buffer (need {buffers.VertexCount}, has {buffer.Length})");
                VertexNumbers.Read(buffers, attribute, format, dimension, (byte*)buffer.GetUnsafePtr());
            }
        }
    }
}
