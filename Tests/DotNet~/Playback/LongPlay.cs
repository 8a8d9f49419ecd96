// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;
using System.IO;
using System.Runtime.InteropServices;
using System.Threading;
using UnityEngine;

namespace QuickSes.Playback
{
    /// <summary>Plays a trajectory, and asks the runtime and the system what that took.</summary>
    public static class LongPlay
    {
        private const int WarmUpSurfaces = 1000;

        /// <summary>Prints name and number per line. Not 0: the trajectory can't be read.</summary>
        public static int Run(string file, int count)
        {
            Engine.Reset();
            var scene = new GameObject("player");
            var surface = scene.AddComponent<MolecularSurface>();
            var player = scene.AddComponent<TrajectoryPlayer>();
            surface.FrameBudget = 1; // the coarsest level: what is asked about are frames, not fineness
            player.StructureSource.SetFile(file);
            player.FramesPerSecond = 60;
            player.Mode = PlaybackMode.PingPong;
            player.Interpolate = true;
            int surfaces = 0;
            surface.SurfaceUpdated += level => ++surfaces;
            surface.Failed += error => throw new InvalidOperationException(error.Message);
            if (!player.Load())
                return 1;
            player.Play();

            PlayUntil(WarmUpSurfaces, ref surfaces);
            surfaces = 0;
            long resident = ResidentBytes(), native = HeapBytes();
            long all = GC.GetTotalAllocatedBytes(true), own = GC.GetAllocatedBytesForCurrentThread();
            PlayUntil(count, ref surfaces);
            own = GC.GetAllocatedBytesForCurrentThread() - own;
            all = GC.GetTotalAllocatedBytes(true) - all;
            native = HeapBytes() - native;
            resident = ResidentBytes() - resident;

            Console.WriteLine($"surfaces {surfaces}");
            Console.WriteLine($"allocated_main_thread {own}");
            Console.WriteLine($"allocated_all_threads {all}");
            Console.WriteLine($"native_heap_growth {native}");
            Console.WriteLine($"resident_growth {resident}");
            Console.WriteLine($"live_meshes {Engine.LiveObjects<Mesh>()}");
            Engine.Quit();
            return 0;
        }

        private static void PlayUntil(int count, ref int surfaces)
        {
            while (surfaces < count)
            {
                Engine.Frame(1 / 60.0);
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
