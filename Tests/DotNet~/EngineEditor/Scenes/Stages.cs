// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using UnityEngine;
using UnityEngine.SceneManagement;

namespace UnityEditor
{
    public sealed class GameObjectUtility
    {
        public static void SetParentAndAlign(GameObject child, GameObject parent)
        {
            if (parent == null)
                return;
            child.transform.SetParent(parent.transform, false);
            child.transform.localPosition = Vector3.zero;
            child.transform.localRotation = Quaternion.identity;
            child.transform.localScale = Vector3.one;
            SetLayer(child, parent.layer);
        }

        public static void EnsureUniqueNameForSibling(GameObject self)
        {
            string name = self.name;
            for (int k = 1; HasNamesake(self); ++k)
                self.name = $"{name} ({k})";
        }

        // Of objects without a parent, these are the others without one.
        private static bool HasNamesake(GameObject self)
        {
            foreach (Object item in ObjectRegistry.Objects)
                if (item is GameObject other && other != self && !other.IsPersistent && other.name == self.name &&
                    other.transform.parent == self.transform.parent)
                    return true;
            return false;
        }

        private static void SetLayer(GameObject root, int layer)
        {
            root.layer = layer;
            for (int k = 0; k < root.transform.childCount; ++k)
                SetLayer(root.transform.GetChild(k).gameObject, layer);
        }
    }
}

namespace UnityEditor.SceneManagement
{
    public sealed class EditorSceneManager : SceneManager
    {
        public static bool IsPreviewScene(Scene scene) => false;
    }

    /// <summary>A prefab that is open for editing: see <see cref="EditorDriver.OpenPrefab"/>.</summary>
    public sealed class PrefabStage
    {
        internal PrefabStage(GameObject root, string path) => (prefabContentsRoot, assetPath) = (root, path);

        public GameObject prefabContentsRoot { get; }

        public string assetPath { get; }
    }

    public static class PrefabStageUtility
    {
        /// <summary>That of an object; null: it is in none.</summary>
        public static PrefabStage GetPrefabStage(GameObject gameObject) =>
            Project.Stage != null && gameObject.transform.Root == Project.Stage.prefabContentsRoot ? Project.Stage : null;
    }

    public static class StageUtility
    {
        public static void PlaceGameObjectInCurrentStage(GameObject gameObject)
        {
            if (Project.Stage != null)
                gameObject.transform.SetParent(Project.Stage.prefabContentsRoot.transform, true);
        }
    }
}
