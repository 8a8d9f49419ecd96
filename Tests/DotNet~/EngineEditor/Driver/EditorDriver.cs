// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using System.IO;
using System.Reflection;
using UnityEditor;
using UnityEngine;
using Object = UnityEngine.Object;

namespace QuickSes.EngineDouble
{
    /// <summary>
    /// What the Editor and its user do, done when a test says so. The project is a folder of its own, and the current one,
    /// as in the Editor.
    /// </summary>
    public static class EditorDriver
    {
        private static readonly List<string> s_log = new List<string>();
        private static string s_folder, s_folderBefore, s_dataPathBefore;

        /// <summary>The folder of a package, whose files are assets of the GUIDs in the .meta files beside them.</summary>
        public static string PackageFolder { get; set; }

        /// <summary>What the user chooses in the next panel; "": nothing.</summary>
        public static string ChosenPath { get; set; } = "";

        /// <summary>Whether the user agrees to what a dialog asks.</summary>
        public static bool Agrees { get; set; } = true;

        /// <summary>Whether the user cancels what shows its progress.</summary>
        public static bool Cancels { get; set; }

        /// <summary>The panels and dialogs that were shown, and what was pinged, as "kind: text".</summary>
        public static IReadOnlyList<string> Shown => s_log;

        /// <summary>Whether a bar is being shown.</summary>
        public static bool ShowsProgress { get; internal set; }

        /// <summary>Edit mode in an empty project.</summary>
        public static void Begin()
        {
            s_folderBefore = Environment.CurrentDirectory;
            s_dataPathBefore = Application.dataPath;
            s_folder = Path.Combine(Path.GetTempPath(), Path.GetRandomFileName());
            Directory.CreateDirectory(Path.Combine(s_folder, "Assets"));
            Environment.CurrentDirectory = s_folder;
            Application.dataPath = Path.Combine(Environment.CurrentDirectory, "Assets");
            Application.isEditor = true;
            Engine.Resetting += Forget;
            Engine.BeginFrame = EditorApplication.BeginFrame;
            Engine.Reset();
            Engine.EnterEditMode();
        }

        public static void End()
        {
            try
            {
                Engine.Reset();
            }
            finally
            {
                Engine.Resetting -= Forget;
                Engine.BeginFrame = null;
                Application.isEditor = false;
                Application.dataPath = s_dataPathBefore;
                Environment.CurrentDirectory = s_folderBefore;
                Directory.Delete(s_folder, true);
            }
        }

        /// <summary>Whether an asset is as it is in its file.</summary>
        public static bool IsSaved(string path) => Project.Find(path).IsSaved;

        /// <summary>Lets assets not be written, as where the disk is full.</summary>
        public static bool IsDiskFull { get; set; }

        /// <summary>Lets version control refuse to have a file written.</summary>
        public static void Lock(string path) => Project.Locked.Add(path);

        /// <summary>Opens a prefab in a stage of its own.</summary>
        /// <returns>Its root there.</returns>
        public static GameObject OpenPrefab(string path)
        {
            var root = Object.Instantiate((GameObject)Project.Find(path).Main);
            root.name = Project.Find(path).Main.name;
            Engine.OpenAsPrefab(root);
            Project.Stage = new UnityEditor.SceneManagement.PrefabStage(root, path);
            return root;
        }

        /// <summary>Has the methods called that ask for it when the Editor has loaded an assembly.</summary>
        public static void Load(Assembly assembly)
        {
            foreach ((MethodInfo method, InitializeOnLoadMethodAttribute _) in
                Methods.With<InitializeOnLoadMethodAttribute>(assembly))
                method.Invoke(null, null);
        }

        /// <summary>Invokes a command of a component's context menu.</summary>
        public static void InvokeContextMenu(string path, Object context) =>
            EditorApplication.Execute(path, new MenuCommand(context));

        internal static void Note(string kind, string text) => s_log.Add($"{kind}: {text}");

        private static void Forget()
        {
            s_log.Clear();
            ChosenPath = "";
            Agrees = true;
            Cancels = ShowsProgress = IsDiskFull = false;
            Project.Clear();
            Undo.ClearAll();
            Selection.activeGameObject = null;
            EditorApplication.delayCall = null;
            DragAndDrop.Reset();
        }
    }
}
