// SPDX-License-Identifier: MIT
using UnityEditor;
using UnityEngine;

namespace QuickSes.Editor
{
    /// <summary>
    /// GameObject > Molecular, also in the context menu of the Hierarchy; and the context menu of the component.
    /// </summary>
    internal static class MolecularMenu
    {
        public const string FromFile = "GameObject/Molecular/Surface from file...";
        public const string Empty = "GameObject/Molecular/Surface (empty)";
        public const string BakeMesh = "CONTEXT/MolecularSurface/Bake to mesh asset...";
        public const string BakePrefab = "CONTEXT/MolecularSurface/Bake to prefab...";
        private const int Priority = 10; // among those that create objects

        // The command's context is the object that was right-clicked, the parent to be.
        [MenuItem(FromFile, false, Priority)]
        private static void OpenWindow(MenuCommand command) =>
            SurfaceFromFileWindow.Open(command.context as GameObject);

        [MenuItem(Empty, false, Priority)]
        private static void CreateEmpty(MenuCommand command) =>
            SurfaceCreator.CreateEmpty(command.context as GameObject);

        [MenuItem(BakeMesh)]
        private static void BakeToMesh(MenuCommand command) =>
            SurfaceBaker.BakeWithDialog((MolecularSurface)command.context);

        [MenuItem(BakePrefab)]
        private static void BakeToPrefab(MenuCommand command) =>
            PrefabBaker.BakeWithDialog((MolecularSurface)command.context);
    }
}
