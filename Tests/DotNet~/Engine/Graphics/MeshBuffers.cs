// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using UnityEngine;
using UnityEngine.Rendering;

namespace QuickSes.EngineDouble
{
    /// <summary>
    /// The data of a mesh, in unmanaged memory. Shared by a mesh and the snapshots of it; a mesh that is changed while
    /// there are snapshots goes on with a copy. Objects are used again, so that neither makes garbage.
    /// </summary>
    internal sealed unsafe class MeshBuffers
    {
        private static readonly Stack<MeshBuffers> s_unused = new Stack<MeshBuffers>();

        private readonly IntPtr[] _streams = new IntPtr[VertexLayout.StreamCount];
        private readonly long[] _streamBytes = new long[VertexLayout.StreamCount];
        private readonly int[] _streamNames = new int[VertexLayout.StreamCount]; // of GraphicsMemory; 0: none
        private IntPtr _indices;
        private long _indexBytes;
        private int _indexName;
        private int _references;

        private MeshBuffers()
        {
        }

        public VertexLayout Layout { get; } = new VertexLayout();

        public List<SubMeshDescriptor> SubMeshes { get; } = new List<SubMeshDescriptor>();

        public int VertexCount { get; private set; }

        public int IndexCount { get; private set; }

        public IndexFormat IndexFormat { get; private set; }

        public Bounds Bounds { get; set; }

        public bool IsShared => _references > 1;

        public int IndexSize => IndexFormat == IndexFormat.UInt16 ? 2 : 4;

        public byte* Indices => (byte*)_indices;

        public static MeshBuffers Create()
        {
            MeshBuffers buffers = s_unused.Count > 0 ? s_unused.Pop() : new MeshBuffers();
            buffers._references = 1;
            buffers.Clear(false);
            return buffers;
        }

        public MeshBuffers Share()
        {
            ++_references;
            return this;
        }

        public void Release()
        {
            if (--_references > 0)
                return;
            Clear(false);
            s_unused.Push(this);
        }

        public MeshBuffers Copy()
        {
            MeshBuffers copy = Create();
            copy.SetVertexParams(VertexCount, Layout.Attributes);
            copy.SetIndexParams(IndexCount, IndexFormat);
            for (int stream = 0; stream < VertexLayout.StreamCount; ++stream)
                Buffer.MemoryCopy((void*)_streams[stream], (void*)copy._streams[stream], _streamBytes[stream],
                    _streamBytes[stream]);
            Buffer.MemoryCopy((void*)_indices, (void*)copy._indices, _indexBytes, _indexBytes);
            copy.SubMeshes.Clear();
            foreach (SubMeshDescriptor subMesh in SubMeshes)
                copy.SubMeshes.Add(subMesh);
            copy.Bounds = Bounds;
            return copy;
        }

        public void Clear(bool keepVertexLayout)
        {
            VertexCount = 0;
            if (!keepVertexLayout)
                Layout.Set(ReadOnlySpan<VertexAttributeDescriptor>.Empty);
            for (int stream = 0; stream < VertexLayout.StreamCount; ++stream)
                Resize(ref _streams[stream], ref _streamBytes[stream], 0, ref _streamNames[stream]);
            IndexCount = 0;
            if (!keepVertexLayout)
                IndexFormat = IndexFormat.UInt16;
            Resize(ref _indices, ref _indexBytes, 0, ref _indexName);
            SubMeshes.Clear();
            SubMeshes.Add(default);
            Bounds = default;
        }

        /// <summary>Of the buffer that the graphics API has of a stream, or of the indices; 0: of none.</summary>
        public int NameOf(int stream) => Name(ref _streamNames[stream], _streams[stream], _streamBytes[stream]);

        public int NameOfIndices() => Name(ref _indexName, _indices, _indexBytes);

        /// <summary>The graphics API gets other buffers.</summary>
        public void Rename()
        {
            for (int stream = 0; stream < VertexLayout.StreamCount; ++stream)
                GraphicsMemory.Forget(ref _streamNames[stream]);
            GraphicsMemory.Forget(ref _indexName);
        }

        public byte* Stream(int stream) => (byte*)_streams[stream];

        public long StreamBytes(int stream) => (uint)stream < VertexLayout.StreamCount ? _streamBytes[stream] : 0;

        public long IndexBytes => _indexBytes;

        /// <summary>What the new buffers hold is NaN, so that what nobody writes is noticed.</summary>
        public void SetVertexParams(int vertexCount, ReadOnlySpan<VertexAttributeDescriptor> attributes)
        {
            if (vertexCount < 0)
                throw new ArgumentOutOfRangeException(nameof(vertexCount), "The vertex count can't be negative.");
            Layout.Set(attributes);
            VertexCount = vertexCount;
            for (int stream = 0; stream < VertexLayout.StreamCount; ++stream)
                Resize(ref _streams[stream], ref _streamBytes[stream], (long)Layout.StrideOf(stream) * vertexCount,
                    ref _streamNames[stream]);
        }

        public void SetIndexParams(int indexCount, IndexFormat format)
        {
            if (indexCount < 0)
                throw new ArgumentOutOfRangeException(nameof(indexCount), "The index count can't be negative.");
            IndexFormat = format;
            IndexCount = indexCount;
            Resize(ref _indices, ref _indexBytes, (long)IndexSize * indexCount, ref _indexName);
        }

        public void WriteVertices(int stream, void* data, int dataStart, int start, int count, int elementSize)
        {
            if (stream < 0 || stream >= VertexLayout.StreamCount || Layout.StrideOf(stream) == 0)
                throw new ArgumentOutOfRangeException(nameof(stream), $"The mesh has no vertex stream {stream}.");
            int stride = Layout.StrideOf(stream);
            if (stride % elementSize != 0 && elementSize % stride != 0)
                throw new ArgumentException($"Elements of {elementSize} bytes don't fit vertices of {stride} bytes.");
            Write((byte*)_streams[stream], _streamBytes[stream], data, dataStart, start, count, elementSize);
        }

        public void WriteIndices(void* data, int dataStart, int start, int count, int elementSize)
        {
            if (elementSize != IndexSize && elementSize != 1)
                throw new ArgumentException($"Elements of {elementSize} bytes don't fit indices of {IndexSize} bytes.");
            Write((byte*)_indices, _indexBytes, data, dataStart, start, count, elementSize);
        }

        public long Index(long at) => IndexFormat == IndexFormat.UInt16
            ? ((ushort*)_indices)[at]
            : ((uint*)_indices)[at];

        public void SetSubMesh(int index, SubMeshDescriptor subMesh, bool measure)
        {
            if ((uint)index >= (uint)SubMeshes.Count)
                throw new IndexOutOfRangeException(
                    $"Submesh {index} is out of range: the mesh has {SubMeshes.Count} of them.");
            if (subMesh.indexStart < 0 || subMesh.indexCount < 0 ||
                (long)subMesh.indexStart + subMesh.indexCount > IndexCount)
                throw new ArgumentOutOfRangeException(nameof(subMesh),
                    $"Indices {subMesh.indexStart} to {(long)subMesh.indexStart + subMesh.indexCount} of the submesh " +
                    $"are beyond the index buffer, which has {IndexCount}.");
            if (measure)
                MeshMeasure.Measure(this, ref subMesh);
            SubMeshes[index] = subMesh;
        }

        private static void Write(byte* to, long size, void* data, int dataStart, int start, int count, int elementSize)
        {
            long begin = (long)start * elementSize, bytes = (long)count * elementSize;
            if (begin + bytes > size)
                throw new ArgumentOutOfRangeException(nameof(count), $"Bytes {begin} to {begin + bytes} are written " +
                    $"to a mesh buffer of {size} bytes.");
            Buffer.MemoryCopy((byte*)data + (long)dataStart * elementSize, to + begin, bytes, bytes);
        }

        private static int Name(ref int name, IntPtr block, long size)
        {
            if (name == 0 && block != IntPtr.Zero)
                name = GraphicsMemory.Add(block, size);
            return name;
        }

        private static void Resize(ref IntPtr block, ref long size, long newSize, ref int name)
        {
            if (size == newSize)
                return;
            GraphicsMemory.Forget(ref name);
            NativeHeap.Free((void*)block, NativeHeap.Meshes);
            block = newSize == 0 ? IntPtr.Zero : (IntPtr)NativeHeap.Allocate(newSize, 16, NativeHeap.Meshes);
            size = newSize;
        }
    }
}
