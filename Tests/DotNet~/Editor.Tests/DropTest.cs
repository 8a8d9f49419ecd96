// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.Editor;
using QuickSes.EngineDouble;
using UnityEditor;
using UnityEngine;
using UnityEngine.TestTools;

namespace QuickSes.Tests
{
    /// <summary>What becomes of assets that the user drops into the Hierarchy and the Scene view.</summary>
    public sealed class DropTest
    {
        private const string Pdb =
            "ATOM      1  CA  ALA A   1      11.639   6.071  -5.147  1.00  0.00           C\nEND\n";

        private int _objects;

        [SetUp]
        public void RegisterHandlers()
        {
            EditorDriver.Load(typeof(MoleculeDrop).Assembly);
            LogAssert.ignoreFailingMessages = true; // the trajectory can't be read
            _objects = Engine.LiveObjects<GameObject>();
        }

        [Test]
        public void EachStructureBecomesASurfaceAndAllAreOneStepOfUndo()
        {
            DragAndDrop.objectReferences = new Object[] { Molecule("a.pdb"), Molecule("b.pdb") };
            Assert.That(DropIntoHierarchy(null, false), Is.EqualTo(DragAndDropVisualMode.Copy));
            Assert.That(Made, Is.Zero, "it was only asked");
            Undo.IncrementCurrentGroup();
            Assert.That(DropIntoHierarchy(null, true), Is.EqualTo(DragAndDropVisualMode.Copy));
            Assert.That(DragAndDrop.IsAccepted, Is.True);
            Assert.That(Made, Is.EqualTo(2));
            Assert.That(Selection.activeGameObject.GetComponent<MolecularSurface>().Source.Molecule.FileName,
                Is.EqualTo("b.pdb"));
            Undo.PerformUndo();
            Assert.That(Made, Is.Zero);
        }

        [Test]
        public void AStructureAndATrajectoryBecomeAPlayer()
        {
            var parent = new GameObject("parent");
            DragAndDrop.objectReferences = new Object[] { Molecule("md.xtc"), Molecule("a.pdb") };
            Assert.That(DropIntoHierarchy(parent, true), Is.EqualTo(DragAndDropVisualMode.Copy));
            var player = Selection.activeGameObject.GetComponent<TrajectoryPlayer>();
            Assert.That(player.transform.parent, Is.SameAs(parent.transform));
            Assert.That(player.StructureSource.Molecule.FileName, Is.EqualTo("a.pdb"));
            Assert.That(player.TrajectorySource.Molecule.FileName, Is.EqualTo("md.xtc"));
        }

        [Test]
        public void InTheSceneViewItIsWhereTheMouseIs()
        {
            var place = new Vector3(1, 2, 3);
            DragAndDrop.objectReferences = new Object[] { Molecule("a.pdb") };
            DragAndDropVisualMode mode = DragAndDrop.Drop<DragAndDrop.SceneDropHandler>(
                handler => handler(null, place, default, null, true));
            Assert.That(mode, Is.EqualTo(DragAndDropVisualMode.Copy));
            Assert.That(Selection.activeGameObject.transform.position, Is.EqualTo(place));
        }

        [TestCase(DragAndDropVisualMode.Rejected, "md.xtc")]
        [TestCase(DragAndDropVisualMode.Rejected, "md.xtc", "a.pdb", "b.pdb")]
        [TestCase(DragAndDropVisualMode.None)]
        public void WhatMakesNoSurfaceMakesNothing(DragAndDropVisualMode expected, params string[] names)
        {
            DragAndDrop.objectReferences = System.Array.ConvertAll(names, name => (Object)Molecule(name));
            Assert.That(DropIntoHierarchy(null, true), Is.EqualTo(expected));
            Assert.That(Made, Is.Zero);
            Assert.That(DragAndDrop.IsAccepted, Is.False);
        }

        [Test]
        public void OtherAssetsAreLeftToOthers()
        {
            DragAndDrop.objectReferences = new Object[] { Molecule("a.pdb"), new TextAsset("text") };
            Assert.That(DropIntoHierarchy(null, true), Is.EqualTo(DragAndDropVisualMode.None));
            Assert.That(Made, Is.Zero);
        }

        [Test]
        public void IntoAnOpenPrefabItGoesBelowItsRoot()
        {
            PrefabUtility.SaveAsPrefabAsset(new GameObject("root"), "Assets/a.prefab");
            GameObject opened = EditorDriver.OpenPrefab("Assets/a.prefab");
            MolecularSurface made = SurfaceCreator.CreateEmpty(null);
            Assert.That(made.transform.parent, Is.SameAs(opened.transform));
        }

        [Test]
        public void TheWindowIsTheMenus()
        {
            SurfaceFromFileWindow.IsOpen = false;
            var parent = new GameObject("parent");
            EditorDriver.InvokeContextMenu(MolecularMenu.FromFile, parent);
            Assert.That(SurfaceFromFileWindow.IsOpen, Is.True);
            Assert.That(SurfaceFromFileWindow.Parent, Is.SameAs(parent));
        }

        private int Made => Engine.LiveObjects<GameObject>() - _objects;

        private static MoleculeAsset Molecule(string name) =>
            MoleculeAsset.Create(name, System.Text.Encoding.ASCII.GetBytes(Pdb));

        private static DragAndDropVisualMode DropIntoHierarchy(GameObject parent, bool perform) =>
            DragAndDrop.Drop<DragAndDrop.HierarchyDropHandler>(handler => handler(
                parent == null ? 0 : parent.GetInstanceID(), HierarchyDropFlags.DropUpon, null, perform));
    }
}
