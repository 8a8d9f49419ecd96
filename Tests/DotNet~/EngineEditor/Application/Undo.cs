// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;
using System.Collections.Generic;
using UnityEngine;
using Object = UnityEngine.Object;

namespace UnityEditor
{
    /// <summary>Steps are those of <see cref="IncrementCurrentGroup"/>: the double's frames begin none.</summary>
    public sealed class Undo
    {
        private static readonly Stack<(int Group, Action Revert)> s_steps = new Stack<(int, Action)>();
        private static int s_group;

        public static void IncrementCurrentGroup() => ++s_group;

        public static void ClearAll() => s_steps.Clear();

        public static void RegisterCreatedObjectUndo(Object objectToUndo, string name) =>
            Push(() => Destroy(objectToUndo));

        public static T AddComponent<T>(GameObject gameObject) where T : Component
        {
            var added = gameObject.AddComponent<T>();
            Push(() => Destroy(added));
            return added;
        }

        /// <summary>Of renderers, and scripts.</summary>
        public static void RecordObject(Object objectToUndo, string name)
        {
            switch (objectToUndo)
            {
                case Renderer renderer:
                    Material[] materials = renderer.sharedMaterials;
                    Push(() => Restore(renderer, () => renderer.sharedMaterials = materials));
                    break;
                case MonoBehaviour script:
                    object state = SerializedFields.Copy(script);
                    Push(() => Restore(script, () => SerializedFields.Paste(script, state)));
                    break;
                default:
                    throw new NotSupportedException($"The double can't take back changes of {objectToUndo.GetType()}.");
            }
        }

        /// <summary>Takes back what the last step has done, the last first.</summary>
        public static void PerformUndo()
        {
            if (s_steps.Count == 0)
                return;
            int group = s_steps.Peek().Group;
            while (s_steps.Count > 0 && s_steps.Peek().Group == group)
                s_steps.Pop().Revert();
            EditorApplication.QueuePlayerLoopUpdate(); // the scene is drawn again
        }

        private static void Push(Action revert) => s_steps.Push((s_group, revert));

        private static void Destroy(Object made)
        {
            if (made != null)
                Object.DestroyImmediate(made);
        }

        private static void Restore(Object changed, Action restore)
        {
            if (changed != null)
                restore();
        }
    }
}
