// SPDX-License-Identifier: MIT
using System;
using UnityEngine;

namespace QuickSes
{
    /// <summary>
    /// Between the coordinates of files, which are right-handed, and Unity's, which are left-handed: x changes its
    /// sign, or molecules would be shown as their mirror images. 1 unit is 1 Å. Any thread; makes no garbage.
    /// </summary>
    public static class UnitySpace
    {
        /// <summary>One position of a file.</summary>
        public static Vector3 FromFile(float x, float y, float z) => new Vector3(-x, y, z);

        /// <summary>All positions of a file.</summary>
        /// <param name="xyz">N x 3, such as <see cref="Structure.Positions"/>.</param>
        /// <param name="positions">Room for N or more.</param>
        public static void FromFile(ReadOnlySpan<float> xyz, Span<Vector3> positions)
        {
            if (xyz.Length % 3 != 0)
                throw new ArgumentException($"has {xyz.Length} numbers, not three per position", nameof(xyz));
            int count = xyz.Length / 3;
            if (positions.Length < count)
                throw new ArgumentException($"has room for {positions.Length} of {count} positions",
                    nameof(positions));
            for (int i = 0; i < count; ++i)
                positions[i] = new Vector3(-xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]);
        }

        /// <summary>Some positions of a file: positions[i] is that of atom indices[i].</summary>
        /// <param name="xyz">M x 3, such as a frame of a <see cref="Trajectory"/>.</param>
        /// <param name="indices">N, each below M, such as <see cref="Structure.FileIndices"/>.</param>
        /// <param name="positions">Room for N or more.</param>
        public static void FromFile(ReadOnlySpan<float> xyz, ReadOnlySpan<uint> indices, Span<Vector3> positions)
        {
            if (xyz.Length % 3 != 0)
                throw new ArgumentException($"has {xyz.Length} numbers, not three per position", nameof(xyz));
            if (positions.Length < indices.Length)
                throw new ArgumentException($"has room for {positions.Length} of {indices.Length} positions",
                    nameof(positions));
            for (int i = 0; i < indices.Length; ++i)
            {
                int first = checked((int)(3 * (long)indices[i]));
                positions[i] = new Vector3(-xyz[first], xyz[first + 1], xyz[first + 2]);
            }
        }

        /// <summary>Back to the coordinates of files.</summary>
        /// <param name="positions">N.</param>
        /// <param name="xyz">Room for N x 3 or more.</param>
        public static void ToFile(ReadOnlySpan<Vector3> positions, Span<float> xyz)
        {
            if (xyz.Length / 3 < positions.Length)
                throw new ArgumentException($"has room for {xyz.Length / 3} of {positions.Length} positions",
                    nameof(xyz));
            for (int i = 0; i < positions.Length; ++i)
            {
                xyz[3 * i] = -positions[i].x;
                xyz[3 * i + 1] = positions[i].y;
                xyz[3 * i + 2] = positions[i].z;
            }
        }
    }
}
