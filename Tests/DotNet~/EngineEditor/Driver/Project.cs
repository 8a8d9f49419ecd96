// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using UnityEditor.SceneManagement;
using UnityEngine;
using Object = UnityEngine.Object;

namespace QuickSes.EngineDouble
{
    /// <summary>A file of the project, or a folder, and what was made of it.</summary>
    internal sealed class ProjectEntry
    {
        private string _written;

        public ProjectEntry(string path, string guid) => (Path, Guid) = (path, guid);

        public string Path { get; }

        public string Guid { get; }

        /// <summary>null: nothing could be made of it.</summary>
        public Object Main { get; private set; }

        public bool IsDirty { get; set; }

        public Type ImporterOverride { get; set; }

        public bool IsSaved => _written == AssetText.Of(Main);

        public bool Has(Object item) => Main == item || (Main is GameObject root && Contains(root, item));

        /// <summary>In place of what there was.</summary>
        public void Hold(Object main)
        {
            Destroy();
            Main = main;
            Main.IsPersistent = true;
        }

        /// <summary>Lets the file have what the asset is now. Not the format of the Editor.</summary>
        public void Write()
        {
            _written = AssetText.Of(Main);
            File.WriteAllText(Path, _written);
            IsDirty = false;
        }

        public void Destroy()
        {
            if (Main != null)
                Main.DestroyNow();
            Main = null;
        }

        private static bool Contains(GameObject root, Object item)
        {
            if (root == item || root.Components.Contains(item))
                return true;
            for (int k = 0; k < root.transform.childCount; ++k)
                if (Contains(root.transform.GetChild(k).gameObject, item))
                    return true;
            return false;
        }
    }

    /// <summary>The files that the Editor knows, by their paths from "Assets" on.</summary>
    internal static class Project
    {
        private static readonly Dictionary<string, ProjectEntry> s_entries = new Dictionary<string, ProjectEntry>();

        public static HashSet<string> Locked { get; } = new HashSet<string>();

        public static bool MayWrite(string path) => !Locked.Contains(path) && !EditorDriver.IsDiskFull;

        /// <summary>null: no prefab is open.</summary>
        public static PrefabStage Stage { get; set; }

        public static ProjectEntry Find(string path) => s_entries.TryGetValue(path, out ProjectEntry entry) ? entry : null;

        public static ProjectEntry FindOrAdd(string path)
        {
            ProjectEntry entry = Find(path);
            if (entry == null)
                s_entries.Add(path, entry = new ProjectEntry(path, Guid.NewGuid().ToString("N")));
            return entry;
        }

        public static ProjectEntry Of(Object asset) => s_entries.Values.FirstOrDefault(entry => entry.Has(asset));

        /// <summary>null: there is none, in the package neither.</summary>
        public static ProjectEntry FindByGuid(string guid)
        {
            ProjectEntry known = s_entries.Values.FirstOrDefault(entry => entry.Guid == guid);
            if (known != null || EditorDriver.PackageFolder == null)
                return known;
            foreach (string meta in Directory.GetFiles(EditorDriver.PackageFolder, "*.meta", SearchOption.AllDirectories))
            {
                if (!File.ReadLines(meta).Contains("guid: " + guid))
                    continue;
                string file = Path.ChangeExtension(meta, null);
                string path = "Packages" + file.Substring(EditorDriver.PackageFolder.Length).Replace('\\', '/');
                s_entries.Add(path, known = new ProjectEntry(path, guid));
                known.Hold(UnityEditor.Importing.Make(file));
            }
            return known;
        }

        /// <summary>With all that is below it.</summary>
        public static void Remove(string path)
        {
            foreach (ProjectEntry entry in s_entries.Values.ToArray())
            {
                if (entry.Path != path && !entry.Path.StartsWith(path + "/", StringComparison.Ordinal))
                    continue;
                entry.Destroy();
                s_entries.Remove(entry.Path);
            }
        }

        // Folders of a name that the Editor hides are none of its own, nor are paths in another form than it writes.
        public static bool IsFolder(string path)
        {
            string[] names = path.Split('/');
            return names[0] == "Assets" && names.All(name => name.Length > 0 && name[0] != '.' && !name.EndsWith("~")) &&
                Directory.Exists(path);
        }

        public static void Clear()
        {
            foreach (ProjectEntry entry in s_entries.Values)
                entry.Destroy();
            s_entries.Clear();
            Locked.Clear();
            Stage = null;
        }
    }
}
