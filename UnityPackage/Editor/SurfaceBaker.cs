// SPDX-License-Identifier: MIT
using System;
using System.IO;
using UnityEditor;
using UnityEngine;

namespace QuickSes.Editor
{
    /// <summary>
    /// Saves surfaces as mesh assets, which need neither this package nor its native library to be shown. Scenes and
    /// components stay as they are. Main thread only.
    /// </summary>
    public static class SurfaceBaker
    {
        private const string Extension = ".asset";

        /// <summary>
        /// Computes the finest surface of a component, however long that takes, and saves a copy of it: exact buffers,
        /// 32-bit indices, in Å of the component's space. A mesh asset that is there already keeps its GUID and gets
        /// the new content, so what refers to it shows that; this can't be undone.
        /// </summary>
        /// <param name="surface">In an open scene or prefab stage, and active.</param>
        /// <param name="assetPath">Such as "Assets/Crambin.asset", in a folder that exists.</param>
        /// <param name="asset">The asset, or null.</param>
        /// <param name="error">"", or a sentence that names what is wrong.</param>
        public static bool TryBake(MolecularSurface surface, string assetPath, out Mesh asset, out string error) =>
            TryBake(surface, assetPath, null, out asset, out error);

        /// <param name="goesOn">If not null: called now and then; false ends it.</param>
        internal static bool TryBake(MolecularSurface surface, string assetPath, Func<bool> goesOn, out Mesh asset,
            out string error)
        {
            if (surface == null)
                throw new ArgumentNullException(nameof(surface));
            asset = null;
            error = ErrorOf(assetPath, Extension, typeof(Mesh));
            if (error.Length > 0 || !TryCompute(surface, goesOn, out error))
                return false;
            if (surface.CurrentLevel.TriangleCount == 0)
            {
                error = $"The surface of '{surface.name}' is empty.";
                return false;
            }
            asset = Save(surface, assetPath);
            return true;
        }

        /// <summary>Asks where to save it; what goes wrong is shown in a dialog.</summary>
        /// <returns>The asset; null: the user cancelled, or it failed.</returns>
        public static Mesh BakeWithDialog(MolecularSurface surface)
        {
            if (surface == null)
                throw new ArgumentNullException(nameof(surface));
            string path = EditorUtility.SaveFilePanelInProject("Bake surface to mesh asset",
                MoleculeNames.AssetNameOf(surface.name), Extension.Substring(1),
                "The finest surface is computed and saved.");
            if (string.IsNullOrEmpty(path))
                return null;
            bool isBaked;
            Mesh asset;
            string error;
            try
            {
                isBaked = TryBake(surface, path, () => GoesOn(surface), out asset, out error);
            }
            finally
            {
                EditorUtility.ClearProgressBar();
            }
            if (isBaked)
                EditorGUIUtility.PingObject(asset);
            else
                EditorUtility.DisplayDialog("The surface was not baked", error, "OK");
            return asset;
        }

        // The Editor shows what is going on, and lets the user end it, while other threads start the GPU and compute.
        internal static bool GoesOn(MolecularSurface surface) => !EditorUtility.DisplayCancelableProgressBar(
            "Molecular Surface", surface.Progress > 0 ? "Computing the finest surface" : SurfaceStatus.Starting,
            surface.Progress);

        /// <summary>Why an asset of that type can't be saved there; "": it can.</summary>
        internal static string ErrorOf(string assetPath, string extension, Type type)
        {
            if (assetPath == null)
                throw new ArgumentNullException(nameof(assetPath));
            if (!assetPath.StartsWith("Assets/", StringComparison.Ordinal) ||
                !assetPath.EndsWith(extension, StringComparison.OrdinalIgnoreCase))
                return $"'{assetPath}' is no path of the form Assets/...{extension}.";
            string folder = Path.GetDirectoryName(assetPath).Replace('\\', '/');
            if (!AssetDatabase.IsValidFolder(folder))
                return $"There is no folder '{folder}'.";
            UnityEngine.Object present = AssetDatabase.LoadMainAssetAtPath(assetPath);
            return present == null || type.IsInstanceOfType(present)
                ? ""
                : $"'{assetPath}' is there already and is no {type.Name} but a {present.GetType().Name}.";
        }

        private static bool TryCompute(MolecularSurface surface, Func<bool> goesOn, out string error)
        {
            error = "";
            if (EditorUtility.IsPersistent(surface) || !surface.isActiveAndEnabled)
                error = $"'{surface.name}' is not active in an open scene or prefab, so it has no surface.";
            else if (surface.AtomCount == 0 && !surface.Source.IsSet)
                error = $"'{surface.name}' has no atoms: choose a source, or give it some by SetAtoms.";
            else if ((surface.AtomCount == 0 && !surface.LoadSource()) || !surface.ComputeWhile(goesOn))
                error = surface.LastError.Status != QuickSesStatus.Ok ? surface.LastError.Message : "It was cancelled.";
            return error.Length == 0;
        }

        private static Mesh Save(MolecularSurface surface, string path)
        {
            var present = AssetDatabase.LoadMainAssetAtPath(path) as Mesh;
            Mesh asset = present != null ? present : new Mesh();
            surface.CopyTo(asset);
            asset.name = Path.GetFileNameWithoutExtension(path);
            MeshUtility.SetMeshCompression(asset, ModelImporterMeshCompression.Off);
            if (present == null)
            {
                AssetDatabase.CreateAsset(asset, path);
            }
            else
            {
                EditorUtility.SetDirty(asset);
                AssetDatabase.SaveAssetIfDirty(asset);
            }
            return asset;
        }
    }
}
