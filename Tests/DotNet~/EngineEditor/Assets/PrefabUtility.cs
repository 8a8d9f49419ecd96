// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;
using System.IO;
using UnityEngine;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    public sealed class PrefabUtility
    {
        private static readonly char[] s_refused = "/?<>\\:*|\"".ToCharArray();

        /// <summary>A prefab that is there keeps its GUID. Objects are new, and references to those before are none.</summary>
        public static GameObject SaveAsPrefabAsset(GameObject instanceRoot, string assetPath, out bool success)
        {
            if (instanceRoot == null)
                throw new ArgumentNullException("Parameter root is null");
            if (instanceRoot.IsPersistent)
                throw new ArgumentException("Can't save persistent object as a Prefab asset");
            RequirePath(assetPath);
            success = AssetDatabase.IsValidFolder(Path.GetDirectoryName(assetPath).Replace('\\', '/')) &&
                Project.MayWrite(assetPath);
            if (!success)
            {
                Debug.LogError($"Could not save Prefab at '{assetPath}'.");
                return null;
            }
            GameObject prefab = Duplication.ForFile(instanceRoot);
            prefab.name = Path.GetFileNameWithoutExtension(assetPath);
            ProjectEntry entry = Project.FindOrAdd(assetPath);
            entry.Hold(prefab);
            entry.Write();
            return prefab;
        }

        public static GameObject SaveAsPrefabAsset(GameObject instanceRoot, string assetPath) =>
            SaveAsPrefabAsset(instanceRoot, assetPath, out _);

        /// <summary>The double has no instances that know their prefab.</summary>
        public static void RecordPrefabInstancePropertyModifications(Object targetObject)
        {
        }

        private static void RequirePath(string path)
        {
            if (string.IsNullOrEmpty(path))
                throw new ArgumentNullException("path is null or empty");
            string name = Path.GetFileName(path);
            if (name.Length == 0 || name[0] == '.' || name[0] == ' ' || name.IndexOfAny(s_refused) >= 0 ||
                !name.EndsWith(".prefab", StringComparison.OrdinalIgnoreCase))
                throw new ArgumentException($"Given path is not valid: '{path}'");
            if (Directory.Exists(path))
                throw new ArgumentException($"Overwriting a folder with an Asset is not allowed: '{path}'");
            if (!Directory.Exists(Path.GetDirectoryName(path)))
                throw new ArgumentException($"Given path does not exist: '{path}'");
        }
    }
}
