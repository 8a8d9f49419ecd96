// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System.Collections;
using System.Collections.Generic;
using System.Diagnostics;
using UnityEngine;
using UnityEngine.TestTools;

namespace QuickSes.Tests
{
    /// <summary>One player, several surfaces.</summary>
    public sealed class PlayedSurfacesTest
    {
        private const int Frames = 600;

        private static readonly int[] s_backbone = { 0, 1, 3 }; // N, CA, C
        private static readonly int[] s_water = { TestFrames.WaterAtom };

        private PlayerFixture _playing;
        private TestFolder _folder;
        private SurfaceRig _backbone, _water;

        private TrajectoryPlayer Player => _playing.Player;

        [SetUp]
        public void MakePlayer()
        {
            _folder = new TestFolder();
            _playing = new PlayerFixture();
            _backbone = new SurfaceRig("backbone");
            _water = new SurfaceRig("water");
            Player.FramesPerSecond = 10;
            _playing.UseStructure();
            Player.TrajectorySource.SetFile(_folder.Write("md.dcd", TestFrames.Dcd(TestFrames.Frames(Frames))));
            Player.AddSurface(_backbone.Surface, "//A/1/N,CA,C").ColorScheme = AtomColorScheme.Element;
            PlayedSurface water = Player.AddSurface(_water.Surface, "(HOH)");
            water.KeepWater = true;
        }

        [TearDown]
        public void DestroyPlayer()
        {
            _playing.Dispose();
            _backbone.Dispose();
            _water.Dispose();
            _folder.Dispose();
        }

        private static void AssertAt(MolecularSurface surface, int[] atoms, double place)
        {
            int frame = (int)place;
            float weight = (float)(place - frame);
            Assert.That(surface.AtomCount, Is.EqualTo(atoms.Length), surface.name);
            for (int i = 0; i < atoms.Length; ++i)
            {
                Vector3 file = TestFrames.Position(frame, atoms[i]);
                if (weight > 0)
                    file = (1 - weight) * file + weight * TestFrames.Position(frame + 1, atoms[i]);
                Vector3 there = new Vector3(-file.x, file.y, file.z);
                Assert.That((surface.Positions[i] - there).magnitude, Is.LessThan(1e-4f * (1 + frame)),
                    "atom {0} of {1} in frame {2}", i, surface.name, place);
            }
        }

        private void AssertAllAt(double place)
        {
            AssertAt(_playing.Surface, TestFrames.WithoutWater, place);
            AssertAt(_backbone.Surface, s_backbone, place);
            AssertAt(_water.Surface, s_water, place);
        }

        [Test]
        public void AllSurfacesAreAlwaysInTheSameFrame()
        {
            _playing.Load();
            AssertAllAt(0);
            Player.Play();
            var seen = new HashSet<int>();
            Stopwatch waited = Stopwatch.StartNew();
            Player.FrameShown += _ => AssertAllAt(Player.ShownFrame); // in the very tick
            while (seen.Count < Frames)
            {
                Player.Tick(0.03f);
                seen.Add(Player.ShownFrame);
                AssertAllAt(Player.ShownFrame);
                System.Threading.Thread.Yield();
                Assert.That(waited.Elapsed.TotalSeconds, Is.LessThan(SurfaceRig.Patience), "still waiting");
            }
            Assert.That(_playing.Failures, Is.Empty);
        }

        [Test]
        public void AllSurfacesAreInTheSamePlaceBetweenFrames()
        {
            Player.Interpolate = true;
            _playing.Load();
            foreach (double place in new[] { 10.25, 3.5, 598.75, 0.5 })
            {
                Player.Frame = place;
                _playing.WaitUntilShown((int)place);
                AssertAllAt(place);
            }
        }

        [Test]
        public void JumpingAboutKeepsThemTogether()
        {
            _playing.Load();
            var random = new System.Random(1);
            for (int jump = 0; jump < 200; ++jump)
            {
                Player.Frame = random.Next(Frames);
                for (int tick = random.Next(3); tick >= 0; --tick)
                {
                    Player.Tick(0);
                    AssertAllAt(Player.ShownFrame);
                }
            }
        }

        [Test]
        public void EachLeavesOutWhatItIsToldTo()
        {
            string[] lines = TestFrames.Pdb(1).Split('\n');
            lines[1] = lines[1].Substring(0, lines[1].Length - 2) + " H";
            lines[5] = "HETATM" + lines[5].Substring(6).Replace("ALA A   1", "LIG A   3");
            Player.StructureSource.SetAsset(new TextAsset(string.Join("\n", lines)) { name = "structure.pdb" });
            using (var withoutHydrogen = new SurfaceRig("without hydrogen"))
            using (var withoutHetero = new SurfaceRig("without ligands"))
            {
                Player.AddSurface(withoutHydrogen.Surface, "").SkipHydrogen = true;
                Player.AddSurface(withoutHetero.Surface, "").SkipHetero = true;
                _playing.Load();
                AssertAt(withoutHydrogen.Surface, new[] { 0, 3, 4, 5 }, 0);
                AssertAt(withoutHetero.Surface, new[] { 0, 1, 3, 4 }, 0);
            }
        }

        [UnityTest]
        public IEnumerator EachShowsASurfaceInItsColours()
        {
            _backbone.Surface.Coloring = _water.Surface.Coloring = AtomColoring.Vertices;
            _playing.Load();
            yield return SurfaceRig.Until(() => !_playing.Surface.IsBusy && !_backbone.Surface.IsBusy &&
                !_water.Surface.IsBusy);
            var colors = new HashSet<Color32>(_backbone.Surface.Mesh.colors32);
            Assert.That(colors.Count, Is.EqualTo(2), "nitrogen and carbon");
            Assert.That(_water.Surface.Mesh.colors32, Is.Not.Empty.And.All.EqualTo(_water.Surface.BaseColor));
            Assert.That(_water.Surface.Mesh.bounds.size.x, Is.LessThan(4));
        }

        [UnityTest]
        public IEnumerator TheirOwnSourcesAreLeftAlone()
        {
            _backbone.Surface.Source.SetAsset(new TextAsset(TestFrames.Pdb(1)) { name = "other.pdb" });
            int loaded = 0;
            _backbone.Surface.Loaded += () => ++loaded;
            _backbone.Surface.BeginLoadSource();
            _playing.Load();
            yield return SurfaceRig.Frames(10);
            AssertAllAt(0);
            _backbone.Surface.Source.SkipWater = false;
            _backbone.Surface.FollowSourceSoon(); // the inspector wrote it
            yield return null;
            Assert.That(_backbone.Surface.IsLoading, Is.False);
            Assert.That(loaded, Is.EqualTo(0));
        }

        [UnityTest]
        public IEnumerator TheirOwnSourcesAreNotReadBeforeThereIsAFrame()
        {
            _backbone.Surface.Source.SetAsset(new TextAsset(TestFrames.Pdb(1)) { name = "other.pdb" });
            Assert.That(Player.Load(), Is.True);
            yield return null;
            Assert.That(_backbone.Surface.IsLoading, Is.False);
        }

        [Test]
        public void WhoIsGivenOtherAtomsGetsThemBack()
        {
            _playing.Load();
            _water.Surface.SetAtoms(new Vector3[7], new float[] { 1, 1, 1, 1, 1, 1, 1 });
            _playing.Pass(0);
            AssertAllAt(0);
        }

        [UnityTest]
        public IEnumerator WhoAsksForAtomsGetsThem()
        {
            _playing.Load();
            Player.Frame = 5;
            _playing.WaitUntilShown(5);
            _water.Surface.ClearAtoms();
            _water.Surface.enabled = false;
            _water.Surface.enabled = true;
            yield return SurfaceRig.Until(() => _water.Surface.AtomCount == 1);
            _playing.Pass(0);
            AssertAllAt(5);
            Player.Unload();
            _water.Surface.ClearAtoms();
            int requests = _water.Requests;
            yield return SurfaceRig.Until(() => _water.Requests > requests);
            Assert.That(_water.Surface.AtomCount, Is.EqualTo(0), "the player has none any more");
        }

        [Test]
        public void NamesStayWhileTheyArePlayed()
        {
            _playing.Load();
            Structure structure = _water.Surface.Structure;
            Assert.That(structure.GetAtom(0).ResidueName, Is.EqualTo("HOH"));
            _water.Surface.CloseStructure();
            Assert.That(_water.Surface.Structure, Is.SameAs(structure));
            _water.Surface.enabled = false;
            Assert.That(_water.Surface.Structure, Is.SameAs(structure));
            _water.Surface.enabled = true;
            Player.Frame = 1;
            _playing.WaitUntilShown(1);
            Assert.That(_water.Surface.Structure, Is.SameAs(structure));
            Assert.That(_water.Surface.SetVisible("(HOH)"), Is.True, _water.Surface.VisibleSelectionError);
            Player.Unload();
            Assert.That(_water.Surface.Structure, Is.Null);
        }

        [Test]
        public void OthersGoOnWhereOneIsDestroyed()
        {
            _playing.Load();
            _backbone.Dispose();
            Player.Frame = 7;
            _playing.WaitUntilShown(7);
            AssertAt(_playing.Surface, TestFrames.WithoutWater, 7);
            AssertAt(_water.Surface, s_water, 7);
            Player.Unload();
        }

        [Test]
        public void OthersPlayWhereOneIsDestroyedWhileItIsLoaded([Values] bool isFailing)
        {
            if (isFailing)
                Player.TrajectorySource.SetFile(_folder.Root + "/none.dcd");
            Assert.That(Player.Load(), Is.True);
            _backbone.Dispose();
            _playing.TickUntil(() => !Player.IsLoading, "it is loaded");
            if (!isFailing)
                _playing.WaitUntilShown(0);
            AssertAt(_playing.Surface, TestFrames.WithoutWater, 0);
            AssertAt(_water.Surface, s_water, 0);
            Player.ColorScheme = AtomColorScheme.Element;
            Player.Unload();
            Assert.That(Player.Structure, Is.Null);
            Assert.That(_water.Surface.IsPlayed, Is.False);
        }

        [Test]
        public void EntriesMayBeEmptyAndChange()
        {
            Player.AddSurface(_playing.Surface).Surface = null; // left out
            Assert.That(Player.RemoveSurface(_water.Surface), Is.True);
            Assert.That(Player.RemoveSurface(_water.Surface), Is.False);
            Assert.That(Player.Surfaces.Count, Is.EqualTo(2));
            _playing.Load();
            AssertAt(_backbone.Surface, s_backbone, 0);
            Assert.That(_water.Surface.AtomCount, Is.EqualTo(0));
            Assert.That(() => Player.AddSurface(null), Throws.ArgumentNullException);
        }

        [Test]
        public void NoSurfaceIsPlayedTwice([Values] bool isOwn)
        {
            Player.AddSurface(isOwn ? _playing.Surface : _water.Surface);
            Assert.That(Player.Load(), Is.False);
            Assert.That(_playing.Failures[0], Does.Contain(isOwn ? "'molecule'" : "'water'"));
            Assert.That(_water.Surface.IsPlayed || _playing.Surface.IsPlayed, Is.False);
        }

        [Test]
        public void TwoPlayersDontHaveOneSurface()
        {
            _playing.GameObject.name = "first";
            _playing.Load();
            using (var other = new PlayerFixture())
            {
                other.GameObject.name = "second";
                other.UseEnsemble(3);
                PlayedSurface water = other.Player.AddSurface(_water.Surface, "(HOH)");
                water.KeepWater = true;
                Assert.That(other.Player.Load(), Is.False);
                Assert.That(other.Failures[0], Does.Contain("'first'").And.Contain("'second'").And.Contain("'water'"));
                Assert.That(other.Surface.IsPlayed || other.Player.IsLoading, Is.False);
                Player.Frame = 7;
                _playing.WaitUntilShown(7);
                AssertAllAt(7);

                other.Player.RemoveSurface(_water.Surface);
                other.Load();
                Assert.That(Player.RemoveSurface(_water.Surface));
                PlayedSurface own = Player.AddSurface(other.Surface, "(HOH)");
                Assert.That(Player.Load(), Is.False, "the own surface of a player that plays");
                Assert.That(_playing.Failures[0], Does.Contain("'second'"));
                Assert.That(other.Surface.AtomCount, Is.EqualTo(TestFrames.WithoutWater.Length));

                other.Player.Unload();
                own.KeepWater = true;
                Player.Frame = 0;
                _playing.Load();
                AssertAt(other.Surface, s_water, 0);
                Assert.That(other.Surface.Player, Is.SameAs(Player));
            }
        }

        [Test]
        public void WhoWasAskedToPlayComesBeforeWhoMayHaveNothingToPlay([Values(1, 3)] int models)
        {
            using (var other = new PlayerFixture())
            {
                other.GameObject.name = "wishful";
                other.Player.enabled = false;
                other.Surface.Source.SetAsset(new TextAsset(TestFrames.Pdb(models)) { name = "ensemble.pdb" });
                other.Player.enabled = true; // looks whether there are frames beside it
                Assert.That(other.Surface.Player, Is.SameAs(other.Player));
                Player.AddSurface(other.Surface, "(HOH)").KeepWater = true;
                _playing.Load();
                AssertAt(other.Surface, s_water, 0);
                other.TickUntil(() => !other.Player.IsLoading, "it knows");
                Assert.That(other.Surface.Player, Is.SameAs(Player));
                AssertAt(other.Surface, s_water, 0);
                Assert.That(other.Failures.Count, Is.EqualTo(models > 1 ? 1 : 0), "there are frames that it can't show");
                if (models > 1)
                    Assert.That(other.Failures[0], Does.Contain("'molecule'").And.Contain("'wishful'"));
            }
        }

        [Test]
        public void SelectionsWithoutAtomsAreNamed([Values] bool isDestroyed)
        {
            var ligand = new GameObject("ligand");
            Player.AddSurface(ligand.AddComponent<MolecularSurface>(), "(LIG)");
            Assert.That(Player.Load(), Is.True);
            if (isDestroyed)
                Object.DestroyImmediate(ligand);
            _playing.TickUntil(() => _playing.Failures.Count > 0, "it fails");
            Assert.That(_playing.Failures[0],
                Does.Contain(isDestroyed ? "destroyed" : "surface 'ligand'").And.Contain("filters"));
            Assert.That(_water.Surface.IsPlayed, Is.False);
            Object.DestroyImmediate(ligand);
        }

        [Test]
        public void PlayingSeveralMakesNoGarbage()
        {
            Player.Interpolate = true;
            _playing.Load();
            Player.Play();
            TestDelegate play = () =>
            {
                _playing.PlayUntilShown(_playing.Shown.Count + 20);
            };
            play();
            int before = _playing.Shown.Count;
            Garbage.AssertNoneBesideThreads(play);
            Assert.That(_playing.Shown.Count, Is.GreaterThan(before));
        }
    }
}
