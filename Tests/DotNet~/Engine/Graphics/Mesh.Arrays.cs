// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;
using System.Collections.Generic;
using Unity.Collections.LowLevel.Unsafe;
using UnityEngine.Rendering;

namespace UnityEngine
{
    // Managed arrays of the mesh's contents: each read makes a new one.
    public sealed unsafe partial class Mesh
    {
        public Vector3[] vertices
        {
            get => Read<Vector3>(VertexAttribute.Position, VertexAttributeFormat.Float32, 3);
            set => Write(VertexAttribute.Position, VertexAttributeFormat.Float32, 3, value);
        }

        public Vector3[] normals
        {
            get => Read<Vector3>(VertexAttribute.Normal, VertexAttributeFormat.Float32, 3);
            set => Write(VertexAttribute.Normal, VertexAttributeFormat.Float32, 3, value);
        }

        public Color32[] colors32
        {
            get => Read<Color32>(VertexAttribute.Color, VertexAttributeFormat.UNorm8, 4);
            set => Write(VertexAttribute.Color, VertexAttributeFormat.UNorm8, 4, value);
        }

        public Vector2[] uv2
        {
            get => Read<Vector2>(VertexAttribute.TexCoord1, VertexAttributeFormat.Float32, 2);
            set => Write(VertexAttribute.TexCoord1, VertexAttributeFormat.Float32, 2, value);
        }

        public int[] triangles
        {
            get
            {
                RequireAlive("get_triangles");
                var all = new List<int>();
                if (!LogsThatIndicesCantBeAccessed())
                    for (int i = 0; i < Buffers.SubMeshes.Count; ++i)
                        if (Buffers.SubMeshes[i].topology == MeshTopology.Triangles)
                            all.AddRange(GetIndices(i));
                return all.ToArray();
            }
            set
            {
                RequireAlive("set_triangles");
                subMeshCount = 1;
                SetTriangles(value, 0);
            }
        }

        public void SetVertices(Vector3[] inVertices) => vertices = inVertices;

        public void SetNormals(Vector3[] inNormals) => normals = inNormals;

        public void SetColors(Color32[] inColors) => colors32 = inColors;

        public void SetTriangles(int[] triangles, int submesh) =>
            SetIndices(triangles, MeshTopology.Triangles, submesh);

        public void SetIndices(int[] indices, MeshTopology topology, int submesh)
        {
            RequireAlive("SetIndices");
            if (LogsThatIndicesCantBeAccessed())
                return;
            RequireSubMesh(submesh);
            if (Buffers.SubMeshes.Count > 1)
                throw new NotSupportedException("The double sets indices of meshes with one submesh only.");
            MeshBuffers buffers = Writable();
            buffers.SetIndexParams(indices.Length, buffers.IndexFormat);
            for (int i = 0; i < indices.Length; ++i)
            {
                if (buffers.IndexSize == 2)
                    ((ushort*)buffers.Indices)[i] = (ushort)indices[i];
                else
                    ((int*)buffers.Indices)[i] = indices[i];
            }

            SetSubMesh(submesh, new SubMeshDescriptor(0, indices.Length, topology));
        }

        public int[] GetIndices(int submesh)
        {
            RequireAlive("GetIndices");
            if (LogsThatIndicesCantBeAccessed())
                return Array.Empty<int>();
            RequireSubMesh(submesh);
            SubMeshDescriptor range = Buffers.SubMeshes[submesh];
            var indices = new int[range.indexCount];
            for (int i = 0; i < indices.Length; ++i)
                indices[i] = (int)Buffers.Index((long)range.indexStart + i) + range.baseVertex;
            return indices;
        }

        public uint GetIndexCount(int submesh) => (uint)GetSubMesh(submesh).indexCount;

        public VertexAttributeDescriptor[] GetVertexAttributes() => Buffers.Layout.Attributes.ToArray();

        public bool HasVertexAttribute(VertexAttribute attr) => Buffers.Layout.TryFind(attr, out _, out _);

        public int vertexAttributeCount => Buffers.Layout.Count;

        /// <summary>Stream, format and dimension of an attribute that there is not: -1, Float32, 0.</summary>
        public int GetVertexAttributeStream(VertexAttribute attr) =>
            Buffers.Layout.TryFind(attr, out VertexAttributeDescriptor found, out _) ? found.stream : -1;

        public VertexAttributeFormat GetVertexAttributeFormat(VertexAttribute attr) =>
            Buffers.Layout.TryFind(attr, out VertexAttributeDescriptor found, out _) ? found.format : default;

        public int GetVertexAttributeDimension(VertexAttribute attr) =>
            Buffers.Layout.TryFind(attr, out VertexAttributeDescriptor found, out _) ? found.dimension : 0;

        public int GetVertexBufferStride(int stream) => Buffers.Layout.StrideOf(stream);

        private T[] Read<T>(VertexAttribute attribute, VertexAttributeFormat format, int dimension) where T : struct
        {
            RequireAlive("get_" + attribute);
            if (!_isReadable)
            {
                Debug.LogError($"Not allowed to access {attribute} on mesh '{name}' (isReadable is false; Read/Write " +
                    "must be enabled in import settings)");
                return Array.Empty<T>();
            }

            if (!HasVertexAttribute(attribute))
                return Array.Empty<T>();
            var values = new T[vertexCount];
            var address = (byte*)UnsafeUtility.PinGCArrayAndGetDataAddress(values, out ulong pin);
            VertexNumbers.Read(Buffers, attribute, format, dimension, address);
            UnsafeUtility.ReleaseGCObject(pin);
            return values;
        }

        private void Write<T>(VertexAttribute attribute, VertexAttributeFormat format, int dimension, T[] values)
            where T : struct
        {
            RequireAlive("set_" + attribute);
            RequireReadable("vertex");
            if (attribute != VertexAttribute.Position && values.Length != vertexCount)
            {
                Debug.LogError($"Mesh.{attribute}: there are {values.Length} values for {vertexCount} vertices.");
                return;
            }

            if (values.Length != vertexCount || !HasVertexAttribute(attribute))
                MakeRoom(values.Length, new VertexAttributeDescriptor(attribute, format, dimension));
            var address = (byte*)UnsafeUtility.PinGCArrayAndGetDataAddress(values, out ulong pin);
            VertexNumbers.Write(Writable(), attribute, format, dimension, address);
            UnsafeUtility.ReleaseGCObject(pin);
            Record.NoteChange(this, MeshUpdateFlags.Default);
        }

        // Other attributes keep their values if the number of vertices stays.
        private void MakeRoom(int count, VertexAttributeDescriptor added)
        {
            MeshBuffers old = Buffers.Copy();
            var attributes = new List<VertexAttributeDescriptor>(old.Layout.Attributes.ToArray());
            if (!HasVertexAttribute(added.attribute))
                attributes.Add(added);
            bool keeps = count == old.VertexCount;
            Writable().SetVertexParams(count, attributes.ToArray());
            foreach (VertexAttributeDescriptor kept in old.Layout.Attributes)
            {
                if (!keeps)
                    break;
                var values = new byte[count * kept.dimension * sizeof(float)];
                fixed (byte* address = values)
                {
                    VertexNumbers.Read(old, kept.attribute, VertexAttributeFormat.Float32, kept.dimension, address);
                    VertexNumbers.Write(Buffers, kept.attribute, VertexAttributeFormat.Float32, kept.dimension,
                        address);
                }
            }

            old.Release();
        }
    }
}
