// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using UnityEngine;

namespace QuickSes.Tests
{
    /// <summary>Which time a trajectory is played in.</summary>
    internal sealed class PlayerClockTest
    {
        private PlayerFixture _playing;

        private TrajectoryPlayer Player => _playing.Player;

        [SetUp]
        public void MakePlayer()
        {
            _playing = new PlayerFixture();
            _playing.UseEnsemble(20);
            _playing.Load();
            Player.FramesPerSecond = 10;
            Player.Play();
        }

        [TearDown]
        public void DestroyPlayer()
        {
            _playing.Dispose();
            Time.timeScale = 1;
        }

        [Test]
        public void TheGamesTimeIsScaled()
        {
            Time.timeScale = 0.5f;
            AssertIsAt(1, after: 0.2);
            Time.timeScale = 0;
            AssertIsAt(1, after: 0.2);
        }

        [Test]
        public void UnscaledTimeGoesOnWhereTheGameStandsStill()
        {
            Player.UseUnscaledTime = true;
            Time.timeScale = 0;
            AssertIsAt(2, after: 0.2);
            AssertIsAt(4, after: 0.2);
        }

        [Test]
        public void NothingIsLeftOutAfterAFrameThatTookLong([Values] bool isUnscaled)
        {
            Player.UseUnscaledTime = isUnscaled;
            AssertIsAt(10 * Time.maximumDeltaTime, after: 60);
        }

        // The inspector and animations may write such.
        [Test]
        public void WithARateThatIsNoNumberItStandsStill(
            [Values(float.PositiveInfinity, float.NegativeInfinity, float.NaN)] float rate, [Values] PlaybackMode mode)
        {
            Player.Mode = mode;
            AssertIsAt(1, after: 0.1);
            Engine.Animate(Player, "_framesPerSecond", rate);
            AssertIsAt(1, after: 0.1);
            Assert.That(Player.FramesPerSecond, Is.EqualTo(0));
            Player.FramesPerSecond = 10;
            AssertIsAt(2, after: 0.1);
        }

        [Test]
        public void WhoJumpsWhileItWaitsPlaysOnFromThere()
        {
            _playing.UseEnsemble(200);
            _playing.Load();
            // Far from what was read ahead; the thread that reads may be faster.
            for (int jump = 1; jump < 1000 && !Player.IsWaiting; ++jump)
            {
                Player.Frame = 67 * jump % 200;
                Player.Tick(0);
            }
            Player.Frame = 0;
            Player.Tick(0.1f);
            Assert.That(Player.Frame, Is.EqualTo(1).Within(1e-5));
        }

        private void AssertIsAt(double place, double after)
        {
            Engine.Frame(after);
            Assert.That(Player.Frame, Is.EqualTo(place).Within(1e-5));
            _playing.WaitUntilShown((int)place);
        }
    }
}
