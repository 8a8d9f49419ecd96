// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;
using System.IO;
using System.Runtime.InteropServices;
using System.Threading;
using UnityEngine;

namespace QuickSes.Playback
{
    /// <summary>What frames take in memory, managed and native, asked of the runtime and the system.</summary>
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
            long resident = ResidentBytes(), native = HeapBytes();
            long all = GC.GetTotalAllocatedBytes(true), own = GC.GetAllocatedBytesForCurrentThread();
            PlayUntil(surfaces + count, frame, shown);
            own = GC.GetAllocatedBytesForCurrentThread() - own;
            all = GC.GetTotalAllocatedBytes(true) - all;
            native = HeapBytes() - native;
            resident = ResidentBytes() - resident;

            Console.WriteLine($"surfaces {shown() - surfaces}");
            Console.WriteLine($"allocated_main_thread {own}");
            Console.WriteLine($"allocated_all_threads {all}");
            Console.WriteLine($"native_heap_growth {native}");
            Console.WriteLine($"resident_growth {resident}");
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

        private static long ResidentBytes() =>
            long.Parse(File.ReadAllText("/proc/self/statm").Split(' ')[1]) * Environment.SystemPageSize;

        private static long HeapBytes()
        {
            HeapInfo info = mallinfo2();
            return (long)(info.InUse.ToUInt64() + info.MappedBytes.ToUInt64());
        }

        [DllImport("libc")]
        private static extern HeapInfo mallinfo2();

        // struct mallinfo2 of glibc 2.33.
        [StructLayout(LayoutKind.Sequential)]
        private struct HeapInfo
        {
            public UIntPtr Arena, FreeChunks, FastChunks, MappedChunks, MappedBytes, Unused, FastFree, InUse, Free, Top;
        }
    }
}
