// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System.Collections;
using UnityEngine;
using UnityEngine.TestTools;
using Object = UnityEngine.Object;

namespace QuickSes.Tests
{
    /// <summary>A copy of a surface, as duplicating in the Editor and Instantiate make it, is one of its own.</summary>
    internal sealed class DuplicateTest
    {
        private SurfaceRig _rig;
        private GameObject _copy;

        [TearDown]
        public void TearDown()
        {
            _rig?.Dispose();
            if (_copy != null)
                Object.DestroyImmediate(_copy);
        }

        [UnityTest]
        public IEnumerator ACopyAsksForAtomsOfItsOwn()
        {
            TestMolecules.Blob(60, 1, out Vector3[] positions, out float[] radii);
            TestMolecules.Blob(40, 2, out Vector3[] otherPositions, out float[] otherRadii);
            _rig = new SurfaceRig();
            _rig.Surface.SetAtoms(positions, radii);
            yield return _rig.Settle();

            MolecularSurface copy = Duplicate();
            int requests = 0;
            copy.AtomsRequested += () => ++requests;
            AssertHasMeshOfItsOwn(copy);
            yield return SurfaceRig.Frames(3);
            Assert.That(requests, Is.EqualTo(1));
            Assert.That(_rig.Requests, Is.EqualTo(0), "the original was fed at once, and still has its atoms");
            Assert.That(copy.AtomCount, Is.EqualTo(0));
            Assert.That(copy.Mesh.vertexCount, Is.EqualTo(0));

            int levels = _rig.Levels.Count;
            copy.SetAtoms(otherPositions, otherRadii);
            yield return SurfaceRig.Until(() => !copy.IsBusy);
            Assert.That(_rig.Levels.Count, Is.EqualTo(levels), "listeners are not copied");
            AssertHasMeshOfItsOwn(copy);
            SurfaceMeshes.AssertShows(copy, otherPositions, otherRadii);
            SurfaceMeshes.AssertShows(_rig.Surface, positions, radii);
        }

        [UnityTest]
        public IEnumerator ACopyThatIsSwitchedOffDoesNotShowTheOriginalsMesh()
        {
            _rig = SurfaceRig.WithBlob(40, 6);
            yield return _rig.Settle();
            _rig.Surface.enabled = false;
            AssertHasMeshOfItsOwn(Duplicate());
        }

        [UnityTest]
        public IEnumerator ACopyMadeDuringAJobLeavesItAlone()
        {
            TestMolecules.Blob(500, 3, out Vector3[] positions, out float[] radii);
            for (int frames = 0; frames < 5; ++frames)
            {
                _rig = new SurfaceRig();
                _rig.Surface.SetAtoms(positions, radii);
                yield return SurfaceRig.Frames(frames);
                MolecularSurface copy = Duplicate();
                copy.SetAtoms(positions, radii);
                yield return _rig.Settle();
                yield return SurfaceRig.Until(() => !copy.IsBusy);
                AssertHasMeshOfItsOwn(copy);
                SurfaceMeshes.AssertShows(_rig.Surface, positions, radii);
                SurfaceMeshes.AssertShows(copy, positions, radii);
                TearDown();
            }
        }

        [UnityTest]
        public IEnumerator ACopyReadsItsOwnSource()
        {
            yield return ShowSource();
            MolecularSurface copy = Duplicate();
            Assert.That(copy.Source, Is.Not.SameAs(_rig.Surface.Source));
            Assert.That(copy.Source.Asset, Is.SameAs(_rig.Surface.Source.Asset));
            yield return SurfaceRig.Until(() => copy.AtomCount > 0 && !copy.IsBusy);
            AssertHasMeshOfItsOwn(copy);
            Assert.That(copy.AtomCount, Is.EqualTo(TestFrames.AtomCount - 1));
            Assert.That(copy.Mesh.vertices, Is.EqualTo(_rig.Surface.Mesh.vertices));
            Assert.That(copy.Mesh.triangles, Is.EqualTo(_rig.Surface.Mesh.triangles));

            int triangles = _rig.Surface.Mesh.triangles.Length;
            copy.Source.SkipWater = false;
            Assert.That(_rig.Surface.Source.SkipWater, Is.True);
            Assert.That(copy.LoadSource(), Is.True, copy.LastError.ToString());
            yield return SurfaceRig.Until(() => !copy.IsBusy);
            Assert.That(copy.AtomCount, Is.EqualTo(TestFrames.AtomCount));
            Assert.That(_rig.Surface.AtomCount, Is.EqualTo(TestFrames.AtomCount - 1));
            Assert.That(_rig.Surface.Mesh.triangles.Length, Is.EqualTo(triangles));
            Assert.That(_rig.Surface.IsBusy, Is.False);
        }

        [UnityTest]
        public IEnumerator ChangesOfOneDontShowInTheOther()
        {
            yield return ShowSource();
            _rig.Surface.ProbeRadius = 2;
            _rig.Surface.Levels = new[] { 3f };
            MolecularSurface copy = Duplicate();
            Assert.That(copy.ProbeRadius, Is.EqualTo(2));
            Assert.That(copy.Levels, Is.EqualTo(new[] { 3f }));
            yield return SurfaceRig.Until(() => copy.AtomCount > 0 && !copy.IsBusy && !_rig.Surface.IsBusy);

            int vertices = copy.Mesh.vertexCount;
            _rig.Surface.Spacing = 0.25f;
            _rig.Surface.SetColors(new Color32[TestFrames.AtomCount - 1]);
            yield return _rig.Settle();
            Assert.That(_rig.Surface.Mesh.vertexCount, Is.GreaterThan(2 * vertices));
            Assert.That(_rig.Surface.Mesh.colors32, Has.All.EqualTo(default(Color32)));
            Assert.That(copy.Spacing, Is.EqualTo(0.5f));
            Assert.That(copy.Mesh.vertexCount, Is.EqualTo(vertices));
            Assert.That(copy.Mesh.colors32, Has.None.EqualTo(default(Color32)));

            copy.Levels = new[] { 2f, 1 };
            copy.ClearAtoms();
            yield return SurfaceRig.Frames(3);
            Assert.That(_rig.Surface.Levels, Is.EqualTo(new[] { 3f }));
            Assert.That(_rig.Surface.Mesh.vertexCount, Is.GreaterThan(2 * vertices));
            Assert.That(_rig.Surface.AtomCount, Is.EqualTo(TestFrames.AtomCount - 1));
        }

        [UnityTest]
        public IEnumerator DestroyingOneLeavesTheOtherItsMesh()
        {
            for (int turn = 0; turn < 2; ++turn)
            {
                yield return ShowSource();
                MolecularSurface copy = Duplicate();
                yield return SurfaceRig.Until(() => copy.AtomCount > 0 && !copy.IsBusy);
                MolecularSurface stays = turn == 0 ? copy : _rig.Surface, goes = turn == 0 ? _rig.Surface : copy;
                Mesh mesh = stays.Mesh, gone = goes.Mesh;
                int vertices = mesh.vertexCount;
                Object.Destroy(goes.gameObject);
                yield return SurfaceRig.Frames(2);
                Assert.That(gone == null);
                Assert.That(mesh != null);
                Assert.That(stays.GetComponent<MeshFilter>().sharedMesh, Is.SameAs(mesh));
                Assert.That(mesh.vertexCount, Is.EqualTo(vertices));
                stays.Recompute();
                yield return SurfaceRig.Until(() => !stays.IsBusy);
                Assert.That(mesh.vertexCount, Is.EqualTo(vertices));
                Object.DestroyImmediate(stays.gameObject);
                Assert.That(mesh == null);
            }
        }

        [UnityTest]
        public IEnumerator ACopyOfAnInactiveSurfaceBeginsWhenItIsActivated()
        {
            yield return ShowSource();
            _rig.GameObject.SetActive(false);
            MolecularSurface copy = Duplicate();
            yield return SurfaceRig.Frames(2);
            copy.gameObject.SetActive(true);
            AssertHasMeshOfItsOwn(copy);
            yield return SurfaceRig.Until(() => copy.AtomCount > 0 && !copy.IsBusy);
            AssertHasMeshOfItsOwn(copy);
            Assert.That(copy.Mesh.vertices, Is.EqualTo(_rig.Surface.Mesh.vertices));
        }

        private IEnumerator ShowSource()
        {
            _rig = new SurfaceRig();
            _rig.Surface.Source.SetAsset(new TextAsset(TestFrames.Pdb(1)) { name = "small.pdb" });
            Assert.That(_rig.Surface.LoadSource(), Is.True, _rig.Surface.LastError.ToString());
            yield return _rig.Settle();
            Assert.That(_rig.Surface.Mesh.vertexCount, Is.GreaterThan(0));
        }

        private MolecularSurface Duplicate()
        {
            _copy = Object.Instantiate(_rig.GameObject);
            return _copy.GetComponent<MolecularSurface>();
        }

        private void AssertHasMeshOfItsOwn(MolecularSurface copy)
        {
            Assert.That(copy.Mesh, Is.Not.SameAs(_rig.Surface.Mesh));
            Assert.That(copy.GetComponent<MeshFilter>().sharedMesh, Is.SameAs(copy.Mesh));
            Assert.That(_rig.GameObject.GetComponent<MeshFilter>().sharedMesh, Is.SameAs(_rig.Surface.Mesh));
        }
    }
}
