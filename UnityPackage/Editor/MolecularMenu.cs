// SPDX-License-Identifier: MIT
using UnityEditor;
using UnityEngine;

namespace QuickSes.Editor
{
    /// <summary>GameObject > Molecular, also in the context menu of the Hierarchy.</summary>
    internal static class MolecularMenu
    {
        public const string FromFile = "GameObject/Molecular/Surface from file...";
        public const string Empty = "GameObject/Molecular/Surface (empty)";
        private const int Priority = 10; // among those that create objects

        // The command's context is the object that was right-clicked, the parent to be.
        [MenuItem(FromFile, false, Priority)]
        private static void OpenWindow(MenuCommand command) =>
            SurfaceFromFileWindow.Open(command.context as GameObject);

        [MenuItem(Empty, false, Priority)]
        private static void CreateEmpty(MenuCommand command) =>
            SurfaceCreator.CreateEmpty(command.context as GameObject);
    }
}
