// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;

namespace UnityEngine
{
    /// <summary>Finds what the test has put there with EngineAssets.</summary>
    public sealed class Resources
    {
        private static readonly Dictionary<(string, Type), Object> s_assets = new Dictionary<(string, Type), Object>();

        public static T Load<T>(string path) where T : Object => (T)Load(path, typeof(T));

        public static Object Load(string path) => Load(path, typeof(Object));

        public static Object Load(string path, Type systemTypeInstance)
        {
            foreach (KeyValuePair<(string Path, Type), Object> asset in s_assets)
                if (asset.Key.Path == path && systemTypeInstance.IsInstanceOfType(asset.Value) && asset.Value != null)
                    return asset.Value;
            return null;
        }

        public static void UnloadAsset(Object assetToUnload)
        {
        }

        internal static void Add(string path, Object asset) => s_assets[(path, asset.GetType())] = asset;

        internal static void Clear() => s_assets.Clear();
    }
}
