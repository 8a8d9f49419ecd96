// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;

namespace QuickSes.Tests
{
    /// <summary>What frames leave for the collector.</summary>
    internal static class Garbage
    {
        /// <summary>Plays three times: once everything has grown, the thread allocates nothing.</summary>
        public static void AssertNone(Action play)
        {
            play();
            play();
            long before = GC.GetAllocatedBytesForCurrentThread();
            play();
            Assert.That(GC.GetAllocatedBytesForCurrentThread() - before, Is.EqualTo(0));
        }
    }
}
