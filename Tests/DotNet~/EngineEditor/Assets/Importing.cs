// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Reflection;
using UnityEngine;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    /// <summary>What becomes of files that no importer knows.</summary>
    public class DefaultAsset : Object
    {
    }

    public class MonoScript : TextAsset
    {
    }

    /// <summary>Those that are derived from it are told of what was imported.</summary>
    public class AssetPostprocessor
    {
    }

    internal static class Importing
    {
        private static readonly string[] s_native = { ".asset", ".mat", ".prefab" }; // written by the Editor
        private static readonly string[] s_texts = { ".txt", ".bytes" };

        public static void Import(string path)
        {
            string extension = Path.GetExtension(path).ToLowerInvariant();
            if (!File.Exists(path) || s_native.Contains(extension))
                return; // such a file that somebody else has written can't be read, here
            ProjectEntry entry = Project.FindOrAdd(path);
            Object imported = Make(path, entry.ImporterOverride ?? ImporterOf(extension), s_texts.Contains(extension));
            if (entry.Main is ScriptableObject present && imported != null && imported.GetType() == present.GetType())
            {
                // What refers to it sees the new content.
                Duplication.CopyFields(imported, present);
                present.name = imported.name;
                imported.DestroyNow();
            }
            else if (imported != null)
            {
                entry.Hold(imported);
            }
            foreach (Type type in Methods.Types.Where(typeof(AssetPostprocessor).IsAssignableFrom))
                Methods.Find(type, "OnPostprocessAllAssets")?.Invoke(null,
                    new object[] { new[] { path }, new string[0], new string[0], new string[0] });
        }

        /// <summary>What the importer of its extension makes of a file.</summary>
        public static Object Make(string file)
        {
            string extension = Path.GetExtension(file).ToLowerInvariant();
            return Make(file, ImporterOf(extension), s_texts.Contains(extension));
        }

        private static Type ImporterOf(string extension) => Methods.Types.FirstOrDefault(type =>
            type.GetCustomAttribute<AssetImporters.ScriptedImporterAttribute>()?.fileExtensions.Contains(
                extension.TrimStart('.')) == true);

        private static Object Make(string path, Type importer, bool isText)
        {
            if (importer == null)
                return isText ? new TextAsset(File.ReadAllBytes(path)) { name = Path.GetFileNameWithoutExtension(path) }
                    : (Object)new DefaultAsset { name = Path.GetFileNameWithoutExtension(path) };
            var context = new AssetImporters.AssetImportContext(path);
            ((AssetImporters.ScriptedImporter)Activator.CreateInstance(importer, true)).OnImportAsset(context);
            return context.mainObject;
        }
    }
}

namespace UnityEditor.AssetImporters
{
    [AttributeUsage(AttributeTargets.Class, Inherited = false)]
    public class ScriptedImporterAttribute : Attribute
    {
        public ScriptedImporterAttribute(int version, string[] exts, string[] overrideExts)
        {
            fileExtensions = exts;
            overrideFileExtensions = overrideExts;
        }

        public string[] fileExtensions { get; }

        /// <summary>Those that it is used for when it is asked for.</summary>
        public string[] overrideFileExtensions { get; }
    }

    public abstract class ScriptedImporter
    {
        public abstract void OnImportAsset(AssetImportContext ctx);
    }

    public class AssetImportContext
    {
        private readonly HashSet<Object> _objects = new HashSet<Object>();

        internal AssetImportContext(string path) => assetPath = path;

        public string assetPath { get; }

        public Object mainObject { get; private set; }

        public void AddObjectToAsset(string identifier, Object obj) => _objects.Add(obj);

        public void SetMainObject(Object obj) => mainObject =
            _objects.Contains(obj) ? obj : throw new ArgumentException("Before it is the main object, it is to be added.");

        public void LogImportError(string msg, Object obj = null) => Debug.LogError(msg, obj);
    }
}
