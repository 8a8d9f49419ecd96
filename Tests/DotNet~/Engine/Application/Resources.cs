// SPDX-License-Identifier: MIT
namespace UnityEngine
{
    /// <summary>There are none.</summary>
    public sealed class Resources
    {
        public static T Load<T>(string path) where T : Object => null;
    }
}
