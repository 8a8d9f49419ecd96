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
        private const int Surfaces = 300, Block = 4096; // Boehm's collector hands out whole blocks of memory
        private const int Attempts = 3, MostAttempts = 15; // without collections in between; at all
        private const int Little = 4 * Block;
        private static object s_garbage;
        private object[] _ballast;

        [OneTimeSetUp]
        public void AskWhereNothingElseTells()
        {
            long before = GC.GetAllocatedBytesForCurrentThread();
            s_garbage = new object();
            if (GC.GetAllocatedBytesForCurrentThread() > before)
                Assert.Ignore("This collector counts what threads allocate, which the other tests ask for.");
            // The collector comes when a part of what the heap has was allocated anew: not in a round, whatever ran before.
            _ballast = new object[4 << 20];
        }

        [OneTimeTearDown]
        public void LetGo() => _ballast = null;

        [Test]
        public void PlayingDoesNotGrowTheHeap() => Assert.That(Play(() => { }), Is.LessThan(Little));

        [Test]
        public void GarbageWouldBeSeen() =>
            Assert.That(Play(() => s_garbage = new byte[Block]), Is.GreaterThan((Surfaces - 1) * Block));

        // The least of some attempts: frames that leave garbage leave it in each, and what else the runtime does comes and goes.
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
            long least = long.MaxValue;
            int measured = 0;
            for (int attempt = -1; attempt < MostAttempts && measured < Attempts; ++attempt) // first to compile, and to grow
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
                long growth = GC.GetTotalMemory(false) - before;
                if (attempt < 0 || GC.CollectionCount(0) != collections)
                    continue;
                ++measured;
                least = Math.Min(least, growth);
                if (least < Little)
                    break;
            }
            Assert.That(measured, Is.GreaterThan(0), "collections came in between each time");
            return least;
        }
    }
}
