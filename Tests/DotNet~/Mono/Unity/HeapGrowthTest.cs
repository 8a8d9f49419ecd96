// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using System;
using System.Threading;
using UnityEngine;

namespace QuickSes.Tests
{
    /// <summary>
    /// Playing makes no garbage on any thread. Boehm's collector, which Unity's Mono has, does not count what a thread
    /// allocates (what counts it elsewhere is always 0), so that the whole heap is asked, between collections.
    /// </summary>
    internal sealed class HeapGrowthTest
    {
        private const int Surfaces = 300, Attempts = 5, Block = 4096; // Boehm's collector hands out whole blocks of memory
        private static object s_garbage;

        [OneTimeSetUp]
        public void AskWhereNothingElseTells()
        {
            long before = GC.GetAllocatedBytesForCurrentThread();
            s_garbage = new object();
            if (GC.GetAllocatedBytesForCurrentThread() > before)
                Assert.Ignore("This collector counts what threads allocate, which the other tests ask for.");
        }

        [Test]
        public void PlayingDoesNotGrowTheHeap() => Assert.That(Play(() => { }), Is.LessThan(4 * Block));

        [Test]
        public void GarbageWouldBeSeen() =>
            Assert.That(Play(() => s_garbage = new byte[Block]), Is.GreaterThan((Surfaces - 1) * Block));

        private static long Play(Action garbage)
        {
            TestMolecules.Blob(60, 1, out Vector3[] start, out float[] radii);
            var moved = new Vector3[8][];
            for (int k = 0; k < moved.Length; ++k)
                moved[k] = TestMolecules.Moved(start, k);
            var surface = new GameObject("surface").AddComponent<MolecularSurface>();
            int shown = 0, frame = 0;
            surface.SurfaceUpdated += level => ++shown;
            surface.Failed += error => throw new InvalidOperationException(error.Message);
            surface.SetAtoms(start, radii);
            surface.Spacing = 1;
            long growth = 0;
            for (int attempt = -1; attempt < Attempts; ++attempt) // first to compile, and for memory that grows
            {
                GC.Collect();
                int collections = GC.CollectionCount(0);
                long before = GC.GetTotalMemory(false);
                for (int end = shown + Surfaces; shown < end; ++frame)
                {
                    surface.SetPositions(moved[frame % moved.Length]);
                    int last = shown;
                    while (shown == last)
                    {
                        Engine.Frame(1 / 60.0);
                        Thread.Yield();
                    }
                    garbage();
                }
                growth = GC.GetTotalMemory(false) - before;
                if (attempt >= 0 && GC.CollectionCount(0) == collections)
                    return growth;
            }
            throw new InvalidOperationException("collections came in between each time");
        }
    }
}
