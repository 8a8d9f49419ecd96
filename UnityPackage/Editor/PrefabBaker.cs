// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using System.IO;
using UnityEditor;
using UnityEngine;

namespace QuickSes.Editor
{
    /// <summary>
    /// Saves surfaces as prefabs: an object with a mesh asset and materials, without components of this package, so that
    /// it is shown where there is no native library. Scenes stay as they are, so there is nothing to undo. Main thread
    /// only.
    /// </summary>
    public static class PrefabBaker
    {
        private const string Extension = ".prefab";

        /// <summary>
        /// Computes the finest surface of a component, however long that takes, and saves it as a prefab, with the mesh
        /// (vertex colours included) in an asset beside it. The object is called as the file; it has the surface's
        /// rotation, scale, layer and the settings of its renderer. Materials that are assets are referred to; others
        /// are saved beside it too. Assets that are there already keep their GUIDs and get the new content, which can't
        /// be undone.
        /// </summary>
        /// <param name="surface">In an open scene or prefab stage, and active.</param>
        /// <param name="prefabPath">
        /// Such as "Assets/Crambin.prefab", in a folder that exists; then the mesh is "Assets/Crambin mesh.asset".
        /// </param>
        /// <param name="prefab">The asset, or null.</param>
        /// <param name="error">"", or a sentence that names what is wrong.</param>
        public static bool TryBake(MolecularSurface surface, string prefabPath, out GameObject prefab, out string error) =>
            TryBake(surface, prefabPath, null, out prefab, out error);

        /// <summary>
        /// Asks where to save it, and whether other assets may be replaced; what goes wrong is shown in a dialog.
        /// </summary>
        /// <returns>The prefab; null: the user cancelled, or it failed.</returns>
        public static GameObject BakeWithDialog(MolecularSurface surface)
        {
            if (surface == null)
                throw new ArgumentNullException(nameof(surface));
            string path = EditorUtility.SaveFilePanelInProject("Bake surface to prefab",
                MoleculeNames.AssetNameOf(surface.name), Extension.Substring(1),
                "The finest surface is computed and saved, with mesh and material beside the prefab.");
            if (string.IsNullOrEmpty(path) || !MayReplace(surface, path))
                return null;
            bool isBaked;
            GameObject prefab;
            string error;
            try
            {
                isBaked = TryBake(surface, path, () => SurfaceBaker.GoesOn(surface), out prefab, out error);
            }
            finally
            {
                EditorUtility.ClearProgressBar();
            }
            if (isBaked)
                EditorGUIUtility.PingObject(prefab);
            else
                EditorUtility.DisplayDialog("The surface was not baked", error, "OK");
            return prefab;
        }

        private static bool TryBake(MolecularSurface surface, string prefabPath, Func<bool> goesOn, out GameObject prefab,
            out string error)
        {
            if (surface == null)
                throw new ArgumentNullException(nameof(surface));
            prefab = null;
            error = SurfaceBaker.ErrorOf(prefabPath, Extension, typeof(GameObject));
            for (int k = 0; error.Length == 0 && k < MaterialsOf(surface).Length; ++k)
                if (IsToBeSaved(MaterialsOf(surface)[k]))
                    error = SurfaceBaker.ErrorOf(MoleculeNames.MaterialBeside(prefabPath, k), ".mat", typeof(Material));
            if (error.Length > 0 || !SurfaceBaker.TryBake(surface, MoleculeNames.MeshBeside(prefabPath), goesOn,
                out Mesh mesh, out error))
                return false;
            var made = new GameObject(Path.GetFileNameWithoutExtension(prefabPath));
            try
            {
                Fill(made, surface, mesh, prefabPath);
                prefab = PrefabUtility.SaveAsPrefabAsset(made, prefabPath, out bool isSaved);
                error = isSaved ? "" : $"'{prefabPath}' could not be saved: the Console says why.";
                return isSaved;
            }
            finally
            {
                UnityEngine.Object.DestroyImmediate(made);
            }
        }

        private static void Fill(GameObject made, MolecularSurface surface, Mesh mesh, string prefabPath)
        {
            made.layer = surface.gameObject.layer;
            made.transform.localRotation = surface.transform.localRotation;
            made.transform.localScale = surface.transform.localScale;
            made.AddComponent<MeshFilter>().sharedMesh = mesh;
            var renderer = made.AddComponent<MeshRenderer>();
            EditorUtility.CopySerialized(surface.GetComponent<MeshRenderer>(), renderer);
            Material[] materials = MaterialsOf(surface);
            for (int k = 0; k < materials.Length; ++k)
                if (IsToBeSaved(materials[k]))
                    materials[k] = Save(materials[k], MoleculeNames.MaterialBeside(prefabPath, k));
            renderer.sharedMaterials = materials;
            renderer.enabled = true;
        }

        private static Material[] MaterialsOf(MolecularSurface surface) =>
            surface.GetComponent<MeshRenderer>().sharedMaterials;

        private static bool IsToBeSaved(Material material) => material != null && !AssetDatabase.Contains(material);

        private static Material Save(Material material, string path)
        {
            var present = AssetDatabase.LoadMainAssetAtPath(path) as Material;
            Material asset = present != null ? present : new Material(material);
            if (present == null)
            {
                asset.hideFlags = HideFlags.None;
                AssetDatabase.CreateAsset(asset, path);
                return asset;
            }
            asset.shader = material.shader;
            asset.CopyPropertiesFromMaterial(material);
            EditorUtility.SetDirty(asset);
            AssetDatabase.SaveAssetIfDirty(asset);
            return asset;
        }

        // The panel has asked for the prefab itself.
        private static bool MayReplace(MolecularSurface surface, string prefabPath)
        {
            var replaced = new List<string> { MoleculeNames.MeshBeside(prefabPath) };
            for (int k = 0; k < MaterialsOf(surface).Length; ++k)
                if (IsToBeSaved(MaterialsOf(surface)[k]))
                    replaced.Add(MoleculeNames.MaterialBeside(prefabPath, k));
            replaced.RemoveAll(path => AssetDatabase.LoadMainAssetAtPath(path) == null);
            return replaced.Count == 0 || EditorUtility.DisplayDialog("Replace assets?",
                "These are there already and get the new content:\n\n" + string.Join("\n", replaced), "Replace", "Cancel");
        }
    }
}
