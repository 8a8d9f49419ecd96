// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;

namespace QuickSes.EngineDouble
{
    /// <summary>
    /// What the thread that draws was asked to do, in order. It is done at the end of each frame, on the main thread,
    /// before meshes are looked at; or when a test says so.
    /// </summary>
    public static class RenderThread
    {
        [UnmanagedFunctionPointer(CallingConvention.StdCall)]
        private delegate void Callback(int eventId);

        private static readonly Queue<(IntPtr, int)> s_waiting = new Queue<(IntPtr, int)>();
        private static readonly Dictionary<IntPtr, Callback> s_callbacks = new Dictionary<IntPtr, Callback>();

        /// <summary>Whether frames end with it; else it stands still, as while a window is minimised.</summary>
        public static bool IsRunning { get; set; } = true;

        /// <summary>Events that have not run.</summary>
        public static int Waiting => s_waiting.Count;

        /// <summary>Events that were issued so far.</summary>
        public static int Issued { get; private set; }

        /// <summary>Does what is waiting, or as much of it.</summary>
        public static void Run(int count = int.MaxValue)
        {
            for (; count > 0 && s_waiting.Count > 0; --count)
            {
                (IntPtr callback, int eventId) = s_waiting.Dequeue();
                if (!s_callbacks.TryGetValue(callback, out Callback call))
                    s_callbacks[callback] = call = Marshal.GetDelegateForFunctionPointer<Callback>(callback);
                call(eventId);
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
