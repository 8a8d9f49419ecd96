// SPDX-License-Identifier: MIT
using NUnit.Framework;
using UnityEngine.TestTools.Constraints;
using Is = UnityEngine.TestTools.Constraints.Is;

namespace QuickSes.Tests
{
    /// <summary>What frames leave for the collector.</summary>
    internal static class Garbage
    {
        /// <summary>Plays three times: once everything has grown, the thread allocates nothing.</summary>
        public static void AssertNone(TestDelegate play)
        {
            play();
            play();
            Assert.That(play, Is.Not.AllocatingGCMemory());
        }

        /// <summary>
        /// The same where another thread works along: the runtime allocates where one first waits for the other, in
        /// whichever round that is. Frames that leave garbage leave it in every round.
        /// </summary>
        public static void AssertNoneBesideThreads(TestDelegate play)
        {
            play();
            for (int round = 0; round < 8; ++round)
            {
                if (!new AllocatingGCMemoryConstraint().ApplyTo(play).IsSuccess)
                    return;
            }
            Assert.That(play, Is.Not.AllocatingGCMemory());
        }
    }
}
