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
        /// Computes the finest surface of a component, however long that takes, unless it is shown, and saves a copy of
        /// what is visible of it: exact buffers, 32-bit indices, in Å of the component's space. A mesh asset that is there
        /// already keeps its GUID and gets the new content, so what refers to it shows that; this can't be undone. Nothing
        /// is written over files of other kinds, files that can't be read, or may not be written.
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
            return error.Length == 0 && TryCompute(surface, goesOn, out error) &&
                TrySave(surface, assetPath, out asset, out error);
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

        /// <summary>
        /// Why an asset of that type can't be saved there; "": it can. Version control is asked for what is there already.
        /// </summary>
        internal static string ErrorOf(string assetPath, string extension, Type type)
        {
            if (assetPath == null)
                throw new ArgumentNullException(nameof(assetPath));
            if (!assetPath.StartsWith("Assets/", StringComparison.Ordinal) ||
                !assetPath.EndsWith(extension, StringComparison.OrdinalIgnoreCase))
                return $"'{assetPath}' is no path of the form Assets/...{extension}.";
            string name = Path.GetFileName(assetPath);
            if (name.Length == extension.Length || name[0] == '.' || name[0] == ' ')
                return $"'{name}' is no name of an asset: Unity takes none that is empty, or begins with a dot or a space.";
            string folder = Path.GetDirectoryName(assetPath).Replace('\\', '/');
            if (!AssetDatabase.IsValidFolder(folder))
                return $"There is no folder '{folder}'.";
            UnityEngine.Object present = AssetDatabase.LoadMainAssetAtPath(assetPath);
            return present != null ? ErrorOf(present, assetPath, type)
                : File.Exists(assetPath) ? $"'{assetPath}' is there already and can't be read."
                : "";
        }

        private static string ErrorOf(UnityEngine.Object present, string assetPath, Type type)
        {
            if (!type.IsInstanceOfType(present))
                return $"'{assetPath}' is there already and is no {type.Name} but a {present.GetType().Name}.";
            if (present is Mesh mesh && !mesh.isReadable)
                return $"'{assetPath}' is there already, and its Read/Write is off.";
            if (!AssetDatabase.MakeEditable(assetPath))
                return $"'{assetPath}' is there already, and version control refuses to have it written.";
            return File.Exists(assetPath) && (File.GetAttributes(assetPath) & FileAttributes.ReadOnly) != 0
                ? $"'{assetPath}' is there already and is read-only."
                : "";
        }

        private static bool TryCompute(MolecularSurface surface, Func<bool> goesOn, out string error)
        {
            if (EditorUtility.IsPersistent(surface) || !surface.isActiveAndEnabled)
            {
                error = $"'{surface.name}' is not active in an open scene or prefab, so it has no surface.";
                return false;
            }
            surface.FollowEditsNow();
            error = surface.AtomCount == 0 && !surface.Source.IsSet
                ? $"'{surface.name}' has no atoms: choose a source, or give it some by SetAtoms."
                : "";
            if (error.Length > 0)
                return false;
            bool isCancelled = false;
            Func<bool> goesOnNoted = goesOn == null ? goesOn : () => !(isCancelled = !goesOn());
            // Handlers may destroy it.
            bool isComputed = (surface.AtomCount > 0 || surface.LoadSource()) && surface != null &&
                (surface.IsFinestShown || surface.ComputeWhile(goesOnNoted));
            if (surface == null)
                error = "The surface was destroyed while it was computed.";
            else if (!isComputed)
                error = isCancelled || surface.LastError.Status == QuickSesStatus.Ok
                    ? "It was cancelled."
                    : surface.LastError.Message;
            return error.Length == 0;
        }

        private static bool TrySave(MolecularSurface surface, string path, out Mesh asset, out string error)
        {
            var present = AssetDatabase.LoadMainAssetAtPath(path) as Mesh;
            asset = present != null ? present : new Mesh();
            try
            {
                error = ErrorOfShown(surface);
                if (error.Length == 0)
                    Write(surface, asset, path);
            }
            catch (Exception exception) when (exception is UnityException || exception is QuickSesException)
            {
                error = exception.Message;
            }
            finally
            {
                if (!AssetDatabase.Contains(asset))
                    UnityEngine.Object.DestroyImmediate(asset);
            }
            if (error.Length > 0)
                asset = null;
            return error.Length == 0;
        }

        // Both this and copying bring home what is on the GPU, which may fail.
        private static string ErrorOfShown(MolecularSurface surface) => surface.IsAnyVisible ? ""
            : surface.CurrentLevel.TriangleCount == 0 ? $"The surface of '{surface.name}' is empty."
            : $"All of the surface of '{surface.name}' is hidden.";

        private static void Write(MolecularSurface surface, Mesh asset, string path)
        {
            surface.CopyTo(asset);
            asset.name = Path.GetFileNameWithoutExtension(path);
            MeshUtility.SetMeshCompression(asset, ModelImporterMeshCompression.Off);
            Save(asset, path);
        }

        /// <summary>Writes an asset that is there, or makes one; throws UnityException if that is not possible.</summary>
        internal static void Save(UnityEngine.Object asset, string path)
        {
            if (!AssetDatabase.Contains(asset))
            {
                AssetDatabase.CreateAsset(asset, path);
                return;
            }
            EditorUtility.SetDirty(asset);
            AssetDatabase.SaveAssetIfDirty(asset);
        }
    }
}
