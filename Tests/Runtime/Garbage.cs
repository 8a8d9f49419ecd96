// SPDX-License-Identifier: MIT
using NUnit.Framework;
using UnityEngine.TestTools.Constraints;
using Is = UnityEngine.TestTools.Constraints.Is;

namespace QuickSes.Tests
{
    /// <summary>What code that is repeated leaves for the collector.</summary>
    internal static class Garbage
    {
        /// <summary>
        /// Plays until the calling thread has allocated nothing in a round. In some it may: memory grows, and the
        /// runtime allocates where a thread waits for another for the first time, in whichever round that is. Frames
        /// that leave garbage leave it in every round.
        /// </summary>
        public static void AssertNone(TestDelegate play)
        {
            for (int round = 0; round < 8; ++round)
            {
                if (!new AllocatingGCMemoryConstraint().ApplyTo(play).IsSuccess)
                    return;
            }
            Assert.That(play, Is.Not.AllocatingGCMemory());
        }
    }
}
