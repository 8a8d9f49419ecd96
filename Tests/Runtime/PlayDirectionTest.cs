// SPDX-License-Identifier: MIT
using NUnit.Framework;

namespace QuickSes.Tests
{
    /// <summary>Play and Stop go by the rate and the mode as they are when they are called.</summary>
    internal sealed class PlayDirectionTest
    {
        private const float Step = 0.1f; // s, of one frame

        private PlayerFixture _playing;

        private TrajectoryPlayer Player => _playing.Player;

        [SetUp]
        public void MakePlayer()
        {
            _playing = new PlayerFixture();
            Player.FramesPerSecond = 10;
            _playing.UseEnsemble(5);
            _playing.Load();
        }

        [TearDown]
        public void DestroyPlayer() => _playing.Dispose();

        private void Pass(int steps)
        {
            for (int k = 0; k < steps; ++k)
                _playing.Pass(Step);
        }

        [Test]
        public void AHandlerOfFinishedMayTurnBack()
        {
            Player.Mode = PlaybackMode.Once;
            Player.Finished += () =>
            {
                Player.FramesPerSecond = -Player.FramesPerSecond;
                Player.Play();
            };
            Player.Play();
            Pass(12);
            Assert.That(_playing.Shown, Is.EqualTo(new[] { 0, 1, 2, 3, 4, 3, 2, 1, 0, 1, 2, 3, 4 }));
            Assert.That(_playing.Finishes, Is.EqualTo(3));
        }

        [Test]
        public void BackwardsOnceBeginsAtTheLastFrame()
        {
            Player.Mode = PlaybackMode.Once;
            Player.FramesPerSecond = -10;
            Player.Play();
            Assert.That(Player.Frame, Is.EqualTo(4));
            Pass(6);
            Assert.That(Player.ShownFrame, Is.EqualTo(0));
            Assert.That(_playing.Finishes, Is.EqualTo(1));
        }

        [Test]
        public void StoppedBackwardsItIsAtTheLastFrame()
        {
            Player.FramesPerSecond = -10;
            Player.Stop();
            Assert.That(Player.Frame, Is.EqualTo(4));
            Player.FramesPerSecond = 10;
            Player.Stop();
            Assert.That(Player.Frame, Is.EqualTo(0));
        }

        [Test]
        public void OnceFromTheLastFrameOfALoopBeginsAnew()
        {
            Player.Frame = 4;
            _playing.WaitUntilShown(4);
            Player.Mode = PlaybackMode.Once;
            Player.Play();
            Assert.That(Player.Frame, Is.EqualTo(0));
            Pass(2);
            Assert.That(Player.IsPlaying);
            Assert.That(_playing.Finishes, Is.EqualTo(0));
        }
    }
}
