// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections;
using System.Collections.Generic;
using System.Diagnostics;
using UnityEngine;

namespace QuickSes.EngineDouble
{
    /// <summary>
    /// Runs what a test yields: each null is a frame. Errors in the log end it, unless it is a tear-down.
    /// </summary>
    internal static class EnumeratorRunner
    {
        private static readonly TimeSpan TimeLimit = TimeSpan.FromSeconds(180);

        public static void Run(IEnumerator test, bool isTearDown = false)
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

                double end = Time.timeAsDouble + (step is WaitForSeconds wait ? wait.Seconds : 0);
                do
                {
                    Engine.Frame();
                    if (LogScope.IsOpen && !isTearDown)
                        LogScope.Current.RequireNoFailure();
                    if (clock.Elapsed > TimeLimit)
                        throw new AssertionException($"The test took longer than {TimeLimit.TotalSeconds} s.");
                }
                while (Time.timeAsDouble < end || step is Coroutine coroutine && !coroutine.IsDone);
            }
        }
    }
}
