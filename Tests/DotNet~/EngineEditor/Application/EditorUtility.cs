// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;
using UnityEngine;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    /// <summary>What the user answers is said by <see cref="EditorDriver"/>.</summary>
    public sealed class EditorUtility
    {
        public static bool IsPersistent(Object target) => target != null && target.IsPersistent;

        public static void SetDirty(Object target)
        {
            if (target == null)
                throw new ArgumentNullException(nameof(target));
            ProjectEntry entry = Project.Of(target);
            if (entry != null)
                entry.IsDirty = true;
        }

        /// <summary>Of components of the engine's own types.</summary>
        public static void CopySerialized(Object source, Object dest)
        {
            if (source == null || dest == null)
                throw new NullReferenceException("CopySerialized of no object");
            if (source.GetType() != dest.GetType() || !(source is Component) || source is MonoBehaviour)
                throw new NotSupportedException($"The double copies no {source.GetType()} to a {dest.GetType()}.");
            ((Component)dest).CopyStateOf((Component)source);
            dest.hideFlags = source.hideFlags;
        }

        public static string SaveFilePanelInProject(string title, string defaultName, string extension, string message)
        {
            EditorDriver.Note("panel", defaultName + "." + extension);
            return EditorDriver.ChosenPath;
        }

        public static string OpenFilePanelWithFilters(string title, string directory, string[] filters)
        {
            EditorDriver.Note("panel", title);
            return EditorDriver.ChosenPath;
        }

        public static bool DisplayDialog(string title, string message, string ok, string cancel = "")
        {
            EditorDriver.Note("dialog", message);
            return cancel.Length == 0 || EditorDriver.Agrees;
        }

        /// <summary>Whether the user cancels it.</summary>
        public static bool DisplayCancelableProgressBar(string title, string info, float progress)
        {
            EditorDriver.ShowsProgress = true;
            return EditorDriver.Cancels;
        }

        public static void ClearProgressBar() => EditorDriver.ShowsProgress = false;

        public static Object InstanceIDToObject(int instanceID)
        {
            foreach (Object item in ObjectRegistry.Objects)
                if (item.GetInstanceID() == instanceID)
                    return item;
            return null;
        }
    }

    public sealed class EditorGUIUtility
    {
        public static void PingObject(Object obj) => EditorDriver.Note("ping", AssetDatabase.GetAssetPath(obj));
    }
}
