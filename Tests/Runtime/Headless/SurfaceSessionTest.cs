// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Numerics;

namespace QuickSes.Tests
{
    /// <summary>What becomes of the surface of atoms that come, move and go.</summary>
    internal sealed class SurfaceSessionTest
    {
        private const int Many = 500; // atoms, which take some milliseconds

        private TestHost _host;

        [TearDown]
        public void TearDown() => _host?.Dispose();

        [Test]
        public void NothingIsToDoWithoutAtoms()
        {
            _host = new TestHost();
            Assert.That(_host.Session.IsUpToDate);
            for (int frame = 0; frame < 5; ++frame)
                _host.Tick();
            Assert.That(_host.Levels, Is.Empty);
            Assert.That(_host.Session.CurrentLevel.LevelCount, Is.EqualTo(0));
        }

        [Test]
        public void SurfacesGetFinerUntilTheFinestIsThere()
        {
            _host = TestHost.WithRow(Many);
            Assert.That(_host.Session.IsUpToDate, Is.False);
            _host.Settle();
            for (int k = 1; k < _host.Levels.Count; ++k)
                Assert.That(_host.Levels[k].Spacing, Is.LessThan(_host.Levels[k - 1].Spacing));
            SurfaceLevel level = _host.Session.CurrentLevel;
            Assert.That(level.IsFinest && level.IsOfNewestAtoms);
            Assert.That(level.Spacing, Is.EqualTo(0.5f));
            Assert.That(level.LevelCount, Is.EqualTo(3));
            Assert.That(_host.Finished, Is.EqualTo(1));
            Assert.That(_host.Session.Progress, Is.EqualTo(1));
            Assert.That(_host.Session.UsedBackend, Is.EqualTo(SurfaceBackend.Cpu));
            _host.SetPositions(TestHost.Row(Many, 1));
            _host.Tick();
            Assert.That(_host.Session.Progress, Is.EqualTo(0), "of the next job");
        }

        [Test]
        public void WhatIsShownFollowsTheAtoms()
        {
            _host = TestHost.WithAtom(Vector3.Zero, 1.5f);
            _host.Settle();
            _host.AssertShowsAtom(Vector3.Zero, 1.5f);
            var place = new Vector3(3, -20, 100);
            _host.SetPositions(place);
            Assert.That(_host.Session.IsUpToDate, Is.False);
            _host.Settle();
            _host.AssertShowsAtom(place, 1.5f);
            _host.SetAtoms(new[] { place }, new[] { 2f });
            _host.Settle();
            _host.AssertShowsAtom(place, 2);
            Assert.That(_host.Finished, Is.EqualTo(3));
        }

        [Test]
        public void WhatMovesIsRefinedWhenItRests()
        {
            _host = TestHost.WithRow(Many);
            _host.FrameBudget = 1e-3f; // for the coarsest only
            _host.RestDelay = 2;
            _host.Settle();
            _host.Levels.Clear();
            _host.SetPositions(TestHost.Row(Many, 1));
            TestHost.Until(() => _host.Levels.Count > 0 && SurfaceScheduler.LentCount == 0, _host);
            _host.Now = 1.9;
            for (int frame = 0; frame < 20; ++frame)
                TestHost.Until(() => true, _host);
            Assert.That(_host.Levels.Count, Is.EqualTo(1));
            Assert.That(_host.Session.CurrentLevel.Level, Is.EqualTo(0));
            Assert.That(_host.Session.IsUpToDate, Is.False);
            _host.Now = 2;
            _host.Settle();
            Assert.That(_host.Session.CurrentLevel.IsFinest);
        }

        [Test]
        public void ThePictureKeepsMovingHoweverFastFramesCome()
        {
            _host = TestHost.WithRow(Many);
            int frames = 0;
            // Each frame before anything can arrive: nothing is of the newest atoms, however slow frames are.
            TestHost.Until(() => _host.Levels.Count >= 20, () => _host.SetPositions(TestHost.Row(Many, ++frames % 7)),
                _host);
            Assert.That(_host.Levels.Exists(level => !level.IsOfNewestAtoms), "old ones are shown, too, and say so");
            Assert.That(_host.Finished, Is.EqualTo(0));
            _host.Settle();
            Assert.That(_host.Session.CurrentLevel.IsOfNewestAtoms && _host.Session.CurrentLevel.IsFinest);
        }

        [Test]
        public void WhatMovedWhileItWasComputedIsShownButNotFinished()
        {
            _host = TestHost.WithAtom(Vector3.Zero, 1.5f);
            ContextSlot slot = SurfaceScheduler.PoolOf(SurfaceBackend.Cpu).LendNow(_host.Session, null, out _);
            _host.Session.Start(slot);
            slot.Context.Wait();
            _host.SetPositions(Vector3.One);
            _host.Tick();
            Assert.That(_host.Session.CurrentLevel.IsFinest);
            Assert.That(_host.Session.CurrentLevel.IsOfNewestAtoms, Is.False);
            Assert.That(_host.Session.IsUpToDate, Is.False);
            Assert.That(_host.Finished, Is.EqualTo(0));
            _host.Settle();
            _host.AssertShowsAtom(Vector3.One, 1.5f);
        }

        [Test]
        public void AFrameThatIsRefusedKeepsTheOneBefore()
        {
            _host = TestHost.WithAtom(Vector3.Zero, 1.5f);
            ContextSlot slot = SurfaceScheduler.PoolOf(SurfaceBackend.Cpu).LendNow(_host.Session, null, out _);
            _host.Session.Start(slot);
            _host.SetPositions(new Vector3(float.NaN, 0, 0));
            _host.Session.Start(slot);
            _host.Settle();
            _host.AssertShowsAtom(Vector3.Zero, 1.5f);
            Assert.That(_host.Failures.Count, Is.EqualTo(1));
            Assert.That(_host.Session.LastError.Status, Is.EqualTo(QuickSesStatus.InvalidArgument));
        }

        [Test]
        public void NewColoursComputeNothing()
        {
            _host = TestHost.WithRow(Many);
            _host.Settle();
            uint jobs = SurfaceScheduler.LastJob;
            _host.Session.Atoms.SetBaseColor(0xff0000ff);
            _host.Session.Atoms.SetVisible(new bool[Many]);
            for (int frame = 0; frame < 5; ++frame)
                _host.Tick();
            Assert.That(SurfaceScheduler.LastJob, Is.EqualTo(jobs));
            Assert.That(_host.Session.Atoms.Look.ColorsVersion, Is.GreaterThan(0), "who shows it can tell");
        }

        [Test]
        public void WhatIsBeingUploadedIsNotReplaced()
        {
            _host = TestHost.WithRow(Many);
            _host.CoarserLevels = Array.Empty<float>();
            _host.StepsPerUpload = 40;
            double budget = SurfaceScheduler.UploadBudget;
            SurfaceScheduler.UploadBudget = 1e-6; // a step per frame
            int frames = 0;
            TestHost.Until(() =>
            {
                if (_host.Levels.Count < 3)
                    _host.SetPositions(TestHost.Row(Many, ++frames % 7));
                return _host.Levels.Count >= 4;
            }, _host);
            Assert.That(_host.Taken, Is.GreaterThanOrEqualTo(4));
            _host.Settle();
            Assert.That(_host.Session.CurrentLevel.IsOfNewestAtoms && _host.Session.CurrentLevel.IsFinest);
            SurfaceScheduler.UploadBudget = budget;
        }

        [Test]
        public void WhatArrivedBeforeItsUploadBeganIsReplaced()
        {
            _host = TestHost.WithRow(Many);
            ContextSlot slot = SurfaceScheduler.PoolOf(SurfaceBackend.Cpu).LendNow(_host.Session, null, out _);
            _host.Session.Start(slot);
            slot.Context.Wait();
            _host.Tick();
            Assert.That(_host.Levels.Count, Is.EqualTo(1), "the finest of three levels, which were ready at once");
            Assert.That(_host.Session.CurrentLevel.IsFinest);
        }

        [Test]
        public void SurfacesOfAtomsThatWereReplacedHaveTheLookOfTheirs()
        {
            _host = new TestHost(); // which asserts it
            int frames = 0;
            TestHost.Until(() =>
            {
                ++frames;
                int count = 100 + 37 * (frames % 11);
                _host.SetAtoms(TestHost.Row(count, frames % 3), TestHost.Radii(count));
                return _host.Levels.Count >= 30;
            }, _host);
            _host.Settle();
            Assert.That(_host.Session.CurrentLevel.IsOfNewestAtoms);
        }

        [Test]
        public void WhatMovesIsExpectedToGoOnSoAndRestsInTheEnd()
        {
            _host = TestHost.WithAtom(Vector3.Zero, 1.5f);
            _host.RestDelay = 1;
            _host.Settle();
            Assert.That(_host.IsMoving, Is.False);
            Assert.That(_host.Rests, Is.EqualTo(0));
            _host.SetPositions(Vector3.One);
            _host.Now = 5; // it took longer than that to compute it
            _host.Settle();
            Assert.That(_host.IsMoving);
            Assert.That(_host.Session.IsWaiting, "somebody has to tell it that it rests");
            _host.Tick();
            Assert.That(_host.Rests, Is.EqualTo(0));
            _host.Now = 6;
            _host.Tick();
            _host.Tick();
            Assert.That(_host.Rests, Is.EqualTo(1));
            Assert.That(_host.Session.IsWaiting, Is.False);
            _host.SetPositions(Vector3.Zero);
            _host.Settle();
            Assert.That(_host.Session.IsWaiting);
            _host.Session.Clear();
            Assert.That(_host.Session.IsWaiting, Is.False, "nothing is left that could rest");
        }

        [Test]
        public void CancelledIsCancelledUntilSomethingChanges()
        {
            _host = TestHost.WithRow(20 * Many);
            TestHost.Until(() => _host.Levels.Count > 0, _host);
            _host.Session.Stop();
            Assert.That(_host.Session.IsUpToDate);
            Assert.That(SurfaceScheduler.LentCount, Is.EqualTo(0));
            int levels = _host.Levels.Count;
            for (int frame = 0; frame < 30; ++frame)
                TestHost.Until(() => true, _host);
            Assert.That(_host.Levels.Count, Is.EqualTo(levels));
            _host.Session.Change(SurfaceChange.Shape, 0);
            _host.Settle();
            Assert.That(_host.Session.CurrentLevel.IsFinest);
        }

        [Test]
        public void AMoleculeThatWasNeverShownHasAllItsLevels()
        {
            _host = TestHost.WithAtom(Vector3.Zero, 1.5f);
            _host.Settle();
            _host.SetAtoms(TestHost.Row(Many, 0), TestHost.Radii(Many));
            _host.Session.Stop();
            _host.Session.Change(SurfaceChange.None, 0);
            ContextSlot slot = SurfaceScheduler.PoolOf(SurfaceBackend.Cpu).LendNow(_host.Session, null, out _);
            _host.Session.Start(slot);
            slot.Context.Poll(out SurfaceProgress progress);
            Assert.That(progress.LevelCount, Is.EqualTo(3), "not those finer than what is shown, of other atoms");
            _host.Settle();
            Assert.That(_host.Session.CurrentLevel.IsFinest);
        }

        [Test]
        public void WhatWasDroppedGoesOnLater()
        {
            _host = TestHost.WithRow(Many);
            _host.Tick();
            _host.Session.Drop();
            Assert.That(SurfaceScheduler.LentCount, Is.EqualTo(0));
            Assert.That(SurfaceScheduler.WaitingCount, Is.EqualTo(0));
            _host.Session.Resume();
            _host.Settle();
            Assert.That(_host.Session.CurrentLevel.IsFinest);
        }

        [Test]
        public void WhatIsDoneOrCancelledDoesNotGoOn()
        {
            _host = TestHost.WithRow(Many);
            _host.Settle();
            uint jobs = SurfaceScheduler.LastJob;
            _host.Session.Drop();
            _host.Session.Resume();
            _host.Tick();
            Assert.That(_host.Session.IsUpToDate, "it is done");
            Assert.That(SurfaceScheduler.LastJob, Is.EqualTo(jobs));
            _host.SetPositions(TestHost.Row(Many, 1));
            _host.Session.Stop();
            _host.Session.Drop();
            _host.Session.Resume();
            _host.Tick();
            Assert.That(_host.Session.IsUpToDate, "it was cancelled");
            Assert.That(SurfaceScheduler.LastJob, Is.EqualTo(jobs));
        }

        [Test]
        public void NothingIsLeftOfWhatWasCleared()
        {
            _host = TestHost.WithRow(Many);
            TestHost.Until(() => _host.Levels.Count > 0, _host);
            _host.Session.Clear();
            Assert.That(_host.Session.IsUpToDate);
            Assert.That(_host.Session.CurrentLevel.LevelCount, Is.EqualTo(0));
            int levels = _host.Levels.Count, finished = _host.Finished;
            for (int frame = 0; frame < 10; ++frame)
                TestHost.Until(() => true, _host);
            Assert.That(_host.Levels.Count, Is.EqualTo(levels));
            Assert.That(_host.Finished, Is.EqualTo(finished));
        }

        [Test]
        public void NothingIsToldOfWhatWasCleared()
        {
            _host = TestHost.WithAtom(Vector3.Zero, 1.5f);
            Assert.That(_host.Session.ComputeNow());
            _host.Session.Clear();
            _host.Session.RaiseEvents();
            Assert.That(_host.Levels, Is.Empty);
            _host.SetAtoms(new[] { new Vector3(float.NaN) }, new[] { 1.5f });
            Assert.That(_host.Session.ComputeNow(), Is.False);
            Assert.That(_host.Session.LastError.Status, Is.EqualTo(QuickSesStatus.InvalidArgument));
            _host.Session.Clear();
            Assert.That(_host.Session.LastError.Status, Is.EqualTo(QuickSesStatus.Ok));
            _host.Session.RaiseEvents();
            Assert.That(_host.Failures, Is.Empty);
        }

        [Test]
        public void AnAtomThatCoarseLatticesMissIsShownInTheEnd()
        {
            _host = TestHost.WithAtom(Vector3.One, 1.5f); // in the middle of eight points that are 2 Å apart
            _host.CoarserLevels = Array.Empty<float>();
            _host.Spacing = 2;
            _host.Settle();
            Assert.That(_host.Session.CurrentLevel.VertexCount, Is.EqualTo(0));
            Assert.That(_host.Failures, Is.Empty);
            _host.Spacing = 0.5f;
            _host.CoarserLevels = new[] { 2f, 1f };
            _host.Session.Change(SurfaceChange.Shape, _host.Now);
            _host.Settle();
            _host.AssertShowsAtom(Vector3.One, 1.5f);
        }

        [Test]
        public void AWrongAtomIsToldOnceAndForgottenWithTheNextFrame()
        {
            _host = TestHost.WithAtom(Vector3.Zero, 1.5f);
            _host.Settle();
            _host.SetPositions(new Vector3(float.NaN, 0, 0));
            _host.Settle();
            for (int frame = 0; frame < 5; ++frame)
                _host.Tick();
            Assert.That(_host.Failures.Count, Is.EqualTo(1));
            Assert.That(_host.Failures[0].Status, Is.EqualTo(QuickSesStatus.InvalidArgument));
            Assert.That(_host.Session.LastError.Message, Is.EqualTo(_host.Failures[0].Message));
            _host.AssertShowsAtom(Vector3.Zero, 1.5f);
            _host.SetPositions(Vector3.One);
            _host.Settle();
            _host.AssertShowsAtom(Vector3.One, 1.5f);
            Assert.That(_host.Session.LastError.Status, Is.EqualTo(QuickSesStatus.Ok));
        }

        [Test]
        public void AMeshThatIsRefusedIsAFailure()
        {
            _host = TestHost.WithAtom(Vector3.Zero, 1.5f);
            _host.Refusal = new InvalidOperationException("no room for it");
            _host.Settle();
            Assert.That(_host.Failures.Count, Is.EqualTo(1));
            Assert.That(_host.Failures[0].Status, Is.EqualTo(QuickSesStatus.InternalError));
            Assert.That(_host.Failures[0].Message, Does.Contain("no room for it"));
            Assert.That(_host.Levels, Is.Empty);
            Assert.That(SurfaceScheduler.LentCount, Is.EqualTo(0));
        }

        [Test]
        public void AMeshThatCantBeTakenIsAFailureAndEndsItsJob()
        {
            _host = TestHost.WithRow(20 * Many);
            _host.TakeRefusal = new InvalidOperationException("no memory for it");
            ContextSlot slot = SurfaceScheduler.PoolOf(SurfaceBackend.Cpu).LendNow(_host.Session, null, out _);
            _host.Session.Start(slot);
            TestHost.Until(() => _host.Failures.Count > 0, _host);
            slot.Context.Wait();
            slot.Context.Poll(out SurfaceProgress progress);
            Assert.That(progress.State, Is.EqualTo(SurfaceJobState.Cancelled), "nobody wants its finer levels");
            Assert.That(SurfaceScheduler.LentCount, Is.EqualTo(0));
            Assert.That(_host.Session.IsUpToDate, "it is not tried again and again");
            Assert.That(_host.Failures.Count, Is.EqualTo(1));
            Assert.That(_host.Failures[0].Message, Does.Contain("no memory for it"));
            _host.TakeRefusal = null;
            _host.SetPositions(TestHost.Row(20 * Many, 1));
            _host.Settle();
            Assert.That(_host.Session.CurrentLevel.IsFinest);
        }

        [Test]
        public void ThatThereIsNothingToComputeWithIsToldOnce()
        {
            if (SurfaceContext.IsSupported(SurfaceBackend.Cuda, out string reason))
                Assert.Ignore("there is a GPU here");
            _host = TestHost.WithAtom(Vector3.Zero, 1.5f);
            _host.Backend = SurfaceBackend.Cuda;
            for (int frame = 0; frame < 20; ++frame)
            {
                _host.SetPositions(new Vector3(frame, 0, 0));
                _host.Settle();
            }
            Assert.That(_host.Failures.Count, Is.EqualTo(1));
            Assert.That(_host.Failures[0].Status, Is.EqualTo(QuickSesStatus.BackendUnavailable));
            Assert.That(_host.Failures[0].Message, Does.Contain(reason));
            _host.Backend = SurfaceBackend.Cpu;
            _host.Session.Change(SurfaceChange.Shape, 0);
            _host.Settle();
            Assert.That(_host.Session.CurrentLevel.IsFinest);
            Assert.That(_host.Session.LastError.Status, Is.EqualTo(QuickSesStatus.Ok));
        }

        [Test]
        public void WhatIsComputedNowIsTheFinestAtOnce()
        {
            _host = TestHost.WithRow(Many);
            Assert.That(_host.Session.ComputeNow(), Is.True);
            Assert.That(_host.Session.CurrentLevel.IsFinest);
            Assert.That(_host.Session.IsUpToDate);
            _host.Session.RaiseEvents();
            Assert.That(_host.Levels.Count, Is.EqualTo(1));
            Assert.That(_host.Finished, Is.EqualTo(1));
            Assert.That(SurfaceScheduler.LentCount, Is.EqualTo(0));
        }

        [Test]
        public void WhatCantBeComputedNowLeavesAReasonUntilItCan()
        {
            _host = TestHost.WithAtom(Vector3.Zero, 1.5f);
            _host.Spacing = -1;
            Assert.That(_host.Session.ComputeNow(), Is.False);
            Assert.That(_host.Session.LastError.Status, Is.EqualTo(QuickSesStatus.InvalidArgument));
            Assert.That(SurfaceScheduler.LentCount, Is.EqualTo(0));
            _host.Spacing = 1;
            Assert.That(_host.Session.ComputeNow(), Is.True);
            Assert.That(_host.Session.LastError.Status, Is.EqualTo(QuickSesStatus.Ok));
            _host.Refusal = new InvalidOperationException("no room for it");
            Assert.That(_host.Session.ComputeNow(), Is.False);
            Assert.That(_host.Session.LastError.Message, Does.Contain("no room for it"));
        }

        [Test]
        public void WhatAHandlerThrowsKeepsNoOtherEventBack()
        {
            _host = TestHost.WithAtom(Vector3.Zero, 1.5f);
            Assert.That(_host.Session.ComputeNow());
            _host.Updated = level => throw new InvalidOperationException("a handler's own fault");
            Assert.Throws<InvalidOperationException>(() => _host.Session.RaiseEvents());
            Assert.That(_host.Finished, Is.EqualTo(0));
            _host.Session.RaiseEvents();
            Assert.That(_host.Levels.Count, Is.EqualTo(1));
            Assert.That(_host.Finished, Is.EqualTo(1));
        }

        [Test]
        public void HandlersMayFeedTheNextFrame()
        {
            _host = TestHost.WithAtom(Vector3.Zero, 1.5f);
            int frame = 0;
            bool wasFinishedTooSoon = false;
            _host.Updated = level =>
            {
                wasFinishedTooSoon |= _host.Finished > 0;
                if (level.IsFinest && frame < 10)
                    _host.SetPositions(new Vector3(++frame, 0, 0));
            };
            TestHost.Until(() => frame >= 10 && _host.Session.IsUpToDate, _host);
            Assert.That(wasFinishedTooSoon, Is.False);
            Assert.That(_host.Finished, Is.EqualTo(1));
            _host.AssertShowsAtom(new Vector3(10, 0, 0), 1.5f);
        }

        [Test]
        public void HandlersMayEndTheSession()
        {
            _host = TestHost.WithAtom(Vector3.Zero, 1.5f);
            _host.Updated = level => _host.Session.Dispose();
            TestHost.Until(() => _host.Session.IsDisposed, _host);
            Assert.That(_host.Levels.Count, Is.EqualTo(1));
            Assert.That(_host.Finished, Is.EqualTo(0));
            Assert.That(_host.Disposed, Is.EqualTo(1));
        }
    }
}
