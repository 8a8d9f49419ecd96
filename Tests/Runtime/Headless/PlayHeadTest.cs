// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System.Collections.Generic;

namespace QuickSes.Tests
{
    public sealed class PlayHeadTest
    {
        private static PlayHead Head(int frames, PlaybackMode mode, int sign = 1)
        {
            var head = new PlayHead(frames, mode);
            head.SetSign(sign);
            head.Rewind();
            return head;
        }

        // The frame before and after each of `steps` steps.
        private static List<int> Play(ref PlayHead head, int steps, double step = 1)
        {
            var shown = new List<int> { head.Frame };
            for (int i = 0; i < steps; ++i)
            {
                head.Advance(step);
                shown.Add(head.Frame);
            }
            return shown;
        }

        [TestCase(PlaybackMode.Loop, 1, new[] { 0, 1, 2, 3, 0, 1 })]
        [TestCase(PlaybackMode.Loop, -1, new[] { 3, 2, 1, 0, 3, 2 })]
        [TestCase(PlaybackMode.PingPong, 1, new[] { 0, 1, 2, 3, 2, 1, 0, 1, 2 })]
        [TestCase(PlaybackMode.PingPong, -1, new[] { 3, 2, 1, 0, 1, 2, 3, 2 })]
        [TestCase(PlaybackMode.Once, 1, new[] { 0, 1, 2, 3, 3, 3 })]
        [TestCase(PlaybackMode.Once, -1, new[] { 3, 2, 1, 0, 0 })]
        public void FramesFollowTheMode(PlaybackMode mode, int sign, int[] expected)
        {
            PlayHead head = Head(4, mode, sign);
            Assert.That(Play(ref head, expected.Length - 1), Is.EqualTo(expected));
        }

        [TestCase(PlaybackMode.Loop, 1)]
        [TestCase(PlaybackMode.Loop, -1)]
        [TestCase(PlaybackMode.PingPong, 1)]
        [TestCase(PlaybackMode.PingPong, -1)]
        public void FramesAreShownEquallyLong(PlaybackMode mode, int sign)
        {
            const int frames = 5, perFrame = 4;
            int round = mode == PlaybackMode.Loop ? frames : 2 * (frames - 1);
            PlayHead head = Head(frames, mode, sign);
            List<int> shown = Play(ref head, round * perFrame - 1, 1.0 / perFrame);
            for (int k = 0; k < frames; ++k)
            {
                bool isPassedTwice = mode == PlaybackMode.PingPong && k > 0 && k < frames - 1;
                Assert.That(shown.FindAll(frame => frame == k).Count, Is.EqualTo((isPassedTwice ? 2 : 1) * perFrame),
                    "frame {0}", k);
            }
        }

        [TestCase(PlaybackMode.Loop, 1)]
        [TestCase(PlaybackMode.Loop, -1)]
        [TestCase(PlaybackMode.PingPong, 1)]
        [TestCase(PlaybackMode.PingPong, -1)]
        [TestCase(PlaybackMode.Once, 1)]
        [TestCase(PlaybackMode.Once, -1)]
        public void OneLongStepIsManyShortOnes(PlaybackMode mode, int sign)
        {
            foreach (int frames in new[] { 1, 2, 3, 7 })
            {
                for (int steps = 1; steps < 40; ++steps)
                {
                    PlayHead far = Head(frames, mode, sign), near = Head(frames, mode, sign);
                    far.Advance(steps * 0.75);
                    for (int i = 0; i < steps; ++i)
                        near.Advance(0.75);
                    Assert.That(far.Position, Is.EqualTo(near.Position), "{0} frames, {1} steps", frames, steps);
                    Assert.That(far.Direction, Is.EqualTo(near.Direction), "{0} frames, {1} steps", frames, steps);
                }
            }
        }

        [Test]
        public void OrderIsWhatWillBeShown()
        {
            foreach (PlaybackMode mode in new[] { PlaybackMode.Loop, PlaybackMode.PingPong, PlaybackMode.Once })
            {
                foreach (int sign in new[] { 1, -1 })
                {
                    for (int frames = 1; frames < 6; ++frames)
                    {
                        for (int start = 0; start < frames; ++start)
                        {
                            PlayHead head = Head(frames, mode, sign);
                            head.MoveTo(start);
                            FrameOrder order = head.Order;
                            for (int step = 0; step < 20; ++step)
                            {
                                bool isOver = mode == PlaybackMode.Once &&
                                    (sign > 0 ? start + step >= frames : start - step < 0);
                                Assert.That(order[step], Is.EqualTo(isOver ? -1 : head.Frame),
                                    "{0} {1} frames, sign {2}, start {3}, step {4}", mode, frames, sign, start, step);
                                head.Advance(1);
                            }
                        }
                    }
                }
            }
        }

        [Test]
        public void PlacesAreClamped()
        {
            PlayHead head = Head(10, PlaybackMode.Loop);
            foreach (double place in new[] { -3, double.NegativeInfinity, double.NaN })
            {
                head.MoveTo(place);
                Assert.That(head.Position, Is.EqualTo(0));
            }
            foreach (double place in new[] { 9.0, 9.5, 1e300 })
            {
                head.MoveTo(place);
                Assert.That(head.Position, Is.EqualTo(9));
                Assert.That(head.Frame, Is.EqualTo(9));
            }
            head.MoveTo(4.25);
            Assert.That(head.Position, Is.EqualTo(4.25));
        }

        [Test]
        public void BlendGoesFromTheFramePassedToTheNext()
        {
            PlayHead head = Head(10, PlaybackMode.Loop);
            head.MoveTo(4.25);
            Assert.That(head.Blend, Is.EqualTo(new FrameBlend(4, 5, 0.25f)));
            head.SetSign(-1);
            Assert.That(head.Blend, Is.EqualTo(new FrameBlend(5, 4, 0.75f)));
            head.MoveTo(4);
            Assert.That(head.Blend, Is.EqualTo(new FrameBlend(4, 4, 0)));
        }

        [TestCase(1, 9)]
        [TestCase(-1, 0)]
        public void NothingIsBetweenTheEndsOfALoop(int sign, int end)
        {
            PlayHead head = Head(10, PlaybackMode.Loop, sign);
            Assert.That(head.Advance(9.5), Is.EqualTo(PlayHeadEvents.None));
            Assert.That(head.Blend, Is.EqualTo(new FrameBlend(end, end, 0)));
            Assert.That(head.Position, Is.EqualTo(end));
            Assert.That(head.Advance(0.75), Is.EqualTo(PlayHeadEvents.Looped));
            Assert.That(head.Frame, Is.EqualTo(9 - end));
            Assert.That(head.Blend.Weight, Is.EqualTo(0.25f));
        }

        [Test]
        public void EndsAreTold()
        {
            PlayHead once = Head(4, PlaybackMode.Once);
            Assert.That(once.Advance(2.5), Is.EqualTo(PlayHeadEvents.None));
            Assert.That(once.IsAtEnd, Is.False);
            Assert.That(once.Advance(2.5), Is.EqualTo(PlayHeadEvents.Finished));
            Assert.That(once.IsAtEnd, Is.True);
            once.Rewind();
            Assert.That(once.Position, Is.EqualTo(0));
            Assert.That(once.IsAtEnd, Is.False);

            PlayHead there = Head(4, PlaybackMode.PingPong);
            Assert.That(there.Advance(2.5), Is.EqualTo(PlayHeadEvents.None));
            Assert.That(there.Advance(1), Is.EqualTo(PlayHeadEvents.Looped));
            Assert.That(there.Direction, Is.EqualTo(-1));
            Assert.That(there.Advance(2), Is.EqualTo(PlayHeadEvents.None));
            Assert.That(there.Advance(1), Is.EqualTo(PlayHeadEvents.Looped));
            Assert.That(there.Direction, Is.EqualTo(1));
        }

        [Test]
        public void NoTimeIsNoWay()
        {
            PlayHead head = Head(4, PlaybackMode.Loop);
            head.MoveTo(1.5);
            foreach (double way in new[] { 0.0, -1.0, double.NaN })
                Assert.That(head.Advance(way), Is.EqualTo(PlayHeadEvents.None));
            Assert.That(head.Position, Is.EqualTo(1.5));
        }

        [Test]
        public void TurningRoundMidwayStaysThere()
        {
            PlayHead head = Head(10, PlaybackMode.PingPong);
            head.MoveTo(4.5);
            head.SetSign(-1);
            head.Advance(1);
            Assert.That(head.Position, Is.EqualTo(3.5));
            head.SetMode(PlaybackMode.Once);
            head.SetSign(1);
            head.Advance(1);
            Assert.That(head.Position, Is.EqualTo(4.5));
        }

        [Test]
        public void WhatIsOnItsWayBackGoesBackwardsIfItIsReversed()
        {
            PlayHead head = Head(5, PlaybackMode.PingPong);
            head.Advance(5);
            Assert.That(head.Position, Is.EqualTo(3));
            Assert.That(head.Direction, Is.EqualTo(-1));
            head.SetSign(-1);
            Assert.That(head.Direction, Is.EqualTo(-1));
            head.Advance(1);
            Assert.That(head.Position, Is.EqualTo(2));
        }

        [Test]
        public void ALoopThatLingersAtItsEndGoesOnFromThereInAnotherMode()
        {
            PlayHead head = Head(5, PlaybackMode.Loop);
            head.Advance(4.75);
            head.SetMode(PlaybackMode.PingPong);
            head.Advance(0.5);
            Assert.That(head.Position, Is.EqualTo(3.5));
        }
    }
}
