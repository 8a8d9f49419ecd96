// SPDX-License-Identifier: MIT
using System.Collections.Generic;
using UnityEngine;

namespace QuickSes.EngineDouble
{
    /// <summary>All objects that were made and not destroyed.</summary>
    internal static class ObjectRegistry
    {
        private static readonly List<Object> s_objects = new List<Object>();

        public static IReadOnlyList<Object> Objects => s_objects;

        public static void Add(Object item)
        {
            item.RegistryIndex = s_objects.Count;
            s_objects.Add(item);
        }

        public static void Remove(Object item)
        {
            Object last = s_objects[s_objects.Count - 1];
            s_objects[item.RegistryIndex] = last;
            last.RegistryIndex = item.RegistryIndex;
            s_objects.RemoveAt(s_objects.Count - 1);
        }

        public static int CountOf<T>() where T : Object
        {
            int count = 0;
            for (int i = 0; i < s_objects.Count; ++i)
                if (s_objects[i] is T)
                    ++count;
            return count;
        }
    }
}
