// SPDX-License-Identifier: MIT
using System.Collections.Generic;
using UnityEngine;

namespace QuickSes.EngineDouble
{
    /// <summary>What Destroy was called for; destroyed at the end of the frame, or after a delay.</summary>
    internal static class DestructionQueue
    {
        private static readonly List<(Object Item, double Time)> s_queue = new List<(Object, double)>();

        public static void Add(Object item, float delay)
        {
            item.IsDestructionPending = delay <= 0;
            s_queue.Add((item, Time.timeAsDouble + delay));
        }

        public static void Clear() => s_queue.Clear();

        public static void Run()
        {
            for (int i = 0; i < s_queue.Count; ++i)
            {
                (Object item, double time) = s_queue[i];
                if (time > Time.timeAsDouble)
                    continue;
                s_queue.RemoveAt(i--);
                item.DestroyNow();
            }
        }
    }
}
