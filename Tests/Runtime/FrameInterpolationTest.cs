// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using UnityEngine;

namespace QuickSes.Tests
{
    public sealed class FrameInterpolationTest
    {
        private static Vector3 Between(Vector3 from, Vector3 to, float weight, PeriodicBox box)
        {
            Span<Vector3> between = new Vector3[1];
            FrameInterpolation.Blend(new[] { from }, new[] { to }, weight, box, between);
            return between[0];
        }

        private static void AssertAt(Vector3 actual, float x, float y, float z)
        {
            Assert.That(actual.x, Is.EqualTo(x).Within(1e-5f));
            Assert.That(actual.y, Is.EqualTo(y).Within(1e-5f));
            Assert.That(actual.z, Is.EqualTo(z).Within(1e-5f));
        }

        private static readonly PeriodicBox s_box =
            new PeriodicBox(new Vector3(-10, 0, 0), new Vector3(0, 20, 0), new Vector3(0, 0, 30));

        [Test]
        public void AtomsMoveOnStraightLines()
        {
            var from = new Vector3(1, 2, 3);
            var to = new Vector3(5, -2, 4);
            foreach (PeriodicBox box in new[] { default, s_box })
            {
                AssertAt(Between(from, to, 0, box), 1, 2, 3);
                AssertAt(Between(from, to, 0.25f, box), 2, 1, 3.25f);
                AssertAt(Between(from, to, 0.75f, box), 4, -1, 3.75f);
            }
        }

        [Test]
        public void AtomsDoNotFlyThroughTheBox()
        {
            // Out at x = 0, in again at x = -10; and out at the top in y.
            AssertAt(Between(new Vector3(-0.5f, 5, 5), new Vector3(-9.5f, 5, 5), 0.5f, s_box), 0, 5, 5);
            AssertAt(Between(new Vector3(-5, 19, 5), new Vector3(-5, 1, 5), 0.5f, s_box), -5, 20, 5);
            AssertAt(Between(new Vector3(-0.5f, 19, 29), new Vector3(-9.5f, 1, 1), 0.25f, s_box), -0.25f, 19.5f, 29.5f);
            // Without a box nothing tells that from a long way.
            AssertAt(Between(new Vector3(-0.5f, 5, 5), new Vector3(-9.5f, 5, 5), 0.5f, default), -5, 5, 5);
        }

        [Test]
        public void BoxesMayBeOblique()
        {
            Vector3 a = new Vector3(-10, 0, 0), b = new Vector3(-4, 12, 0), c = new Vector3(-3, 2, 14);
            var box = new PeriodicBox(a, b, c);
            var step = new Vector3(0.4f, -0.3f, 0.2f);
            var start = new Vector3(-8, 7, 3);
            for (int i = -1; i <= 1; ++i)
                for (int j = -1; j <= 1; ++j)
                    for (int k = -1; k <= 1; ++k)
                        AssertAt(Between(start, start + step + i * a + j * b + k * c, 0.5f, box), -7.8f, 6.85f, 3.1f);
        }

        [Test]
        public void FlatBoxesAreNone()
        {
            Assert.That(new PeriodicBox(new Vector3(10, 0, 0), new Vector3(0, 10, 0), Vector3.zero).Exists, Is.False);
            Assert.That(default(PeriodicBox).Exists, Is.False);
            Assert.That(s_box.Exists, Is.True);
        }

        [Test]
        public void LengthsMustMatch()
        {
            Assert.That(() => FrameInterpolation.Blend(new Vector3[2], new Vector3[3], 0, default, new Vector3[3]),
                Throws.ArgumentException);
            Assert.That(() => FrameInterpolation.Blend(new Vector3[2], new Vector3[2], 0, default, new Vector3[1]),
                Throws.ArgumentException);
        }
    }
}
