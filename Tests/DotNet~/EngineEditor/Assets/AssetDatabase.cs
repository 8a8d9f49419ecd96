// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;
using System.IO;
using UnityEditor.AssetImporters;
using UnityEngine;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    [Flags]
    public enum ImportAssetOptions
    {
        Default = 0,
        ForceSynchronousImport = 8
    }

    /// <summary>Paths begin with "Assets".</summary>
    public sealed class AssetDatabase
    {
        private const string Builtin = "Resources/unity_builtin_extra";

        public static bool IsValidFolder(string path) => Project.IsFolder(path);

        /// <returns>The GUID of the folder; "": it was not made.</returns>
        public static string CreateFolder(string parentFolder, string newFolderName)
        {
            if (!IsValidFolder(parentFolder))
                return "";
            string path = parentFolder + "/" + newFolderName;
            Directory.CreateDirectory(path);
            ProjectEntry folder = Project.FindOrAdd(path);
            folder.Hold(new DefaultAsset { name = newFolderName });
            return folder.Guid;
        }

        /// <summary>What is there already is deleted first.</summary>
        public static void CreateAsset(Object asset, string path)
        {
            if (asset == null)
                throw new ArgumentNullException(nameof(asset));
            if (asset.IsPersistent)
                throw new UnityException($"Couldn't add object to asset file because '{asset.name}' is already an asset.");
            if (!IsValidFolder(FolderOf(path)) || Directory.Exists(path) || !Project.MayWrite(path))
                throw new UnityException($"Creating asset at path {path} failed.");
            Project.Remove(path);
            asset.name = Path.GetFileNameWithoutExtension(path);
            ProjectEntry entry = Project.FindOrAdd(path);
            entry.Hold(asset);
            entry.Write();
        }

        /// <summary>A file, or a folder and what is in it.</summary>
        public static bool DeleteAsset(string path)
        {
            Project.Remove(path);
            if (Directory.Exists(path))
                Directory.Delete(path, true);
            else if (File.Exists(path))
                File.Delete(path);
            else
                return false;
            return true;
        }

        public static void SaveAssetIfDirty(Object obj)
        {
            ProjectEntry entry = Project.Of(obj);
            if (entry != null && entry.IsDirty && Project.MayWrite(entry.Path))
                entry.Write();
        }

        /// <summary>Checks a file out, where version control asks for it; false: it may not be written.</summary>
        public static bool MakeEditable(string path) => !Project.Locked.Contains(path);

        public static bool Contains(Object obj) => obj != null && obj.IsPersistent;

        /// <summary>"": it is no asset.</summary>
        public static string GetAssetPath(Object assetObject)
        {
            if (!Contains(assetObject))
                return "";
            return assetObject == Resources.BuiltinMaterial || assetObject == Resources.BuiltinMesh
                ? Builtin
                : Project.Of(assetObject)?.Path ?? "Packages/" + assetObject.name;
        }

        public static string AssetPathToGUID(string path) => Project.Find(path)?.Guid ?? "";

        public static string GUIDToAssetPath(string guid) => Project.FindByGuid(guid)?.Path ?? "";

        /// <summary>null: there is none, or it can't be read.</summary>
        public static Object LoadMainAssetAtPath(string assetPath) => Project.Find(assetPath)?.Main;

        public static T LoadAssetAtPath<T>(string assetPath) where T : Object => LoadMainAssetAtPath(assetPath) as T;

        public static Type GetMainAssetTypeAtPath(string assetPath) => LoadMainAssetAtPath(assetPath)?.GetType();

        public static void Refresh()
        {
            foreach (string file in Directory.GetFiles("Assets", "*", SearchOption.AllDirectories))
            {
                string path = file.Replace('\\', '/');
                if (IsValidFolder(FolderOf(path)) && Project.Find(path) == null)
                    ImportAsset(path);
            }
        }

        public static void ImportAsset(string path, ImportAssetOptions options = ImportAssetOptions.Default) =>
            Importing.Import(path);

        public static Type GetImporterOverride(string path) => Project.Find(path)?.ImporterOverride;

        /// <summary>Imports the file again, by that importer.</summary>
        public static void SetImporterOverride<T>(string path) where T : ScriptedImporter
        {
            Project.FindOrAdd(path).ImporterOverride = typeof(T);
            Importing.Import(path);
        }

        private static string FolderOf(string path) => Path.GetDirectoryName(path).Replace('\\', '/');
    }
}
