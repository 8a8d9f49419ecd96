// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;
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
            return new MeshDataArray(mesh.Buffers.Share());
        }

        /// <summary>A snapshot of one mesh; makes no garbage.</summary>
        public struct MeshDataArray : IDisposable
        {
            private MeshBuffers _buffers;
#if ENABLE_UNITY_COLLECTIONS_CHECKS
            private readonly AtomicSafetyHandle _safety;
#endif

            internal MeshDataArray(MeshBuffers buffers)
            {
                _buffers = buffers;
#if ENABLE_UNITY_COLLECTIONS_CHECKS
                _safety = AtomicSafetyHandle.Create();
                AtomicSafetyHandle.SetAllowSecondaryVersionWriting(_safety, false);
                AtomicSafetyHandle.UseSecondaryVersion(ref _safety);
#endif
            }

            public readonly int Length => _buffers != null ? 1 : 0;

            public readonly MeshData this[int index]
            {
                get
                {
                    if ((uint)index >= (uint)Length)
                        throw new IndexOutOfRangeException($"Index {index} is out of range of '{Length}' Length.");
#if ENABLE_UNITY_COLLECTIONS_CHECKS
                    AtomicSafetyHandle.CheckReadAndThrow(_safety);
                    return new MeshData { _buffers = _buffers, _safety = _safety };
#else
                    return new MeshData { _buffers = _buffers };
#endif
                }
            }

            public void Dispose()
            {
#if ENABLE_UNITY_COLLECTIONS_CHECKS
                AtomicSafetyHandle.CheckDeallocateAndThrow(_safety);
                AtomicSafetyHandle.Release(_safety);
#endif
                _buffers?.Release();
                _buffers = null;
            }
        }

        public struct MeshData
        {
            internal MeshBuffers _buffers;
#if ENABLE_UNITY_COLLECTIONS_CHECKS
            internal AtomicSafetyHandle _safety;
#endif

            public readonly int vertexCount => Readable.VertexCount;

            public readonly SubMeshDescriptor GetSubMesh(int index) => Readable.SubMeshes[index];

            public readonly NativeArray<T> GetVertexData<T>(int stream = 0) where T : struct
            {
                MeshBuffers buffers = Readable;
                if (stream < 0 || stream >= buffers.Layout.UsedStreams)
                    throw new ArgumentOutOfRangeException(nameof(stream), $"There are {buffers.Layout.UsedStreams}.");
                return ViewOf<T>(buffers.Stream(stream), buffers.StreamBytes(stream));
            }

            public readonly NativeArray<T> GetIndexData<T>() where T : struct =>
                ViewOf<T>(Readable.Indices, Readable.IndexBytes);

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
        }
    }
}
