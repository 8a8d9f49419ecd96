// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;

namespace QuickSes.Tests
{
    /// <summary>When the surface of atoms that come, move and rest has creases.</summary>
    internal sealed class SessionCreasesTest
    {
        private const int Many = 500; // atoms, which take some milliseconds

        private TestHost _host;

        [TearDown]
        public void TearDown() => _host?.Dispose();

        [Test]
        public void CreasesComeWhenAtomsRest([Values(0, 1e3f)] float frameBudget)
        {
            _host = TestHost.WithRow(Many);
            _host.SharpCreases = true;
            _host.FrameBudget = frameBudget;
            _host.RestDelay = 2;
            _host.Settle();
            Assert.That(_host.Session.CurrentLevel.HasCreases, "these atoms have not moved");
            Assert.That(_host.Levels.FindAll(level => level.HasCreases).Count, Is.EqualTo(1), "the finest level only");
            _host.SetPositions(TestHost.Row(Many, 1));
            TestHost.Until(() => _host.Session.CurrentLevel.IsOfNewestAtoms && SurfaceScheduler.LentCount == 0, _host);
            Assert.That(_host.Session.CurrentLevel.HasCreases, Is.False);
            Assert.That(_host.Session.IsUpToDate, Is.False, "they are still to come");
            Assert.That(_host.Finished, Is.EqualTo(1));
            _host.Now = 2;
            _host.Settle();
            Assert.That(_host.Session.CurrentLevel.HasCreases);
            Assert.That(_host.IsMoving, Is.False, "its buffers need no room");
            Assert.That(_host.Finished, Is.EqualTo(2));
        }

        [Test]
        public void WhatNeverRestsIsFinishedWithoutCreases()
        {
            _host = TestHost.WithRow(Many);
            _host.SharpCreases = true;
            _host.RestDelay = float.PositiveInfinity;
            _host.Settle();
            _host.SetPositions(TestHost.Row(Many, 1));
            _host.Settle();
            Assert.That(_host.Session.CurrentLevel.IsFinest && !_host.Session.CurrentLevel.HasCreases);
            Assert.That(_host.Finished, Is.EqualTo(2));
            _host.SetPositions(TestHost.Row(Many, 2));
            Assert.That(_host.Session.ComputeNow());
            Assert.That(_host.Session.CurrentLevel.HasCreases, "who asks for it now has all of it");
        }

        [Test]
        public void SurfacesSayWhetherTheyHaveCreases()
        {
            _host = TestHost.WithRow(Many);
            _host.SharpCreases = true;
            _host.CoarserLevels = Array.Empty<float>();
            _host.RestDelay = 1;
            ContextSlot slot = SurfaceScheduler.PoolOf(SurfaceBackend.Cpu).LendNow(_host.Session, null, out _);
            _host.Session.Start(slot);
            slot.Context.Wait();
            _host.SetPositions(TestHost.Row(Many, 1));
            _host.Session.Start(slot); // what is ready is shown all the same
            TestHost.Until(() => _host.Session.CurrentLevel.IsOfNewestAtoms, _host);
            foreach (SurfaceLevel level in _host.Levels)
                Assert.That(level.HasCreases, Is.EqualTo(!level.IsOfNewestAtoms));
        }
    }
}
