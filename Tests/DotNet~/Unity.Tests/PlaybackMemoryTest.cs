// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using System;
using System.Diagnostics;
using System.IO;
using System.Runtime.InteropServices;
using UnityEngine;
using Is = NUnit.Framework.Is;

namespace QuickSes.Tests
{
    /// <summary>
    /// Playing for minutes: 10,000 frames of an NMR ensemble, each of which becomes a surface, without garbage on any
    /// thread and without growing memory, managed or native.
    /// </summary>
    internal sealed class PlaybackMemoryTest
    {
        private const int WarmUpFrames = 1500;
        private const int MeasuredFrames = 10000;

        private static string Ensemble => Path.Combine(
            Repository.Root, "Samples~", "TrajectoryPlayback", "2k39_ensemble.pdb.gz.bytes");

        [Test]
        public void TenThousandFramesFromAPlayerMakeNoGarbage()
        {
            var scene = new GameObject("player");
            var surface = scene.AddComponent<MolecularSurface>();
            var player = scene.AddComponent<TrajectoryPlayer>();
            surface.FrameBudget = 1; // the coarsest level: what is tested are frames, not fineness
            player.StructureSource.SetFile(Ensemble);
            player.FramesPerSecond = 60;
            player.Mode = PlaybackMode.PingPong;
            player.Interpolate = true;
            Assert.That(player.Load());
            player.Play();
            int surfaces = 0, failures = 0;
            surface.SurfaceUpdated += level => ++surfaces;
            surface.Failed += error => ++failures;

            RunUntil(() => surfaces >= WarmUpFrames);
            Memory before = Memory.Now();
            int first = surfaces;
            long own = GC.GetAllocatedBytesForCurrentThread();
            while (surfaces < first + MeasuredFrames)
                Engine.Frame(1 / 60.0);
            own = GC.GetAllocatedBytesForCurrentThread() - own;
            Memory after = Memory.Now();

            Assert.That(own, Is.EqualTo(0), "bytes allocated by the main thread");
            Assert.That(after.Allocated - before.Allocated, Is.LessThanOrEqualTo(Memory.OwnFootprint),
                "bytes allocated by all threads");
            Assert.That(after.Native - before.Native, Is.LessThan(1 << 20), "bytes of the native heap");
            Assert.That(after.Resident - before.Resident, Is.LessThan(16 << 20), "bytes of the process");
            Assert.That(Engine.LiveObjects<Mesh>(), Is.EqualTo(1));
            Assert.That(failures, Is.EqualTo(0));
            Assert.That(player.FrameCount, Is.EqualTo(116));
        }

        [Test]
        public void ManySurfacesOnFewContextsMakeNoGarbageEither()
        {
            const int Count = 12;
            var surfaces = new MolecularSurface[Count];
            var positions = new Vector3[Count][][];
            int updates = 0;
            for (int k = 0; k < Count; ++k)
            {
                TestMolecules.Blob(40 + 10 * k, k, out Vector3[] start, out float[] radii);
                positions[k] = new Vector3[8][];
                for (int frame = 0; frame < positions[k].Length; ++frame)
                    positions[k][frame] = TestMolecules.Moved(start, frame);
                surfaces[k] = new GameObject("surface " + k).AddComponent<MolecularSurface>();
                surfaces[k].SetAtoms(start, radii);
                surfaces[k].SurfaceUpdated += level => ++updates;
            }
            int frames = 0;
            Action step = () =>
            {
                ++frames;
                for (int k = 0; k < Count; ++k)
                    surfaces[k].SetPositions(positions[k][frames % positions[k].Length]);
                Engine.Frame(1 / 60.0);
            };
            while (updates < 1000)
                step();
            long own = GC.GetAllocatedBytesForCurrentThread();
            long all = GC.GetTotalAllocatedBytes(true);
            int from = updates;
            while (updates < from + 2000)
                step();
            Assert.That(GC.GetAllocatedBytesForCurrentThread() - own, Is.EqualTo(0),
                "the main thread");
            Assert.That(GC.GetTotalAllocatedBytes(true) - all, Is.LessThanOrEqualTo(Memory.OwnFootprint));
        }

        private static void RunUntil(Func<bool> condition)
        {
            Stopwatch clock = Stopwatch.StartNew();
            while (!condition())
            {
                Assert.That(clock.Elapsed.TotalMinutes, Is.LessThan(5), "still waiting");
                Engine.Frame(1 / 60.0);
            }
        }

        private struct Memory
        {
            // What asking allocates: a string or two, and the runtime's own threads.
            public const long OwnFootprint = 32 << 10;

            public long Allocated;
            public long Native;
            public long Resident;

            public static Memory Now()
            {
                var memory = new Memory { Native = (long)mallinfo2().InUse, Resident = ResidentBytes() };
                GC.Collect();
                memory.Allocated = GC.GetTotalAllocatedBytes(true);
                return memory;
            }

            private static long ResidentBytes() =>
                long.Parse(File.ReadAllText("/proc/self/statm").Split(' ')[1]) * Environment.SystemPageSize;

            [DllImport("libc")]
            private static extern HeapInfo mallinfo2();

            // struct mallinfo2 of glibc 2.33.
            [StructLayout(LayoutKind.Sequential)]
            private struct HeapInfo
            {
                public UIntPtr Arena, FreeChunks, FastChunks, MappedChunks, Mapped, Unused, FastFree, InUse, Free, Top;
            }
        }
    }
}
