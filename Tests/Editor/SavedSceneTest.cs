// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.Editor;
using System.IO;
using UnityEditor;
using UnityEditor.SceneManagement;
using UnityEngine;
using UnityEngine.SceneManagement;

namespace QuickSes.Tests
{
    /// <summary>Nothing that was computed is in the files of scenes and prefabs.</summary>
    public sealed class SavedSceneTest
    {
        private const string Folder = "Assets/QuickSes saved scene test";
        private const string MeshClass = "--- !u!43 "; // how Unity's YAML begins a mesh
        private SerializationMode _mode;

        [SetUp]
        public void MakeFolder()
        {
            _mode = EditorSettings.serializationMode;
            EditorSettings.serializationMode = SerializationMode.ForceText;
            AssetDatabase.CreateFolder("Assets", Path.GetFileName(Folder));
        }

        [TearDown]
        public void Delete()
        {
            EditorSceneManager.NewScene(NewSceneSetup.EmptyScene, NewSceneMode.Single);
            AssetDatabase.DeleteAsset(Folder);
            EditorSettings.serializationMode = _mode;
        }

        [Test]
        public void ScenesAreSavedWithoutTheMesh()
        {
            Scene scene = EditorSceneManager.NewScene(NewSceneSetup.EmptyScene, NewSceneMode.Single);
            MolecularSurface surface = MakeSurface();
            Assert.That(EditorSceneManager.SaveScene(scene, Folder + "/a.unity"), Is.True);
            AssertHasNoMesh(Folder + "/a.unity");
            Assert.That(surface.GetComponent<MeshFilter>().sharedMesh, Is.SameAs(surface.Mesh));
        }

        [Test]
        public void PrefabsAreSavedWithoutTheMesh()
        {
            EditorSceneManager.NewScene(NewSceneSetup.EmptyScene, NewSceneMode.Single);
            MolecularSurface surface = MakeSurface();
            PrefabUtility.SaveAsPrefabAsset(surface.gameObject, Folder + "/a.prefab");
            AssertHasNoMesh(Folder + "/a.prefab");
        }

        private static MolecularSurface MakeSurface()
        {
            MolecularSurface surface = SurfaceCreator.CreateEmpty(null);
            CreatedSurfaces.GiveAtoms(surface);
            Assert.That(surface.ComputeNow(), Is.True, surface.LastError.Message);
            Assert.That(surface.Mesh.vertexCount, Is.GreaterThan(0));
            return surface;
        }

        private static void AssertHasNoMesh(string path)
        {
            string saved = File.ReadAllText(path);
            Assert.That(saved, Does.Contain("m_Mesh: {fileID: 0}"));
            Assert.That(saved, Does.Not.Contain(MeshClass));
        }
    }
}
