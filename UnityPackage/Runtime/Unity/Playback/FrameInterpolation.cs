// SPDX-License-Identifier: MIT
using System;
using UnityEngine;

namespace QuickSes
{
    /// <summary>Positions between those of two frames.</summary>
    internal static class FrameInterpolation
    {
        /// <summary>
        /// On straight lines. In a periodic box an atom that left it on one side and came back on the other does not
        /// fly through it: it goes on out of the box, and is on the other side with the second frame.
        /// </summary>
        /// <param name="from">N positions.</param>
        /// <param name="to">N positions.</param>
        /// <param name="weight">0: from, 1: to.</param>
        /// <param name="box">Of the first frame.</param>
        /// <param name="between">Room for N positions.</param>
        public static void Blend(ReadOnlySpan<Vector3> from, ReadOnlySpan<Vector3> to, float weight,
            in PeriodicBox box, Span<Vector3> between)
        {
            if (to.Length != from.Length || between.Length < from.Length)
                throw new ArgumentException($"{from.Length}, {to.Length} and {between.Length} positions don't match");
            for (int i = 0; i < from.Length; ++i)
            {
                Vector3 start = from[i], end = to[i];
                var way = new Vector3(end.x - start.x, end.y - start.y, end.z - start.z);
                if (box.Exists)
                    way = box.Shortest(way);
                between[i] = new Vector3(
                    start.x + weight * way.x, start.y + weight * way.y, start.z + weight * way.z);
            }
        }
    }
}
