// SPDX-License-Identifier: MIT
using System.Linq;
using System.Text;
using UnityEditor;
using UnityEngine;

namespace QuickSes.EngineDouble
{
    /// <summary>What an asset is, in words that are others whenever it is another.</summary>
    internal static class AssetText
    {
        public static string Of(Object asset)
        {
            switch (asset)
            {
                case Mesh mesh:
                    return OfMesh(mesh);
                case Material material:
                    return $"material {material.name}, {Reference(material.shader)}, {material.color}";
                case GameObject root:
                    return OfObject(root);
                default:
                    return asset.ToString();
            }
        }

        private static string OfMesh(Mesh mesh)
        {
            var text = new StringBuilder($"mesh {mesh.name}, {MeshUtility.GetMeshCompression(mesh)}\n");
            if (!mesh.isReadable)
                return text.Append(mesh.vertexCount).ToString();
            foreach (Vector3 vertex in mesh.vertices.Concat(mesh.normals))
                text.Append($"{vertex.x:R} {vertex.y:R} {vertex.z:R}\n");
            foreach (Color32 color in mesh.colors32)
                text.Append($"{color.r} {color.g} {color.b} {color.a}\n");
            foreach (Vector2 texcoord in mesh.uv2)
                text.Append($"{texcoord.x:R} {texcoord.y:R}\n");
            return text.Append(string.Join(" ", mesh.triangles)).ToString();
        }

        private static string OfObject(GameObject item)
        {
            var text = new StringBuilder($"object {item.name}, layer {item.layer}\n");
            foreach (Component component in item.Components)
                text.Append(component.GetType()).Append(
                    component is MeshFilter filter ? " " + Reference(filter.sharedMesh)
                    : component is Renderer renderer ? " " + string.Join(" ", renderer.sharedMaterials.Select(Reference))
                    : "").Append('\n');
            for (int k = 0; k < item.transform.childCount; ++k)
                text.Append(OfObject(item.transform.GetChild(k).gameObject));
            return text.ToString();
        }

        private static string Reference(Object item) => item == null ? "none" : AssetDatabase.GetAssetPath(item);
    }
}
