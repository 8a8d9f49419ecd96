// SPDX-License-Identifier: MIT
using UnityEngine;

namespace QuickSes.Editor
{
    /// <summary>Stands in for the window, which draws: what the menu asks for.</summary>
    internal static class SurfaceFromFileWindow
    {
        public static bool IsOpen { get; set; }

        public static GameObject Parent { get; private set; }

        public static void Open(GameObject parent) => (IsOpen, Parent) = (true, parent);
    }
}
