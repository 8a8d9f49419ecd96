// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Linq;
using System.Threading;
using UnityEngine;

namespace QuickSes.Tests
{
    public sealed class FramePrefetcherTest
    {
        /// <summary>Frames in which x is the number of the frame, and y that of the atom.</summary>
        private sealed class CountingReader : FrameReader
        {
            public readonly ManualResetEventSlim Gate = new ManualResetEventSlim(true); // closed: reads wait
            public readonly List<int> Reads = new List<int>(100000); // locked
            public int Damaged = -1, Throws = -1;
            public bool CanOpen = true, ThrowsOnOpening, WaitsOnOpening;
            public volatile bool IsDisposed;
            public long Allocated; // bytes, by the thread, before its newest read

            private readonly int _frames, _atoms;

            public CountingReader(int frames, int atoms = 4)
            {
                _frames = frames;
                _atoms = atoms;
            }

            public override int FrameCount => _frames;
            public override int AtomCount => _atoms;
            public override string Warning => "a warning";

            public override bool TryOpen(out QuickSesError error)
            {
                if (WaitsOnOpening)
                    Gate.Wait();
                if (ThrowsOnOpening)
                    throw new InvalidOperationException("thrown");
                error = CanOpen ? default : new QuickSesError(QuickSesStatus.FileError, "can't be opened");
                return CanOpen;
            }

            public override bool TryRead(int frame, Span<Vector3> positions, out TrajectoryFrame info,
                out QuickSesError error)
            {
                Volatile.Write(ref Allocated, GC.GetAllocatedBytesForCurrentThread());
                lock (Reads)
                    Reads.Add(frame);
                Gate.Wait();
                if (frame == Throws)
                    throw new InvalidOperationException("thrown");
                for (int i = 0; i < positions.Length; ++i)
                    positions[i] = new Vector3(frame, i, 0);
                info = default;
                error = frame == Damaged ? new QuickSesError(QuickSesStatus.FileError, "damaged") : default;
                return frame != Damaged;
            }

            public override void Dispose() => IsDisposed = true;

            public int[] ReadsSoFar()
            {
                lock (Reads)
                    return Reads.ToArray();
            }
        }

        private static FrameOrder Order(
            int frames, int first, PlaybackMode mode = PlaybackMode.Loop, int direction = 1) =>
            new FrameOrder(frames, mode, direction, first);

        private static void WaitUntil(Func<bool> condition, string what)
        {
            if (!SpinWait.SpinUntil(condition, TimeSpan.FromSeconds(SurfaceRig.Patience)))
                Assert.Fail("waited in vain until " + what);
        }

        private static void WaitUntilOpen(FramePrefetcher prefetcher)
        {
            WaitUntil(() => prefetcher.GetOpening(out _) != FrameState.Pending, "it is open");
            Assert.That(prefetcher.GetOpening(out QuickSesError error), Is.EqualTo(FrameState.Ready), error.ToString());
        }

        private static FrameState WaitFor(FramePrefetcher prefetcher, int frame)
        {
            WaitUntil(() => prefetcher.Get(frame, out _, out _, out _) != FrameState.Pending, "a frame is there");
            return prefetcher.Get(frame, out _, out _, out _);
        }

        private static void AssertShows(FramePrefetcher prefetcher, int frame)
        {
            Assert.That(WaitFor(prefetcher, frame), Is.EqualTo(FrameState.Ready));
            prefetcher.Get(frame, out ReadOnlySpan<Vector3> positions, out _, out _);
            Assert.That(positions.Length, Is.EqualTo(prefetcher.AtomCount));
            for (int i = 0; i < positions.Length; ++i)
                Assert.That(positions[i], Is.EqualTo(new Vector3(frame, i, 0)));
        }

        [TestCase(PlaybackMode.Loop, 1, 5, new[] { 5, 6, 7, 8, 9, 0, 1, 2 })]
        [TestCase(PlaybackMode.Loop, -1, 1, new[] { 1, 0, 9, 8, 7, 6, 5, 4 })]
        [TestCase(PlaybackMode.PingPong, 1, 8, new[] { 8, 9, 7, 6, 5, 4, 3 })]
        [TestCase(PlaybackMode.Once, 1, 7, new[] { 7, 8, 9 })]
        [TestCase(PlaybackMode.Once, -1, 2, new[] { 2, 1, 0 })]
        public void FramesAreReadInTheOrderOfShowing(PlaybackMode mode, int direction, int first, int[] expected)
        {
            var reader = new CountingReader(10);
            using (var prefetcher = new FramePrefetcher(reader, 8))
            {
                WaitUntilOpen(prefetcher);
                prefetcher.Request(Order(10, first, mode, direction));
                WaitUntil(() => reader.ReadsSoFar().Length >= expected.Length, "all are read");
                foreach (int frame in expected)
                    AssertShows(prefetcher, frame);
            }
            Assert.That(reader.ReadsSoFar(), Is.EqualTo(expected)); // and no more
        }

        [Test]
        public void FramesAreReadOnceWhilePlaying()
        {
            var reader = new CountingReader(1000);
            using (var prefetcher = new FramePrefetcher(reader, 8))
            {
                for (int frame = 0; frame < 500; ++frame)
                {
                    prefetcher.Request(Order(1000, frame, PlaybackMode.Once));
                    AssertShows(prefetcher, frame);
                }
            }
            int[] reads = reader.ReadsSoFar();
            Assert.That(reads, Is.EqualTo(Enumerable.Range(0, reads.Length)));
            Assert.That(reads.Length, Is.InRange(500, 508));
        }

        [Test]
        public void SeekingDropsWhatWasWantedBefore()
        {
            var reader = new CountingReader(100);
            using (var prefetcher = new FramePrefetcher(reader, 4))
            {
                WaitUntilOpen(prefetcher);
                reader.Gate.Reset();
                prefetcher.Request(Order(100, 0));
                WaitUntil(() => reader.ReadsSoFar().Length == 1, "the first is being read");
                prefetcher.Request(Order(100, 20));
                prefetcher.Request(Order(100, 50));
                reader.Gate.Set();
                AssertShows(prefetcher, 53);
            }
            Assert.That(reader.ReadsSoFar(), Is.EqualTo(new[] { 0, 50, 51, 52, 53 }));
        }

        [Test]
        public void RandomSeeksShowWhatIsAskedFor()
        {
            const int frames = 60;
            var random = new System.Random(1);
            var reader = new CountingReader(frames);
            var modes = new[] { PlaybackMode.Loop, PlaybackMode.PingPong, PlaybackMode.Once };
            using (var prefetcher = new FramePrefetcher(reader, 6))
            {
                for (int seek = 0; seek < 2000; ++seek)
                {
                    FrameOrder order = Order(frames, random.Next(frames), modes[random.Next(3)],
                        random.Next(2) == 0 ? 1 : -1);
                    prefetcher.Request(order);
                    if (random.Next(3) == 0) // others are overtaken
                        for (int step = 0; step < 2; ++step)
                            if (order[step] >= 0)
                                AssertShows(prefetcher, order[step]);
                }
                Assert.That(prefetcher.SlotCount, Is.EqualTo(6));
            }
            Assert.That(reader.ReadsSoFar(), Is.All.InRange(0, frames - 1));
        }

        [TestCase(1000L, 1, 3)] // never fewer than playing needs
        [TestCase(10 * 12 * 100L, 64, 10)]
        [TestCase(FramePrefetcher.MemoryLimit, 64, 64)]
        [TestCase(FramePrefetcher.MemoryLimit, 1, 3)]
        public void MemoryIsBounded(long limit, int slots, int expected)
        {
            using (var prefetcher = new FramePrefetcher(new CountingReader(1000, 100), slots, limit))
            {
                WaitUntilOpen(prefetcher);
                Assert.That(prefetcher.SlotCount, Is.EqualTo(expected));
                Assert.That(prefetcher.FrameCount, Is.EqualTo(1000));
                Assert.That(prefetcher.AtomCount, Is.EqualTo(100));
                Assert.That(prefetcher.Warning, Is.EqualTo("a warning"));
            }
        }

        [Test]
        public void DamagedFramesAreToldAndOthersRead()
        {
            var reader = new CountingReader(10) { Damaged = 3 };
            using (var prefetcher = new FramePrefetcher(reader, 5))
            {
                prefetcher.Request(Order(10, 2));
                AssertShows(prefetcher, 2);
                Assert.That(WaitFor(prefetcher, 3), Is.EqualTo(FrameState.Damaged));
                prefetcher.Get(3, out ReadOnlySpan<Vector3> positions, out _, out QuickSesError error);
                Assert.That(positions.Length, Is.EqualTo(0));
                Assert.That(error.Message, Is.EqualTo("damaged"));
                AssertShows(prefetcher, 4);
            }
        }

        [Test]
        public void WhatCannotBeOpenedIsTold()
        {
            var reader = new CountingReader(10) { CanOpen = false };
            var prefetcher = new FramePrefetcher(reader, 5);
            WaitUntil(() => prefetcher.GetOpening(out _) == FrameState.Damaged, "it failed");
            prefetcher.GetOpening(out QuickSesError error);
            Assert.That(error.Message, Is.EqualTo("can't be opened"));
            prefetcher.Request(Order(10, 0));
            Assert.That(prefetcher.Get(0, out _, out _, out _), Is.EqualTo(FrameState.Pending));
            prefetcher.Dispose();
            AssertLeaves(prefetcher, reader);
        }

        [Test]
        public void ExceptionsDoNotLeaveTheThread()
        {
            var reader = new CountingReader(10) { ThrowsOnOpening = true };
            var prefetcher = new FramePrefetcher(reader, 5);
            WaitUntil(() => prefetcher.GetOpening(out _) == FrameState.Damaged, "it failed");
            prefetcher.GetOpening(out QuickSesError error);
            Assert.That(error.Status, Is.EqualTo(QuickSesStatus.InternalError));
            Assert.That(error.Message, Does.Contain("thrown"));
            prefetcher.Dispose();
            AssertLeaves(prefetcher, reader);
        }

        [Test]
        public void ReadsThatThrowDamageTheirFrameOnly()
        {
            var reader = new CountingReader(10) { Throws = 1 };
            using (var prefetcher = new FramePrefetcher(reader, 5))
            {
                prefetcher.Request(Order(10, 0));
                Assert.That(WaitFor(prefetcher, 1), Is.EqualTo(FrameState.Damaged));
                prefetcher.Get(1, out _, out _, out QuickSesError error);
                Assert.That(error.Status, Is.EqualTo(QuickSesStatus.InternalError));
                Assert.That(error.Message, Does.Contain("thrown"));
                AssertShows(prefetcher, 0);
                AssertShows(prefetcher, 2);
            }
            WaitUntil(() => reader.IsDisposed, "the reader is given back");
        }

        // The thread plans without the lock: by the time it has a slot for another frame, that slot may be wanted.
        [Test]
        public void FramesThatAreWantedStayWhatTheyAre()
        {
            var random = new System.Random(1);
            using (var prefetcher = new FramePrefetcher(new CountingReader(100, 64), 4))
            {
                WaitUntilOpen(prefetcher);
                int seen = 0, others = 0;
                Stopwatch waited = Stopwatch.StartNew();
                while (seen < 20000)
                {
                    int frame = 10 * random.Next(3);
                    prefetcher.Request(Order(100, frame));
                    if (prefetcher.Get(frame, out ReadOnlySpan<Vector3> positions, out _, out _) == FrameState.Ready)
                    {
                        ++seen;
                        for (int look = 0; look < 3; ++look)
                        {
                            Thread.SpinWait(20); // for as long as it might be read into
                            foreach (Vector3 position in positions)
                                others += position.x == frame ? 0 : 1;
                        }
                    }
                    else
                    {
                        Thread.Yield();
                    }
                    Assert.That(waited.Elapsed.TotalSeconds, Is.LessThan(SurfaceRig.Patience), "still waiting");
                }
                Assert.That(others, Is.EqualTo(0));
            }
        }

        // Its reader waits at the gate, and a timer would open it if somebody waited for that.
        private static void DisposeAtTheClosedGate(FramePrefetcher prefetcher, CountingReader reader)
        {
            TimeSpan patience = TimeSpan.FromSeconds(SurfaceRig.Patience);
            using (new Timer(_ => reader.Gate.Set(), null, patience, Timeout.InfiniteTimeSpan))
                prefetcher.Dispose();
            Assert.That(reader.Gate.IsSet || prefetcher.HasLeft || reader.IsDisposed, Is.False);
        }

        private static void AssertLeaves(FramePrefetcher prefetcher, CountingReader reader, params int[] reads)
        {
            WaitUntil(() => prefetcher.HasLeft, "the thread has left by itself");
            Assert.That(reader.IsDisposed, Is.True);
            Assert.That(reader.ReadsSoFar(), Is.EqualTo(reads));
            prefetcher.Dispose(); // once more does no harm
        }

        private static FramePrefetcher StuckInOpening(CountingReader reader)
        {
            reader.Gate.Reset();
            return new FramePrefetcher(reader, 5);
        }

        private static FramePrefetcher StuckInARead(CountingReader reader)
        {
            var prefetcher = new FramePrefetcher(reader, 5);
            reader.Gate.Reset();
            prefetcher.Request(Order(10, 0));
            WaitUntil(() => reader.ReadsSoFar().Length == 1, "a frame is being read");
            return prefetcher;
        }

        [Test]
        public void DisposeDoesNotWaitForOpening()
        {
            var reader = new CountingReader(10) { WaitsOnOpening = true };
            FramePrefetcher prefetcher = StuckInOpening(reader);
            DisposeAtTheClosedGate(prefetcher, reader);
            reader.Gate.Set();
            AssertLeaves(prefetcher, reader);
        }

        [Test]
        public void DisposeDoesNotWaitForARead()
        {
            var reader = new CountingReader(10);
            FramePrefetcher prefetcher = StuckInARead(reader);
            DisposeAtTheClosedGate(prefetcher, reader);
            prefetcher.Request(Order(10, 5)); // too late
            Assert.That(prefetcher.Get(5, out _, out _, out _), Is.EqualTo(FrameState.Pending));
            reader.Gate.Set();
            AssertLeaves(prefetcher, reader, 0);
            prefetcher.Request(Order(10, 6));
            Assert.That(prefetcher.Get(0, out _, out _, out _), Is.EqualTo(FrameState.Pending));
        }

        [Test]
        public void ADomainIsNotUnloadedBeforeTheyHaveLeft()
        {
            var opening = new CountingReader(10) { WaitsOnOpening = true };
            FramePrefetcher first = StuckInOpening(opening);
            first.Dispose();
            var reading = new CountingReader(10);
            FramePrefetcher second = StuckInARead(reading);
            var idle = new CountingReader(10);
            var third = new FramePrefetcher(idle, 5);
            WaitUntilOpen(third);
            var opener = new Thread(() =>
            {
                Thread.Sleep(50);
                opening.Gate.Set();
                reading.Gate.Set();
            });
            opener.Start();
            BackgroundThread.SendAllAway();
            opener.Join();
            Assert.That(first.HasLeft && second.HasLeft && third.HasLeft, Is.True);
            Assert.That(opening.IsDisposed && reading.IsDisposed && idle.IsDisposed, Is.True);
            AssertLeaves(second, reading, 0);
        }

        [Test]
        public void FramesAreFoundAmongAnyOthers()
        {
            const int count = 7, atoms = 2;
            var random = new System.Random(1);
            using (var slots = new FrameSlots(count, atoms))
            {
                var frameOf = new int[count]; // what each slot has
                Array.Fill(frameOf, -1);
                for (int change = 0; change < 3000; ++change)
                {
                    // Few numbers, many of which share a bucket.
                    FrameOrder order = Order(200, 16 * random.Next(12) + random.Next(2), PlaybackMode.Once,
                        random.Next(2) == 0 ? 1 : -1);
                    var wanted = Enumerable.Range(0, count).Select(step => order[step]).Where(f => f >= 0).ToList();
                    bool isWork = slots.TryPlan(order, out int frame, out int slot);
                    Assert.That(isWork, Is.EqualTo(wanted.Except(frameOf).Any()));
                    if (!isWork)
                        continue;
                    Assert.That(frame, Is.EqualTo(wanted.First(f => !frameOf.Contains(f))));
                    Assert.That(wanted, Has.No.Member(frameOf[slot]));
                    if (frameOf.Contains(-1))
                        Assert.That(frameOf[slot], Is.EqualTo(-1), "what is there stays while there is room");
                    int gone = frameOf[slot];
                    slots.Assign(slot, frame);
                    frameOf[slot] = frame;
                    Assert.That(slots.Get(frame, out _, out _, out _), Is.EqualTo(FrameState.Pending));
                    slots.Positions(slot).Fill(new Vector3(frame, 0, 0));
                    slots.Finish(slot, FrameState.Ready, default, default);
                    Assert.That(slots.Get(gone, out _, out _, out _), Is.EqualTo(FrameState.Pending));
                    foreach (int there in frameOf.Where(f => f >= 0))
                    {
                        slots.Get(there, out ReadOnlySpan<Vector3> positions, out _, out _);
                        Assert.That(positions.ToArray(), Is.EqualTo(new Vector3[atoms].Select(
                            _ => new Vector3(there, 0, 0))));
                    }
                }
            }
        }

        [Test]
        public void NoThreadMakesGarbage()
        {
            var reader = new CountingReader(100000);
            using (var prefetcher = new FramePrefetcher(reader, 8))
            {
                int frame = 0;
                TestDelegate play = () =>
                {
                    for (int end = frame + 200; frame < end; ++frame)
                    {
                        prefetcher.Request(Order(100000, frame));
                        while (prefetcher.Get(frame, out _, out _, out _) == FrameState.Pending)
                            Thread.Yield();
                    }
                };
                Garbage.AssertNoneBesideThreads(play);
                // Nor does the thread that reads.
                long least = long.MaxValue;
                for (int round = 0; round < 8 && least != 0; ++round)
                {
                    long before = Volatile.Read(ref reader.Allocated);
                    play();
                    least = Math.Min(least, Volatile.Read(ref reader.Allocated) - before);
                }
                Assert.That(least, Is.EqualTo(0));
                Assert.That(reader.ReadsSoFar().Length, Is.GreaterThanOrEqualTo(600));
            }
        }
    }
}
