// SPDX-License-Identifier: MIT
using Unity.Collections;
using UnityEngine;
using UnityEngine.Rendering;

namespace QuickSes.Editor
{
    /// <summary>Copies the mesh of a surface without the unused ends of padded buffers.</summary>
    internal static class MeshCopy
    {
        /// <param name="source">
        /// Readable, with one stream of vertices, 32-bit indices and one submesh: as surfaces are shown.
        /// </param>
        /// <param name="target">Is replaced, but for its name and hide flags.</param>
        public static void Copy(Mesh source, Mesh target)
        {
            SubMeshDescriptor part = source.GetSubMesh(0);
            target.Clear();
            using (Mesh.MeshDataArray meshes = Mesh.AcquireReadOnlyMeshData(source))
            {
                Mesh.MeshData data = meshes[0];
                NativeArray<byte> vertices = data.GetVertexData<byte>();
                target.SetVertexBufferParams(part.vertexCount, source.GetVertexAttributes());
                target.SetVertexBufferData(vertices, 0, 0, part.vertexCount * source.GetVertexBufferStride(0));
                target.SetIndexBufferParams(part.indexCount, IndexFormat.UInt32);
                target.SetIndexBufferData(data.GetIndexData<uint>(), 0, 0, part.indexCount);
            }
            target.subMeshCount = 1;
            target.SetSubMesh(0, part, MeshUpdateFlags.DontRecalculateBounds);
            target.bounds = source.bounds;
        }
    }
}
