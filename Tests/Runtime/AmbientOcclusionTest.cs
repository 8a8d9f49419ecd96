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
            AssertIsThatOf(_positions);
        }

        [UnityTest]
        public IEnumerator FollowsAtomsThatMove()
        {
            _rig.Surface.RestDelay = 1e6f;
            _rig.Surface.SharpCreases = false;
            _rig.Surface.FrameBudget = 0;
            _rig.Surface.SetAtoms(_positions, _radii);
            yield return _rig.Settle();
            for (int frame = 0; frame < 5; ++frame)
            {
                Vector3[] moved = TestMolecules.Moved(_positions, frame);
                _rig.Surface.SetPositions(moved);
                yield return SurfaceRig.Until(() => _rig.Surface.CurrentLevel.IsOfNewestAtoms &&
                    _rig.Surface.CurrentLevel.Spacing == _rig.Surface.Spacing);
                AssertIsThatOf(moved);
            }
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
                AssertIsThatOf(_positions);
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

        // To the bit what the library says, vertex by vertex; and open and closed places are among them.
        private void AssertIsThatOf(Vector3[] positions)
        {
            SurfaceMeshes.AssertShows(_rig.Surface, positions, _radii, !_rig.Surface.CurrentLevel.HasCreases &&
                _rig.Surface.SharpCreases);
            Vector2[] shown = SurfaceMeshes.First(_rig.Surface.Mesh.uv2, _rig.Surface.CurrentLevel.VertexCount);
            float least = 1, most = 0;
            foreach (Vector2 texcoord in shown)
            {
                Assert.That(texcoord.x, Is.InRange(0, 1));
                Assert.That(texcoord.y, Is.EqualTo(1));
                least = Math.Min(least, texcoord.x);
                most = Math.Max(most, texcoord.x);
            }
            Assert.That(least, Is.LessThan(0.5f));
            Assert.That(most, Is.GreaterThan(0.9f));
        }
    }
}
