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
        public void ASourceThatIsTakenAwayTakesTheAtomsAlong()
        {
            ReadFile();
            Settle();
            _surface.Source.Kind = MoleculeSourceKind.None;
            Edit();
            Assert.That(_surface.AtomCount, Is.EqualTo(0));
            Assert.That(_surface.Mesh.vertexCount, Is.EqualTo(0));
            ReadFile();
            Assert.That(_surface.AtomCount, Is.EqualTo(1));
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
