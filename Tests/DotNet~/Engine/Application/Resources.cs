// SPDX-License-Identifier: MIT
using System.Collections.Generic;

namespace UnityEngine
{
    /// <summary>What tests put there, by path.</summary>
    public sealed class Resources
    {
        internal static readonly Dictionary<string, Object> Assets = new Dictionary<string, Object>();

        public static T Load<T>(string path) where T : Object =>
            Assets.TryGetValue(path, out Object asset) && asset != null ? asset as T : null;
    }
}
