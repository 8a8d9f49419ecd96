// SPDX-License-Identifier: MIT
using System;
using UnityEngine;
using UnityEngine.Rendering;

namespace QuickSes.EngineDouble
{
    /// <summary>Bounds and ranges, as the engine finds them where it is not told them.</summary>
    internal static class MeshMeasure
    {
        public static void Measure(MeshBuffers mesh, ref SubMeshDescriptor subMesh)
        {
            if (subMesh.indexCount == 0 ||
                !mesh.Layout.TryFind(VertexAttribute.Position, out VertexAttributeDescriptor position, out int offset))
            {
                subMesh.bounds = default;
                subMesh.firstVertex = subMesh.vertexCount = 0;
                return;
            }

            long first = long.MaxValue, last = -1;
            Vector3 min = Vector3.positiveInfinity, max = Vector3.negativeInfinity;
            for (int i = 0; i < subMesh.indexCount; ++i)
            {
                long vertex = mesh.Index((long)subMesh.indexStart + i) + subMesh.baseVertex;
                if (vertex < 0 || vertex >= mesh.VertexCount)
                    continue;
                first = Math.Min(first, vertex);
                last = Math.Max(last, vertex);
                Vector3 point = VertexNumbers.ReadPosition(mesh, position, offset, vertex);
                min = Vector3.Min(min, point);
                max = Vector3.Max(max, point);
            }

            subMesh.firstVertex = last < 0 ? 0 : (int)first;
            subMesh.vertexCount = last < 0 ? 0 : (int)(last - first + 1);
            Bounds bounds = default;
            if (last >= 0)
                bounds.SetMinMax(min, max);
            subMesh.bounds = bounds;
        }

        public static Bounds UnionOfSubMeshes(MeshBuffers mesh)
        {
            Bounds bounds = default;
            bool isFirst = true;
            foreach (SubMeshDescriptor subMesh in mesh.SubMeshes)
            {
                if (subMesh.indexCount == 0)
                    continue;
                if (isFirst)
                    bounds = subMesh.bounds;
                else
                    bounds.Encapsulate(subMesh.bounds);
                isFirst = false;
            }

            return bounds;
        }
    }
}
