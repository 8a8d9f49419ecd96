// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System.IO;
using System.Text.RegularExpressions;
using UnityEditor;
using UnityEngine;
using UnityEngine.TestTools;
using Object = UnityEngine.Object;

namespace QuickSes.EngineDouble.Tests
{
    [EditorTest]
    public sealed class ProjectTest
    {
        private const string Path = "Assets/a.asset";

        private sealed class Script : MonoBehaviour
        {
            public GameObject Inside, Outside;
            public int Calls;

            private void Awake() => ++Calls;

            private void OnEnable() => ++Calls;
        }

        [Test]
        public void AnAssetHasAFileAndAGuid()
        {
            var mesh = new Mesh();
            AssetDatabase.CreateAsset(mesh, Path);
            Assert.That(mesh.name, Is.EqualTo("a"));
            Assert.That(File.Exists(Path), Is.True);
            Assert.That(AssetDatabase.LoadMainAssetAtPath(Path), Is.SameAs(mesh));
            Assert.That(AssetDatabase.LoadAssetAtPath<Material>(Path), Is.Null);
            Assert.That(AssetDatabase.GetAssetPath(mesh), Is.EqualTo(Path));
            Assert.That(AssetDatabase.GUIDToAssetPath(AssetDatabase.AssetPathToGUID(Path)), Is.EqualTo(Path));
            Assert.That(AssetDatabase.Contains(mesh) && EditorUtility.IsPersistent(mesh), Is.True);
            Assert.That(() => AssetDatabase.CreateAsset(mesh, "Assets/b.asset"), Throws.TypeOf<UnityException>());
            Assert.That(AssetDatabase.DeleteAsset(Path), Is.True);
            Assert.That(mesh == null && !File.Exists(Path), Is.True);
            Assert.That(AssetDatabase.DeleteAsset(Path), Is.False);
        }

        [Test]
        public void ANewAssetTakesThePlaceOfWhatIsThere()
        {
            var before = new Mesh();
            AssetDatabase.CreateAsset(before, Path);
            AssetDatabase.CreateAsset(new TextAsset("text"), Path);
            Assert.That(before == null, Is.True);
            Assert.That(AssetDatabase.LoadMainAssetAtPath(Path), Is.InstanceOf<TextAsset>());
        }

        [Test]
        public void OnlyWhatIsMarkedAsChangedIsWritten()
        {
            var mesh = new Mesh();
            AssetDatabase.CreateAsset(mesh, Path);
            Assert.That(EditorDriver.IsSaved(Path), Is.True);
            mesh.vertices = new[] { Vector3.one };
            AssetDatabase.SaveAssetIfDirty(mesh);
            Assert.That(EditorDriver.IsSaved(Path), Is.False);
            EditorUtility.SetDirty(mesh);
            EditorDriver.Lock(Path);
            Assert.That(AssetDatabase.MakeEditable(Path), Is.False);
            AssetDatabase.SaveAssetIfDirty(mesh);
            Assert.That(EditorDriver.IsSaved(Path), Is.False);
        }

        [TestCase("Assets", true)]
        [TestCase("Assets/folder", true)]
        [TestCase("Assets/none", false)]
        [TestCase("Assets/", false)]
        [TestCase("Assets/../Assets", false)]
        [TestCase("Assets/.hidden", false)]
        [TestCase("Assets/hidden~", false)]
        [TestCase("Library", false)]
        public void FoldersAreThoseThatTheEditorShows(string path, bool isShown)
        {
            foreach (string folder in new[] { "Assets/folder", "Assets/.hidden", "Assets/hidden~", "Library" })
                Directory.CreateDirectory(folder);
            Assert.That(AssetDatabase.IsValidFolder(path), Is.EqualTo(isShown));
        }

        [Test]
        public void AssetsAreNotDestroyed()
        {
            var mesh = new Mesh();
            AssetDatabase.CreateAsset(mesh, Path);
            LogAssert.Expect(LogType.Error, new Regex("not permitted"));
            Object.DestroyImmediate(mesh);
            Assert.That(mesh != null, Is.True);
        }

        [Test]
        public void APrefabIsACopyWithoutWhatIsInNoFile()
        {
            var root = new GameObject("root", typeof(MeshFilter), typeof(MeshRenderer)) { layer = 3 };
            var child = new GameObject("child");
            child.transform.SetParent(root.transform);
            root.GetComponent<MeshFilter>().sharedMesh = new Mesh();
            var material = new Material();
            AssetDatabase.CreateAsset(material, "Assets/a.mat");
            root.GetComponent<MeshRenderer>().sharedMaterials = new[] { material, new Material() };
            Engine.EnterPlayModeInTheSameScene();
            var script = root.AddComponent<Script>();
            (script.Inside, script.Outside) = (child, new GameObject("outside"));
            GameObject prefab = PrefabUtility.SaveAsPrefabAsset(root, "Assets/a.prefab", out bool isSaved);
            Assert.That(isSaved && AssetDatabase.Contains(prefab.GetComponent<MeshFilter>()), Is.True);
            Assert.That(prefab.name, Is.EqualTo("a"));
            Assert.That(prefab.layer, Is.EqualTo(3));
            Assert.That(prefab.scene.IsValid(), Is.False);
            Assert.That(root.scene.rootCount, Is.EqualTo(2));
            Assert.That(prefab.GetComponent<MeshFilter>().sharedMesh == null, Is.True);
            Assert.That(prefab.GetComponent<MeshRenderer>().sharedMaterials, Is.EqualTo(new[] { material, null }));
            var copied = prefab.GetComponentInChildren<Script>(true);
            Assert.That(copied.Inside, Is.SameAs(prefab.transform.GetChild(0).gameObject));
            Assert.That(copied.Outside == null, Is.True);
            Assert.That(copied.Calls, Is.EqualTo(script.Calls), "the copy is told nothing");
            Engine.Frame();
            Assert.That(AssetDatabase.GetAssetPath(copied), Is.EqualTo("Assets/a.prefab"));

            string guid = AssetDatabase.AssetPathToGUID("Assets/a.prefab");
            PrefabUtility.SaveAsPrefabAsset(root, "Assets/a.prefab");
            Assert.That(AssetDatabase.AssetPathToGUID("Assets/a.prefab"), Is.EqualTo(guid));
            foreach (string refused in new[] { "Assets/.a.prefab", "Assets/ a.prefab", "Assets/a.txt", "Assets/no/a.prefab" })
                Assert.That(() => PrefabUtility.SaveAsPrefabAsset(root, refused), Throws.ArgumentException);
            LogAssert.Expect(LogType.Error, new Regex("Assets/b.prefab"));
            EditorDriver.IsDiskFull = true;
            Assert.That(PrefabUtility.SaveAsPrefabAsset(root, "Assets/b.prefab", out isSaved) == null && !isSaved, Is.True);
        }

        [Test]
        public void AnOpenPrefabIsInNoSceneAndTakesNewObjects()
        {
            var root = new GameObject("root");
            PrefabUtility.SaveAsPrefabAsset(root, "Assets/a.prefab");
            GameObject opened = EditorDriver.OpenPrefab("Assets/a.prefab");
            var made = new GameObject("made");
            UnityEditor.SceneManagement.StageUtility.PlaceGameObjectInCurrentStage(made);
            Assert.That(made.transform.parent, Is.SameAs(opened.transform));
            Assert.That(made.scene.IsValid(), Is.False);
            Assert.That(UnityEditor.SceneManagement.PrefabStageUtility.GetPrefabStage(made).assetPath,
                Is.EqualTo("Assets/a.prefab"));
            Assert.That(UnityEditor.SceneManagement.PrefabStageUtility.GetPrefabStage(root), Is.Null);
        }
    }
}
