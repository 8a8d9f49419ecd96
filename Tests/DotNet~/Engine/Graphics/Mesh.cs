// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;
using System.Collections.Generic;
using Unity.Collections;
using Unity.Collections.LowLevel.Unsafe;
using UnityEngine.Rendering;

namespace UnityEngine
{
    public sealed unsafe partial class Mesh : Object
    {
        private bool _isReadable = true;
        private GraphicsBuffer.Target _vertexTarget = GraphicsBuffer.Target.Vertex;
        private GraphicsBuffer.Target _indexTarget = GraphicsBuffer.Target.Index;

        public Mesh()
        {
        }

        internal MeshBuffers Buffers { get; private set; } = MeshBuffers.Create();

        internal MeshRecord Record { get; } = new MeshRecord();

        public bool isReadable
        {
            get
            {
                RequireAlive("get_isReadable");
                return _isReadable;
            }
        }

        public int vertexCount
        {
            get
            {
                RequireAlive("get_vertexCount");
                return Buffers.VertexCount;
            }
        }

        public IndexFormat indexFormat
        {
            get
            {
                RequireAlive("get_indexFormat");
                return Buffers.IndexFormat;
            }
            set
            {
                RequireAlive("set_indexFormat");
                if (value != Buffers.IndexFormat)
                    Writable().SetIndexParams(0, value);
            }
        }

        public int subMeshCount
        {
            get
            {
                RequireAlive("get_subMeshCount");
                return Buffers.SubMeshes.Count;
            }
            set
            {
                RequireAlive("set_subMeshCount");
                if (value < 0)
                    throw new ArgumentOutOfRangeException(nameof(value), "The submesh count can't be negative.");
                List<SubMeshDescriptor> subMeshes = Writable().SubMeshes;
                while (subMeshes.Count > value)
                    subMeshes.RemoveAt(subMeshes.Count - 1);
                while (subMeshes.Count < value)
                    subMeshes.Add(default);
            }
        }

        public Bounds bounds
        {
            get
            {
                RequireAlive("get_bounds");
                return Buffers.Bounds;
            }
            set
            {
                RequireAlive("set_bounds");
                Writable().Bounds = value;
                Record.Change(this);
            }
        }

        public void Clear() => Clear(true);

        public void Clear(bool keepVertexLayout)
        {
            RequireAlive("Clear");
            Writable().Clear(keepVertexLayout);
            Record.NoteChange(this, MeshUpdateFlags.Default);
        }

        /// <summary>What the buffers can be used for besides; another value makes the engine make others.</summary>
        public GraphicsBuffer.Target vertexBufferTarget
        {
            get => _vertexTarget;
            set => SetTarget(ref _vertexTarget, value, "set_vertexBufferTarget");
        }

        public GraphicsBuffer.Target indexBufferTarget
        {
            get => _indexTarget;
            set => SetTarget(ref _indexTarget, value, "set_indexBufferTarget");
        }

        /// <summary>The graphics API's buffer of a stream (OpenGL: its name), until the mesh gets another one.</summary>
        public IntPtr GetNativeVertexBufferPtr(int index)
        {
            RequireAlive("GetNativeVertexBufferPtr");
            ++Record.NativePointerCalls;
            if (index < 0 || index >= VertexLayout.StreamCount)
                throw new ArgumentOutOfRangeException(nameof(index));
            return (IntPtr)Writable().NameOf(index);
        }

        public IntPtr GetNativeIndexBufferPtr()
        {
            RequireAlive("GetNativeIndexBufferPtr");
            ++Record.NativePointerCalls;
            return (IntPtr)Writable().NameOfIndices();
        }

        public GraphicsBuffer GetVertexBuffer(int index) => new GraphicsBuffer((int)GetNativeVertexBufferPtr(index));

        public GraphicsBuffer GetIndexBuffer() => new GraphicsBuffer((int)GetNativeIndexBufferPtr());

        private void SetTarget(ref GraphicsBuffer.Target target, GraphicsBuffer.Target value, string what)
        {
            RequireAlive(what);
            if (target != value)
                Writable().Rename();
            target = value;
        }

        public void MarkDynamic() => RequireAlive("MarkDynamic");

        public void MarkModified()
        {
            RequireAlive("MarkModified");
            Record.Notify(this);
        }

        public void UploadMeshData(bool markNoLongerReadable)
        {
            RequireAlive("UploadMeshData");
            _isReadable &= !markNoLongerReadable;
        }

        public void SetVertexBufferParams(int vertexCount, params VertexAttributeDescriptor[] attributes)
        {
            RequireAlive("SetVertexBufferParams");
            SetVertexParams(vertexCount, attributes);
        }

        public void SetIndexBufferParams(int indexCount, IndexFormat format)
        {
            RequireAlive("SetIndexBufferParams");
            RequireReadable("index");
            if (Record.RefusesIndices)
                throw new OutOfMemoryException("There is no memory for indices.");
            Writable().SetIndexParams(indexCount, format);
            ++Record.IndexParamsCalls;
            Record.Change(this);
        }

        public void SetVertexBufferData<T>(NativeArray<T> data, int dataStart, int meshBufferStart, int count,
            int stream = 0, MeshUpdateFlags flags = MeshUpdateFlags.Default) where T : struct
        {
            RequireAlive("SetVertexBufferData");
            RequireReadable("vertex");
            RequireRange(data.Length, dataStart, meshBufferStart, count);
            WriteVertices<T>(stream, data.GetUnsafeReadOnlyPtr(), dataStart, meshBufferStart, count, flags);
        }

        public void SetVertexBufferData<T>(T[] data, int dataStart, int meshBufferStart, int count, int stream = 0,
            MeshUpdateFlags flags = MeshUpdateFlags.Default) where T : struct
        {
            RequireAlive("SetVertexBufferData");
            RequireReadable("vertex");
            RequireRange(data.Length, dataStart, meshBufferStart, count);
            void* address = UnsafeUtility.PinGCArrayAndGetDataAddress(data, out ulong pin);
            try
            {
                WriteVertices<T>(stream, address, dataStart, meshBufferStart, count, flags);
            }
            finally
            {
                UnsafeUtility.ReleaseGCObject(pin);
            }
        }

        /// <summary>An unreadable mesh is an error in the log here, not an exception, as in the engine.</summary>
        public void SetIndexBufferData<T>(NativeArray<T> data, int dataStart, int meshBufferStart, int count,
            MeshUpdateFlags flags = MeshUpdateFlags.Default) where T : struct
        {
            RequireAlive("SetIndexBufferData");
            if (LogsThatIndicesCantBeAccessed())
                return;
            RequireRange(data.Length, dataStart, meshBufferStart, count);
            WriteIndices<T>(data.GetUnsafeReadOnlyPtr(), dataStart, meshBufferStart, count, flags);
        }

        public void SetIndexBufferData<T>(T[] data, int dataStart, int meshBufferStart, int count,
            MeshUpdateFlags flags = MeshUpdateFlags.Default) where T : struct
        {
            RequireAlive("SetIndexBufferData");
            if (LogsThatIndicesCantBeAccessed())
                return;
            RequireRange(data.Length, dataStart, meshBufferStart, count);
            void* address = UnsafeUtility.PinGCArrayAndGetDataAddress(data, out ulong pin);
            try
            {
                WriteIndices<T>(address, dataStart, meshBufferStart, count, flags);
            }
            finally
            {
                UnsafeUtility.ReleaseGCObject(pin);
            }
        }

        public void SetSubMesh(int index, SubMeshDescriptor desc, MeshUpdateFlags flags = MeshUpdateFlags.Default)
        {
            RequireAlive("SetSubMesh");
            bool measures = (flags & MeshUpdateFlags.DontRecalculateBounds) == 0;
            MeshBuffers buffers = Writable();
            buffers.SetSubMesh(index, desc, measures);
            if (measures)
                buffers.Bounds = MeshMeasure.UnionOfSubMeshes(buffers);
            ++Record.SubMeshCalls;
            if ((flags & MeshUpdateFlags.DontValidateIndices) == 0)
                LogIndicesOutOfBounds(desc.indexStart, desc.indexCount, desc.baseVertex);
            Record.NoteChange(this, flags);
        }

        public SubMeshDescriptor GetSubMesh(int index)
        {
            RequireAlive("GetSubMesh");
            RequireSubMesh(index);
            return Buffers.SubMeshes[index];
        }

        internal override void OnDestroying()
        {
            Buffers.Release();
            Buffers = null;
        }

        internal void RequireReadable(string what)
        {
            if (!_isReadable)
                throw new InvalidOperationException($"Not allowed to access {what} data on mesh '{name}' (isReadable " +
                    "is false; Read/Write must be enabled in import settings)");
        }

        private MeshBuffers Writable()
        {
            if (!Buffers.IsShared)
                return Buffers;
            MeshBuffers copy = Buffers.Copy();
            Buffers.Release();
            return Buffers = copy;
        }

        private void SetVertexParams(int vertexCount, ReadOnlySpan<VertexAttributeDescriptor> attributes)
        {
            RequireReadable("vertex");
            Writable().SetVertexParams(vertexCount, attributes);
            ++Record.VertexParamsCalls;
            Record.Change(this);
        }

        private void WriteVertices<T>(int stream, void* data, int dataStart, int start, int count,
            MeshUpdateFlags flags) where T : struct
        {
            Writable().WriteVertices(stream, data, dataStart, start, count, UnsafeUtility.SizeOf<T>());
            ++Record.VertexUploads;
            Record.NoteBytes((long)count * UnsafeUtility.SizeOf<T>());
            Record.NoteChange(this, flags);
        }

        private void WriteIndices<T>(void* data, int dataStart, int start, int count, MeshUpdateFlags flags)
            where T : struct
        {
            MeshBuffers buffers = Writable();
            buffers.WriteIndices(data, dataStart, start, count, UnsafeUtility.SizeOf<T>());
            ++Record.IndexUploads;
            Record.NoteBytes((long)count * UnsafeUtility.SizeOf<T>());
            if ((flags & MeshUpdateFlags.DontValidateIndices) == 0)
                LogIndicesOutOfBounds(start * UnsafeUtility.SizeOf<T>() / buffers.IndexSize,
                    count * UnsafeUtility.SizeOf<T>() / buffers.IndexSize, 0);
            Record.NoteChange(this, flags);
        }

        private void LogIndicesOutOfBounds(int start, int count, int baseVertex)
        {
            for (int i = start; i < start + count; ++i)
            {
                if (Buffers.Index(i) + baseVertex < Buffers.VertexCount)
                    continue;
                Debug.LogError($"Failed setting triangles. Some indices are referencing out of bounds vertices. " +
                    $"IndexCount: {count}, VertexCount: {Buffers.VertexCount}");
                return;
            }
        }

        private bool LogsThatIndicesCantBeAccessed()
        {
            if (_isReadable)
                return false;
            Debug.LogError($"Not allowed to access triangles/indices on mesh '{name}' (isReadable is false; " +
                "Read/Write must be enabled in import settings)");
            return true;
        }

        private void RequireSubMesh(int index)
        {
            if ((uint)index >= (uint)Buffers.SubMeshes.Count)
                throw new IndexOutOfRangeException("Specified sub mesh is out of range. Must be greater or equal to " +
                    "0 and less than subMeshCount.");
        }

        private static void RequireRange(int length, int dataStart, int meshBufferStart, int count)
        {
            if (dataStart < 0 || meshBufferStart < 0 || count < 0 || (long)dataStart + count > length)
                throw new ArgumentOutOfRangeException($"Bad start/count arguments (dataStart:{dataStart} " +
                    $"meshBufferStart:{meshBufferStart} count:{count})");
        }
    }
}
