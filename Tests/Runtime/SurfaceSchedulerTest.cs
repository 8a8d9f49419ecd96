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

        [UnityTest]
        public IEnumerator EverybodySeesSomethingBeforeAnybodySeesTheFinest()
        {
            for (int k = 0; k < 40; ++k)
                _rigs.Add(SurfaceRig.WithBlob(200, k));
            int shown = 0, finest = 0;
            yield return SurfaceRig.Until(() =>
            {
                shown = finest = 0;
                foreach (SurfaceRig rig in _rigs)
                {
                    shown += rig.Surface.CurrentLevel.LevelCount > 0 ? 1 : 0;
                    finest += rig.Surface.CurrentLevel.IsFinest && rig.Surface.CurrentLevel.LevelCount > 0 ? 1 : 0;
                }
                return shown == _rigs.Count;
            });
            // The last few in the queue find nobody behind them, and rested ones have their turn now and then.
            Assert.That(finest, Is.LessThan(_rigs.Count / 2));
            yield return SurfaceRig.Until(AreUpToDate);
        }

        [UnityTest]
        public IEnumerator AContextIsFreedWithTheLastSurface()
        {
            _rigs.Add(SurfaceRig.WithBlob(20, 1));
            yield return SurfaceRig.Until(AreUpToDate);
            Assert.That(SurfaceScheduler.ContextCount, Is.GreaterThan(0));
            _rigs[0].GameObject.SetActive(false);
            Assert.That(SurfaceScheduler.ContextCount, Is.GreaterThan(0), "it may be shown again");
            _rigs[0].Dispose();
            Assert.That(SurfaceScheduler.ContextCount, Is.EqualTo(0));
            yield return SurfaceRig.Until(() => ContextSlot.NativeContexts == 0);
        }

        [UnityTest]
        public IEnumerator FreeingTheLastContextIsWaitedForWhereItMust()
        {
            _rigs.Add(SurfaceRig.WithBlob(20000, 1));
            yield return SurfaceRig.Until(() => _rigs[0].Levels.Count > 0);
            _rigs[0].Dispose(); // in the background
            SurfaceScheduler.ReleaseContexts();
            Assert.That(ContextSlot.NativeContexts, Is.EqualTo(0), "native threads must not outlive the domain");
        }

        [UnityTest]
        public IEnumerator ContextsOfTheDeadAreUsedAgain()
        {
            _rigs.Add(new SurfaceRig()); // has no atoms
            for (int k = 0; k < 6; ++k)
                using (SurfaceRig rig = SurfaceRig.WithBlob(30, k))
                    yield return rig.Settle();
            Assert.That(SurfaceScheduler.ContextCount, Is.EqualTo(1));
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
        public void AtLeastOneContextIsNeeded() =>
            Assert.Throws<ArgumentOutOfRangeException>(() => SurfaceScheduler.MaxContexts = 0);

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
                SurfaceMeshes.AssertIsSurfaceOf(surface.Mesh, positions[k], radii[k], 0.5f, surface.OwnerAtomAt);
                Assert.That(_rigs[k].Failures, Is.Empty);
            }
        }
    }
}
