// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections;
using System.Collections.Generic;
using System.Diagnostics;

namespace QuickSes.EngineDouble
{
    /// <summary>
    /// Runs what a test yields: each null is a frame. Errors in the log end it.
    /// </summary>
    internal static class EnumeratorRunner
    {
        private static readonly TimeSpan TimeLimit = TimeSpan.FromSeconds(450);

        public static void Run(IEnumerator test)
        {
            Stopwatch clock = Stopwatch.StartNew();
            var routines = new Stack<IEnumerator>();
            routines.Push(test);
            while (routines.Count > 0)
            {
                if (!routines.Peek().MoveNext())
                {
                    (routines.Pop() as IDisposable)?.Dispose();
                    continue;
                }

                object step = routines.Peek().Current;
                if (step is IEnumerator inner)
                {
                    routines.Push(inner);
                    continue;
                }

                Engine.Frame();
                if (LogScope.IsOpen)
                    LogScope.Current.RequireNoFailure();
                if (clock.Elapsed > TimeLimit)
                    throw new AssertionException($"The test took longer than {TimeLimit.TotalSeconds} s.");
            }
        }
    }
}
