// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System.Collections;
using System.Linq;
using System.Text.RegularExpressions;
using UnityEngine;
using UnityEngine.TestTools;

namespace QuickSes.Tests
{
    /// <summary>Playing, by a clock that is the test's.</summary>
    public sealed class TrajectoryPlayerTest
    {
        private PlayerFixture _playing;

        private TrajectoryPlayer Player => _playing.Player;

        [SetUp]
        public void MakePlayer()
        {
            _playing = new PlayerFixture();
            Player.FramesPerSecond = 10;
        }

        [TearDown]
        public void DestroyPlayer() => _playing.Dispose();

        private void LoadEnsemble(int frames)
        {
            _playing.UseEnsemble(frames);
            _playing.Load();
        }

        [Test]
        public void ModelsOfTheStructuresFileAreFrames()
        {
            LoadEnsemble(5);
            Assert.That(Player.FrameCount, Is.EqualTo(5));
            Assert.That(Player.IsReady, Is.True);
            Assert.That(Player.IsLoading || Player.IsPlaying, Is.False);
            Assert.That(_playing.Loads, Is.EqualTo(1));
            _playing.AssertShows(0);
            for (int frame = 4; frame >= 0; --frame)
            {
                Player.Frame = frame;
                _playing.WaitUntilShown(frame);
                _playing.AssertShows(frame);
            }
            Assert.That(_playing.Shown, Is.EqualTo(new[] { 0, 4, 3, 2, 1, 0 }));
            Assert.That(_playing.Failures, Is.Empty);
        }

        [Test]
        public void AtomsAreThereBeforeTheFirstFrame()
        {
            _playing.UseEnsemble(3);
            Player.StructureSource.Model = 2;
            Assert.That(Player.Load(), Is.True);
            Assert.That(Player.IsLoading, Is.True);
            Assert.That(Player.LoadProgress, Is.LessThan(1));
            _playing.TickUntil(() => Player.Structure != null, "the structure is read");
            Assert.That(Player.ShownFrame, Is.EqualTo(-1));
            Assert.That(Player.LoadProgress, Is.LessThan(1));
            Assert.That(Player.Structure.Model, Is.EqualTo(2));
            _playing.AssertAt(TestFrames.Frame(1), 0);
        }

        [Test]
        public void NothingComesOfWhatIsCancelled()
        {
            for (int ticks = 0; ticks < 4; ++ticks)
            {
                DestroyPlayer();
                MakePlayer();
                _playing.UseEnsemble(3);
                Assert.That(Player.Load(), Is.True);
                for (int k = 0; k < ticks && !Player.IsReady; ++k)
                {
                    Player.Tick(0);
                    System.Threading.Thread.Sleep(5);
                }
                if (Player.IsReady) // too late to cancel it
                    continue;
                Player.CancelLoading();
                Assert.That(Player.IsLoading || _playing.Surface.IsPlayed || Player.Structure != null, Is.False);
                Assert.That(Player.LoadProgress, Is.EqualTo(1));
                for (int k = 0; k < 20; ++k)
                {
                    Player.Tick(0);
                    System.Threading.Thread.Sleep(1);
                }
                Assert.That(_playing.Loads, Is.EqualTo(0));
                Assert.That(_playing.Shown, Is.Empty);
                Assert.That(_playing.Failures, Is.Empty);
            }
            LoadEnsemble(3);
            Player.CancelLoading(); // what is loaded stays
            Assert.That(Player.IsReady, Is.True);
        }

        [Test]
        public void TimeThatPassesBeforeFramesAreThereDoesNotCount()
        {
            _playing.UseEnsemble(5);
            Player.Play();
            Assert.That(Player.Load(), Is.True);
            _playing.TickUntil(() =>
            {
                if (Player.ShownFrame < 0)
                    Player.Tick(0.1f); // a frame's
                return Player.ShownFrame >= 0;
            }, "a frame is shown");
            Assert.That(_playing.Shown, Is.EqualTo(new[] { 0 }));
        }

        [Test]
        public void LoopGoesRound()
        {
            LoadEnsemble(3);
            Player.Play();
            Assert.That(Player.IsPlaying, Is.True);
            for (int step = 0; step < 7; ++step)
                _playing.Pass(0.1f);
            Assert.That(_playing.Shown, Is.EqualTo(new[] { 0, 1, 2, 0, 1, 2, 0, 1 }));
            Assert.That(_playing.Loops, Is.EqualTo(2));
            Assert.That(_playing.Finishes, Is.EqualTo(0));
            _playing.AssertShows(1);
        }

        [Test]
        public void LoopGoesRoundBackwards()
        {
            LoadEnsemble(3);
            Player.FramesPerSecond = -10;
            Player.Play();
            for (int step = 0; step < 5; ++step)
                _playing.Pass(0.1f);
            Assert.That(_playing.Shown, Is.EqualTo(new[] { 0, 2, 1, 0, 2, 1 }));
            Assert.That(_playing.Loops, Is.EqualTo(2));
        }

        [Test]
        public void PingPongGoesThereAndBack()
        {
            LoadEnsemble(3);
            Player.Mode = PlaybackMode.PingPong;
            Player.Play();
            for (int step = 0; step < 5; ++step)
                _playing.Pass(0.1f);
            Assert.That(_playing.Shown, Is.EqualTo(new[] { 0, 1, 2, 1, 0, 1 }));
            Assert.That(_playing.Loops, Is.EqualTo(2));
        }

        [Test]
        public void OnceStopsAtTheEndAndPlaysAgain()
        {
            LoadEnsemble(3);
            Player.Mode = PlaybackMode.Once;
            Player.Play();
            for (int step = 0; step < 5; ++step)
                _playing.Pass(0.1f);
            Assert.That(_playing.Shown, Is.EqualTo(new[] { 0, 1, 2 }));
            Assert.That(_playing.Finishes, Is.EqualTo(1));
            Assert.That(Player.IsPlaying, Is.False);
            Player.Play();
            _playing.Pass(0);
            _playing.Pass(0.1f);
            Assert.That(_playing.Shown, Is.EqualTo(new[] { 0, 1, 2, 0, 1 }));
        }

        [Test]
        public void PauseStaysAndStopRewinds()
        {
            LoadEnsemble(5);
            Player.Play();
            _playing.Pass(0.2f);
            Player.Pause();
            _playing.Pass(10);
            Assert.That(Player.Frame, Is.EqualTo(2).Within(1e-6));
            Player.Play();
            _playing.Pass(0.1f);
            _playing.AssertShows(3);
            Player.Stop();
            Assert.That(Player.IsPlaying, Is.False);
            _playing.WaitUntilShown(0);
            _playing.AssertShows(0);
        }

        [Test]
        public void PlacesOutOfRangeAreClamped()
        {
            LoadEnsemble(5);
            Player.Frame = 100;
            Assert.That(Player.Frame, Is.EqualTo(4));
            Assert.That(Player.NormalizedTime, Is.EqualTo(1));
            Player.Frame = -1;
            Assert.That(Player.Frame, Is.EqualTo(0));
            Player.NormalizedTime = 0.5;
            _playing.WaitUntilShown(2);
            _playing.AssertShows(2);
            Assert.That(() => Player.FramesPerSecond = float.NaN, Throws.TypeOf<System.ArgumentOutOfRangeException>());
        }

        [Test]
        public void PlaceIsKeptForWhatIsLoadedNext()
        {
            _playing.UseEnsemble(5);
            Player.Frame = 3;
            Assert.That(Player.Load(), Is.True);
            _playing.WaitUntilShown(3);
            Assert.That(_playing.Shown, Is.EqualTo(new[] { 3 }));
            Player.enabled = false;
            Assert.That(Player.IsReady, Is.False);
            Assert.That(Player.Structure, Is.Null);
            Player.enabled = true;
            _playing.TickUntil(() => Player.ShownFrame >= 0, "it is back");
            _playing.AssertShows(3);
            Player.Unload();
            Player.Frame = 2;
            Player.Stop();
            _playing.Load();
            _playing.AssertShows(0);
        }

        [Test]
        public void FramesInBetweenAreInterpolated()
        {
            LoadEnsemble(3);
            Player.Interpolate = true;
            Player.Frame = 1.25;
            _playing.WaitUntilShown(1);
            Vector3[] expected = TestFrames.Frame(1);
            for (int i = 0; i < expected.Length; ++i)
                expected[i] = 0.75f * expected[i] + 0.25f * TestFrames.Position(2, i);
            _playing.AssertAt(expected, 1e-5f);
            Player.Interpolate = false;
            _playing.Pass(0);
            _playing.AssertShows(1);
        }

        [Test]
        public void NothingIsSentWhileNothingMoves()
        {
            LoadEnsemble(3);
            Player.Play();
            _playing.Pass(0.01f);
            Vector3 elsewhere = new Vector3(100, 0, 0);
            _playing.Surface.SetPositions(Enumerable.Repeat(elsewhere, _playing.Surface.AtomCount).ToArray());
            _playing.Pass(0.01f);
            Assert.That(_playing.Positions[0], Is.EqualTo(elsewhere));
            _playing.Pass(0.09f);
            _playing.AssertShows(1);
        }

        [Test]
        public void AtomsComeAgainIfTheSurfaceWasGivenOthers()
        {
            LoadEnsemble(3);
            _playing.Surface.SetAtoms(new Vector3[2], new float[] { 1, 1 });
            _playing.Pass(0);
            _playing.AssertShows(0);
            Assert.That(_playing.Surface.AtomCount, Is.EqualTo(TestFrames.WithoutWater.Length));
        }

        [Test]
        public void HandlersMayUnload()
        {
            LoadEnsemble(3);
            Player.FrameShown += _ => Player.Unload();
            Player.Frame = 1;
            _playing.TickUntil(() => !Player.IsReady, "it is unloaded");
            Assert.That(Player.FrameCount, Is.EqualTo(0));
            Assert.That(Player.ShownFrame, Is.EqualTo(-1));
            Player.Tick(1);
        }

        [Test]
        public void HandlersThatThrowHoldUpNoOtherEvent([Values] bool isWired)
        {
            LoadEnsemble(3);
            Player.Mode = PlaybackMode.Once;
            if (isWired)
                Player.Events.FrameShown.AddListener(ThrowAtTwo);
            else
                Player.FrameShown += ThrowAtTwo;
            LogAssert.Expect(LogType.Exception, new Regex("thrown"));
            Player.Play();
            for (int step = 0; step < 3; ++step)
                _playing.Pass(0.1f);
            Assert.That(_playing.Finishes, Is.EqualTo(1));
            Assert.That(_playing.Shown, Is.EqualTo(new[] { 0, 1, 2 }));
        }

        private static void ThrowAtTwo(int frame)
        {
            if (frame == 2)
                throw new System.InvalidOperationException("thrown");
        }

        [Test]
        public void WhatIsUnloadedHasNothingMoreToTell()
        {
            LoadEnsemble(2);
            Player.Mode = PlaybackMode.Once;
            Player.FrameShown += _ => Player.enabled = false;
            Player.Play();
            Player.Tick(0.1f);
            _playing.TickUntil(() => !Player.enabled, "a frame is shown");
            Player.Tick(0);
            Assert.That(_playing.Finishes, Is.EqualTo(0));
        }

        // The last frame is far beyond those that were read ahead: it comes some ticks later.
        [Test]
        public void FinishesWhenTheLastFrameIsShown()
        {
            LoadEnsemble(200);
            Player.Mode = PlaybackMode.Once;
            Player.PrefetchFrames = 2;
            int shown = -1;
            Player.Finished += () => shown = Player.ShownFrame;
            Player.Play();
            Player.Tick(1000f);
            Assert.That(Player.IsPlaying, Is.False);
            _playing.TickUntil(() => _playing.Finishes > 0, "it has finished");
            Assert.That(shown, Is.EqualTo(199));
            _playing.Pass(0.1f);
            Assert.That(_playing.Finishes, Is.EqualTo(1));
            // Whoever plays it again meanwhile is not stopped by the end of the time before.
            Player.Play();
            Player.Tick(1000f);
            Player.Play();
            _playing.TickUntil(() => Player.ShownFrame == 0, "it is at the beginning again");
            Assert.That(Player.IsPlaying, Is.True);
        }

        [Test]
        public void HandlersMayDestroyIt()
        {
            LoadEnsemble(2);
            Player.Mode = PlaybackMode.Once;
            Player.FrameShown += _ => Object.DestroyImmediate(_playing.GameObject);
            Player.Play();
            TrajectoryPlayer player = Player;
            player.Tick(0.1f);
            _playing.TickUntil(() => player == null, "it is gone");
            Assert.That(_playing.Finishes, Is.EqualTo(0)); // of something that is gone
        }

        [Test]
        public void PlayingMakesNoGarbage()
        {
            LoadEnsemble(40);
            Player.Interpolate = true;
            Player.PrefetchFrames = 8;
            _playing.Load();
            Player.Play();
            TestDelegate play = () =>
            {
                _playing.PlayUntilShown(_playing.Shown.Count + 20);
            };
            play();
            int before = _playing.Shown.Count;
            Garbage.AssertNoneBesideThreads(play);
            Assert.That(_playing.Shown.Count, Is.GreaterThan(before));
        }

        [UnityTest]
        public IEnumerator BaseColorIsFollowed()
        {
            LoadEnsemble(3);
            Player.ColorScheme = AtomColorScheme.Uniform;
            _playing.Surface.Coloring = AtomColoring.Vertices;
            yield return SurfaceRig.Until(() => !_playing.Surface.IsBusy);
            var color = new Color32(1, 2, 3, 255);
            _playing.Surface.BaseColor = color;
            yield return SurfaceRig.Until(() => !_playing.Surface.IsBusy);
            Assert.That(_playing.Surface.Mesh.colors32, Is.Not.Empty.And.All.EqualTo(color));
        }

        [UnityTest]
        public IEnumerator TheEnginePlaysIt()
        {
            _playing.UseEnsemble(5);
            _playing.Surface.Spacing = 1;
            Player.FramesPerSecond = 1000;
            Assert.That(Player.Load(), Is.True);
            Player.Play();
            yield return SurfaceRig.Until(() => (_playing.Loops > 0 || !Application.isPlaying) &&
                _playing.Shown.Count > 0 && _playing.Surface.Mesh.vertexCount > 0);
            Assert.That(_playing.Failures, Is.Empty);
        }
    }
}
