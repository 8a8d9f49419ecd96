// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections;
using System.Collections.Generic;
using UnityEngine;
using UnityEngine.TestTools;
using Object = UnityEngine.Object;

namespace QuickSes.Tests
{
    /// <summary>Many surfaces, few contexts.</summary>
    internal sealed class SurfaceSchedulerTest
    {
        private const int Surfaces = 300;

        private readonly List<SurfaceRig> _rigs = new List<SurfaceRig>();

        [TearDown]
        public void TearDown()
        {
            foreach (SurfaceRig rig in _rigs)
                rig.Dispose();
            _rigs.Clear();
        }

        [UnityTest]
        public IEnumerator HundredsOfSurfacesShowTheirOwnAtoms()
        {
            var positions = new Vector3[Surfaces][];
            var radii = new float[Surfaces][];
            for (int k = 0; k < Surfaces; ++k)
            {
                TestMolecules.Blob(1 + k % 23, k, out positions[k], out radii[k]);
                var rig = new SurfaceRig("surface " + k);
                rig.Surface.SetAtoms(positions[k], radii[k]);
                _rigs.Add(rig);
            }
            int most = 0;
            yield return SurfaceRig.Until(() =>
            {
                most = Math.Max(most, SurfaceScheduler.ContextCount);
                return AreUpToDate();
            });
            AssertEachIsItsOwn(positions, radii);

            // All of them move, some vanish, and all they show is the last of it.
            for (int frame = 0; frame < 10; ++frame)
            {
                for (int k = 0; k < Surfaces; ++k)
                {
                    positions[k] = TestMolecules.Moved(positions[k], frame * Surfaces + k);
                    _rigs[k].Surface.SetPositions(positions[k]);
                }
                if (frame == 5)
                    for (int k = 0; k < Surfaces; k += 10)
                        _rigs[k].GameObject.SetActive(false);
                yield return null;
            }
            for (int k = 0; k < Surfaces; k += 10)
                _rigs[k].GameObject.SetActive(true);
            yield return SurfaceRig.Until(AreUpToDate);
            AssertEachIsItsOwn(positions, radii);
            Assert.That(most, Is.InRange(1, SurfaceScheduler.MaxContexts));
        }

        [Test]
        public void ASurfaceThatWasNeverEnabledLeavesNothing()
        {
            TestMolecules.Blob(40, 1, out Vector3[] positions, out float[] radii);
            var hidden = new GameObject("never enabled");
            hidden.SetActive(false);
            var surface = hidden.AddComponent<MolecularSurface>();
            surface.SetAtoms(positions, radii);
            Assert.That(surface.ComputeNow());
            Mesh mesh = surface.Mesh;
            Object.DestroyImmediate(hidden);
            SurfaceScheduler.ReleaseContexts();
            Assert.That(mesh == null);
            Assert.That(ContextSlot.NativeContexts, Is.EqualTo(0));
        }

        [Test]
        public void APrefabThatIsSetUpByAScriptHoldsNoContexts()
        {
            SurfaceScheduler.ReleaseContexts(); // those of other tests too, with what never was enabled
            TestMolecules.Blob(40, 1, out Vector3[] positions, out float[] radii);
            var prefab = new GameObject("prefab"); // as in a file: nothing of it ever ran
            prefab.SetActive(false);
            var original = prefab.AddComponent<MolecularSurface>();
            original.Spacing = 1;
            original.Levels = new[] { 3f };
            original.BaseColor = Color.red;
            GameObject instance = Object.Instantiate(prefab);
            instance.SetActive(true);
            var surface = instance.GetComponent<MolecularSurface>();
            surface.SetAtoms(positions, radii);
            Assert.That(surface.ComputeNow());
            Assert.That(surface.CurrentLevel.Spacing, Is.EqualTo(1));
            Assert.That(SurfaceScheduler.ContextCount, Is.GreaterThan(0));
            Object.DestroyImmediate(instance);
            Assert.That(SurfaceScheduler.ContextCount, Is.EqualTo(0));
            Object.DestroyImmediate(prefab);
        }

        private bool AreUpToDate()
        {
            foreach (SurfaceRig rig in _rigs)
                if (rig.Surface.IsBusy)
                    return false;
            return true;
        }

        private void AssertEachIsItsOwn(Vector3[][] positions, float[][] radii)
        {
            for (int k = 0; k < _rigs.Count; ++k)
            {
                MolecularSurface surface = _rigs[k].Surface;
                SurfaceMeshes.AssertShows(surface, positions[k], radii[k]);
                Assert.That(_rigs[k].Failures, Is.Empty);
            }
        }
    }
}
