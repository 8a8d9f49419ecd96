// SPDX-License-Identifier: MIT
using System;
using UnityEngine;

namespace QuickSes.Tests
{
    /// <summary>Small molecules, made of numbers that are the same in every run.</summary>
    internal static class TestMolecules
    {
        /// <summary>Of a number; those of numbers that are near each other do not begin alike.</summary>
        public static System.Random RandomOf(int number) => new System.Random(unchecked(number * 1640531527));

        /// <summary>Atoms at random in a cube of such an edge that they overlap as those of a protein do.</summary>
        public static void Blob(int count, int seed, out Vector3[] positions, out float[] radii)
        {
            var random = new System.Random(seed);
            float edge = 2.2f * Mathf.Pow(count, 1f / 3);
            positions = new Vector3[count];
            radii = new float[count];
            for (int i = 0; i < count; ++i)
            {
                positions[i] = new Vector3(Number(random, edge), Number(random, edge), Number(random, edge));
                radii[i] = 1.2f + Number(random, 0.6f);
            }
        }

        /// <summary>The same atoms a little later.</summary>
        public static Vector3[] Moved(Vector3[] positions, int seed, float distance = 0.3f)
        {
            var random = new System.Random(seed);
            var moved = new Vector3[positions.Length];
            for (int i = 0; i < moved.Length; ++i)
                moved[i] = positions[i] + new Vector3(
                    Number(random, distance), Number(random, distance), Number(random, distance));
            return moved;
        }

        public static float[] Floats(Vector3[] vectors)
        {
            var numbers = new float[3 * vectors.Length];
            for (int i = 0; i < vectors.Length; ++i)
                for (int k = 0; k < 3; ++k)
                    numbers[3 * i + k] = vectors[i][k];
            return numbers;
        }

        private static float Number(System.Random random, float below) => (float)random.NextDouble() * below;
    }
}
