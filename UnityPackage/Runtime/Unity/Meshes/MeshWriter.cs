// SPDX-License-Identifier: MIT
using System;
using System.Runtime.InteropServices;
using Unity.Profiling;
using UnityEngine;
using UnityEngine.Rendering;

namespace QuickSes
{
    /// <summary>
    /// Writes a surface into a mesh, in one piece or many: straight from native memory, without garbage, and without the
    /// engine checking or measuring it again. Remembers the buffers of the mesh, and notices if somebody else has
    /// changed them. Main thread only.
    /// </summary>
    internal sealed unsafe class MeshWriter : IDisposable
    {
        /// <summary>The engine neither checks nor measures what it is given.</summary>
        public const MeshUpdateFlags Unchecked = MeshUpdateFlags.DontValidateIndices |
            MeshUpdateFlags.DontResetBoneBounds | MeshUpdateFlags.DontNotifyMeshUsers |
            MeshUpdateFlags.DontRecalculateBounds;

        private static readonly ProfilerMarker s_marker = new ProfilerMarker("QuickSES.Upload");

        private readonly NativeMemory _memory = new NativeMemory();
        private Mesh _mesh; // whose buffers the next describe
        private VertexAttributeDescriptor[] _layout;
        private int _vertexCapacity;
        private int _indexCapacity;
        private int _indexCount; // of the submesh

        /// <summary>Whether buffers were made larger than what was to go into them.</summary>
        public bool HasRoom { get; private set; }

        /// <summary>The mesh is the caller's.</summary>
        public void Dispose()
        {
            Forget();
            _memory.Dispose();
        }

        /// <summary>Nothing is known of any mesh.</summary>
        public void Forget() => _mesh = null;

        /// <summary>Whether the mesh is still as this writer left it, as far as that can be asked without garbage.</summary>
        public bool IsIntact(Mesh mesh) =>
            _mesh == mesh && AreIntact(mesh, _layout, _vertexCapacity, _indexCount);

        /// <summary>Whether a mesh has such buffers, as far as that can be asked without garbage.</summary>
        public static bool AreIntact(Mesh mesh, VertexAttributeDescriptor[] layout, int vertices, int drawnIndices)
        {
            if (mesh.vertexCount != vertices || mesh.vertexAttributeCount != layout.Length ||
                mesh.indexFormat != IndexFormat.UInt32 || mesh.subMeshCount != 1 ||
                mesh.GetIndexCount(0) != (uint)drawnIndices)
                return false;
            foreach (VertexAttributeDescriptor attribute in layout)
                if (mesh.GetVertexAttributeStream(attribute.attribute) != attribute.stream ||
                    mesh.GetVertexAttributeFormat(attribute.attribute) != attribute.format ||
                    mesh.GetVertexAttributeDimension(attribute.attribute) != attribute.dimension)
                    return false;
            return true;
        }

        /// <summary>Whether <see cref="Reserve"/> would leave the buffers as they are.</summary>
        public bool Suffices(Mesh mesh, MeshStyle style, int vertices, int indices, bool withRoom) =>
            IsIntact(mesh) && _layout == style.Layout && Suffices(_vertexCapacity, vertices, withRoom) &&
            Suffices(_indexCapacity, indices, withRoom);

        /// <summary>Throws if a mesh can't be written to.</summary>
        public static void RequireWritable(Mesh mesh)
        {
            if (!mesh.isReadable)
                throw new InvalidOperationException(
                    $"The mesh '{mesh.name}' can't be written to: it was made unreadable (UploadMeshData).");
        }

        /// <summary>Gives a mesh the buffers it needs. Throws if it can't be written to.</summary>
        /// <param name="mesh">Readable (its default).</param>
        /// <param name="style">Of the vertices.</param>
        /// <param name="vertices">How many.</param>
        /// <param name="indices">How many.</param>
        /// <param name="withRoom">
        /// False: of just that size. True: they only grow, and by more than is needed, which spares the engine new ones
        /// while sizes vary; then Mesh.vertexCount counts unused vertices at the end as well.
        /// </param>
        public void Reserve(Mesh mesh, MeshStyle style, int vertices, int indices, bool withRoom)
        {
            RequireWritable(mesh);
            using (s_marker.Auto())
            {
                VertexAttributeDescriptor[] layout = style.Layout;
                bool isKnown = IsIntact(mesh);
                bool hasVertices = isKnown && _layout == layout && Suffices(_vertexCapacity, vertices, withRoom);
                bool hasIndices = isKnown && Suffices(_indexCapacity, indices, withRoom);
                _layout = layout;
                _mesh = null; // should something fail half way
                if (!isKnown)
                    mesh.subMeshCount = 1;
                ShowNothing(mesh);
                if (!hasVertices)
                {
                    _vertexCapacity = withRoom ? WithRoom(vertices) : vertices;
                    mesh.SetVertexBufferParams(_vertexCapacity, layout);
                }
                if (!hasIndices)
                {
                    _indexCapacity = withRoom ? WithRoom(indices) : indices;
                    mesh.SetIndexBufferParams(_indexCapacity, IndexFormat.UInt32);
                    ShowNothing(mesh); // what submeshes there are then is the engine's to say
                }
                HasRoom = withRoom;
                _mesh = mesh;
            }
        }

        /// <summary>Writes vertices first, first + 1, ... of one stream.</summary>
        /// <param name="stream">Of <see cref="MeshStyle"/>.</param>
        /// <param name="stride">Bytes of a vertex in it.</param>
        /// <param name="data">The first vertex to be written.</param>
        /// <param name="first">Its place.</param>
        /// <param name="count">How many.</param>
        public void WriteVertices(int stream, int stride, void* data, int first, int count)
        {
            using (s_marker.Auto())
            {
                switch (stride)
                {
                    case 4:
                        Write<uint>(stream, data, first, count);
                        break;
                    case 8:
                        Write<Vector2>(stream, data, first, count);
                        break;
                    case 16:
                        Write<Bytes16>(stream, data, first, count);
                        break;
                    default:
                        Write<Bytes24>(stream, data, first, count);
                        break;
                }
            }
        }

        /// <summary>Writes the values that atoms have to the vertices they own.</summary>
        /// <param name="surface">What is in the mesh.</param>
        /// <param name="perAtom">Of 4 or 8 bytes.</param>
        /// <param name="stream">Which has just these.</param>
        /// <param name="first">Vertex.</param>
        /// <param name="count">How many.</param>
        /// <param name="room">For the piece.</param>
        public void Paint<T>(KeptMesh surface, ReadOnlySpan<T> perAtom, int stream, int first, int count,
            UnmanagedBuffer<byte> room) where T : unmanaged
        {
            Span<byte> painted = room.Resize(checked(sizeof(T) * count));
            surface.Paint(perAtom, first, MemoryMarshal.Cast<byte, T>(painted));
            WriteVertices(stream, sizeof(T), room.Pointer, first, count);
        }

        /// <summary>Writes texture coordinates: those of the atoms, or those that the surface has itself.</summary>
        /// <param name="surface">What is in the mesh.</param>
        /// <param name="perAtom">Empty: the surface's own.</param>
        /// <param name="first">Vertex.</param>
        /// <param name="count">How many.</param>
        /// <param name="room">For the piece.</param>
        public void WriteTexcoords(KeptMesh surface, ReadOnlySpan<System.Numerics.Vector2> perAtom, int first, int count,
            UnmanagedBuffer<byte> room)
        {
            if (perAtom.IsEmpty)
                fixed (float* own = surface.View.Texcoords)
                    WriteVertices(MeshStyle.TexcoordStream, MeshStyle.TexcoordBytes, own + 2L * first, first, count);
            else
                Paint(surface, perAtom, MeshStyle.TexcoordStream, first, count, room);
        }

        public void WriteIndices(uint* data, int first, int count)
        {
            using (s_marker.Auto())
                _mesh.SetIndexBufferData(_memory.View<uint>(data, count), 0, first, count, Unchecked);
        }

        /// <summary>What has been written is what is drawn from now on.</summary>
        public void Finish(in Bounds bounds, int vertices, int indices)
        {
            _indexCount = indices;
            SetSubMesh(_mesh, bounds, vertices, indices);
        }

        /// <summary>The flags keep the engine from telling renderers about changes.</summary>
        public void Tell() => _mesh.MarkModified();

        private void ShowNothing(Mesh mesh)
        {
            _indexCount = 0;
            SetSubMesh(mesh, default, 0, 0);
        }

        /// <summary>What is drawn of a mesh with one submesh.</summary>
        public static void SetSubMesh(Mesh mesh, in Bounds bounds, int vertices, int indices)
        {
            var submesh = new SubMeshDescriptor(0, indices) { bounds = bounds, vertexCount = vertices };
            mesh.SetSubMesh(0, submesh, Unchecked);
            mesh.bounds = bounds;
            mesh.MarkModified();
        }

        // One without room would do for some time, and be replaced in the middle of playback.
        private bool Suffices(int capacity, int needed, bool withRoom) =>
            withRoom ? HasRoom && capacity >= needed : capacity == needed;

        /// <summary>What buffers are made for that are to last.</summary>
        public static int WithRoom(int count) => (int)Math.Min(count + (long)count / 4, int.MaxValue);

        private void Write<T>(int stream, void* data, int first, int count) where T : unmanaged =>
            _mesh.SetVertexBufferData(_memory.View<T>(data, count), 0, first, count, stream, Unchecked);

#pragma warning disable 169 // only their sizes count
        [StructLayout(LayoutKind.Sequential)]
        private struct Bytes16
        {
            private Vector3 _position;
            private uint _normal;
        }

        [StructLayout(LayoutKind.Sequential)]
        private struct Bytes24
        {
            private Vector3 _position;
            private Vector3 _normal;
        }
#pragma warning restore 169
    }
}
