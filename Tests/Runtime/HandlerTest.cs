// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections;
using System.Collections.Generic;
using System.Text.RegularExpressions;
using UnityEngine;
using UnityEngine.TestTools;
using Object = UnityEngine.Object;

namespace QuickSes.Tests
{
    /// <summary>Handlers of events may do anything.</summary>
    internal sealed class HandlerTest
    {
        private SurfaceRig _rig;

        [TearDown]
        public void TearDown() => _rig?.Dispose();

        [UnityTest]
        public IEnumerator WhatAHandlerThrowsKeepsNoOtherEventBack()
        {
            _rig = SurfaceRig.WithBlob(40, 1);
            _rig.Surface.SurfaceUpdated += level =>
            {
                if (level.IsFinest)
                    throw new InvalidOperationException("a handler's own fault");
            };
            LogAssert.Expect(LogType.Exception, new Regex("own fault"));
            yield return _rig.Settle();
            yield return SurfaceRig.Frames(3);
            Assert.That(_rig.Finished, Is.EqualTo(1));
        }

        [Test]
        public void WhatOneListenerThrowsIsLoggedAndTheOthersAreTold()
        {
            TestMolecules.Blob(40, 1, out Vector3[] positions, out float[] radii);
            _rig = new SurfaceRig();
            MolecularSurface surface = _rig.Surface;
            var told = new List<string>();
            Action<SurfaceLevel> removed = level => told.Add("removed");
            surface.SurfaceUpdated += removed;
            surface.SurfaceUpdated += level => throw new InvalidOperationException("first fault");
            surface.SurfaceUpdated += level => told.Add("updated");
            surface.SurfaceUpdated -= removed;
            surface.Events.SurfaceUpdated.AddListener(() => told.Add("updated, wired"));
            surface.RefinementFinished += () => throw new InvalidOperationException("second fault");
            surface.RefinementFinished += () => told.Add("finished");
            surface.Events.RefinementFinished.AddListener(() => told.Add("finished, wired"));
            surface.Failed += error => throw new InvalidOperationException("third fault");
            surface.Failed += error => told.Add("failed");
            surface.Events.Failed.AddListener(message => told.Add("failed, wired"));
            LogAssert.Expect(LogType.Exception, new Regex("first fault"));
            LogAssert.Expect(LogType.Exception, new Regex("second fault"));
            surface.SetAtoms(positions, radii);
            Assert.That(surface.ComputeNow());
            Assert.That(told, Is.EqualTo(new[] { "updated", "updated, wired", "finished", "finished, wired" }));
            told.Clear();
            LogAssert.Expect(LogType.Exception, new Regex("third fault"));
            positions[0].x = float.NaN;
            surface.SetPositions(positions);
            Assert.That(surface.ComputeNow(), Is.False);
            Assert.That(told, Is.EqualTo(new[] { "failed", "failed, wired" }));
        }

        [Test]
        public void WhatAListenerOfAPlayerThrowsIsLoggedAsWell()
        {
            using (var playing = new PlayerFixture())
            {
                var told = new List<string>();
                playing.Player.Loaded += () => throw new InvalidOperationException("first fault");
                playing.Player.Loaded += () => told.Add("loaded");
                playing.Player.Events.Loaded.AddListener(() => told.Add("loaded, wired"));
                playing.Player.FrameShown += frame => throw new InvalidOperationException("second fault");
                playing.Player.FrameShown += frame => told.Add("frame " + frame);
                playing.Player.Events.FrameShown.AddListener(frame => told.Add($"frame {frame}, wired"));
                LogAssert.Expect(LogType.Exception, new Regex("first fault"));
                LogAssert.Expect(LogType.Exception, new Regex("second fault"));
                playing.UseEnsemble(3);
                playing.Load();
                Assert.That(told, Is.EqualTo(new[] { "loaded", "loaded, wired", "frame 0", "frame 0, wired" }));
            }
        }

        // Of one event, those after it are not told: the engine calls them.
        [Test]
        public void WhatAWiredListenerThrowsReachesNoCaller()
        {
            int laterInOne = 0, ofOthers = 0;
            _rig = new SurfaceRig();
            MolecularSurface surface = _rig.Surface;
            SurfaceEvents events = surface.Events;
            events.Loaded.AddListener(() => throw new InvalidOperationException("first fault"));
            events.Loaded.AddListener(() => ++laterInOne);
            events.SurfaceUpdated.AddListener(() => throw new InvalidOperationException("second fault"));
            events.RefinementFinished.AddListener(() => ++ofOthers);
            events.RefinementFinished.AddListener(() => throw new InvalidOperationException("third fault"));
            events.Failed.AddListener(message => throw new InvalidOperationException("fourth fault"));
            foreach (string which in new[] { "first", "second", "third", "fourth" })
                LogAssert.Expect(LogType.Exception, new Regex(which + " fault"));
            surface.Source.SetAsset(new TextAsset(TestFrames.Pdb(1)) { name = "small.pdb" });
            Assert.That(surface.LoadSource());
            Assert.That(surface.ComputeNow());
            surface.Source.SetFile("/no/such/file.pdb");
            Assert.That(surface.LoadSource(), Is.False);
            Assert.That((laterInOne, ofOthers), Is.EqualTo((0, 1)));
        }

        [Test]
        public void NorThatOfAPlayer()
        {
            using (var playing = new PlayerFixture())
            {
                playing.Player.Events.Failed.AddListener(message => throw new InvalidOperationException("its own fault"));
                LogAssert.Expect(LogType.Exception, new Regex("its own fault"));
                playing.Player.StructureSource.SetFile("/no/such/file.pdb");
                Assert.That(playing.Player.Load(), Is.False);
            }
        }

        [UnityTest]
        public IEnumerator NothingIsFinishedThatWasClearedOrDestroyed()
        {
            _rig = SurfaceRig.WithBlob(40, 3);
            _rig.Surface.SurfaceUpdated += level =>
            {
                if (level.IsFinest)
                    _rig.Surface.ClearAtoms();
            };
            yield return SurfaceRig.Until(() => _rig.Surface.AtomCount == 0);
            yield return SurfaceRig.Frames(3);
            Assert.That(_rig.Finished, Is.EqualTo(0));
            _rig.Dispose();

            _rig = SurfaceRig.WithBlob(40, 3);
            GameObject doomed = _rig.GameObject;
            _rig.Surface.SurfaceUpdated += level =>
            {
                if (level.IsFinest)
                    Object.DestroyImmediate(doomed);
            };
            yield return SurfaceRig.Until(() => doomed == null);
            Assert.That(_rig.Finished, Is.EqualTo(0));
        }

        [UnityTest]
        public IEnumerator AHandlerMayDisableWhatItFeeds()
        {
            using (SurfaceRig other = SurfaceRig.WithBlob(30, 4))
            {
                yield return other.Settle();
                TestMolecules.Blob(40, 5, out Vector3[] positions, out float[] radii);
                _rig = new SurfaceRig();
                _rig.Surface.AtomsRequested += () =>
                {
                    _rig.Surface.SetAtoms(positions, radii);
                    _rig.Surface.enabled = false;
                };
                yield return SurfaceRig.Until(() => !_rig.Surface.enabled);
                yield return SurfaceRig.Frames(3);
                Assert.That(_rig.Surface.IsBusy, Is.False);
                Assert.That(SurfaceScheduler.LentCount, Is.EqualTo(0));
                Assert.That(SurfaceScheduler.WaitingCount, Is.EqualTo(0));
            }
        }

        [UnityTest]
        public IEnumerator NothingComesOfWhatAHandlerStops([Values] bool isDisabled)
        {
            _rig = SurfaceRig.WithBlob(300, 6);
            MolecularSurface surface = _rig.Surface;
            surface.SurfaceUpdated += level =>
            {
                if (isDisabled)
                    surface.enabled = false;
                else
                    surface.Cancel();
            };
            yield return SurfaceRig.Until(() => _rig.Levels.Count > 0);
            Assert.That(surface.IsBusy, Is.False);
            yield return SurfaceRig.Frames(5);
            Assert.That(_rig.Levels.Count, Is.EqualTo(1));
            Assert.That(_rig.Finished, Is.EqualTo(_rig.Levels[0].IsFinest ? 1 : 0));
            Assert.That(SurfaceScheduler.LentCount + SurfaceScheduler.WaitingCount, Is.Zero);
            surface.enabled = true;
            surface.Recompute();
            yield return SurfaceRig.Until(() => _rig.Levels.Count > 1);
            Assert.That(surface.IsBusy, Is.False);
            Assert.That(_rig.Failures, Is.Empty);
        }

        [UnityTest]
        public IEnumerator APlayerThatAHandlerDisablesShowsNoMoreUntilItIsEnabled()
        {
            using (var playing = new PlayerFixture())
            {
                int stopped = -1;
                playing.Player.FrameShown += frame =>
                {
                    playing.Player.enabled = frame < 2 || stopped >= 0;
                    stopped = playing.Player.enabled ? stopped : frame;
                };
                playing.UseEnsemble(20);
                playing.Player.FramesPerSecond = 1000;
                playing.Load();
                playing.Player.Play();
                yield return SurfaceRig.Until(() => stopped >= 0);
                Assert.That(playing.Player.IsLoading, Is.False);
                int count = playing.Shown.Count;
                Assert.That(playing.Shown[count - 1], Is.EqualTo(stopped));
                yield return SurfaceRig.Frames(5);
                Assert.That(playing.Shown.Count, Is.EqualTo(count));
                playing.Player.enabled = true;
                yield return SurfaceRig.Until(() => playing.Shown.Count > count);
                Assert.That(playing.Failures, Is.Empty);
            }
        }

        [UnityTest]
        public IEnumerator AHandlerMayDestroyWhatAsksForAtoms()
        {
            _rig = new SurfaceRig();
            GameObject doomed = _rig.GameObject;
            _rig.Surface.AtomsRequested += () => Object.DestroyImmediate(doomed);
            yield return SurfaceRig.Until(() => doomed == null);
            yield return SurfaceRig.Frames(2);
        }

        [UnityTest]
        public IEnumerator AHandlerMayDestroyWhatCantBeRead()
        {
            _rig = new SurfaceRig();
            GameObject doomed = _rig.GameObject;
            _rig.Surface.Failed += error => Object.DestroyImmediate(doomed);
            _rig.Surface.Source.SetFile("/no/such/file.pdb"); // which the first frame begins to read
            yield return SurfaceRig.Until(() => doomed == null);
            yield return SurfaceRig.Frames(2);
            Assert.That(_rig.Requests, Is.EqualTo(0));
        }

        [UnityTest]
        public IEnumerator WhoTriesAgainInFailedIsToldAgainInALaterFrame([Values] bool atOnce)
        {
            _rig = new SurfaceRig();
            int nesting = 0, deepest = 0;
            _rig.Surface.Failed += error =>
            {
                deepest = Math.Max(deepest, ++nesting);
                if (atOnce && _rig.Failures.Count < 100)
                    _rig.Surface.LoadSource();
                else if (_rig.Failures.Count < 100)
                    _rig.Surface.BeginLoadSource();
                --nesting;
            };
            _rig.Surface.Source.SetFile("/no/such/file.pdb");
            _rig.Surface.BeginLoadSource();
            Assert.That(_rig.Failures.Count, Is.EqualTo(1));
            yield return SurfaceRig.Until(() => _rig.Failures.Count == 3);
            Assert.That(deepest, Is.EqualTo(1));
        }

        [UnityTest]
        public IEnumerator WhoLoadsAgainInFailedOfAPlayerIsToldAgainInTheNextTick()
        {
            using (var playing = new PlayerFixture())
            {
                playing.Player.Failed += (frame, error) =>
                {
                    if (playing.Failures.Count < 100)
                        playing.Player.Load();
                };
                playing.Player.StructureSource.SetFile("/no/such/file.pdb");
                Assert.That(playing.Player.Load(), Is.False);
                Assert.That(playing.Failures.Count, Is.EqualTo(1));
                yield return SurfaceRig.Until(() => playing.Failures.Count == 3);
                Assert.That(playing.FailedFrames, Is.All.EqualTo(-1));
            }
        }

        [UnityTest]
        public IEnumerator AHandlerOfFailedMayTakeAnotherFile()
        {
            using (var folder = new TestFolder())
            using (var playing = new PlayerFixture())
            {
                string file = folder.Write("small.pdb", TestFrames.Pdb(2));
                _rig = new SurfaceRig();
                _rig.Surface.Failed += error =>
                {
                    _rig.Surface.Source.SetFile(file);
                    _rig.Surface.BeginLoadSource();
                };
                _rig.Surface.Source.SetFile("/no/such/file.pdb");
                _rig.Surface.BeginLoadSource();
                playing.Player.Failed += (frame, error) =>
                {
                    playing.Player.StructureSource.SetFile(file);
                    playing.Player.Load();
                };
                playing.Player.StructureSource.SetFile("/no/such/file.pdb");
                playing.Player.Load();
                yield return SurfaceRig.Until(() => _rig.Surface.AtomCount > 0 && playing.Player.ShownFrame == 0);
                yield return SurfaceRig.Frames(3);
                Assert.That((_rig.Failures.Count, playing.Failures.Count), Is.EqualTo((1, 1)));
            }
        }

        [Test]
        public void WhatAHandlerDestroysRaisesNothingMore()
        {
            int wired = 0;
            _rig = SurfaceRig.WithBlob(40, 1);
            _rig.Surface.Events.SurfaceUpdated.AddListener(() => ++wired);
            _rig.Surface.SurfaceUpdated += level => _rig.Dispose();
            _rig.Surface.ComputeNow();
            _rig = SurfaceRig.WithBlob(40, 1);
            _rig.Surface.Events.RefinementFinished.AddListener(() => ++wired);
            _rig.Surface.RefinementFinished += () => _rig.Dispose();
            _rig.Surface.ComputeNow();
            _rig = new SurfaceRig();
            _rig.Surface.Events.Failed.AddListener(message => ++wired);
            _rig.Surface.Failed += error => _rig.Dispose();
            _rig.Surface.Source.SetFile("/no/such/file.pdb");
            Assert.That(_rig.Surface.LoadSource(), Is.False);
            Assert.That(_rig.GameObject == null);
            Assert.That(wired, Is.Zero);
        }
    }
}
