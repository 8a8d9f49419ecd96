// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.Editor;
using System.IO;
using UnityEditor;
using UnityEngine;
using UnityEngine.Rendering;
using UnityEngine.TestTools;

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

        [Test]
        public void AFileThatCannotBeReadIsNotOverwritten()
        {
            const string text = "of a script that is missing";
            string path = _folder + "/a.asset";
            LogAssert.ignoreFailingMessages = true; // Unity tells that it can't be read
            File.WriteAllText(path, text);
            AssetDatabase.ImportAsset(path);
            AssertRefused(MakeSurface(), path, "there already");
            Assert.That(File.ReadAllText(path), Is.EqualTo(text));
        }

        [Test]
        public void AMeshAssetThatMayNotBeWrittenStaysAsItIs()
        {
            MolecularSurface surface = MakeSurface();
            Mesh first = Bake(surface, "a.asset");
            int coarse = first.vertexCount;
            first.UploadMeshData(true);
            surface.Spacing /= 2;
            AssertRefused(surface, _folder + "/a.asset", "Read/Write");
            Assert.That(first.vertexCount, Is.EqualTo(coarse));
        }

        [Test]
        public void AFileThatIsReadOnlyStaysAsItIs()
        {
            MolecularSurface surface = MakeSurface();
            string path = _folder + "/a.asset";
            Mesh first = Bake(surface, "a.asset");
            int coarse = first.vertexCount;
            surface.Spacing /= 2;
            File.SetAttributes(path, FileAttributes.ReadOnly);
            AssertRefused(surface, path, "read-only");
            File.SetAttributes(path, FileAttributes.Normal);
            Assert.That(first.vertexCount, Is.EqualTo(coarse));
        }

        [TestCase("a.asset", "Assets/")]
        [TestCase("Assets/../a.asset", "Assets/..")]
        [TestCase("Assets/.a.asset", ".a")]
        [TestCase("Assets/ a.asset", " a")]
        [TestCase("Assets/.asset", ".asset")]
        [TestCase("Assets/a.mesh", ".asset")]
        [TestCase("Assets/no such folder/a.asset", "Assets/no such folder")]
        public void PathsOutsideTheProjectAreRefused(string path, string named) =>
            AssertRefused(MakeSurface(), path, named);

        [Test]
        public void WithoutAtomsThereIsNothingToBake() =>
            AssertRefused(_created.Keep(SurfaceCreator.CreateEmpty(null)), _folder + "/a.asset", "no atoms");

        [Test]
        public void WhatIsHiddenIsNotInTheAsset()
        {
            MolecularSurface surface = MakeSurface();
            surface.SetVisible(new[] { true, false });
            Mesh asset = Bake(surface, "a.asset");
            Assert.That(asset.GetIndexCount(0), Is.GreaterThan(0).And.LessThan(3 * surface.CurrentLevel.TriangleCount));
            surface.SetVisible(new[] { false, false });
            AssertRefused(surface, _folder + "/b.asset", "hidden");
            Assert.That(AssetDatabase.LoadMainAssetAtPath(_folder + "/b.asset") == null, Is.True);
            AssertRefused(surface, _folder + "/a.asset", "hidden");
            Assert.That(asset.GetIndexCount(0), Is.GreaterThan(0), "it was overwritten by nothing");
        }

        [Test]
        public void WhatWasEditedJustNowIsBaked()
        {
            string path = Path.Combine(Application.temporaryCachePath, "one atom.pdb");
            File.WriteAllText(path,
                "ATOM      1  CA  ALA A   1      11.639   6.071  -5.147  1.00  0.00           C\nEND\n");
            MolecularSurface surface = _created.Keep(SurfaceCreator.CreateEmpty(null));
            surface.Source.SetAsset(TwoAtoms());
            Assert.That(surface.LoadSource(), Is.True);
            int vertices = Bake(surface, "a.asset").vertexCount;
            var edited = new SerializedObject(surface);
            edited.FindProperty("_source._kind").intValue = (int)MoleculeSourceKind.File;
            edited.FindProperty("_source._path").stringValue = path;
            edited.ApplyModifiedProperties();
            Mesh asset = Bake(surface, "b.asset");
            File.Delete(path);
            Assert.That(surface.AtomCount, Is.EqualTo(1));
            Assert.That(asset.vertexCount, Is.LessThan(vertices));
        }

        [Test]
        public void HandlersMayBake([Values] bool ofEachSurface)
        {
            MolecularSurface surface = MakeSurface();
            int bakes = 0;
            if (ofEachSurface)
                surface.SurfaceUpdated += _ => Assert.That(Bake(surface, $"{++bakes}.asset") != null);
            else
                surface.RefinementFinished += () => Assert.That(Bake(surface, $"{++bakes}.asset") != null);
            Assert.That(surface.ComputeNow(), Is.True, surface.LastError.Message);
            Assert.That(bakes, Is.EqualTo(1));
        }

        [Test]
        public void ASurfaceThatAHandlerDestroysIsNotBaked()
        {
            MolecularSurface surface = MakeSurface();
            surface.SurfaceUpdated += _ => Object.DestroyImmediate(surface.gameObject);
            AssertRefused(surface, _folder + "/a.asset", "destroyed");
        }

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

        private static TextAsset TwoAtoms() => new TextAsset(
            "ATOM      1  CA  ALA A   1      11.639   6.071  -5.147  1.00  0.00           C\n" +
            "ATOM      2  CA  ALA A   2      14.639   6.071  -5.147  1.00  0.00           C\nEND\n") { name = "two.pdb" };

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
