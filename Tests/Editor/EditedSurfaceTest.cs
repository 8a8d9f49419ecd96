// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.Editor;
using System.Collections;
using UnityEditor;
using UnityEngine;
using UnityEngine.TestTools;

namespace QuickSes.Tests
{
    /// <summary>What inspector and Undo do to a surface in edit mode.</summary>
    public sealed class EditedSurfaceTest
    {
        private const int MostFrames = 100000; // a surface of two atoms is there long before

        private readonly CreatedSurfaces _created = new CreatedSurfaces();
        private MolecularSurface _surface;

        [SetUp]
        public void MakeSurface()
        {
            _surface = _created.MakeComputed();
            Undo.IncrementCurrentGroup();
        }

        [TearDown]
        public void Destroy() => _created.Destroy();

        [Test]
        public void EditingASettingBeginsAComputationAndSoDoesUndo()
        {
            float before = _surface.Spacing;
            Assert.That(_surface.IsBusy, Is.False);
            Edit("_spacing", property => property.floatValue = 2 * before);
            Assert.That(_surface.Spacing, Is.EqualTo(2 * before));
            Assert.That(_surface.IsBusy, Is.True);
            Assert.That(_surface.ComputeNow(), Is.True);
            Assert.That(_surface.CurrentLevel.Spacing, Is.EqualTo(2 * before));

            Undo.PerformUndo();
            Assert.That(_surface.Spacing, Is.EqualTo(before));
            Assert.That(_surface.IsBusy, Is.True);
        }

        [UnityTest]
        public IEnumerator InEditModeTheSurfaceArrivesByItself()
        {
            Edit("_probeRadius", property => property.floatValue = 1);
            for (int frame = 0; frame < MostFrames && _surface.IsBusy; ++frame)
                yield return null;
            Assert.That(_surface.IsBusy, Is.False);
            Assert.That(_surface.CurrentLevel.IsFinest, Is.True);
        }

        [UnityTest]
        public IEnumerator EditingTheSourceReadsIt()
        {
            MolecularSurface other = _created.Keep(SurfaceCreator.CreateEmpty(null));
            const string atom = "ATOM      1  CA  ALA A   1      11.639   6.071  -5.147  1.00  0.00           C\nEND\n";
            string path = System.IO.Path.Combine(Application.temporaryCachePath, "atom.pdb");
            System.IO.File.WriteAllText(path, atom);
            var edited = new SerializedObject(other);
            edited.FindProperty("_source._kind").intValue = (int)MoleculeSourceKind.File;
            edited.FindProperty("_source._path").stringValue = path;
            edited.ApplyModifiedProperties();
            for (int frame = 0; frame < MostFrames && other.AtomCount == 0; ++frame)
                yield return null;
            System.IO.File.Delete(path);
            Assert.That(other.AtomCount, Is.EqualTo(1));

            edited.Update();
            edited.FindProperty("_source._kind").intValue = (int)MoleculeSourceKind.None;
            edited.ApplyModifiedProperties();
            for (int frame = 0; frame < MostFrames && other.AtomCount != 0; ++frame)
                yield return null;
            Assert.That(other.AtomCount, Is.EqualTo(0));
        }

        [UnityTest]
        public IEnumerator AFilterThatLostTheMeshGetsItBack()
        {
            var filter = _surface.GetComponent<MeshFilter>();
            filter.sharedMesh = null; // as a changed prefab leaves it
            Edit("_spacing", property => property.floatValue *= 2);
            for (int frame = 0; frame < MostFrames && filter.sharedMesh == null; ++frame)
                yield return null;
            Assert.That(filter.sharedMesh, Is.SameAs(_surface.Mesh));
        }

        [Test]
        public void UndoOfAddComponentGivesMeshAndMaterialBack()
        {
            GameObject cube = GameObject.CreatePrimitive(PrimitiveType.Cube);
            _created.Keep(cube.transform);
            var filter = cube.GetComponent<MeshFilter>();
            var renderer = cube.GetComponent<MeshRenderer>();
            Mesh mesh = filter.sharedMesh;
            Material material = renderer.sharedMaterial;
            Undo.IncrementCurrentGroup();
            MolecularSurface added = Undo.AddComponent<MolecularSurface>(cube);
            CreatedSurfaces.GiveAtoms(added);
            Assert.That(added.ComputeNow(), Is.True, added.LastError.Message);
            Assert.That(filter.sharedMesh, Is.SameAs(added.Mesh));
            Assert.That(renderer.sharedMaterial, Is.Not.SameAs(material));
            Undo.PerformUndo();
            Assert.That(added == null, Is.True);
            Assert.That(filter.sharedMesh, Is.SameAs(mesh));
            Assert.That(renderer.sharedMaterial, Is.SameAs(material));
        }

        private void Edit(string path, System.Action<SerializedProperty> edit)
        {
            var edited = new SerializedObject(_surface);
            edit(edited.FindProperty(path));
            edited.ApplyModifiedProperties();
        }
    }
}
