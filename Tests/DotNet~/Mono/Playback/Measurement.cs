// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;
using System.Threading;
using UnityEngine;

namespace QuickSes.Playback
{
    /// <summary>What frames take in memory where the runtime does not count what is allocated.</summary>
    internal static class Measurement
    {
        private const int WarmUpSurfaces = 1000;

        /// <summary>Prints name and number per line, after a warm-up.</summary>
        /// <param name="count">How many surfaces are to be shown meanwhile, at least.</param>
        /// <param name="frame">Makes a frame.</param>
        /// <param name="shown">How many surfaces have been shown so far.</param>
        public static void Print(int count, Action frame, Func<int> shown)
        {
            PlayUntil(WarmUpSurfaces, frame, shown);
            int surfaces = shown();
            long heap = GC.GetTotalMemory(true);
            int collections = GC.CollectionCount(0);
            PlayUntil(surfaces + count, frame, shown);
            Console.WriteLine($"surfaces {shown() - surfaces}");
            Console.WriteLine($"heap_growth {GC.GetTotalMemory(false) - heap}");
            Console.WriteLine($"collections {GC.CollectionCount(0) - collections}");
            Console.WriteLine($"live_meshes {Engine.LiveObjects<Mesh>()}");
        }

        private static void PlayUntil(int count, Action frame, Func<int> shown)
        {
            while (shown() < count)
            {
                frame();
                Thread.Sleep(1); // the cores are the surface's meanwhile
            }
        }
    }
}
