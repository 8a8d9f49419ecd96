// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using UnityEngine;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    public enum DragAndDropVisualMode
    {
        None = 0,
        Copy = 1,
        Link = 2,
        Rejected = 32
    }

    [Flags]
    public enum HierarchyDropFlags
    {
        None = 0,
        DropUpon = 1,
        DropBetween = 2,
        DropAfterParent = 4,
        SearchActive = 8,
        DropAbove = 16
    }

    public class DragAndDrop
    {
        public delegate DragAndDropVisualMode SceneDropHandler(Object dropUpon, Vector3 worldPosition,
            Vector2 viewportPosition, Transform parentForDraggedObjects, bool perform);

        public delegate DragAndDropVisualMode HierarchyDropHandler(int dropTargetInstanceID, HierarchyDropFlags dropMode,
            Transform parentForDraggedObjects, bool perform);

        private static readonly List<Delegate> s_handlers = new List<Delegate>();

        public static Object[] objectReferences { get; set; } = Array.Empty<Object>();

        /// <summary>Whether somebody took what is dragged; only the double tells.</summary>
        public static bool IsAccepted { get; private set; }

        public static void AddDropHandler(SceneDropHandler handler) => s_handlers.Add(handler);

        public static void AddDropHandler(HierarchyDropHandler handler) => s_handlers.Add(handler);

        public static void AcceptDrag() => IsAccepted = true;

        /// <summary>What the handlers make of it, asked one after the other; only in the double.</summary>
        public static DragAndDropVisualMode Drop<T>(Func<T, DragAndDropVisualMode> ask) where T : Delegate
        {
            foreach (Delegate each in s_handlers)
                if (each is T handler && ask(handler) is DragAndDropVisualMode mode && mode != DragAndDropVisualMode.None)
                    return mode;
            return DragAndDropVisualMode.None;
        }

        internal static void Reset()
        {
            s_handlers.Clear();
            objectReferences = Array.Empty<Object>();
            IsAccepted = false;
        }
    }
}
