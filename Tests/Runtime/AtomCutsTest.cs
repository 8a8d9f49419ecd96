// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using UnityEngine;
using UnityEngine.TestTools.Constraints;
using Is = UnityEngine.TestTools.Constraints.Is;

namespace QuickSes.Tests
{
    /// <summary>Cuts are what a comparison of everything with everything says.</summary>
    internal sealed class AtomCutsTest
    {
        private readonly AtomCuts _cuts = new AtomCuts();

        [TestCase(1, 1, 0f, 1f)]
        [TestCase(50, 5, 3f, 1f)]
        [TestCase(2000, 1, 5f, 1f)]
        [TestCase(2000, 40, 4f, 1f)]
        [TestCase(2000, 1000, 1.5f, 1f)]
        [TestCase(2000, 2000, 2f, 1f)]
        [TestCase(2000, 300, 0f, 1f)]
        [TestCase(2000, 300, 0.01f, 1f)]
        [TestCase(2000, 300, 1e6f, 1f)]
        [TestCase(2000, 300, 3e38f, 1f)]
        [TestCase(1000, 30, 4f, 1e4f)]
        [TestCase(1000, 0, 4f, 1f)]
        public void Within(int count, int chosenCount, float distance, float spread)
        {
            Vector3[] positions = Positions(count, 17 * count + chosenCount, spread);
            var atoms = new bool[count];
            for (int k = 0; k < chosenCount; ++k)
                atoms[(int)(k * (long)count / chosenCount)] = true;
            var expected = new bool[count];
            int expectedCount = 0;
            for (int i = 0; i < count; ++i)
            {
                for (int k = 0; k < count && !expected[i]; ++k)
                    expected[i] = atoms[k] && IsWithin(positions[i], positions[k], distance);
                expectedCount += expected[i] ? 1 : 0;
            }
            var chosen = new bool[count];
            Assert.That(_cuts.Within(positions, atoms, distance, chosen), Is.EqualTo(expectedCount));
            Assert.That(chosen, Is.EqualTo(expected));
            if (chosenCount > 0)
                Assert.That(expectedCount, Is.GreaterThanOrEqualTo(chosenCount));
            Assert.That(_cuts.Within(positions, atoms, distance, atoms), Is.EqualTo(expectedCount), "in place");
            Assert.That(atoms, Is.EqualTo(expected));
        }

        [Test]
        public void InAPlaneAndOnALine()
        {
            Vector3[] positions = Positions(500, 3, 1);
            foreach (Vector3 scale in new[] { new Vector3(1, 1, 0), new Vector3(0, 0, 1), new Vector3(0, 0, 0) })
            {
                var points = new Vector3[20];
                for (int k = 0; k < points.Length; ++k)
                    points[k] = Vector3.Scale(positions[k], scale);
                var chosen = new bool[positions.Length];
                _cuts.Within(positions, points, 4, chosen);
                for (int i = 0; i < positions.Length; ++i)
                    Assert.That(chosen[i],
                        Is.EqualTo(Array.Exists(points, point => IsWithin(positions[i], point, 4))));
            }
        }

        [Test]
        public void WhatIsNoNumberIsNowhere()
        {
            Vector3[] positions = Positions(100, 5, 1);
            positions[7].x = float.NaN;
            positions[8].y = float.PositiveInfinity;
            positions[10].z = float.NaN;
            var atoms = new bool[100];
            var chosen = new bool[100];
            atoms[7] = atoms[8] = atoms[10] = true;
            Assert.That(_cuts.Within(positions, atoms, 5, chosen), Is.EqualTo(0));
            atoms[9] = true;
            Assert.That(_cuts.Within(positions, atoms, 1e9f, chosen), Is.EqualTo(97));
            Assert.That(chosen[7] || chosen[8] || chosen[10], Is.False);
            foreach (float wrong in new[] { -1, float.NaN, float.PositiveInfinity })
                Assert.That(() => _cuts.Within(positions, atoms, wrong, chosen),
                    Throws.TypeOf<ArgumentOutOfRangeException>());
            Assert.That(() => _cuts.Within(positions, atoms, 1, new bool[99]), Throws.ArgumentException);
            Assert.That(() => _cuts.Within(positions, new bool[101], 1, chosen), Throws.ArgumentException);
        }

        [Test]
        public void InFrontOfAPlane()
        {
            Vector3[] positions = Positions(300, 8, 1);
            var plane = new Plane(new Vector3(1, -2, 0.5f), new Vector3(3, 1, 2));
            var chosen = new bool[300];
            int count = AtomCuts.InFrontOf(positions, plane, chosen);
            Assert.That(count, Is.InRange(10, 290));
            for (int i = 0; i < 300; ++i)
                Assert.That(chosen[i], Is.EqualTo(plane.GetSide(positions[i])));

            Matrix4x4 toWorld = Matrix4x4.TRS(new Vector3(2, 5, -1), Quaternion.Euler(20, 50, 70), new Vector3(2, 0.5f, -1));
            var world = new Plane(new Vector3(-1, 1, 2), toWorld.MultiplyPoint3x4(positions[0]));
            count = AtomCuts.InFrontOf(positions, world, toWorld, chosen);
            int expected = 0;
            for (int i = 1; i < 300; ++i) // the first lies in the plane
            {
                float distance = world.GetDistanceToPoint(toWorld.MultiplyPoint3x4(positions[i]));
                if (Math.Abs(distance) > 1e-3f)
                    Assert.That(chosen[i], Is.EqualTo(distance > 0));
                expected += distance > 0 ? 1 : 0;
            }
            Assert.That(count, Is.EqualTo(expected).Within(2).And.InRange(10, 290));
        }

        [Test]
        public void Residues()
        {
            uint[] residues = { 0, 0, 1, 2, 2, 2 };
            var chosen = new[] { false, true, false, false, false, true };
            Assert.That(AtomCuts.CompleteResidues(residues, chosen), Is.EqualTo(5));
            Assert.That(chosen, Is.EqualTo(new[] { true, true, false, true, true, true }));
            Assert.That(AtomCuts.CompleteResidues(residues, new bool[6]), Is.EqualTo(0));
            Assert.That(() => AtomCuts.CompleteResidues(residues, new bool[5]), Throws.ArgumentException);
        }

        [Test]
        public void CutsMakeNoGarbage()
        {
            Vector3[] positions = Positions(3000, 9, 1);
            var atoms = new bool[3000];
            var chosen = new bool[3000];
            for (int i = 0; i < 200; ++i)
                atoms[i] = true;
            var plane = new Plane(new Vector3(0, 1, 0), 0);
            void Cut()
            {
                for (int k = 0; k < 20; ++k)
                {
                    _cuts.Within(positions, atoms, 2 + 0.2f * k, chosen);
                    AtomCuts.InFrontOf(positions, plane, chosen);
                }
            }
            Cut(); // memory grows, and code is compiled
            Assert.That(Cut, Is.Not.AllocatingGCMemory());
        }

        private static bool IsWithin(Vector3 a, Vector3 b, float distance)
        {
            float x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
            return x * x + y * y + z * z <= distance * distance;
        }

        // About as dense as a protein.
        private static Vector3[] Positions(int count, int seed, float spread)
        {
            var random = new System.Random(seed);
            double edge = Math.Pow(10.0 * count, 1.0 / 3) * spread;
            var positions = new Vector3[count];
            for (int i = 0; i < count; ++i)
                positions[i] = new Vector3((float)(edge * random.NextDouble()), (float)(edge * random.NextDouble()),
                    (float)(edge * random.NextDouble()));
            return positions;
        }
    }
}
