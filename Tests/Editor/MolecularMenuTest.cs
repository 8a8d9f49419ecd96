// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.Editor;
using System.Collections;
using UnityEditor;
using UnityEngine;
using UnityEngine.TestTools;

namespace QuickSes.Tests
{
    public sealed class MolecularMenuTest
    {
        private readonly CreatedSurfaces _created = new CreatedSurfaces();

        [SetUp]
        public void BeginStepOfUndo() => Undo.IncrementCurrentGroup();

        [TearDown]
        public void Destroy() => _created.Destroy();

        [Test]
        public void TheMenuMakesASurfaceWithoutAtomsThatUndoTakesBack()
        {
            Assert.That(EditorApplication.ExecuteMenuItem(MolecularMenu.Empty), Is.True);
            GameObject made = Selection.activeGameObject;
            MolecularSurface surface = _created.Keep(made.GetComponent<MolecularSurface>());
            Assert.That(made.GetComponent<MeshFilter>().sharedMesh, Is.SameAs(surface.Mesh));
            Assert.That(made.GetComponent<MeshRenderer>().sharedMaterial != null, Is.True);
            Assert.That(surface.Source.IsSet, Is.False);
            Assert.That(surface.AtomCount, Is.EqualTo(0));
            Undo.PerformUndo();
            Assert.That(made == null, Is.True);
        }

        [UnityTest]
        public IEnumerator OnlyASurfaceThatIsAddedByHandShowsTheDemo()
        {
            EditorApplication.ExecuteMenuItem(MolecularMenu.Empty);
            MolecularSurface ofMenu = _created.Keep(Selection.activeGameObject.GetComponent<MolecularSurface>());
            MolecularSurface empty = _created.Keep(SurfaceCreator.CreateEmpty(null));
            MolecularSurface unset = _created.Keep(SurfaceCreator.Create(new MoleculeSource(), null));
            MolecularSurface added = _created.Keep(new GameObject("added").AddComponent<MolecularSurface>());
            bool isDemoDue = false;
            EditorApplication.delayCall += () => isDemoDue = true; // after those of the surfaces
            while (!isDemoDue)
                yield return null;
            Assert.That(added.Source.IsSet, Is.True);
            foreach (MolecularSurface surface in new[] { ofMenu, empty, unset })
            {
                Assert.That(surface.Source.IsSet, Is.False);
                Assert.That(surface.AtomCount, Is.EqualTo(0));
            }
        }

        [Test]
        public void ASurfaceOfAFileHasItsNameAndACopyOfTheSource()
        {
            var source = new MoleculeSource { SkipHydrogen = true, Selection = "//A" };
            source.SetFile("/molecules/1crn.pdb.gz");
            MolecularSurface surface = _created.Keep(SurfaceCreator.Create(source, null));
            Assert.That(surface.name, Is.EqualTo("1crn"));
            Assert.That(surface.Source, Is.Not.SameAs(source));
            Assert.That(surface.Source.IsSameAs(source), Is.True);
            Assert.That(Selection.activeGameObject, Is.SameAs(surface.gameObject));
        }

        [Test]
        public void AParentGetsItAtItsOriginAndOnItsLayer()
        {
            var parent = new GameObject("Parent") { layer = 4 };
            parent.transform.position = new Vector3(1, 2, 3);
            _created.Keep(parent.transform);
            MolecularSurface surface = SurfaceCreator.CreateEmpty(parent);
            Assert.That(surface.transform.parent, Is.SameAs(parent.transform));
            Assert.That(surface.transform.localPosition, Is.EqualTo(Vector3.zero));
            Assert.That(surface.gameObject.layer, Is.EqualTo(4));
            Assert.That(_created.Keep(SurfaceCreator.CreateEmpty(parent)).name, Is.Not.EqualTo(surface.name));
        }

        [Test]
        public void ATrajectoryComesWithAPlayer()
        {
            var structure = new MoleculeSource();
            structure.SetAsset(new TextAsset("none"));
            var trajectory = new TrajectorySource { Kind = MoleculeSourceKind.StreamingAssets, Path = "md.xtc" };
            LogAssert.ignoreFailingMessages = true; // neither can be read
            TrajectoryPlayer player = _created.Keep(SurfaceCreator.Create(structure, trajectory, null));
            Assert.That(player.StructureSource.IsSameAs(structure), Is.True);
            Assert.That(player.TrajectorySource.IsSameAs(trajectory), Is.True);
            Assert.That(player.GetComponent<MolecularSurface>().Source.IsSet, Is.False);
            Assert.That(player.isActiveAndEnabled, Is.True);
            Undo.PerformUndo();
            Assert.That(player == null, Is.True);
        }
    }
}
