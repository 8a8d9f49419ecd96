// SPDX-License-Identifier: MIT
using System.Collections.Generic;
using UnityEngine;
using UnityEngine.Rendering;

namespace QuickSes.EngineDouble
{
    /// <summary>
    /// What a GPU would trip over and the flags of an upload keep the engine from looking at: read when the mesh would
    /// be drawn, whatever the flags were.
    /// </summary>
    public static class MeshCheck
    {
        private const float Tolerance = 1e-3f;

        private static readonly List<Mesh> s_changed = new List<Mesh>(64); // no garbage in tests of it

        /// <summary>The first fault of a mesh in words, or null.</summary>
        public static string FaultOf(Mesh mesh)
        {
            MeshBuffers buffers = mesh.Buffers;
            if (mesh.Record.AwaitsNotification)
                return "was changed with DontNotifyMeshUsers and not marked as modified since";
            for (int i = 0; i < buffers.SubMeshes.Count; ++i)
            {
                string fault = FaultOf(buffers, buffers.SubMeshes[i]);
                if (fault != null)
                    return $"submesh {i} {fault}";
            }

            return null;
        }

        internal static void NoteChange(Mesh mesh) => s_changed.Add(mesh);

        internal static void RunOnChanged()
        {
            for (int i = 0; i < s_changed.Count; ++i)
            {
                Mesh mesh = s_changed[i];
                mesh.Record.IsChecked = true;
                string fault = mesh == null ? null : FaultOf(mesh);
                if (fault != null)
                    Debug.LogError($"Mesh '{mesh.name}' can't be drawn: it {fault}.");
            }

            s_changed.Clear();
        }

        private static string FaultOf(MeshBuffers mesh, in SubMeshDescriptor subMesh)
        {
            if (subMesh.indexCount == 0)
                return null;
            if ((long)subMesh.indexStart + subMesh.indexCount > mesh.IndexCount)
                return $"ends at index {(long)subMesh.indexStart + subMesh.indexCount} of {mesh.IndexCount}";
            if (subMesh.topology == MeshTopology.Triangles && subMesh.indexCount % 3 != 0)
                return $"has {subMesh.indexCount} indices, which are no whole triangles";
            if (!mesh.Layout.TryFind(VertexAttribute.Position, out VertexAttributeDescriptor position, out int offset))
                return "has no positions";
            Vector3 slack = (mesh.Bounds.size.magnitude + 1) * Tolerance * Vector3.one;
            Vector3 min = mesh.Bounds.min - slack, max = mesh.Bounds.max + slack;
            for (int i = 0; i < subMesh.indexCount; ++i)
            {
                long vertex = mesh.Index((long)subMesh.indexStart + i) + subMesh.baseVertex;
                if (vertex < 0 || vertex >= mesh.VertexCount)
                    return $"has index {vertex}, and there are {mesh.VertexCount} vertices";
                if (vertex < subMesh.firstVertex || vertex >= (long)subMesh.firstVertex + subMesh.vertexCount)
                    return $"has index {vertex}, which is not among its {subMesh.vertexCount} vertices from " +
                        $"{subMesh.firstVertex}";
                Vector3 point = VertexNumbers.ReadPosition(mesh, position, offset, vertex);
                // Written so that NaN is a fault, too.
                if (!(point.x >= min.x && point.y >= min.y && point.z >= min.z &&
                    point.x <= max.x && point.y <= max.y && point.z <= max.z))
                    return $"has a vertex at {point}, outside of the mesh's bounds ({mesh.Bounds})";
            }

            return null;
        }
    }
}
