// SPDX-License-Identifier: MIT
using NUnit.Framework;
using UnityEngine;

namespace QuickSes.Tests
{
    /// <summary>Rays against surfaces.</summary>
    internal sealed class PickTest
    {
        private SurfaceRig _rig;

        [TearDown]
        public void TearDown() => _rig?.Dispose();

        [Test]
        public void ARayMeetsTheNearSideOfASphere()
        {
            _rig = new SurfaceRig();
            _rig.Surface.SetAtoms(new[] { new Vector3(1, 2, 3) }, new[] { 2f });
            _rig.Surface.ComputeNow();
            Assert.That(_rig.Surface.TryPick(new Ray(new Vector3(1, 2, -50), Vector3.forward), out int atom,
                out Vector3 point));
            Assert.That(atom, Is.EqualTo(0));
            Assert.That((point - new Vector3(1, 2, 1)).magnitude, Is.LessThan(0.1));
            Assert.That(_rig.Surface.TryPick(new Ray(new Vector3(1, 2, 50), Vector3.forward), out atom, out point),
                Is.False, "it is behind");
            Assert.That(atom, Is.EqualTo(-1));
            Assert.That(_rig.Surface.TryPick(new Ray(new Vector3(4, 2, -50), Vector3.forward), out _, out _), Is.False);
            Assert.That(_rig.Surface.TryPick(new Ray(new Vector3(1, 2, 3), Vector3.up), out _, out point));
            Assert.That((point - new Vector3(1, 4, 3)).magnitude, Is.LessThan(0.1), "from within");
        }

        [Test]
        public void TheTransformIsHeeded()
        {
            _rig = new SurfaceRig();
            _rig.Surface.SetAtoms(new[] { Vector3.zero, new Vector3(10, 0, 0) }, new[] { 2f, 2f });
            _rig.Surface.ComputeNow();
            Transform place = _rig.GameObject.transform;
            place.position = new Vector3(100, 0, 0);
            place.rotation = Quaternion.Euler(0, 0, 90); // x becomes y
            place.localScale = new Vector3(0.1f, 0.1f, 0.1f);
            Assert.That(_rig.Surface.TryPick(new Ray(new Vector3(0, 1, 0), Vector3.right), out int atom,
                out Vector3 point));
            Assert.That(atom, Is.EqualTo(1));
            Assert.That((point - new Vector3(99.8f, 1, 0)).magnitude, Is.LessThan(0.01));
        }

        [Test]
        public void NothingIsThereToBePicked()
        {
            _rig = new SurfaceRig();
            Assert.That(_rig.Surface.TryPick(new Ray(Vector3.zero, Vector3.up), out int atom, out _), Is.False);
            Assert.That(atom, Is.EqualTo(-1));
        }

        [Test]
        public void TheFirstTriangleIsFoundAsByLookingAtAll()
        {
            _rig = SurfaceRig.WithBlob(150, 1);
            _rig.Surface.ComputeNow();
            Vector3[] vertices = _rig.Surface.Mesh.vertices;
            int[] triangles = _rig.Surface.Mesh.triangles;
            Bounds bounds = _rig.Surface.Mesh.bounds;
            var random = new System.Random(2);
            int hits = 0;
            for (int k = 0; k < 200; ++k)
            {
                Vector3 from = Somewhere(bounds, random, 3), to = Somewhere(bounds, random, 1);
                if (k % 10 == 0)
                    to = from + Vector3.right; // a direction with zeros
                var ray = new Ray(from, to - from);
                bool expected = Nearest(vertices, triangles, ray, out double distance, out int corner);
                Assert.That(_rig.Surface.TryPick(ray, out int atom, out Vector3 point), Is.EqualTo(expected));
                if (!expected)
                    continue;
                ++hits;
                Assert.That((point - ray.origin).magnitude, Is.EqualTo(distance).Within(1e-3));
                Assert.That(atom, Is.EqualTo(_rig.Surface.OwnerAtomAt(triangles[corner]))
                    .Or.EqualTo(_rig.Surface.OwnerAtomAt(triangles[corner + 1]))
                    .Or.EqualTo(_rig.Surface.OwnerAtomAt(triangles[corner + 2])));
            }
            Assert.That(hits, Is.GreaterThan(80));
        }

        [Test]
        public void ThePickedAtomIsTheOneOfTheNearestVertexOfItsTriangle()
        {
            _rig = new SurfaceRig();
            _rig.Surface.SetAtoms(new[] { Vector3.zero, new Vector3(1.5f, 0, 0) }, new[] { 1.7f, 1.7f });
            _rig.Surface.ComputeNow();
            for (float x = -1; x <= 2.5f; x += 0.5f)
            {
                Assert.That(_rig.Surface.TryPick(new Ray(new Vector3(x, 0.01f, 9), Vector3.back), out int atom, out _));
                Assert.That(atom, Is.EqualTo(x < 0.75f ? 0 : 1));
            }
        }

        private static Vector3 Somewhere(Bounds bounds, System.Random random, float scale) => bounds.center + scale *
            Vector3.Scale(bounds.extents, new Vector3(Signed(random), Signed(random), Signed(random)));

        private static float Signed(System.Random random) => 2 * (float)random.NextDouble() - 1;

        // In double precision, by the signs of volumes.
        private static bool Nearest(
            Vector3[] vertices, int[] triangles, Ray ray, out double distance, out int firstCorner)
        {
            distance = double.PositiveInfinity;
            firstCorner = -1;
            for (int i = 0; i < triangles.Length; i += 3)
            {
                Vector3 a = vertices[triangles[i]] - ray.origin, b = vertices[triangles[i + 1]] - ray.origin,
                    c = vertices[triangles[i + 2]] - ray.origin;
                double u = Volume(b, c, ray.direction), v = Volume(c, a, ray.direction),
                    w = Volume(a, b, ray.direction);
                bool isInside = (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
                if (!isInside || u + v + w == 0)
                    continue;
                double t = Volume(a, b, c) / (u + v + w);
                if (t < 0 || t >= distance)
                    continue;
                distance = t;
                firstCorner = i;
            }
            return !double.IsPositiveInfinity(distance);
        }

        private static double Volume(Vector3 a, Vector3 b, Vector3 c) =>
            a.x * ((double)b.y * c.z - (double)b.z * c.y) + a.y * ((double)b.z * c.x - (double)b.x * c.z) +
            a.z * ((double)b.x * c.y - (double)b.y * c.x);
    }
}
