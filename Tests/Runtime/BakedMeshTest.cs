// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System.Collections;
using UnityEngine;
using UnityEngine.TestTools;
using Object = UnityEngine.Object;

namespace QuickSes.Tests
{
    /// <summary>A mesh that was put into the filter, such as a baked one, stays until there is a surface.</summary>
    internal sealed class BakedMeshTest
    {
        private const string NoFile = "/no/such/folder/molecule.pdb";

        private GameObject _prefab;
        private GameObject _instance;
        private Mesh _baked;

        [TearDown]
        public void TearDown()
        {
            foreach (Object made in new Object[] { _prefab, _instance, _baked })
                if (made != null)
                    Object.DestroyImmediate(made);
        }

        [UnityTest]
        public IEnumerator ADisabledComponentDoesNotTouchIt()
        {
            MolecularSurface surface = Instance(false);
            TestMolecules.Blob(30, 1, out Vector3[] positions, out float[] radii);
            surface.SetAtoms(positions, radii);
            yield return SurfaceRig.Frames(3);
            Assert.That(Filter(surface).sharedMesh, Is.SameAs(_baked));
            _instance.SetActive(false);
            _instance.SetActive(true);
            Assert.That(Filter(surface).sharedMesh, Is.SameAs(_baked));
            Object.DestroyImmediate(surface);
            Assert.That(_instance.GetComponent<MeshFilter>().sharedMesh, Is.SameAs(_baked));
        }

        [UnityTest]
        public IEnumerator ItComesBackWhenTheComponentIsRemoved()
        {
            MolecularSurface surface = Instance(true);
            yield return ShowBlob(surface);
            MeshFilter filter = Filter(surface);
            Assert.That(filter.sharedMesh, Is.SameAs(surface.Mesh));
            Object.DestroyImmediate(surface);
            Assert.That(filter.sharedMesh, Is.SameAs(_baked));
        }

        [UnityTest]
        public IEnumerator NothingComesBackWhereSomebodyHasPutAnother()
        {
            MolecularSurface surface = Instance(true);
            yield return ShowBlob(surface);
            MeshFilter filter = Filter(surface);
            var other = new Mesh();
            filter.sharedMesh = other;
            Object.DestroyImmediate(surface);
            Assert.That(filter.sharedMesh, Is.SameAs(other));
            Object.DestroyImmediate(other);
        }

        [UnityTest]
        public IEnumerator ASurfaceTakesItsPlaceWhenItIsThere()
        {
            MolecularSurface surface = Instance(true);
            int levels = 0;
            surface.SurfaceUpdated += level => ++levels;
            Assert.That(Filter(surface).sharedMesh, Is.SameAs(_baked));
            TestMolecules.Blob(30, 1, out Vector3[] positions, out float[] radii);
            surface.SetAtoms(positions, radii);
            yield return SurfaceRig.Until(() =>
            {
                Assert.That(Filter(surface).sharedMesh, Is.SameAs(levels == 0 ? _baked : surface.Mesh));
                return !surface.IsBusy;
            });
            Assert.That(Filter(surface).sharedMesh, Is.SameAs(surface.Mesh));
            SurfaceMeshes.AssertShows(surface, positions, radii);
            Assert.That(_baked.vertexCount, Is.EqualTo(3));

            // What is put there while the surface is off gives way to it again.
            surface.enabled = false;
            Filter(surface).sharedMesh = _baked;
            yield return SurfaceRig.Frames(2);
            Assert.That(Filter(surface).sharedMesh, Is.SameAs(_baked));
            surface.enabled = true;
            Assert.That(Filter(surface).sharedMesh, Is.SameAs(surface.Mesh));

            // Where there is no surface any more, to the next one.
            surface.enabled = false;
            surface.ClearAtoms();
            Filter(surface).sharedMesh = _baked;
            surface.enabled = true;
            yield return SurfaceRig.Frames(2);
            Assert.That(Filter(surface).sharedMesh, Is.SameAs(_baked));
            surface.SetAtoms(positions, radii);
            yield return SurfaceRig.Until(() => !surface.IsBusy);
            Assert.That(Filter(surface).sharedMesh, Is.SameAs(surface.Mesh));

            // As does none at all.
            Filter(surface).sharedMesh = null;
            surface.Recompute();
            yield return SurfaceRig.Until(() => !surface.IsBusy);
            Assert.That(Filter(surface).sharedMesh, Is.SameAs(surface.Mesh));
        }

        [UnityTest]
        public IEnumerator WhereNothingCanBeComputedItStays()
        {
            MolecularSurface surface = Instance(true);
            int failures = 0;
            surface.Failed += error => ++failures;
            surface.Source.SetFile(NoFile);
            yield return SurfaceRig.Until(() => failures > 0);
            yield return SurfaceRig.Frames(3);
            Assert.That(Filter(surface).sharedMesh, Is.SameAs(_baked));

            // As without a library: there is no context. Where there is CUDA, a bad atom has to do.
            TestMolecules.Blob(30, 1, out Vector3[] positions, out float[] radii);
            positions[7].y = float.NaN;
            surface.Backend = SurfaceBackend.Cuda;
            surface.SetAtoms(positions, radii);
            yield return SurfaceRig.Until(() => failures > 1 && !surface.IsBusy);
            Assert.That(Filter(surface).sharedMesh, Is.SameAs(_baked));
            surface.enabled = false;
            surface.enabled = true;
            yield return SurfaceRig.Frames(3);
            Assert.That(Filter(surface).sharedMesh, Is.SameAs(_baked));
        }

        private static IEnumerator ShowBlob(MolecularSurface surface)
        {
            TestMolecules.Blob(30, 1, out Vector3[] positions, out float[] radii);
            surface.SetAtoms(positions, radii);
            yield return SurfaceRig.Until(() => !surface.IsBusy);
        }

        private static MeshFilter Filter(MolecularSurface surface) => surface.GetComponent<MeshFilter>();

        private MolecularSurface Instance(bool isEnabled)
        {
            _baked = new Mesh
            {
                vertices = new[] { Vector3.zero, Vector3.right, Vector3.up }, triangles = new[] { 0, 2, 1 }
            };
            _prefab = new GameObject("prefab"); // as in a file: nothing of it ever ran
            _prefab.SetActive(false);
            var original = _prefab.AddComponent<MolecularSurface>();
            original.enabled = isEnabled;
            Filter(original).sharedMesh = _baked;
            _instance = Object.Instantiate(_prefab);
            _instance.SetActive(true);
            var surface = _instance.GetComponent<MolecularSurface>();
            Assert.That(Filter(surface).sharedMesh, Is.SameAs(_baked));
            return surface;
        }
    }
}
