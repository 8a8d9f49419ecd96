// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.Editor;
using UnityEditor;
using UnityEngine;
using UnityEngine.Rendering;

namespace QuickSes.Tests
{
    public sealed class SurfaceBakerTest
    {
        private readonly CreatedSurfaces _created = new CreatedSurfaces();
        private string _folder;

        [SetUp]
        public void MakeFolder() =>
            _folder = AssetDatabase.GUIDToAssetPath(AssetDatabase.CreateFolder("Assets", "QuickSes bake test"));

        [TearDown]
        public void Delete()
        {
            _created.Destroy();
            AssetDatabase.DeleteAsset(_folder);
        }

        [TestCase(AtomColoring.Vertices)]
        [TestCase(AtomColoring.Texture)]
        public void TheAssetHoldsTheFinestSurface(AtomColoring coloring)
        {
            MolecularSurface surface = MakeSurface();
            surface.Coloring = coloring;
            Bake(surface, "Two atoms.asset");

            var asset = AssetDatabase.LoadAssetAtPath<Mesh>(_folder + "/Two atoms.asset");
            Assert.That(surface.CurrentLevel.IsFinest, Is.True);
            Assert.That(asset.vertexCount, Is.EqualTo(surface.CurrentLevel.VertexCount));
            Assert.That(asset.indexFormat, Is.EqualTo(IndexFormat.UInt32));
            Assert.That(asset.GetIndexCount(0), Is.EqualTo(3 * surface.CurrentLevel.TriangleCount));
            Vector3[] shown = surface.Mesh.vertices;
            System.Array.Resize(ref shown, surface.CurrentLevel.VertexCount);
            Assert.That(asset.vertices, Is.EqualTo(shown));
            Assert.That(asset.HasVertexAttribute(VertexAttribute.Normal), Is.True);
            Assert.That(asset.HasVertexAttribute(VertexAttribute.Color), Is.True);
            Assert.That(asset.bounds, Is.EqualTo(surface.Mesh.bounds));
            Assert.That(asset.name, Is.EqualTo("Two atoms"));
            Assert.That(asset.hideFlags, Is.EqualTo(HideFlags.None));
            Assert.That(MeshUtility.GetMeshCompression(asset), Is.EqualTo(ModelImporterMeshCompression.Off));
        }

        [Test]
        public void TheComponentKeepsAMeshOfItsOwn()
        {
            MolecularSurface surface = MakeSurface();
            Mesh asset = Bake(surface, "a.asset");
            Assert.That(asset, Is.Not.SameAs(surface.Mesh));
            Assert.That(surface.GetComponent<MeshFilter>().sharedMesh, Is.SameAs(surface.Mesh));
            Assert.That(AssetDatabase.Contains(surface.Mesh), Is.False);
        }

        [Test]
        public void AMeshAssetThatIsThereKeepsItsGuid()
        {
            MolecularSurface surface = MakeSurface();
            Mesh first = Bake(surface, "a.asset");
            string guid = AssetDatabase.AssetPathToGUID(_folder + "/a.asset");
            int coarse = first.vertexCount;
            surface.Spacing /= 2;
            Mesh second = Bake(surface, "a.asset");
            Assert.That(second, Is.SameAs(first));
            Assert.That(second.vertexCount, Is.GreaterThan(coarse));
            Assert.That(AssetDatabase.AssetPathToGUID(_folder + "/a.asset"), Is.EqualTo(guid));
        }

        [Test]
        public void AnAssetOfAnotherKindIsNotOverwritten()
        {
            string path = _folder + "/a.asset";
            AssetDatabase.CreateAsset(new TextAsset("text"), path);
            AssertRefused(MakeSurface(), path, "TextAsset");
            Assert.That(AssetDatabase.LoadMainAssetAtPath(path), Is.InstanceOf<TextAsset>());
        }

        [TestCase("a.asset", "Assets/")]
        [TestCase("Assets/a.mesh", ".asset")]
        [TestCase("Assets/no such folder/a.asset", "Assets/no such folder")]
        public void PathsOutsideTheProjectAreRefused(string path, string named) =>
            AssertRefused(MakeSurface(), path, named);

        [Test]
        public void WithoutAtomsThereIsNothingToBake() =>
            AssertRefused(_created.Keep(SurfaceCreator.CreateEmpty(null)), _folder + "/a.asset", "no atoms");

        [Test]
        public void ASurfaceThatIsOffIsRefused()
        {
            MolecularSurface surface = MakeSurface();
            surface.enabled = false;
            AssertRefused(surface, _folder + "/a.asset", "not active");
        }

        [Test]
        public void WhatTheLibraryRefusesIsTold()
        {
            MolecularSurface surface = MakeSurface();
            surface.SetPositions(new[] { Vector3.zero, new Vector3(float.NaN, 0, 0) });
            AssertRefused(surface, _folder + "/a.asset", "position");
        }

        private MolecularSurface MakeSurface()
        {
            MolecularSurface surface = _created.Keep(SurfaceCreator.CreateEmpty(null));
            surface.Failed += _ => { }; // instead of the Console, which would fail the test
            CreatedSurfaces.GiveAtoms(surface);
            return surface;
        }

        private Mesh Bake(MolecularSurface surface, string name)
        {
            Assert.That(SurfaceBaker.TryBake(surface, _folder + "/" + name, out Mesh asset, out string error), Is.True,
                error);
            return asset;
        }

        private static void AssertRefused(MolecularSurface surface, string path, string named)
        {
            Assert.That(SurfaceBaker.TryBake(surface, path, out Mesh asset, out string error), Is.False);
            Assert.That(asset == null, Is.True);
            Assert.That(error, Does.Contain(named).IgnoreCase);
        }
    }
}
