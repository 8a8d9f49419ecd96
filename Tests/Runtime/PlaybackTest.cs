// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System.Collections;
using UnityEngine;
using UnityEngine.TestTools;
using UnityEngine.TestTools.Constraints;
using Is = UnityEngine.TestTools.Constraints.Is;

namespace QuickSes.Tests
{
    /// <summary>Positions that change in every frame.</summary>
    internal sealed class PlaybackTest
    {
        private SurfaceRig _rig;

        [TearDown]
        public void TearDown() => _rig?.Dispose();

        [UnityTest]
        public IEnumerator TheSameRadiiMeanTheSameMolecule()
        {
            TestMolecules.Blob(50, 3, out Vector3[] positions, out float[] radii);
            _rig = new SurfaceRig();
            _rig.Surface.SetAtoms(positions, radii);
            var colors = new Color32[50];
            for (int i = 0; i < colors.Length; ++i)
                colors[i] = new Color32((byte)i, 0, 0, 255);
            _rig.Surface.SetColors(colors);
            yield return _rig.Settle();
            _rig.Surface.SetAtoms(TestMolecules.Moved(positions, 1), radii);
            yield return _rig.Settle();
            Color32[] shown = _rig.Surface.Mesh.colors32;
            for (int v = 0; v < shown.Length; v += 17)
                Assert.That(shown[v], Is.EqualTo(colors[_rig.Surface.OwnerAtomAt(v)]), "colours stay");
        }

        [UnityTest]
        public IEnumerator FeedingAFrameMakesNoGarbage()
        {
            TestMolecules.Blob(200, 4, out Vector3[] positions, out float[] radii);
            float[] xyz = TestMolecules.Floats(positions);
            var indices = new int[200];
            for (int i = 0; i < indices.Length; ++i)
                indices[i] = 199 - i;
            _rig = new SurfaceRig();
            MolecularSurface surface = _rig.Surface;
            surface.SetAtoms(positions, radii);
            yield return _rig.Settle();
            TestDelegate feed = () =>
            {
                surface.SetPositions(positions);
                surface.SetPositions(xyz);
                surface.SetPositions(positions, indices);
                surface.SetAtoms(positions, radii);
            };
            feed();
            Assert.That(feed, Is.Not.AllocatingGCMemory());
            yield return _rig.Settle();
        }
    }
}
