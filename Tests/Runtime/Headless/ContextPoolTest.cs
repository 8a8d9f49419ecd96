// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Numerics;

namespace QuickSes.Tests
{
    /// <summary>Many surfaces, few contexts.</summary>
    internal sealed class ContextPoolTest
    {
        private int _maxContexts;
        private TestHost[] _hosts;

        [SetUp]
        public void SetUp()
        {
            _maxContexts = SurfaceScheduler.MaxContexts;
            _hosts = Array.Empty<TestHost>();
        }

        [TearDown]
        public void TearDown()
        {
            foreach (TestHost host in _hosts)
                host.Dispose();
            SurfaceScheduler.MaxContexts = _maxContexts;
        }

        [TestCase(1)]
        [TestCase(3)]
        public void EverybodyShowsTheirOwnAtoms(int contexts)
        {
            SurfaceScheduler.ReleaseContexts();
            SurfaceScheduler.MaxContexts = contexts;
            _hosts = Hosts(60, k => TestHost.WithAtom(Place(k, 0), Radius(k)));
            int most = 0;
            for (int round = 0; round < 3; ++round)
            {
                for (int k = 0; k < _hosts.Length; ++k)
                    _hosts[k].SetPositions(Place(k, round));
                TestHost.Until(() =>
                {
                    most = Math.Max(most, SurfaceScheduler.ContextCount);
                    return AreUpToDate();
                }, _hosts);
                for (int k = 0; k < _hosts.Length; ++k)
                    _hosts[k].AssertShowsAtom(Place(k, round), Radius(k));
            }
            Assert.That(most, Is.InRange(1, contexts));
        }

        [Test]
        public void EverybodySeesSomethingBeforeAnybodySeesTheFinest()
        {
            _hosts = Hosts(40, k => TestHost.WithRow(200 + k));
            ContextPool pool = SurfaceScheduler.PoolOf(SurfaceBackend.Cpu);
            int waited = 0, finest = 0;
            TestHost.Until(() =>
            {
                if (pool.IsAnyUrgent)
                {
                    ++waited;
                    finest = Array.FindAll(_hosts, host => host.Session.CurrentLevel.IsFinest).Length;
                }
                return Array.TrueForAll(_hosts, host => host.Levels.Count > 0);
            }, _hosts);
            Assert.That(waited, Is.GreaterThan(0));
            Assert.That(finest, Is.LessThan(_hosts.Length / 2), "rested ones have their turn now and then");
            TestHost.Until(AreUpToDate, _hosts);
        }

        [Test]
        public void WhoeverHadAContextGetsItAgain()
        {
            SurfaceScheduler.ReleaseContexts();
            SurfaceScheduler.MaxContexts = 2;
            _hosts = Hosts(2, k => TestHost.WithAtom(Place(k, 0), Radius(k)));
            ContextPool pool = SurfaceScheduler.PoolOf(SurfaceBackend.Cpu);
            foreach (ContextSlot slot in Array.ConvertAll(_hosts, host => pool.LendNow(host.Session, null, out _)))
                pool.Release(slot, false);
            foreach (TestHost host in _hosts)
                host.Session.ComputeNow(); // now each has one
            Array.Reverse(_hosts); // else that which is unused for longest would be the right one
            foreach (TestHost host in _hosts)
            {
                ContextSlot slot = pool.LendNow(host.Session, null, out _);
                Assert.That(slot.SentBy, Is.SameAs(host.Session.Atoms));
                pool.Release(slot, false);
            }
        }

        [Test]
        public void EachHasAContextOfItsOwnAsLongAsThereMayBeMore()
        {
            SurfaceScheduler.ReleaseContexts();
            SurfaceScheduler.MaxContexts = 2;
            _hosts = Hosts(3, k => TestHost.WithAtom(Place(k, 0), 1.5f));
            for (int k = 0; k < _hosts.Length; ++k) // one after the other: each could have that of the one before
            {
                _hosts[k].Settle();
                Assert.That(SurfaceScheduler.ContextCount, Is.EqualTo(Math.Min(k + 1, 2)));
            }
        }

        [Test]
        public void WhoWaitsForOneBackEndMayTakeAnother()
        {
            SurfaceScheduler.ReleaseContexts();
            SurfaceScheduler.MaxContexts = 1;
            _hosts = Hosts(2, k => TestHost.WithAtom(Place(k, 0), 1.5f));
            TestHost.Until(() => SurfaceScheduler.LentCount == 1, _hosts[0]); // which it keeps until its next frame
            _hosts[1].Tick();
            Assert.That(SurfaceScheduler.WaitingCount, Is.EqualTo(1));
            _hosts[1].Backend = SurfaceBackend.Auto;
            _hosts[1].Settle();
            _hosts[1].AssertShowsAtom(Place(1, 0), 1.5f);
        }

        [Test]
        public void NobodyShowsWhatTheLastUserLeftBehind()
        {
            SurfaceScheduler.ReleaseContexts();
            SurfaceScheduler.MaxContexts = 1;
            _hosts = Hosts(2, k => TestHost.WithAtom(Place(k, 0), Radius(k)));
            ContextPool pool = SurfaceScheduler.PoolOf(SurfaceBackend.Cpu);
            ContextSlot slot = pool.LendNow(_hosts[0].Session, null, out _);
            _hosts[0].Session.Start(slot);
            slot.Context.Wait();
            _hosts[0].Session.Drop(); // nobody has collected what is ready
            Assert.That(pool.LendNow(_hosts[1].Session, null, out _), Is.SameAs(slot));
            // Of whichever level: the other atom is 10 Å away.
            _hosts[1].Updated = level => _hosts[1].AssertShowsAtom(Place(1, 0), Radius(1), level.Spacing);
            _hosts[1].Session.Start(slot);
            _hosts[1].Settle();
            Assert.That(_hosts[1].Levels, Is.Not.Empty);
            _hosts[1].AssertShowsAtom(Place(1, 0), Radius(1));
        }

        [Test]
        public void WhoCantWaitGetsOneMore()
        {
            SurfaceScheduler.ReleaseContexts();
            SurfaceScheduler.MaxContexts = 1;
            _hosts = Hosts(2, k => TestHost.WithRow(20000));
            TestHost.Until(() => SurfaceScheduler.LentCount == 1, _hosts);
            Assert.That(_hosts[1].Session.ComputeNow(), Is.True);
            Assert.That(SurfaceScheduler.ContextCount, Is.InRange(1, 2));
            Assert.That(_hosts[1].Session.CurrentLevel.IsFinest);
            TestHost.Until(AreUpToDate, _hosts);
            Assert.That(SurfaceScheduler.ContextCount, Is.EqualTo(1), "the one that was too many is gone");
            SurfaceScheduler.ReleaseContexts();
            Assert.That(ContextSlot.NativeContexts, Is.EqualTo(0));
        }

        [Test]
        public void OneThatCouldNotBeMadeTakesNobodysPlace()
        {
            SurfaceScheduler.ReleaseContexts();
            SurfaceScheduler.MaxContexts = 1;
            _hosts = Hosts(1, k => TestHost.WithAtom(Place(k, 0), 1.5f));
            uint threads = SurfaceScheduler.Threads;
            try
            {
                SurfaceScheduler.Threads = 100000; // more than a context may have
                TestHost.Until(() => _hosts[0].Failures.Count > 0, _hosts);
            }
            finally
            {
                SurfaceScheduler.Threads = threads;
            }
            Assert.That(SurfaceScheduler.ContextCount, Is.EqualTo(0));
            ContextPool pool = SurfaceScheduler.PoolOf(SurfaceBackend.Cpu);
            ContextSlot slot = pool.LendNow(_hosts[0].Session, null, out _);
            pool.Release(slot, false);
            Assert.That(SurfaceScheduler.ContextCount, Is.EqualTo(1));
            Assert.That(pool.LendNow(_hosts[0].Session, null, out _), Is.SameAs(slot));
            pool.Release(slot, false);
        }

        [Test]
        public void ManySurfacesAreNotManySquared()
        {
            const int count = 2000;
            int asked = 0;
            _hosts = Hosts(count, k => new TestHost { AskedWhetherGone = () => ++asked });
            Assert.That(asked, Is.LessThan(4 * count));
            for (int k = 0; k < count; k += 2) // in no order
                _hosts[k].Dispose();
            foreach (TestHost host in _hosts)
                host.IsGone = true;
            SurfaceScheduler.ReleaseContexts();
            foreach (TestHost host in _hosts)
                Assert.That((host.Session.IsDisposed, host.Disposed), Is.EqualTo((true, 1)));
        }

        [Test]
        public void WhoIsGoneIsFoundByThoseWhoCome()
        {
            _hosts = Hosts(100, k => new TestHost());
            foreach (TestHost host in _hosts)
                host.IsGone = true;
            TestHost[] later = Hosts(1000, k => new TestHost());
            foreach (TestHost host in _hosts)
                Assert.That(host.Session.IsDisposed);
            foreach (TestHost host in later)
            {
                Assert.That(host.Session.IsDisposed, Is.False);
                host.Dispose();
            }
        }

        [Test]
        public void WhoHasSomethingToShowMakesRoomForThoseWhoHaveNothing()
        {
            SurfaceScheduler.ReleaseContexts();
            SurfaceScheduler.MaxContexts = 1;
            _hosts = Hosts(2, k => TestHost.WithRow(20000));
            _hosts[0].Spacing = 0.1f; // takes seconds, so that a coarser level comes first
            ContextSlot slot = SurfaceScheduler.PoolOf(SurfaceBackend.Cpu).LendNow(_hosts[0].Session, null, out _);
            _hosts[0].Session.Start(slot); // of all levels, since nobody waits yet
            _hosts[1].Tick();
            TestHost.Until(() => _hosts[0].Levels.Count > 0, _hosts[0]);
            Assert.That(_hosts[0].Session.CurrentLevel.IsFinest, Is.False);
            Assert.That(slot.User, Is.SameAs(_hosts[1].Session));
            _hosts[0].Spacing = 0.5f;
            _hosts[0].Session.Change(SurfaceChange.Shape, 0);
            TestHost.Until(AreUpToDate, _hosts);
        }

        [Test]
        public void AJobThatLosesItsContextBeginsAgain()
        {
            _hosts = Hosts(1, k => TestHost.WithAtom(Place(k, 0), Radius(k)));
            _hosts[0].RestDelay = 1000; // it does not wait for that
            ContextSlot slot = SurfaceScheduler.PoolOf(SurfaceBackend.Cpu).LendNow(_hosts[0].Session, null, out _);
            _hosts[0].Session.Start(slot);
            SurfaceScheduler.ReleaseContexts();
            Assert.That(SurfaceScheduler.ContextCount, Is.EqualTo(0));
            TestHost.Until(AreUpToDate, _hosts);
            _hosts[0].AssertShowsAtom(Place(0, 0), Radius(0));
            Assert.That(_hosts[0].Failures, Is.Empty);
        }

        [Test]
        public void ContextsAreFreedWithTheLastSurface()
        {
            _hosts = Hosts(2, k => TestHost.WithRow(20000));
            TestHost.Until(() => _hosts[0].Levels.Count > 0, _hosts);
            _hosts[1].Dispose();
            Assert.That(SurfaceScheduler.ContextCount, Is.GreaterThan(0));
            _hosts[0].Dispose(); // in the background
            Assert.That(SurfaceScheduler.ContextCount, Is.EqualTo(0));
            SurfaceScheduler.ReleaseContexts();
            Assert.That(ContextSlot.NativeContexts, Is.EqualTo(0), "native threads must not outlive the domain");
        }

        [Test]
        public void ContextsOfTheDeadAreUsedAgain()
        {
            SurfaceScheduler.ReleaseContexts();
            _hosts = Hosts(1, k => new TestHost()); // has no atoms
            for (int k = 0; k < 6; ++k)
                using (TestHost host = TestHost.WithAtom(Place(k, 0), Radius(k)))
                    host.Settle();
            Assert.That(SurfaceScheduler.ContextCount, Is.EqualTo(1));
        }

        [Test]
        public void WhoIsGoneWithoutAWordLeavesNothing()
        {
            TestHost gone = TestHost.WithAtom(Place(0, 0), Radius(0));
            Assert.That(gone.Session.ComputeNow());
            gone.IsGone = true;
            SurfaceScheduler.ReleaseContexts();
            Assert.That(gone.Session.IsDisposed);
            Assert.That(gone.Disposed, Is.EqualTo(1));
            Assert.That(ContextSlot.NativeContexts, Is.EqualTo(0));
        }

        [Test]
        public void WhenTheDomainUnloadsNothingIsLeft()
        {
            _hosts = Hosts(3, k => TestHost.WithRow(2000));
            TestHost.Until(() => SurfaceScheduler.LentCount > 0, _hosts);
            SurfaceScheduler.DisposeAll();
            foreach (TestHost host in _hosts)
                Assert.That(host.Session.IsDisposed);
            Assert.That(ContextSlot.NativeContexts, Is.EqualTo(0));
        }

        [Test]
        public void AtLeastOneContextIsNeeded() =>
            Assert.Throws<ArgumentOutOfRangeException>(() => SurfaceScheduler.MaxContexts = 0);

        private static TestHost[] Hosts(int count, Func<int, TestHost> make)
        {
            var hosts = new TestHost[count];
            for (int k = 0; k < count; ++k)
                hosts[k] = make(k);
            return hosts;
        }

        private static Vector3 Place(int k, int round) => new Vector3(10 * k, 7 * round, -k);

        private static float Radius(int k) => 1 + k % 4;

        private bool AreUpToDate()
        {
            foreach (TestHost host in _hosts)
                if (!host.Session.IsUpToDate)
                    return false;
            return true;
        }
    }
}
