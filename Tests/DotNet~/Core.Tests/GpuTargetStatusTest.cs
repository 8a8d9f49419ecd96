// SPDX-License-Identifier: MIT
using NUnit.Framework;

namespace QuickSes.Tests
{
    public sealed class GpuTargetStatusTest
    {
        [TestCase(0, 0, false)] // nothing yet
        [TestCase(5, 0, true)]
        [TestCase(int.MaxValue, 0, true)]
        [TestCase(5, 5, false)]
        [TestCase(6, 5, true)]
        [TestCase(4, 5, false)]
        [TestCase(1, int.MaxValue, true)] // 1 follows the last number
        [TestCase(int.MaxValue, 1, false)]
        [TestCase(5, int.MaxValue - 5, true)]
        [TestCase(int.MaxValue - 5, 5, false)]
        public void TheNewestMeshIsLostWhereItsEventIsLaterThanTheLastThatRan(int submitted, int done, bool isLost)
        {
            var status = new GpuTargetStatus(default, submitted, done, 0, true);
            Assert.That(status.IsNewestLost, Is.EqualTo(isLost));
            var waits = new GpuTargetStatus(default, submitted, done, 1, true);
            Assert.That(waits.IsNewestLost, Is.False, "it waits for its event");
        }
    }
}
