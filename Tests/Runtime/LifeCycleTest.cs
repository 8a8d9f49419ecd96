// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System.Collections;
using UnityEngine;
using UnityEngine.TestTools;
using Object = UnityEngine.Object;

namespace QuickSes.Tests
{
    /// <summary>What the engine does to a component while it computes.</summary>
    internal sealed class LifeCycleTest
    {
        private SurfaceRig _rig;

        [TearDown]
        public void TearDown() => _rig?.Dispose();

        [UnityTest]
        public IEnumerator ADestroyedSurfaceTakesItsMeshAlong()
        {
            _rig = SurfaceRig.WithBlob(40, 1);
            yield return _rig.Settle();
            MolecularSurface surface = _rig.Surface;
            Mesh mesh = surface.Mesh;
            Assert.That(surface.OwnerAtomAt(0), Is.InRange(0, 39));
            Object.Destroy(_rig.GameObject);
            yield return SurfaceRig.Frames(2);
            Assert.That(mesh == null);
            Assert.Throws<MissingReferenceException>(() => surface.OwnerAtomAt(0));
            Assert.That(SurfaceScheduler.WaitingCount, Is.EqualTo(0));
        }

        [UnityTest]
        public IEnumerator DestroyingDuringAJobEndsIt()
        {
            for (int frames = 0; frames < 6; ++frames)
            {
                _rig = SurfaceRig.WithBlob(1500, 2);
                yield return SurfaceRig.Frames(frames);
                Object.Destroy(_rig.GameObject);
                yield return null;
            }
            _rig = SurfaceRig.WithBlob(10, 3);
            yield return _rig.Settle();
            Assert.That(_rig.Surface.CurrentLevel.IsFinest, "and others go on");
        }

        [UnityTest]
        public IEnumerator ADisabledSurfaceKeepsItsPictureAndGoesOnLater()
        {
            TestMolecules.Blob(300, 4, out Vector3[] positions, out float[] radii);
            _rig = new SurfaceRig();
            _rig.Surface.SetAtoms(positions, radii);
            yield return SurfaceRig.Until(() => _rig.Levels.Count > 0);
            _rig.GameObject.SetActive(false);
            Assert.That(SurfaceScheduler.LentCount, Is.EqualTo(0), "others may have the context");
            int levels = _rig.Levels.Count, vertices = _rig.Surface.Mesh.vertexCount;
            yield return SurfaceRig.Frames(5);
            Assert.That(_rig.Levels.Count, Is.EqualTo(levels));
            Assert.That(_rig.Surface.Mesh.vertexCount, Is.EqualTo(vertices));
            _rig.GameObject.SetActive(true);
            yield return _rig.Settle();
            SurfaceMeshes.AssertShows(_rig.Surface, positions, radii);
        }

        [UnityTest]
        public IEnumerator AtomsMayComeWhileDisabled()
        {
            TestMolecules.Blob(30, 5, out Vector3[] positions, out float[] radii);
            _rig = new SurfaceRig();
            _rig.Surface.enabled = false;
            _rig.Surface.SetAtoms(positions, radii);
            yield return SurfaceRig.Frames(3);
            Assert.That(_rig.Levels, Is.Empty);
            _rig.Surface.enabled = true;
            yield return _rig.Settle();
            SurfaceMeshes.AssertShows(_rig.Surface, positions, radii);
        }

        [Test]
        public void WhatWasNeverEnabledIsComputedInItsColour([Values] bool isSet)
        {
            var hidden = new GameObject("never enabled");
            hidden.SetActive(false);
            var surface = hidden.AddComponent<MolecularSurface>();
            if (isSet)
                surface.BaseColor = new Color32(10, 20, 30, 255);
            surface.Coloring = AtomColoring.Vertices;
            surface.SetAtoms(new[] { Vector3.zero }, new[] { 1.5f });
            Assert.That(surface.ComputeNow());
            Assert.That(surface.Mesh.colors32, Is.Not.Empty.And.All.EqualTo(surface.BaseColor));
            Object.DestroyImmediate(hidden);
        }

        [UnityTest]
        public IEnumerator ListenersMayDestroyTheSurface()
        {
            _rig = SurfaceRig.WithBlob(100, 6);
            GameObject doomed = _rig.GameObject;
            _rig.Surface.SurfaceUpdated += level => Object.DestroyImmediate(doomed);
            yield return SurfaceRig.Until(() => doomed == null);
            yield return SurfaceRig.Frames(3);
            Assert.That(_rig.Levels.Count, Is.EqualTo(1));
        }

        [UnityTest]
        public IEnumerator ListenersMayFeedTheNextFrame()
        {
            TestMolecules.Blob(50, 7, out Vector3[] positions, out float[] radii);
            _rig = new SurfaceRig();
            int frame = 0;
            _rig.Surface.SurfaceUpdated += level =>
            {
                if (++frame < 10)
                    _rig.Surface.SetPositions(TestMolecules.Moved(positions, frame));
            };
            _rig.Surface.SetAtoms(positions, radii);
            yield return SurfaceRig.Until(() => frame >= 10 && !_rig.Surface.IsBusy);
            SurfaceMeshes.AssertShows(_rig.Surface, TestMolecules.Moved(positions, 9), radii);
        }

        [UnityTest]
        public IEnumerator WhatNeverRestsIsNotBusyWithTheLevelThatFits()
        {
            TestMolecules.Blob(300, 10, out Vector3[] positions, out float[] radii);
            _rig = new SurfaceRig();
            _rig.Surface.RestDelay = float.PositiveInfinity;
            _rig.Surface.FrameBudget = 1e-3f; // for the coarsest only
            _rig.Surface.SetAtoms(positions, radii);
            yield return _rig.Settle();
            Assert.That(_rig.Surface.CurrentLevel.IsFinest, "other atoms count as rest");
            int finished = _rig.Finished;
            _rig.Surface.SetPositions(TestMolecules.Moved(positions, 1));
            Assert.That(_rig.Surface.IsBusy);
            yield return _rig.Settle();
            Assert.That(_rig.Surface.CurrentLevel.IsOfNewestAtoms && !_rig.Surface.CurrentLevel.IsFinest);
            Assert.That(_rig.Finished, Is.EqualTo(finished), "it may still be refined");
            _rig.Surface.RestDelay = 0;
            Assert.That(_rig.Surface.IsBusy);
            yield return _rig.Settle();
            Assert.That(_rig.Surface.CurrentLevel.IsFinest);
            Assert.That(_rig.Finished, Is.EqualTo(finished + 1));
        }

        // What was under way when it was disabled is not left coarse.
        [UnityTest]
        public IEnumerator WhatNeverRestsIsFinishedAfterItWasDisabled()
        {
            TestMolecules.Blob(300, 11, out Vector3[] positions, out float[] radii);
            _rig = new SurfaceRig();
            _rig.Surface.RestDelay = float.PositiveInfinity;
            _rig.Surface.SetAtoms(positions, radii);
            yield return SurfaceRig.Until(() => _rig.Levels.Count > 0);
            _rig.Surface.enabled = false;
            _rig.Surface.enabled = true;
            yield return _rig.Settle();
            Assert.That(_rig.Surface.CurrentLevel.IsFinest);
        }

        [UnityTest]
        public IEnumerator ParentAndChildHaveSurfacesOfTheirOwn()
        {
            TestMolecules.Blob(40, 8, out Vector3[] outer, out float[] outerRadii);
            TestMolecules.Blob(60, 9, out Vector3[] inner, out float[] innerRadii);
            _rig = new SurfaceRig("parent");
            using (var child = new SurfaceRig("child", _rig.GameObject.transform))
            {
                _rig.Surface.SetAtoms(outer, outerRadii);
                child.Surface.SetAtoms(inner, innerRadii);
                yield return _rig.Settle();
                yield return child.Settle();
                SurfaceMeshes.AssertShows(_rig.Surface, outer, outerRadii);
                SurfaceMeshes.AssertShows(child.Surface, inner, innerRadii);
                Object.DestroyImmediate(child.GameObject);
                yield return SurfaceRig.Frames(2);
                Assert.That(_rig.Surface.Mesh.vertexCount, Is.GreaterThan(0));
            }
        }
    }
}
