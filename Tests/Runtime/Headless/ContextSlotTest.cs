// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System.Numerics;
using System.Threading;

namespace QuickSes.Tests
{
    /// <summary>Contexts are made and freed, whatever else the program's threads do.</summary>
    internal sealed class ContextSlotTest
    {
        private const int More = 200; // tasks than threads: the pool makes a few new ones per second only

        [Test]
        public void AFullThreadPoolKeepsNobodyWaiting()
        {
            SurfaceScheduler.ReleaseContexts();
            ThreadPool.GetMinThreads(out int threads, out _);
            using (var leave = new ManualResetEvent(false))
            {
                int blocked = 0, done = 0, count = threads + More;
                for (int k = 0; k < count; ++k)
                {
                    ThreadPool.QueueUserWorkItem(state =>
                    {
                        Interlocked.Increment(ref blocked);
                        leave.WaitOne();
                        Interlocked.Increment(ref done);
                    });
                }
                while (Volatile.Read(ref blocked) < threads) // so many begin at once
                    Thread.Sleep(1);
                TestHost host = null;
                int left;
                try
                {
                    host = TestHost.WithAtom(Vector3.One, 2);
                    host.Settle();
                    host.AssertShowsAtom(Vector3.One, 2);
                    host.Dispose();
                    SurfaceScheduler.ReleaseContexts();
                    Assert.That(ContextSlot.NativeContexts, Is.EqualTo(0));
                }
                finally
                {
                    left = Volatile.Read(ref blocked);
                    leave.Set();
                    host?.Dispose();
                }
                while (Volatile.Read(ref done) < count) // those that were left waiting still ask for the event
                    Thread.Sleep(1);
                Assert.That(left, Is.InRange(1, count - 1), "the pool was full, and tasks were left waiting");
            }
        }

        [Test]
        public void WhatIsBeingMadeCanBeFreedAtOnce()
        {
            for (int k = 0; k < 20; ++k)
            {
                var slot = new ContextSlot(new SurfaceContextOptions { Backend = SurfaceBackend.Cpu, Threads = 1 });
                slot.CreateInBackground();
                slot.DisposeInBackground();
                slot.WaitUntilDisposed();
                Assert.That(slot.IsReady && slot.IsDisposed);
                Assert.That(slot.HasFailed, Is.False);
            }
        }

        [Test]
        public void WhatCantBeMadeSaysWhyAndCanBeFreed()
        {
            var slot = new ContextSlot(new SurfaceContextOptions { Backend = (SurfaceBackend)77 });
            slot.CreateInBackground();
            slot.DisposeInBackground();
            slot.WaitUntilDisposed();
            Assert.That(slot.HasFailed);
            Assert.That(slot.Error.Message, Is.Not.Empty);
        }
    }
}
