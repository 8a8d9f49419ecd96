// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;

namespace QuickSes.EngineDouble
{
    /// <summary>
    /// What the thread that draws was asked to do, in order. It is done at the end of each frame, on the main thread,
    /// before meshes are looked at; or when a test says so.
    /// </summary>
    public static class RenderThread
    {
        private static readonly Queue<(IntPtr, int)> s_waiting = new Queue<(IntPtr, int)>();
        private static readonly Dictionary<int, Action<int>> s_functions = new Dictionary<int, Action<int>>();

        /// <summary>Whether frames end with it; else it stands still, as while a window is minimised.</summary>
        public static bool IsRunning { get; set; } = true;

        /// <summary>Events that have not run.</summary>
        public static int Waiting => s_waiting.Count;

        /// <summary>Events that were issued so far.</summary>
        public static int Issued { get; private set; }

        /// <summary>Lets a pointer, any small number but 0, be one to a function: no native code is called here.</summary>
        public static void Declare(IntPtr pointer, Action<int> function) => s_functions[(int)pointer] = function;

        /// <summary>Does what is waiting, or as much of it.</summary>
        public static void Run(int count = int.MaxValue)
        {
            for (; count > 0 && s_waiting.Count > 0; --count)
            {
                (IntPtr callback, int eventId) = s_waiting.Dequeue();
                if (!s_functions.TryGetValue((int)callback, out Action<int> function))
                    throw new InvalidOperationException($"There is no function at {callback}.");
                function(eventId);
            }
        }

        internal static void Add(IntPtr callback, int eventId)
        {
            s_waiting.Enqueue((callback, eventId));
            ++Issued;
        }

        internal static void EndFrame()
        {
            if (IsRunning)
                Run();
        }

        internal static void Reset()
        {
            Run();
            IsRunning = true;
        }
    }
}
