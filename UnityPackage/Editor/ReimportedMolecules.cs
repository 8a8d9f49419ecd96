// SPDX-License-Identifier: MIT
using System;
using UnityEditor;
using UnityEngine;

namespace QuickSes.Editor
{
    /// <summary>
    /// Has surfaces and players read molecule assets again that were imported anew, in edit mode and in play mode.
    /// </summary>
    internal sealed class ReimportedMolecules : AssetPostprocessor
    {
        private static void OnPostprocessAllAssets(string[] importedAssets, string[] deletedAssets,
            string[] movedAssets, string[] movedFromAssetPaths)
        {
            if (!Array.Exists(importedAssets,
                path => AssetDatabase.GetMainAssetTypeAtPath(path) == typeof(MoleculeAsset)))
                return;
            // Those that are not active follow when they are.
            foreach (MolecularSurface surface in Resources.FindObjectsOfTypeAll<MolecularSurface>())
                surface.FollowSourceSoon();
            foreach (TrajectoryPlayer player in Resources.FindObjectsOfTypeAll<TrajectoryPlayer>())
                player.FollowEdits();
        }
    }
}
