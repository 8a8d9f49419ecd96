// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using System.IO;
using UnityEditor;
using UnityEditor.SceneManagement;
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
        /// be undone; but a prefab with a <see cref="MolecularSurface"/>, which would be lost, is left alone.
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
            error = ErrorOf(surface, prefabPath);
            if (error.Length > 0 || !SurfaceBaker.TryBake(surface, MoleculeNames.MeshBeside(prefabPath), goesOn,
                out Mesh mesh, out error))
                return false;
            var made = new GameObject(Path.GetFileNameWithoutExtension(prefabPath));
            try
            {
                Fill(made, surface, mesh, prefabPath);
                prefab = PrefabUtility.SaveAsPrefabAsset(made, prefabPath, out bool isSaved);
                error = isSaved ? "" : $"'{prefabPath}' could not be saved: the Console says why.";
            }
            catch (UnityException exception)
            {
                error = exception.Message;
            }
            finally
            {
                UnityEngine.Object.DestroyImmediate(made);
            }
            return error.Length == 0;
        }

        // Of the prefab and the materials; that of the mesh is told by who bakes it.
        private static string ErrorOf(MolecularSurface surface, string prefabPath)
        {
            string error = SurfaceBaker.ErrorOf(prefabPath, Extension, typeof(GameObject));
            if (error.Length == 0 && HoldsSurface(surface, prefabPath))
                error = $"'{prefabPath}' is a prefab with a Molecular Surface, which would be lost.";
            foreach (int slot in SlotsToSave(MaterialsOf(surface)))
                if (error.Length == 0)
                    error = SurfaceBaker.ErrorOf(MoleculeNames.MaterialBeside(prefabPath, slot), ".mat", typeof(Material));
            return error;
        }

        // In the file, or where the prefab is open and not saved yet.
        private static bool HoldsSurface(MolecularSurface surface, string prefabPath)
        {
            var present = AssetDatabase.LoadAssetAtPath<GameObject>(prefabPath);
            PrefabStage stage = PrefabStageUtility.GetPrefabStage(surface.gameObject);
            return (present != null && present.GetComponentInChildren<MolecularSurface>(true) != null) ||
                (stage != null && stage.assetPath.Equals(prefabPath, StringComparison.OrdinalIgnoreCase));
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
            foreach (int slot in SlotsToSave(materials))
            {
                Material saved = Save(materials[slot], MoleculeNames.MaterialBeside(prefabPath, slot));
                Material original = materials[slot];
                for (int k = slot; k < materials.Length; ++k)
                    if (materials[k] == original)
                        materials[k] = saved;
            }
            renderer.sharedMaterials = materials;
            renderer.enabled = true;
        }

        private static Material[] MaterialsOf(MolecularSurface surface) =>
            surface.GetComponent<MeshRenderer>().sharedMaterials;

        // The first of each material that is no asset.
        private static List<int> SlotsToSave(Material[] materials)
        {
            var slots = new List<int>();
            for (int k = 0; k < materials.Length; ++k)
                if (materials[k] != null && !AssetDatabase.Contains(materials[k]) &&
                    Array.IndexOf(materials, materials[k]) == k)
                    slots.Add(k);
            return slots;
        }

        private static Material Save(Material material, string path)
        {
            var present = AssetDatabase.LoadMainAssetAtPath(path) as Material;
            Material asset = present != null ? present : new Material(material) { hideFlags = HideFlags.None };
            try
            {
                asset.shader = material.shader;
                asset.CopyPropertiesFromMaterial(material);
                SurfaceBaker.Save(asset, path);
            }
            finally
            {
                if (!AssetDatabase.Contains(asset))
                    UnityEngine.Object.DestroyImmediate(asset);
            }
            return asset;
        }

        // The panel has asked for the prefab itself.
        private static bool MayReplace(MolecularSurface surface, string prefabPath)
        {
            var replaced = new List<string> { MoleculeNames.MeshBeside(prefabPath) };
            foreach (int slot in SlotsToSave(MaterialsOf(surface)))
                replaced.Add(MoleculeNames.MaterialBeside(prefabPath, slot));
            replaced.RemoveAll(path => AssetDatabase.LoadMainAssetAtPath(path) == null);
            return replaced.Count == 0 || EditorUtility.DisplayDialog("Replace assets?",
                "These are there already and get the new content:\n\n" + string.Join("\n", replaced), "Replace", "Cancel");
        }
    }
}
