// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System.Collections.Generic;

namespace UnityEngine
{
    /// <summary>What tests put there, by path, and the package's material.</summary>
    public sealed class Resources
    {
        internal static readonly Dictionary<string, Object> Assets = new Dictionary<string, Object>();

        private static Material s_material, s_builtinMaterial;
        private static Mesh s_builtinMesh;

        /// <summary>What the engine brings along for new objects.</summary>
        internal static Material BuiltinMaterial => s_builtinMaterial != null
            ? s_builtinMaterial
            : s_builtinMaterial = new Material { name = "Default-Material", IsPersistent = true };

        internal static Mesh BuiltinMesh => s_builtinMesh != null
            ? s_builtinMesh
            : s_builtinMesh = new Mesh { name = "Default-Mesh", IsPersistent = true };

        /// <summary>Also those that are not active, and assets.</summary>
        public static T[] FindObjectsOfTypeAll<T>() where T : Object => Engine.AllObjects<T>().ToArray();

        public static T Load<T>(string path) where T : Object
        {
            if (path == "QuickSes/MolecularSurface")
                return Material() as T;
            return Assets.TryGetValue(path, out Object asset) && asset != null ? asset as T : null;
        }

        private static Material Material()
        {
            if (s_material == null)
                s_material = new Material { name = "MolecularSurface", IsPersistent = true }.DeclareProperty("_QuickSesAtomColors");
            return s_material;
        }
    }
}
