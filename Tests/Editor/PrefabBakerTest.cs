// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.Editor;
using UnityEditor;
using UnityEngine;
using UnityEngine.Rendering;

namespace QuickSes.Tests
{
    public sealed class PrefabBakerTest
    {
        private readonly CreatedSurfaces _created = new CreatedSurfaces();
        private string _folder;

        [SetUp]
        public void MakeFolder() =>
            _folder = AssetDatabase.GUIDToAssetPath(AssetDatabase.CreateFolder("Assets", "QuickSes prefab test"));

        [TearDown]
        public void Delete()
        {
            _created.Destroy();
            AssetDatabase.DeleteAsset(_folder);
        }

        [Test]
        public void ThePrefabShowsTheSurfaceWithoutThisPackage()
        {
            MolecularSurface surface = MakeSurface();
            surface.transform.localScale = new Vector3(0.1f, 0.1f, 0.1f);
            surface.GetComponent<MeshRenderer>().receiveShadows = false;
            GameObject prefab = Bake(surface, "Two atoms.prefab");
            Assert.That(prefab.name, Is.EqualTo("Two atoms"));
            Assert.That(prefab.transform.localScale, Is.EqualTo(surface.transform.localScale));
            Assert.That(prefab.GetComponents<Component>().Length, Is.EqualTo(3), "Transform, filter, renderer");
            Mesh mesh = prefab.GetComponent<MeshFilter>().sharedMesh;
            Assert.That(AssetDatabase.GetAssetPath(mesh), Is.EqualTo(_folder + "/Two atoms mesh.asset"));
            Assert.That(mesh.vertexCount, Is.EqualTo(surface.CurrentLevel.VertexCount));
            Assert.That(mesh.HasVertexAttribute(VertexAttribute.Color), Is.True);
            var renderer = prefab.GetComponent<MeshRenderer>();
            Assert.That(renderer.receiveShadows, Is.False);
            Assert.That(renderer.sharedMaterial, Is.SameAs(surface.GetComponent<MeshRenderer>().sharedMaterial));
            Assert.That(AssetDatabase.Contains(renderer.sharedMaterial), Is.True);
        }

        [Test]
        public void AMaterialThatIsNoAssetIsSaved()
        {
            MolecularSurface surface = MakeSurface();
            var material = new Material(surface.GetComponent<MeshRenderer>().sharedMaterial) { color = Color.red };
            surface.GetComponent<MeshRenderer>().sharedMaterial = material;
            GameObject prefab = Bake(surface, "a.prefab");
            Material saved = prefab.GetComponent<MeshRenderer>().sharedMaterial;
            Assert.That(AssetDatabase.GetAssetPath(saved), Is.EqualTo(_folder + "/a material.mat"));
            Assert.That(saved.color, Is.EqualTo(Color.red));
            Object.DestroyImmediate(material);
        }

        [Test]
        public void BakingAgainKeepsTheGuids()
        {
            MolecularSurface surface = MakeSurface();
            GameObject first = Bake(surface, "a.prefab");
            string prefab = AssetDatabase.AssetPathToGUID(_folder + "/a.prefab");
            string mesh = AssetDatabase.AssetPathToGUID(_folder + "/a mesh.asset");
            int coarse = first.GetComponent<MeshFilter>().sharedMesh.vertexCount;
            surface.Spacing /= 2;
            GameObject second = Bake(surface, "a.prefab");
            Assert.That(second.GetComponent<MeshFilter>().sharedMesh.vertexCount, Is.GreaterThan(coarse));
            Assert.That(AssetDatabase.AssetPathToGUID(_folder + "/a.prefab"), Is.EqualTo(prefab));
            Assert.That(AssetDatabase.AssetPathToGUID(_folder + "/a mesh.asset"), Is.EqualTo(mesh));
        }

        [Test]
        public void APrefabThatHasASurfaceIsNotReplacedByOneThatHasNone()
        {
            string path = _folder + "/a.prefab";
            MolecularSurface surface = MakeSurface();
            surface.transform.SetParent(_created.Keep(new GameObject("parent").transform));
            PrefabUtility.SaveAsPrefabAsset(surface.transform.parent.gameObject, path);
            Assert.That(PrefabBaker.TryBake(surface, path, out _, out string error), Is.False);
            Assert.That(error, Does.Contain(path));
            var kept = AssetDatabase.LoadAssetAtPath<GameObject>(path);
            Assert.That(kept.GetComponentInChildren<MolecularSurface>(true) != null, Is.True);
            AssertNothingBeside("a");
        }

        [TestCase(".a")]
        [TestCase(" a")]
        public void NamesThatUnityRefusesAreRefusedBeforeAnythingIsSaved(string name)
        {
            Assert.That(PrefabBaker.TryBake(MakeSurface(), $"{_folder}/{name}.prefab", out _, out string error), Is.False);
            Assert.That(error, Does.Contain(name));
            AssertNothingBeside(name);
        }

        [Test]
        public void AnAssetOfAnotherKindBesideItIsNotOverwritten([Values("a mesh.asset", "a material.mat")] string name)
        {
            MolecularSurface surface = MakeSurface();
            var material = new Material(surface.GetComponent<MeshRenderer>().sharedMaterial);
            surface.GetComponent<MeshRenderer>().sharedMaterial = material;
            AssetDatabase.CreateAsset(new TextAsset("text"), _folder + "/" + name);
            Assert.That(PrefabBaker.TryBake(surface, _folder + "/a.prefab", out _, out string error), Is.False);
            Assert.That(error, Does.Contain(name).And.Contain("TextAsset"));
            Assert.That(AssetDatabase.LoadMainAssetAtPath(_folder + "/" + name), Is.InstanceOf<TextAsset>());
            Assert.That(AssetDatabase.LoadMainAssetAtPath(_folder + "/a.prefab") == null, Is.True);
            Object.DestroyImmediate(material);
        }

        [Test]
        public void AMaterialThatIsThereTwiceIsSavedOnce()
        {
            MolecularSurface surface = MakeSurface();
            var renderer = surface.GetComponent<MeshRenderer>();
            var material = new Material(renderer.sharedMaterial);
            var other = new Material(renderer.sharedMaterial);
            renderer.sharedMaterials = new[] { material, null, material, other };
            Material[] saved = Bake(surface, "a.prefab").GetComponent<MeshRenderer>().sharedMaterials;
            Assert.That(saved.Length, Is.EqualTo(4));
            Assert.That(saved[1] == null, Is.True);
            Assert.That(saved[2], Is.SameAs(saved[0]));
            Assert.That(saved[3], Is.Not.SameAs(saved[0]));
            foreach (int k in new[] { 0, 3 })
                Assert.That(AssetDatabase.Contains(saved[k]), Is.True);
            Object.DestroyImmediate(material);
            Object.DestroyImmediate(other);
        }

        [TestCase("a.prefab", "Assets/")]
        [TestCase("Assets/a.asset", ".prefab")]
        [TestCase("Assets/no such folder/a.prefab", "Assets/no such folder")]
        public void PathsOutsideTheProjectAreRefused(string path, string named)
        {
            Assert.That(PrefabBaker.TryBake(MakeSurface(), path, out GameObject prefab, out string error), Is.False);
            Assert.That(prefab == null, Is.True);
            Assert.That(error, Does.Contain(named));
        }

        [Test]
        public void TheSceneStaysAsItIs()
        {
            MolecularSurface surface = MakeSurface();
            int objects = surface.gameObject.scene.rootCount;
            Bake(surface, "a.prefab");
            Assert.That(surface.gameObject.scene.rootCount, Is.EqualTo(objects));
        }

        private void AssertNothingBeside(string name)
        {
            foreach (string path in new[] { name + " mesh.asset", name + " material.mat" })
                Assert.That(AssetDatabase.LoadMainAssetAtPath($"{_folder}/{path}") == null, Is.True, path);
        }

        private MolecularSurface MakeSurface()
        {
            MolecularSurface surface = _created.Keep(SurfaceCreator.CreateEmpty(null));
            CreatedSurfaces.GiveAtoms(surface);
            return surface;
        }

        private GameObject Bake(MolecularSurface surface, string name)
        {
            Assert.That(PrefabBaker.TryBake(surface, _folder + "/" + name, out GameObject prefab, out string error),
                Is.True, error);
            return prefab;
        }
    }
}
