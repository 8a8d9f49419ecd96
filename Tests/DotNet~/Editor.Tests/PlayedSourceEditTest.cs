// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using System;
using System.IO;
using System.Text;
using UnityEngine;
using Object = UnityEngine.Object;

namespace QuickSes.Tests
{
    /// <summary>What edits of a surface's source do where a player brings its atoms, or did.</summary>
    public sealed class PlayedSourceEditTest
    {
        private const int MostFrames = 1000000;

        private string _folder;
        private MolecularSurface _surface;
        private TrajectoryPlayer _player;

        [SetUp]
        public void MakePlayer()
        {
            Engine.Reset();
            _folder = Directory.CreateDirectory(Path.Combine(Path.GetTempPath(), Path.GetRandomFileName())).FullName;
            _player = new GameObject("molecule").AddComponent<TrajectoryPlayer>();
            _player.Pause();
            _surface = _player.GetComponent<MolecularSurface>();
            Engine.Frame();
        }

        [TearDown]
        public void Destroy()
        {
            Object.DestroyImmediate(_surface.gameObject);
            Directory.Delete(_folder, true);
        }

        [Test]
        public void OncePlayedASurfaceFollowsItsSourceAgain([Values] bool isRemoved, [Values] bool isSourceSet)
        {
            if (isSourceSet)
                _surface.Source.SetFile(Ensemble(2, 1));
            _player.StructureSource.SetFile(Ensemble(3, 2));
            PlayUntil(3);
            if (isRemoved)
                Object.DestroyImmediate(_player);
            else
                _player.enabled = false;
            Edit();
            Settle();
            Assert.That(_surface.AtomCount, Is.EqualTo(3), "the source was not edited");
            EditSource(4, 1);
            Assert.That(_surface.AtomCount, Is.EqualTo(4));
            Assert.That(_surface.Structure.AtomCount, Is.EqualTo(4));
        }

        [Test]
        public void AnEditWhileAnotherSourceIsPlayedIsNotFollowedLater()
        {
            _player.StructureSource.SetFile(Ensemble(3, 2));
            PlayUntil(3);
            EditSource(4, 1);
            Assert.That(_surface.AtomCount, Is.EqualTo(3));
            _player.enabled = false;
            Edit();
            Settle();
            Assert.That(_surface.AtomCount, Is.EqualTo(3));
        }

        [Test]
        public void AtomsOfAScriptThatCameAfterAPlayersStay()
        {
            _player.StructureSource.SetFile(Ensemble(3, 2));
            PlayUntil(3);
            _player.enabled = false;
            _surface.SetAtoms(new Vector3[5], new float[] { 1, 1, 1, 1, 1 });
            EditSource(4, 1);
            Assert.That(_surface.AtomCount, Is.EqualTo(5));
        }

        [Test]
        public void ThePlayerFollowsTheSourceThatItPlays()
        {
            EditSource(3, 2);
            AssertPlays(3);
            Edit();
            Engine.Frame();
            Engine.Frame();
            Assert.That(_player.IsLoading, Is.False, "the source was not edited");
            EditSource(4, 2);
            AssertPlays(4);
            EditSource(5, 1); // nothing to play
            Assert.That(_player.IsReady || _surface.IsPlayed, Is.False);
            Assert.That(_surface.AtomCount, Is.EqualTo(5));
            EditSource(6, 2);
            AssertPlays(6);
        }

        [Test]
        public void AnEditOfThePlayerIsNotForgottenForOneOfTheSurface()
        {
            EditSource(3, 2);
            int loads = 0;
            _player.Loaded += () => ++loads;
            _player.PrefetchFrames = 5;
            _player.FollowEdits();
            Assert.That(_player.FollowSurfaceSource(), Is.True, "it loads what is set soon");
            FramesUntil(() => loads == 1);
            AssertPlays(3);
        }

        [Test]
        public void ASourceThatIsTakenFromAPlayerTakesTheAtomsAlong()
        {
            EditSource(3, 2);
            AssertPlays(3);
            _surface.Source.Kind = MoleculeSourceKind.None;
            Edit();
            Settle();
            Assert.That(_surface.IsPlayed, Is.False);
            Assert.That(_surface.AtomCount, Is.EqualTo(0));
        }

        [Test]
        public void ColoursOfTheSourceArePlayed()
        {
            _surface.Coloring = AtomColoring.Vertices;
            _surface.Source.ColorScheme = AtomColorScheme.Uniform;
            EditSource(3, 2);
            Assert.That(_surface.Mesh.colors32, Is.Not.Empty.And.All.EqualTo(_surface.BaseColor));
            _surface.Source.ColorScheme = AtomColorScheme.Residue;
            Edit();
            Settle();
            AssertPlays(3);
            Assert.That(_surface.Mesh.colors32, Has.None.EqualTo(_surface.BaseColor));
            _surface.Source.ColorScheme = AtomColorScheme.Uniform; // as it was loaded
            Edit();
            Settle();
            Assert.That(_surface.Mesh.colors32, Has.All.EqualTo(_surface.BaseColor));
        }

        [Test]
        public void EachEditOfSurfacesThatArePlayedIsFollowed()
        {
            var other = new GameObject("other").AddComponent<MolecularSurface>();
            PlayedSurface played = _player.AddSurface(other, "//A/1-2");
            EditSource(3, 2);
            Assert.That(other.AtomCount, Is.EqualTo(2));
            int loads = 0, expected = 0;
            _player.Loaded += () => ++loads;
            var edits = new Action[]
            {
                () => played.KeepWater = true, () => played.SkipHydrogen = true, () => played.SkipHetero = true,
                () => played.ColorScheme = AtomColorScheme.Chain, () => played.Selection = "//A/1",
                () => _player.AddSurface(new GameObject("third").AddComponent<MolecularSurface>()),
                () => _player.RemoveSurface(_player.Surfaces[1].Surface), () => _player.RemoveSurface(other)
            };
            foreach (Action edit in edits)
            {
                edit();
                _player.FollowEdits();
                Settle();
                Assert.That(loads, Is.EqualTo(++expected));
                _player.FollowEdits();
                Settle();
                Assert.That(loads, Is.EqualTo(expected), "nothing was edited");
            }
            Assert.That(other.IsPlayed, Is.False);
            Assert.That(other.AtomCount, Is.EqualTo(1), "those it had last");
        }

        private void AssertPlays(int atoms)
        {
            Assert.That(_player.IsReady && _surface.IsPlayed, Is.True);
            Assert.That(_surface.AtomCount, Is.EqualTo(atoms));
        }

        private void PlayUntil(int atoms)
        {
            Assert.That(_player.Load(), Is.True, _player.LastError.ToString());
            FramesUntil(() => _player.ShownFrame >= 0);
            Assert.That(_surface.AtomCount, Is.EqualTo(atoms));
        }

        private void EditSource(int atoms, int models)
        {
            _surface.Source.SetFile(Ensemble(atoms, models));
            Edit();
            Settle();
        }

        private void Edit() => Inspector.Validate(_surface);

        // A frame more, in which the player hears of an edit.
        private void Settle()
        {
            Engine.Frame();
            Engine.Frame();
            FramesUntil(() => !_surface.IsBusy && !_player.IsLoading);
        }

        private static void FramesUntil(Func<bool> condition)
        {
            for (int frame = 0; frame < MostFrames && !condition(); ++frame)
                Engine.Frame();
            Assert.That(condition(), Is.True);
        }

        private string Ensemble(int atoms, int models)
        {
            var text = new StringBuilder();
            for (int model = 1; model <= models; ++model)
            {
                text.Append(FormattableString.Invariant($"MODEL     {model,4}\n"));
                for (int i = 1; i <= atoms; ++i)
                    text.Append(FormattableString.Invariant(
                        $"ATOM  {i,5}  CA  ALA A{i,4}    {3 * i,8:0.000}{model,8:0.000}   0.000  1.00  0.00           C\n"));
                text.Append("ENDMDL\n");
            }
            string path = Path.Combine(_folder, $"{atoms}x{models}.pdb");
            File.WriteAllText(path, text.Append("END\n").ToString());
            return path;
        }
    }
}
