// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections;
using UnityEngine;
using UnityEngine.Rendering;
using UnityEngine.TestTools;
using Object = UnityEngine.Object;

namespace QuickSes.Tests
{
    /// <summary>Atoms go in, the surface that is theirs comes out, level after level.</summary>
    internal sealed class MolecularSurfaceTest
    {
        private SurfaceRig _rig;

        [TearDown]
        public void TearDown() => _rig?.Dispose();

        [UnityTest]
        public IEnumerator AtomsAreRequestedUntilThereAreSome()
        {
            _rig = new SurfaceRig();
            yield return SurfaceRig.Frames(3);
            Assert.That(_rig.Requests, Is.EqualTo(1));
            Assert.That(_rig.Surface.IsBusy, Is.False);
            Assert.That(_rig.Surface.CurrentLevel.LevelCount, Is.EqualTo(0));

            int late = 0;
            _rig.Surface.AtomsRequested += () => ++late;
            yield return SurfaceRig.Frames(2);
            Assert.That(late, Is.EqualTo(1), "late listeners hear it as well");

            _rig.Surface.SetAtoms(new[] { Vector3.zero }, new[] { 1.5f });
            _rig.Surface.AtomsRequested += () => ++late;
            yield return SurfaceRig.Frames(2);
            Assert.That(late, Is.EqualTo(1), "there are atoms now");
        }

        [UnityTest]
        public IEnumerator TheSurfaceOfOneAtomIsItsSphere()
        {
            var centre = new Vector3(3, -4, 5);
            _rig = new SurfaceRig();
            _rig.Surface.SetAtoms(new[] { centre }, new[] { 1.7f });
            yield return _rig.Settle();
            Mesh mesh = _rig.Surface.Mesh;
            Assert.That(SurfaceMeshes.IsClosed(mesh, _rig.Surface));
            Vector3[] vertices = mesh.vertices, normals = mesh.normals;
            for (int v = 0; v < vertices.Length; ++v)
            {
                Assert.That((vertices[v] - centre).magnitude, Is.EqualTo(1.7f).Within(1e-4));
                Assert.That(Vector3.Dot(normals[v], (vertices[v] - centre).normalized), Is.GreaterThan(0.9999));
                Assert.That(_rig.Surface.OwnerAtomAt(v), Is.EqualTo(0));
            }
            Assert.That((mesh.bounds.center - centre).magnitude, Is.LessThan(0.05));
            Assert.That(mesh.bounds.extents.x, Is.EqualTo(1.7f).Within(0.05));
            Assert.That(_rig.Surface.Area, Is.EqualTo(4 * Math.PI * 1.7 * 1.7).Within(5).Percent);
            Assert.That(_rig.Surface.Volume, Is.EqualTo(4 / 3.0 * Math.PI * Math.Pow(1.7, 3)).Within(5).Percent);
        }

        [Test]
        public void NothingIsKnownOfASurfaceThatWasCleared()
        {
            _rig = SurfaceRig.WithBlob(40, 1);
            Assert.That(_rig.Surface.ComputeNow(), Is.True);
            Assert.That(_rig.Surface.OwnerAtomAt(0), Is.InRange(0, 39));
            _rig.Surface.ClearAtoms();
            Assert.Throws<ArgumentOutOfRangeException>(() => _rig.Surface.OwnerAtomAt(0));
            Assert.That(_rig.Surface.Owners.Length + _rig.Surface.AtomCount, Is.Zero);
            Assert.That((_rig.Surface.Area, _rig.Surface.Volume), Is.EqualTo((0.0, 0.0)));
            Assert.That(_rig.Surface.UsedDelivery, Is.EqualTo(SurfaceDelivery.Auto));
        }

        [UnityTest]
        public IEnumerator LevelsComeFromCoarseToFine()
        {
            _rig = SurfaceRig.WithBlob(60, 1);
            yield return _rig.Settle();
            Assert.That(_rig.Levels.Count, Is.InRange(1, 3), "some may be passed over");
            for (int k = 1; k < _rig.Levels.Count; ++k)
                Assert.That(_rig.Levels[k].Spacing, Is.LessThan(_rig.Levels[k - 1].Spacing));
            SurfaceLevel last = _rig.Levels[_rig.Levels.Count - 1];
            Assert.That(last.Spacing, Is.EqualTo(0.5f));
            Assert.That(last.IsFinest && last.IsOfNewestAtoms);
            Assert.That(last.Level, Is.EqualTo(2));
            Assert.That(last.LevelCount, Is.EqualTo(3));
            Assert.That(last.VertexCount, Is.EqualTo(_rig.Surface.Mesh.vertexCount));
            Assert.That(_rig.Finished, Is.EqualTo(1));
            Assert.That(_rig.Failures, Is.Empty);
        }

        [UnityTest]
        public IEnumerator TheMeshIsWhatTheLibraryComputes()
        {
            TestMolecules.Blob(80, 2, out Vector3[] positions, out float[] radii);
            _rig = new SurfaceRig();
            _rig.Surface.SetAtoms(positions, radii);
            yield return _rig.Settle();
            Mesh mesh = _rig.Surface.Mesh;
            SurfaceMeshes.AssertShows(_rig.Surface, positions, radii);
            Assert.That(SurfaceMeshes.IsClosed(mesh, _rig.Surface));
            Assert.That(SurfaceMeshes.SignedVolume(mesh), Is.EqualTo(_rig.Surface.Volume).Within(2).Percent,
                "front faces are outside");
            Assert.That(mesh.indexFormat, Is.EqualTo(IndexFormat.UInt32));
            Assert.That(mesh.isReadable);
            Assert.That(_rig.GameObject.GetComponent<MeshFilter>().sharedMesh, Is.SameAs(mesh));
            Assert.That(mesh.hideFlags & HideFlags.DontSave, Is.EqualTo(HideFlags.DontSave), "scenes don't save it");
        }

        [UnityTest]
        public IEnumerator FramesGoIntoTheMesh()
        {
            TestMolecules.Blob(50, 3, out Vector3[] positions, out float[] radii);
            _rig = new SurfaceRig();
            _rig.Surface.SetAtoms(positions, radii);
            yield return _rig.Settle();
            for (int frame = 0; frame < 20; ++frame)
            {
                positions = TestMolecules.Moved(positions, frame);
                _rig.Surface.SetPositions(positions);
                yield return null;
            }
            yield return _rig.Settle();
            Assert.That(_rig.GameObject.GetComponent<MeshFilter>().sharedMesh, Is.SameAs(_rig.Surface.Mesh));
            SurfaceMeshes.AssertShows(_rig.Surface, positions, radii);
            Assert.That(_rig.Failures, Is.Empty);
        }

        [UnityTest]
        public IEnumerator PositionsArePickedByAnIndexList()
        {
            TestMolecules.Blob(40, 4, out Vector3[] all, out float[] allRadii);
            var indices = new[] { 31, 2, 17, 39, 0, 8 };
            var picked = new Vector3[indices.Length];
            var radii = new float[indices.Length];
            for (int i = 0; i < indices.Length; ++i)
            {
                picked[i] = all[indices[i]];
                radii[i] = allRadii[indices[i]];
            }
            _rig = new SurfaceRig();
            _rig.Surface.SetAtoms(new Vector3[indices.Length], radii);
            _rig.Surface.SetPositions(all, indices);
            yield return _rig.Settle();
            SurfaceMeshes.AssertShows(_rig.Surface, picked, radii);
        }

        [Test]
        public void PositionsMayBePickedOutOfItsOwn()
        {
            TestMolecules.Blob(3, 4, out Vector3[] positions, out float[] radii);
            _rig = new SurfaceRig();
            _rig.Surface.SetAtoms(positions, radii);
            _rig.Surface.SetPositions(_rig.Surface.Positions, new[] { 1, 2, 0 });
            Assert.That(_rig.Surface.Positions.ToArray(),
                Is.EqualTo(new[] { positions[1], positions[2], positions[0] }));
        }

        [UnityTest]
        public IEnumerator ColoursDontMakeALevelCoarser()
        {
            _rig = SurfaceRig.WithBlob(3000, 15);
            yield return SurfaceRig.Until(() => _rig.Levels.Count >= 2 || !_rig.Surface.IsBusy);
            _rig.Surface.SetColors(new Color32[3000]);
            yield return _rig.Settle();
            for (int k = 1; k < _rig.Levels.Count; ++k)
                Assert.That(_rig.Levels[k].Spacing, Is.LessThanOrEqualTo(_rig.Levels[k - 1].Spacing));
        }

        [UnityTest]
        public IEnumerator TextureCoordinatesAreThoseOfTheAtoms()
        {
            _rig = SurfaceRig.WithBlob(20, 7);
            var texcoords = new Vector2[20];
            for (int i = 0; i < texcoords.Length; ++i)
                texcoords[i] = new Vector2(i, -i);
            _rig.Surface.SetTexcoords(texcoords);
            yield return _rig.Settle();
            Mesh mesh = _rig.Surface.Mesh;
            Assert.That(mesh.HasVertexAttribute(VertexAttribute.TexCoord1));
            Vector2[] shown = mesh.uv2;
            for (int v = 0; v < shown.Length; ++v)
                Assert.That(shown[v], Is.EqualTo(texcoords[_rig.Surface.OwnerAtomAt(v)]));
        }

        [UnityTest]
        public IEnumerator ComponentsOfTheSurfaceAreMeasured()
        {
            _rig = new SurfaceRig();
            _rig.Surface.MeasureComponents = true;
            _rig.Surface.SetAtoms(new[] { Vector3.zero, new Vector3(30, 0, 0) }, new[] { 1.5f, 3f });
            yield return _rig.Settle();
            Assert.That(_rig.Surface.Components.Length, Is.EqualTo(2));
            SurfaceComponent a = _rig.Surface.Components[0], b = _rig.Surface.Components[1];
            Assert.That(a.Area + b.Area, Is.EqualTo(_rig.Surface.Area).Within(1e-6).Percent);
            Assert.That(a.Volume + b.Volume, Is.EqualTo(_rig.Surface.Volume).Within(1e-6).Percent);
            Assert.That(Math.Max(a.Volume, b.Volume), Is.EqualTo(4 / 3.0 * Math.PI * 27).Within(2).Percent);
        }

        [UnityTest]
        public IEnumerator NoAtomsAreAnEmptySurface()
        {
            _rig = SurfaceRig.WithBlob(20, 8);
            yield return _rig.Settle();
            _rig.Surface.SetAtoms(new Vector3[0], new float[0]);
            yield return _rig.Settle();
            Assert.That(_rig.Surface.Mesh.vertexCount, Is.EqualTo(0));
            Assert.That(_rig.Surface.Mesh.GetIndexCount(0), Is.EqualTo(0));
            Assert.That(_rig.Failures, Is.Empty);
            _rig.Surface.ClearAtoms();
            Assert.That(_rig.Surface.IsBusy, Is.False);
        }

        [UnityTest]
        public IEnumerator ABadFrameIsToldAndTheLastGoodMeshStays()
        {
            TestMolecules.Blob(30, 9, out Vector3[] positions, out float[] radii);
            _rig = new SurfaceRig();
            _rig.Surface.SetAtoms(positions, radii);
            yield return _rig.Settle();
            var bad = (Vector3[])positions.Clone();
            bad[7].y = float.NaN;
            _rig.Surface.SetPositions(bad);
            yield return _rig.Settle();
            Assert.That(_rig.Failures.Count, Is.EqualTo(1));
            Assert.That(_rig.Failures[0].Status, Is.EqualTo(QuickSesStatus.InvalidArgument));
            Assert.That(_rig.Failures[0].Message, Does.Contain("7"));
            Assert.That(_rig.Surface.LastError.Status, Is.EqualTo(QuickSesStatus.InvalidArgument));
            SurfaceMeshes.AssertShows(_rig.Surface, positions, radii);

            Vector3[] next = TestMolecules.Moved(positions, 1);
            _rig.Surface.SetPositions(next);
            yield return _rig.Settle();
            Assert.That(_rig.Surface.LastError.Status, Is.EqualTo(QuickSesStatus.Ok));
            SurfaceMeshes.AssertShows(_rig.Surface, next, radii);
        }

        [UnityTest]
        public IEnumerator AFailureWithoutListenersIsLogged()
        {
            var lonely = new GameObject("lonely").AddComponent<MolecularSurface>();
            lonely.SetAtoms(new[] { Vector3.zero }, new[] { -1f });
            LogAssert.Expect(LogType.Error, new System.Text.RegularExpressions.Regex("lonely: .*radi"));
            yield return SurfaceRig.Until(() => !lonely.IsBusy);
            Object.Destroy(lonely.gameObject);
        }

        [Test]
        public void WrongLengthsThrowAndChangeNothing()
        {
            _rig = SurfaceRig.WithBlob(10, 10);
            MolecularSurface surface = _rig.Surface;
            Assert.Throws<ArgumentException>(() => surface.SetAtoms(new Vector3[3], new float[2]));
            Assert.Throws<ArgumentException>(() => surface.SetPositions(new Vector3[9]));
            Assert.Throws<ArgumentException>(() => surface.SetPositions(new float[31]));
            Assert.Throws<ArgumentException>(() => surface.SetPositions(new Vector3[20], new int[9]));
            Assert.Throws<ArgumentOutOfRangeException>(() => surface.SetPositions(new Vector3[9],
                new[] { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9 }));
            Assert.Throws<ArgumentException>(() => surface.SetColors(new Color32[11]));
            Assert.Throws<ArgumentException>(() => surface.SetVisible(new bool[11]));
            Assert.Throws<ArgumentException>(() => surface.SetTexcoords(new Vector2[11]));
            Assert.Throws<ArgumentNullException>(() => surface.SetPositions((Vector3[])null));
            Assert.Throws<ArgumentOutOfRangeException>(() => surface.SetAtoms(new Vector3[3], new float[3], 4));
            Assert.Throws<ArgumentOutOfRangeException>(() => surface.OwnerAtomAt(-1));
            Assert.That(surface.AtomCount, Is.EqualTo(10));
            Assert.That(surface.ComputeNow());
            Assert.That(_rig.Failures, Is.Empty);
        }

        [Test]
        public void AtomsHaveToBeThereFirst()
        {
            _rig = new SurfaceRig();
            Assert.Throws<InvalidOperationException>(() => _rig.Surface.SetPositions(new Vector3[1]));
            Assert.Throws<InvalidOperationException>(() => _rig.Surface.ComputeNow());
        }

        [UnityTest]
        public IEnumerator SettingsChangeTheSurface()
        {
            TestMolecules.Blob(40, 11, out Vector3[] positions, out float[] radii);
            _rig = new SurfaceRig();
            _rig.Surface.SetAtoms(positions, radii);
            yield return _rig.Settle();
            double ses = _rig.Surface.Volume;
            _rig.Surface.Surface = SurfaceKind.Vdw;
            yield return _rig.Settle();
            double vdw = _rig.Surface.Volume;
            _rig.Surface.Surface = SurfaceKind.Sas;
            yield return _rig.Settle();
            Assert.That(vdw, Is.LessThan(ses));
            Assert.That(ses, Is.LessThan(_rig.Surface.Volume));
            _rig.Surface.Surface = SurfaceKind.Ses;
            _rig.Surface.Spacing = 0.8f;
            yield return _rig.Settle();
            SurfaceMeshes.AssertShows(_rig.Surface, positions, radii);

            int levels = _rig.Levels.Count;
            _rig.Surface.Spacing = 0.8f;
            yield return SurfaceRig.Frames(3);
            Assert.That(_rig.Levels.Count, Is.EqualTo(levels), "the same value is no change");
        }

        [UnityTest]
        public IEnumerator BuffersHaveRoomWhileAtomsMoveAndNoneAtRest([Values] bool isSharp)
        {
            TestMolecules.Blob(60, 12, out Vector3[] positions, out float[] radii);
            _rig = new SurfaceRig();
            _rig.Surface.SharpCreases = isSharp;
            _rig.Surface.RestDelay = float.PositiveInfinity;
            _rig.Surface.FrameBudget = 0;
            _rig.Surface.SetAtoms(positions, radii);
            yield return _rig.Settle();
            Assert.That(_rig.Surface.Mesh.vertexCount, Is.EqualTo(_rig.Surface.CurrentLevel.VertexCount));
            positions = TestMolecules.Moved(positions, 1);
            _rig.Surface.SetPositions(positions);
            yield return _rig.Settle();
            yield return SurfaceRig.Frames(5);
            Assert.That(_rig.Surface.Mesh.vertexCount, Is.GreaterThan(_rig.Surface.CurrentLevel.VertexCount));
            Assert.That(_rig.Surface.Mesh.GetIndexCount(0), Is.EqualTo(3 * _rig.Surface.CurrentLevel.TriangleCount));
            SurfaceMeshes.AssertShows(_rig.Surface, positions, radii, true);
            int updates = _rig.Levels.Count;
            uint jobs = SurfaceScheduler.LastJob;
            _rig.Surface.RestDelay = 0;
            yield return SurfaceRig.Until(() => _rig.Levels.Count > updates);
            Assert.That(_rig.Surface.Mesh.vertexCount, Is.EqualTo(_rig.Surface.CurrentLevel.VertexCount));
            SurfaceMeshes.AssertShows(_rig.Surface, positions, radii);
            Assert.That(SurfaceScheduler.LastJob - jobs, Is.EqualTo(isSharp ? 1 : 0), "nothing but creases was computed");
        }

        [Test]
        public void ComputeNowShowsTheFinest()
        {
            TestMolecules.Blob(40, 13, out Vector3[] positions, out float[] radii);
            _rig = new SurfaceRig();
            _rig.Surface.SetAtoms(positions, radii);
            Assert.That(_rig.Surface.ComputeNow());
            SurfaceMeshes.AssertShows(_rig.Surface, positions, radii);
            Assert.That(_rig.Surface.IsBusy, Is.False);
            Assert.That(_rig.Finished, Is.EqualTo(1));
        }
    }
}
