// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections;
using UnityEngine;
using UnityEngine.Rendering;
using UnityEngine.TestTools;

namespace QuickSes.Tests
{
    /// <summary>Surfaces are darker where they are closed in, whether atoms rest or move, unless somebody does not want that.</summary>
    internal sealed class AmbientOcclusionTest
    {
        private const int Atoms = 200;

        private SurfaceRig _rig;
        private Vector3[] _positions;
        private float[] _radii;

        [SetUp]
        public void SetUp()
        {
            TestMolecules.Blob(Atoms, 3, out _positions, out _radii);
            _rig = new SurfaceRig();
        }

        [TearDown]
        public void TearDown() => _rig.Dispose();

        [UnityTest]
        public IEnumerator IsThereByDefault([Values] SurfaceKind kind, [Values] bool isCompact)
        {
            _rig.Surface.Surface = kind;
            _rig.Surface.CompactVertices = isCompact;
            _rig.Surface.SetAtoms(_positions, _radii);
            yield return _rig.Settle();
            if (!isCompact) // whose normals are others in the engine than in the library
                SurfaceMeshes.AssertShows(_rig.Surface, _positions, _radii);
            AssertIsInRange(kind == SurfaceKind.Gaussian ? 0.95f : 0.5f); // which is smooth
        }

        [UnityTest]
        public IEnumerator FollowsAtomsThatMove()
        {
            _rig.Surface.RestDelay = 1e6f;
            _rig.Surface.SharpCreases = false;
            _rig.Surface.FrameBudget = 0;
            _rig.Surface.SetAtoms(_positions, _radii);
            yield return _rig.Settle();
            Vector3[] moved = null;
            for (int frame = 0; frame < 5; ++frame)
            {
                moved = TestMolecules.Moved(_positions, frame);
                int shown = _rig.Levels.Count;
                _rig.Surface.SetPositions(moved);
                yield return SurfaceRig.Until(() => _rig.Levels.Count > shown);
                AssertIsInRange(0.5f);
            }
            _rig.Surface.RestDelay = 0;
            yield return _rig.Settle();
            SurfaceMeshes.AssertShows(_rig.Surface, moved, _radii);
            AssertIsInRange(0.5f);
        }

        [UnityTest]
        public IEnumerator GoesAndComes()
        {
            _rig.Surface.SetAtoms(_positions, _radii);
            for (int round = 0; round < 2; ++round)
            {
                _rig.Surface.AmbientOcclusion = false;
                yield return _rig.Settle();
                Assert.That(_rig.Surface.Mesh.HasVertexAttribute(VertexAttribute.TexCoord1), Is.False);
                SurfaceMeshes.AssertShows(_rig.Surface, _positions, _radii);
                _rig.Surface.AmbientOcclusion = true;
                yield return _rig.Settle();
                SurfaceMeshes.AssertShows(_rig.Surface, _positions, _radii);
                AssertIsInRange(0.5f);
            }
        }

        [UnityTest]
        public IEnumerator IsBakedWithTheMesh()
        {
            _rig.Surface.SetAtoms(_positions, _radii);
            yield return _rig.Settle();
            var copy = new Mesh();
            _rig.Surface.CopyTo(copy);
            Assert.That(copy.uv2, Is.EqualTo(_rig.Surface.Mesh.uv2));
            UnityEngine.Object.DestroyImmediate(copy);
        }

        // Open and closed places are among them, the latter at most so open.
        private void AssertIsInRange(float darkest)
        {
            Vector2[] shown = SurfaceMeshes.First(_rig.Surface.Mesh.uv2, _rig.Surface.CurrentLevel.VertexCount);
            float least = 1, most = 0;
            foreach (Vector2 texcoord in shown)
            {
                Assert.That(texcoord.x, Is.InRange(0, 1));
                Assert.That(texcoord.y, Is.EqualTo(1));
                least = Math.Min(least, texcoord.x);
                most = Math.Max(most, texcoord.x);
            }
            Assert.That(least, Is.LessThan(darkest));
            Assert.That(most, Is.GreaterThan(0.9f));
        }
    }
}
