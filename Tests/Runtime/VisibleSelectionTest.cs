// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections;
using System.Text.RegularExpressions;
using UnityEngine;
using UnityEngine.TestTools;

namespace QuickSes.Tests
{
    /// <summary>Which atoms are shown, by selections; and the structure that they are looked up in.</summary>
    internal sealed class VisibleSelectionTest
    {
        private const string Chains =
            "ATOM      1  N   ALA A   1       0.000   0.000   0.000  1.00  0.00           N\n" +
            "ATOM      2  CA  ALA A   1       1.400   0.000   0.000  1.00  0.00           C\n" +
            "ATOM      3  N   GLY A   2       5.000   0.000   0.000  1.00  0.00           N\n" +
            "ATOM      4  N   GLY B   1      12.000   0.000   0.000  1.00  0.00           N\n" +
            "HETATM    5 ZN    ZN B   9      15.000   0.000   0.000  1.00  0.00          ZN\nEND\n";

        private SurfaceRig _rig;
        private int _logged;

        private MolecularSurface Surface => _rig.Surface;

        [SetUp]
        public void SetUp()
        {
            _logged = 0;
            _rig = new SurfaceRig();
            Surface.Coloring = AtomColoring.Vertices; // where hidden triangles are not in the mesh
        }

        [TearDown]
        public void TearDown() => _rig.Dispose();

        [UnityTest]
        public IEnumerator ASelectionHidesTheOthers()
        {
            Load(Chains);
            yield return _rig.Settle();
            int all = Triangles();
            Assert.That(Surface.SetVisible("//B"), Is.True);
            yield return _rig.Settle();
            int ofB = Triangles();
            Assert.That(ofB, Is.InRange(1, all - 1));
            Assert.That(Surface.SetVisible("//!B"), Is.True);
            yield return _rig.Settle();
            Assert.That(Triangles(), Is.EqualTo(all - ofB), "A and B don't touch");
            Assert.That(Surface.SetVisible("//C"), Is.True);
            yield return _rig.Settle();
            Assert.That(Triangles(), Is.EqualTo(0));
            Surface.VisibleSelection = "";
            yield return _rig.Settle();
            Assert.That(Triangles(), Is.EqualTo(all));
            Assert.That(Surface.VisibleSelectionError, Is.Empty);
        }

        [UnityTest]
        public IEnumerator WhatCantBeUnderstoodChangesNothing()
        {
            Load(Chains);
            Surface.SetVisible("//B");
            yield return _rig.Settle();
            int ofB = Triangles();
            Assert.That(Surface.SetVisible("//[["), Is.False);
            Assert.That(Surface.VisibleSelectionError, Does.Contain("//[["));
            yield return _rig.Settle();
            Assert.That(Triangles(), Is.EqualTo(ofB));
            Assert.That(() => Surface.SetVisible((string)null), Throws.ArgumentNullException);
        }

        [UnityTest]
        public IEnumerator ItHoldsForFilesThatAreReadLater()
        {
            Assert.That(Surface.SetVisible("//B"), Is.True, "there are no atoms yet");
            Load(Chains);
            yield return _rig.Settle();
            int ofB = Triangles();
            Surface.SetVisible("");
            yield return _rig.Settle();
            Assert.That(Triangles(), Is.GreaterThan(ofB));

            Surface.SetVisible("//B");
            Load(Chains.Replace("END", "ATOM      6  N   GLY A   3      30.000   0.000   0.000  1.00  0.00           N\nEND"));
            yield return _rig.Settle();
            Assert.That(Surface.AtomCount, Is.EqualTo(6));
            Assert.That(Triangles(), Is.EqualTo(ofB));
        }

        [UnityTest]
        public IEnumerator AMaskAndASelectionReplaceEachOther()
        {
            Load(Chains);
            Surface.SetVisible(new[] { true, false, false, false, false });
            yield return EditSomethingElse();
            int ofOne = Triangles();
            Surface.SetVisible("//B");
            Surface.SetVisible(new[] { true, false, false, false, false });
            yield return EditSomethingElse();
            Assert.That(Triangles(), Is.EqualTo(ofOne));
            Surface.SetVisible("//A/1/N");
            yield return _rig.Settle();
            Assert.That(Triangles(), Is.EqualTo(ofOne));
            Surface.SetVisible("//A");
            yield return _rig.Settle();
            Assert.That(Triangles(), Is.GreaterThan(ofOne));
        }

        [Test]
        public void AtomsOfScriptsHaveNoNames()
        {
            Surface.SetAtoms(new[] { Vector3.zero }, new[] { 1.5f });
            Assert.That(Surface.Structure, Is.Null);
            Assert.That(Surface.SetVisible("//A"), Is.False);
            Assert.That(Surface.VisibleSelectionError, Does.Contain("names"));
            Assert.That(Surface.SetVisible(""), Is.True);
            Assert.That(Surface.VisibleSelectionError, Is.Empty);
        }

        [Test]
        public void ASelectionThatWasSavedAndIsWrongIsTold()
        {
            Surface.SetVisible("//[[");
            LogAssert.Expect(LogType.Warning, new Regex("all atoms are shown.*//\\[\\["));
            Load(Chains);
            Assert.That(Surface.VisibleSelectionError, Does.Contain("//[["));
        }

        [UnityTest]
        public IEnumerator WhatCantBeUnderstoodOfAtomsThatAreReadAgainHidesNone()
        {
            Load(Chains);
            yield return _rig.Settle();
            int all = Triangles();
            Surface.SetVisible("//B");
            Surface.SetVisible("//[[");
            LogAssert.Expect(LogType.Warning, new Regex("all atoms are shown.*//\\[\\["));
            Load(Chains); // as many atoms, with the same radii
            yield return _rig.Settle();
            Assert.That(Triangles(), Is.EqualTo(all));
        }

        [Test]
        public void ASelectionThatNamesNoAtomIsTold()
        {
            Load(Chains);
            Assert.That(Surface.SetVisible("chain C"), Is.True, "it is understood");
            Assert.That(Surface.VisibleSelectionError, Does.Contain("'chain C'").And.Contain("chains A, B"));
            Surface.VisibleSelection = "chain B";
            Assert.That(Surface.VisibleSelectionError, Is.Empty);
            LogAssert.Expect(LogType.Warning, new Regex("no atom.*'chain B'.*chain A$"));
            Load(Chains.Replace(" B ", " A "));
            Assert.That(Surface.VisibleSelectionError, Does.Contain("names none"));
            Surface.VisibleSelection = "";
            Load(Chains.Replace(" A ", "   ").Replace(" B ", "   "));
            Surface.SetVisible("chain A");
            Assert.That(Surface.VisibleSelectionError, Does.EndWith("no chains"));
        }

        [TestCase("ABCDEFGHIJKL", "chains A, B, C, D, E, F, G, H, I, J, K, L$")]
        [TestCase("ABCDEFGHIJKLM", "chains A, B, C, D, E, F, G, H, I, J, K, L, ...$")]
        public void OfManyChainsTheFirstAreNamed(string chains, string named)
        {
            Load(string.Concat(Array.ConvertAll(chains.ToCharArray(),
                chain => $"ATOM      1  CA  ALA {chain}   1       0.000   0.000   0.000  1.00  0.00           C\n")));
            Surface.SetVisible("chain Z");
            Assert.That(Surface.VisibleSelectionError, Does.Match(named.Replace("...", @"\.\.\.")));
        }

        [Test]
        public void WhatWasClosedStaysClosedWhenTheSourceIsReadAgain()
        {
            string path = System.IO.Path.GetTempFileName();
            System.IO.File.WriteAllText(path, Chains);
            Surface.Source.SetFile(path);
            Surface.Source.Format = StructureFormat.Pdb;
            Assert.That(Surface.LoadSource());
            Assert.That(Surface.Structure, Is.Not.Null);
            Surface.CloseStructure();
            Assert.That(Surface.LoadSource());
            System.IO.File.Delete(path);
            LogAssert.Expect(LogType.Warning, new Regex("can't be read again"));
            Assert.That(Surface.Structure, Is.Null);
        }

        [Test]
        public void WhatIsAskedForStaysOpenWhenTheSourceIsReadAgain()
        {
            string path = System.IO.Path.GetTempFileName();
            System.IO.File.WriteAllText(path, Chains);
            Surface.Source.SetFile(path);
            Surface.Source.Format = StructureFormat.Pdb;
            Assert.That(Surface.LoadSource());
            Assert.That(Surface.Structure, Is.Not.Null);
            Assert.That(Surface.LoadSource());
            BackgroundThread.SendAllAway(); // which free what nobody needs
            System.IO.File.Delete(path);
            Assert.That(Surface.Structure, Is.Not.Null, "it is not read once more");
            Assert.That(Surface.Structure.GetAtom(4).Name, Is.EqualTo("ZN"));
        }

        [Test]
        public void TheStructureStaysOpenWhileSomebodyAsks()
        {
            Assert.That(Surface.Structure, Is.Null);
            Load(Chains);
            Structure first = Surface.Structure;
            Assert.That(first.GetAtom(4).Name, Is.EqualTo("ZN"));
            Assert.That(Surface.Structure, Is.SameAs(first), "it is not read anew for each question");
            Assert.That(first.MemoryBytes, Is.InRange(5 * 50, 5 * 5000));

            Load(Chains.Replace("ZN    ZN", "MG    MG"));
            Assert.That(first.IsDisposed);
            Structure second = Surface.Structure;
            Assert.That(second.GetAtom(4).Name, Is.EqualTo("MG"));
            Surface.CloseStructure();
            Assert.That(second.IsDisposed);
            Assert.That(Surface.Structure.GetAtom(4).Name, Is.EqualTo("MG"));

            Surface.Structure.Dispose(); // by whoever asked
            Assert.That(Surface.Structure.GetAtom(4).Name, Is.EqualTo("MG"));

            Structure third = Surface.Structure;
            Surface.enabled = false;
            Assert.That(third.IsDisposed);
            Surface.enabled = true;
            third = Surface.Structure;
            UnityEngine.Object.DestroyImmediate(_rig.GameObject);
            Assert.That(third.IsDisposed);
        }

        [Test]
        public void WhatADisabledSurfaceIsAskedForGoesWithIt()
        {
            Load(Chains);
            Surface.enabled = false;
            Structure structure = Surface.Structure;
            Assert.That(structure.IsDisposed, Is.False);
            UnityEngine.Object.DestroyImmediate(_rig.GameObject);
            Assert.That(structure.IsDisposed);
        }

        [Test]
        public void TheStructureGoesWithItsAtoms()
        {
            Load(Chains);
            Structure structure = Surface.Structure;
            var moved = new Vector3[5];
            Surface.SetPositions(moved);
            Surface.SetAtoms(moved, structure.Radii.ToArray());
            Assert.That(Surface.Structure, Is.SameAs(structure), "the same atoms have moved");
            Surface.SetAtoms(new Vector3[3], new[] { 1f, 1, 1 });
            Assert.That(structure.IsDisposed);
            Assert.That(Surface.Structure, Is.Null);
            Load(Chains);
            structure = Surface.Structure;
            Surface.ClearAtoms();
            Assert.That(structure.IsDisposed);
            Assert.That(Surface.Structure, Is.Null);
        }

        [Test]
        public void AFileThatBecameAnotherIsToldOnce([Values] bool isAsLong)
        {
            string path = System.IO.Path.GetTempFileName();
            try
            {
                System.IO.File.WriteAllText(path, Chains);
                Surface.Source.SetFile(path);
                Surface.Source.Format = StructureFormat.Pdb;
                Assert.That(Surface.LoadSource(), Is.True, Surface.LastError.ToString());
                System.IO.File.WriteAllText(path, isAsLong ? Chains.Replace("  15.000", "  25.000")
                    : Chains.Substring(Chains.IndexOf('\n') + 1));
                LogAssert.Expect(LogType.Warning, new Regex(isAsLong ? "other atoms now" : "4 atoms now, not 5"));
                Application.logMessageReceived += Count;
                Assert.That(Surface.Structure, Is.Null);
                Assert.That(Surface.Structure, Is.Null);
                Assert.That(Surface.SetVisible("//A"), Is.False);
                Assert.That(Surface.VisibleSelectionError, Does.Contain(isAsLong ? "other atoms now" : "4 atoms now, not 5"));
                Assert.That(_logged, Is.EqualTo(1));
                Surface.SetAtoms(new Vector3[3], new[] { 1f, 1, 1 });
                Assert.That(Surface.SetVisible("//A"), Is.False);
                Assert.That(Surface.VisibleSelectionError, Does.Contain("not of a file"), "these never were");
            }
            finally
            {
                Application.logMessageReceived -= Count;
                System.IO.File.Delete(path);
            }
        }

        private void Count(string message, string stack, LogType type) => ++_logged;

        private IEnumerator EditSomethingElse()
        {
            Surface.FollowSourceSoon();
            yield return null;
            yield return _rig.Settle();
        }

        private void Load(string pdb)
        {
            Surface.Source.SetAsset(new TextAsset(pdb) { name = "chains.pdb" });
            Assert.That(Surface.LoadSource(), Is.True, Surface.LastError.ToString());
        }

        private int Triangles() => (int)Surface.Mesh.GetIndexCount(0) / 3;
    }
}
