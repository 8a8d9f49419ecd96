// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using System.Collections;
using System.Diagnostics;
using UnityEngine;
using UnityEngine.TestTools;

namespace QuickSes.Tests
{
    /// <summary>The place in the trajectory, keyed in the Animation window or by Timeline.</summary>
    internal sealed class AnimatedPlayerTest
    {
        private PlayerFixture _playing;

        private TrajectoryPlayer Player => _playing.Player;

        [SetUp]
        public void MakePlayer()
        {
            _playing = new PlayerFixture();
            _playing.UseEnsemble(20);
            _playing.Load();
        }

        [TearDown]
        public void DestroyPlayer() => _playing.Dispose();

        // A frame of the game in which an animation is at this place.
        private void FrameAt(float place)
        {
            void Animate() => Engine.Animate(Player, "_frame", place);
            Engine.Animating += Animate;
            Engine.Frame(0.01);
            Engine.Animating -= Animate;
        }

        [UnityTest]
        public IEnumerator AnAnimationScrubs([Values] bool isEditMode)
        {
            if (isEditMode)
            {
                _playing.Dispose();
                Engine.EnterEditMode();
                MakePlayer();
            }
            foreach (float place in new[] { 7f, 8f, 3.6f, 19f, 0f })
            {
                FrameAt(place);
                Assert.That(Player.Frame, Is.EqualTo(place));
                yield return SurfaceRig.Until(() => Player.ShownFrame == (int)place);
                _playing.AssertShows((int)place);
            }
            FrameAt(1000);
            Assert.That(Player.Frame, Is.EqualTo(19));
        }

        [Test]
        public void WhatIsReadAlreadyIsShownInTheSameFrame()
        {
            for (int frame = 1; frame < 20; ++frame)
            {
                Player.Frame = frame; // read ahead from here
                _playing.WaitUntilShown(frame);
                Player.Frame = frame - 1;
                _playing.WaitUntilShown(frame - 1);
                FrameAt(frame);
                Assert.That(Player.ShownFrame, Is.EqualTo(frame).Or.EqualTo(frame - 1));
                if (!Player.IsWaiting)
                    _playing.AssertShows(frame);
            }
        }

        [Test]
        public void AnimationsWinOverPlaying()
        {
            Player.FramesPerSecond = 100;
            Player.Play();
            Stopwatch waited = Stopwatch.StartNew();
            for (int k = 0; k < 10 || Player.ShownFrame != 12; ++k)
            {
                Assert.That(waited.Elapsed.TotalSeconds, Is.LessThan(SurfaceRig.Patience), "still waiting");
                FrameAt(12);
                Assert.That(Player.Frame, Is.EqualTo(12));
                System.Threading.Thread.Sleep(1); // while a frame is read, playing waits for it
            }
            Engine.Frame(0.01); // the animation is over
            Assert.That(Player.Frame, Is.EqualTo(13).Within(1e-6), "it plays on from there");
        }

        [UnityTest]
        public IEnumerator TheEndOfAPreviewIsFollowedWithoutAMessage()
        {
            FrameAt(12);
            typeof(TrajectoryPlayer).GetField("_frame",
                System.Reflection.BindingFlags.Instance | System.Reflection.BindingFlags.NonPublic)
                .SetValue(Player, 2f);
            yield return SurfaceRig.Until(() => Player.ShownFrame == 2);
            _playing.AssertShows(2);
        }

        [UnityTest]
        public IEnumerator AnAnimationMaySayWhereToBegin()
        {
            Assert.That(Player.Load(), Is.True);
            Engine.Animate(Player, "_frame", 9f);
            yield return SurfaceRig.Until(() => Player.ShownFrame >= 0);
            Assert.That(Player.ShownFrame, Is.EqualTo(9));
        }
    }
}
