// SPDX-License-Identifier: MIT
using System.Collections.Generic;
using UnityEngine;

namespace QuickSes.EngineDouble
{
    /// <summary>What Destroy was called for; destroyed at the end of the frame.</summary>
    internal static class DestructionQueue
    {
        private static readonly List<Object> s_queue = new List<Object>();

        public static void Add(Object item)
        {
            item.IsDestructionPending = true;
            s_queue.Add(item);
        }

        public static void Clear() => s_queue.Clear();

        public static void Run()
        {
            for (int i = 0; i < s_queue.Count; ++i)
                s_queue[i].DestroyNow();
            s_queue.Clear();
        }
    }
}
