// SPDX-License-Identifier: MIT
using System.Collections.Generic;

namespace UnityEngine
{
    /// <summary>What tests put there, by path, and the package's material.</summary>
    public sealed class Resources
    {
        internal static readonly Dictionary<string, Object> Assets = new Dictionary<string, Object>();

        private static Material s_material;

        public static T Load<T>(string path) where T : Object
        {
            if (path == "QuickSes/MolecularSurface")
                return Material() as T;
            return Assets.TryGetValue(path, out Object asset) && asset != null ? asset as T : null;
        }

        private static Material Material()
        {
            if (s_material == null)
                s_material = new Material { name = "MolecularSurface" }.DeclareProperty("_QuickSesAtomColors");
            return s_material;
        }
    }
}
