// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System.IO;
using UnityEngine;
using QuickSes.EngineDouble;

namespace QuickSes.Tests
{
    /// <summary>What a surface does after the inspector, Undo or a prefab wrote its serialised fields.</summary>
    public sealed class SourceEditTest
    {
        private const string Atom =
            "ATOM      1  CA  ALA A   1      11.639   6.071  -5.147  1.00  0.00           C\n";
        private const string Water =
            "HETATM    2  O   HOH A   2      15.000   6.000  -5.000  1.00  0.00           O\n";
        private const int MostFrames = 1000000;

        private string _path;
        private MolecularSurface _surface;
        private int _failures;

        [SetUp]
        public void MakeSurface()
        {
            Engine.Reset();
            _path = Path.Combine(Path.GetTempPath(), Path.GetRandomFileName() + ".pdb");
            File.WriteAllText(_path, Atom + Water + "END\n");
            _surface = new GameObject("surface").AddComponent<MolecularSurface>();
            _failures = 0;
            _surface.Failed += _ => ++_failures;
            Engine.Frame();
        }

        [TearDown]
        public void Destroy()
        {
            Object.DestroyImmediate(_surface.gameObject);
            File.Delete(_path);
            File.Delete(_path + ".other.pdb");
        }

        [Test]
        public void AnEditedSourceIsRead()
        {
            ReadFile();
            Assert.That(_surface.AtomCount, Is.EqualTo(1));
            _surface.Source.SkipWater = false;
            Edit();
            Settle();
            Assert.That(_surface.AtomCount, Is.EqualTo(2));
            Settle();
            Assert.That(_surface.CurrentLevel.IsFinest, Is.True);
        }

        [Test]
        public void ToolsThatWaitForTheSurfaceGetThatOfWhatWasEditedJustNow()
        {
            ReadFile();
            _surface.Source.SkipWater = false;
            Inspector.Validate(_surface);
            Assert.That(_surface.ComputeNow(), Is.True);
            Assert.That(_surface.AtomCount, Is.EqualTo(2));
            Assert.That(_surface.CurrentLevel.IsOfNewestAtoms, Is.True);
        }

        [Test]
        public void ASourceThatIsTakenAwayTakesTheAtomsAlong()
        {
            ReadFile();
            Settle();
            int requests = 0;
            _surface.AtomsRequested += () => ++requests;
            Engine.Frame();
            Assert.That(requests, Is.Zero);
            _surface.Source.Kind = MoleculeSourceKind.None;
            Edit();
            Assert.That(_surface.AtomCount, Is.EqualTo(0));
            Assert.That(_surface.Mesh.vertexCount, Is.EqualTo(0));
            Assert.That(requests, Is.EqualTo(1), "scripts may give it others");
            ReadFile();
            Assert.That(_surface.AtomCount, Is.EqualTo(1));
        }

        [Test]
        public void ASourceThatIsTakenAwayWhileItIsReadBringsNothing()
        {
            _surface.Source.SetFile(_path);
            Edit();
            Assert.That(_surface.IsLoading, Is.True);
            _surface.Source.Kind = MoleculeSourceKind.None;
            Edit();
            Assert.That(_surface.IsLoading, Is.False);
            Assert.That(_surface.AtomCount, Is.Zero);
        }

        [Test]
        public void ASourceThatCannotBeReadIsToldOnceAndLeavesTheSurface()
        {
            ReadFile();
            Settle();
            int vertices = _surface.Mesh.vertexCount;
            _surface.Source.SetFile(_path + "x");
            Edit();
            Engine.Frame();
            Assert.That(_failures, Is.EqualTo(1));
            Assert.That(_surface.LastError.Message, Does.Contain(_path + "x"));
            Assert.That(_surface.Mesh.vertexCount, Is.EqualTo(vertices));
            _surface.Source.SetFile(_path);
            Edit();
            Settle();
            Assert.That(_surface.LastError.Status, Is.EqualTo(QuickSesStatus.Ok));
        }

        [Test]
        public void AtomsOfAScriptAreNotReplaced()
        {
            _surface.SetAtoms(new[] { Vector3.zero, Vector3.right, Vector3.up }, new[] { 1f, 1f, 1f });
            ReadFile();
            Assert.That(_surface.AtomCount, Is.EqualTo(3));
        }

        [Test]
        public void TheBaseColourReachesAtomsThatHaveNoOther()
        {
            _surface.Source.ColorScheme = AtomColorScheme.Uniform;
            _surface.Coloring = AtomColoring.Vertices;
            ReadFile();
            Settle();
            var red = new Color32(255, 0, 0, 255);
            Inspector.Set(_surface, "_baseColor", red);
            Engine.Frame();
            Settle();
            Assert.That(_surface.Mesh.colors32, Is.Not.Empty.And.All.EqualTo(red));
        }

        [Test]
        public void AFilterThatLostTheMeshGetsItBack()
        {
            var filter = _surface.GetComponent<MeshFilter>();
            filter.sharedMesh = null;
            Edit();
            Assert.That(filter.sharedMesh, Is.SameAs(_surface.Mesh));
        }

        [Test]
        public void AnotherColourSchemeIsNotComputed()
        {
            _surface.Coloring = AtomColoring.Vertices;
            ReadFile();
            Settle();
            Color32[] before = _surface.Mesh.colors32;
            uint jobs = SurfaceScheduler.LastJob;
            ChooseColors(AtomColorScheme.Chain);
            Settle();
            Assert.That(_surface.Mesh.colors32, Is.Not.EqualTo(before));
            Assert.That(SurfaceScheduler.LastJob, Is.EqualTo(jobs));
            Edit();
            Assert.That(_surface.IsLoading, Is.False, "nothing was edited");
        }

        [Test]
        public void AColourSchemeThatIsChosenWhileAtomsAreReadDoesNotKeepThemAway()
        {
            ReadFile();
            Settle();
            Vector3 before = _surface.Positions[0];
            WriteOther(Atom.Replace("11.639", "21.639"));
            Edit();
            Assert.That(_surface.IsLoading, Is.True);
            ChooseColors(AtomColorScheme.Chain);
            Settle();
            Assert.That(_surface.Positions[0], Is.EqualTo(before - 10 * Vector3.right));
        }

        [Test]
        public void AColourSchemeForAtomsOfAnotherSourceBringsThoseOfThisOne()
        {
            _surface.SetAtoms(new[] { Vector3.zero }, new[] { 1f });
            File.WriteAllText(_path, "ATOM  nonsense\n");
            _surface.Source.SetFile(_path);
            Assert.That(_surface.LoadSource(), Is.False);
            File.WriteAllText(_path, Atom + "END\n");
            ChooseColors(AtomColorScheme.Chain);
            Settle();
            Assert.That(_surface.Positions[0], Is.Not.EqualTo(Vector3.zero));
        }

        [Test]
        public void AColourSchemeForAFileThatHasOtherAtomsByNowBringsThem()
        {
            ReadFile();
            Settle();
            File.WriteAllText(_path, Atom + Atom.Replace("11.639", "21.639").Replace("A   1", "A   2") + "END\n");
            ChooseColors(AtomColorScheme.Chain);
            Settle();
            Assert.That(_failures, Is.Zero);
            Assert.That(_surface.AtomCount, Is.EqualTo(2));
        }

        private void ChooseColors(AtomColorScheme scheme)
        {
            _surface.Source.ColorScheme = scheme;
            Edit();
        }

        // The same atoms elsewhere, in another file.
        private void WriteOther(string atom)
        {
            string path = _path + ".other.pdb";
            File.WriteAllText(path, atom + "END\n");
            _surface.Source.SetFile(path);
        }

        private void ReadFile()
        {
            _surface.Source.SetFile(_path);
            Edit();
            while (_surface.IsLoading)
                Engine.Frame();
        }

        private void Edit()
        {
            Inspector.Validate(_surface);
            Engine.Frame();
        }

        private void Settle()
        {
            for (int frame = 0; frame < MostFrames && _surface.IsBusy; ++frame)
                Engine.Frame();
            Assert.That(_surface.IsBusy, Is.False);
        }
    }
}
