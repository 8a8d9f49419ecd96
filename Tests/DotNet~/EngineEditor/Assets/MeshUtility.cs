// SPDX-License-Identifier: MIT
using System.Runtime.CompilerServices;
using UnityEngine;

namespace UnityEditor
{
    public enum ModelImporterMeshCompression
    {
        Off = 0,
        Low = 1,
        Medium = 2,
        High = 3
    }

    public sealed class MeshUtility
    {
        private static readonly ConditionalWeakTable<Mesh, object> s_compressions =
            new ConditionalWeakTable<Mesh, object>();

        public static void SetMeshCompression(Mesh mesh, ModelImporterMeshCompression compression)
        {
            s_compressions.Remove(mesh);
            s_compressions.Add(mesh, compression);
        }

        public static ModelImporterMeshCompression GetMeshCompression(Mesh mesh) =>
            s_compressions.TryGetValue(mesh, out object compression)
                ? (ModelImporterMeshCompression)compression
                : ModelImporterMeshCompression.Off;
    }
}
