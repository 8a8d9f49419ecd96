// SPDX-License-Identifier: MIT
using System.Threading;
using UnityEngine;

namespace QuickSes.EngineDouble
{
    /// <summary>The thread that drives the engine; others may not use its objects.</summary>
    internal static class EngineThread
    {
        private static int s_mainThread;

        /// <summary>True when no thread has driven the engine yet, too.</summary>
        public static bool IsMain => s_mainThread == 0 || s_mainThread == Thread.CurrentThread.ManagedThreadId;

        public static void Adopt() => s_mainThread = Thread.CurrentThread.ManagedThreadId;

        public static void Require(string member)
        {
            if (!IsMain)
                throw new UnityException($"{member} can only be called from the main thread.");
        }
    }
}
