// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System.Collections.Generic;
using UnityEngine;

namespace QuickSes.Tests
{
    /// <summary>What the player makes of structures and trajectories, whole and broken.</summary>
    public sealed class TrajectoryFilesTest
    {
        private PlayerFixture _playing;
        private TestFolder _folder;

        private TrajectoryPlayer Player => _playing.Player;

        [SetUp]
        public void MakePlayer()
        {
            _folder = new TestFolder();
            _playing = new PlayerFixture();
            Player.FramesPerSecond = 10;
        }

        [TearDown]
        public void DestroyPlayer()
        {
            _playing.Dispose();
            _folder.Dispose();
        }

        private void LoadWith(string name, byte[] bytes)
        {
            _playing.UseStructure();
            Player.TrajectorySource.SetFile(_folder.Write(name, bytes));
            _playing.Load();
        }

        private void Seek(int frame)
        {
            Player.Frame = frame;
            _playing.WaitUntilShown(frame);
        }

        // Everything that can be told at once, or when the file has been opened.
        private string FailToLoad()
        {
            if (Player.Load())
                _playing.TickUntil(() => _playing.Failures.Count > 0, "it fails");
            Assert.That(_playing.FailedFrames, Is.EqualTo(new[] { -1 }));
            Assert.That(Player.IsReady || Player.IsLoading, Is.False);
            Assert.That(Player.LastError.Message, Is.EqualTo(_playing.Failures[0]));
            return _playing.Failures[0];
        }

        [Test]
        public void DcdIsPlayed()
        {
            LoadWith("md.dcd", TestFrames.Dcd(TestFrames.Frames(4)));
            Assert.That(Player.FrameCount, Is.EqualTo(4));
            foreach (int frame in new[] { 3, 1, 2, 0 })
            {
                Seek(frame);
                _playing.AssertShows(frame);
            }
            Assert.That(Player.TryGetTime(out _), Is.False);
        }

        [Test]
        public void XtcIsPlayed()
        {
            LoadWith("md.xtc.bytes", TestFrames.Xtc(TestFrames.Frames(4), 2.5f));
            Assert.That(Player.FrameCount, Is.EqualTo(4));
            foreach (int frame in new[] { 3, 1, 2, 0 })
            {
                Seek(frame);
                _playing.AssertAt(TestFrames.Frame(frame), 1e-5f);
                Assert.That(Player.TryGetTime(out double picoseconds), Is.True);
                Assert.That(picoseconds, Is.EqualTo(2.5 * frame).Within(1e-5));
            }
        }

        [Test]
        public void FilesOfMoleculeAssetsArePlayed()
        {
            MoleculeAsset structure = MoleculeAsset.Create("structure.pdb",
                System.Text.Encoding.ASCII.GetBytes(TestFrames.Pdb(1)));
            MoleculeAsset frames = MoleculeAsset.Create("md.dcd", TestFrames.Dcd(TestFrames.Frames(3)));
            Player.StructureSource.SetAsset(structure);
            Player.TrajectorySource.SetAsset(frames);
            Assert.That(Player.Load(), Is.True);
            Object.DestroyImmediate(structure); // what they hold is still there
            Object.DestroyImmediate(frames);
            Seek(2);
            _playing.AssertShows(2);
        }

        [Test]
        public void TextAssetsMayTakeSeveralFramesToBeCopied()
        {
            string remarks = string.Concat(System.Linq.Enumerable.Repeat("REMARK 999".PadRight(80) + "\n", 150000));
            _playing.UseStructure();
            Player.TrajectorySource.SetAsset(new TextAsset(remarks + TestFrames.Pdb(4)) { name = "long.pdb" });
            _playing.Load();
            Seek(3);
            _playing.AssertShows(3);
        }

        [Test]
        public void StructureOfTheSurfaceServesToo()
        {
            _playing.Surface.Source.SetAsset(new TextAsset(TestFrames.Pdb(1)) { name = "structure.pdb" });
            Player.TrajectorySource.SetFile(_folder.Write("md.dcd", TestFrames.Dcd(TestFrames.Frames(2))));
            _playing.Load();
            Seek(1);
            _playing.AssertShows(1);
        }

        [Test]
        public void NumbersOfAtomsMustMatch()
        {
            var frames = new List<Vector3[]> { new Vector3[9], new Vector3[9] };
            _playing.UseStructure();
            Player.TrajectorySource.SetFile(_folder.Write("other.dcd", TestFrames.Dcd(frames)));
            Assert.That(FailToLoad(),
                Does.Contain(" 9 ").And.Contain($" {TestFrames.AtomCount}").And.Contain("other.dcd"));
            _playing.AssertAt(TestFrames.Frame(0), 0); // those of the structure
        }

        [Test]
        public void WhatIsMissingIsNamed()
        {
            Assert.That(FailToLoad(), Does.Contain("structure").And.Contain("chosen"));
        }

        [Test]
        public void OneModelIsNoTrajectory()
        {
            _playing.UseStructure();
            Assert.That(FailToLoad(), Does.Contain("trajectory").And.Contain("structure.pdb").And.Contain("models"));
        }

        [Test]
        public void NoSuchTrajectoryIsTold()
        {
            _playing.UseStructure();
            Player.TrajectorySource.SetFile(System.IO.Path.Combine(_folder.Root, "none.xtc"));
            Assert.That(FailToLoad(), Does.Contain(Player.TrajectorySource.Path));
        }

        [Test]
        public void WhatIsNoTrajectoryIsTold()
        {
            _playing.UseStructure();
            Player.TrajectorySource.SetAsset(new TextAsset("nonsense") { name = "nonsense.dcd" });
            Assert.That(FailToLoad(), Does.Contain("'nonsense.dcd'"));
        }

        [Test]
        public void DamagedFramesAreLeftOut()
        {
            List<Vector3[]> frames = TestFrames.Frames(5);
            frames[2][3].y = float.NaN;
            LoadWith("md.dcd", TestFrames.Dcd(frames));
            Player.Play();
            for (int step = 0; step < 9; ++step)
            {
                _playing.Pass(0.1f);
                _playing.Pass(0); // still there
                if (step == 1) // the damaged frame is due: the one before stays
                    _playing.AssertShows(1);
            }
            Assert.That(_playing.Shown, Is.EqualTo(new[] { 0, 1, 3, 4, 0, 1, 3, 4 }));
            Assert.That(_playing.FailedFrames, Is.EqualTo(new[] { 2, 2 })); // once each time round
            Assert.That(_playing.Failures[0], Does.Contain("frame 2"));
            Assert.That(Player.LastError.Status, Is.EqualTo(QuickSesStatus.FileError));
            Assert.That(Player.IsPlaying, Is.True);
        }

        [Test]
        public void NothingIsInterpolatedTowardsADamagedFrame()
        {
            List<Vector3[]> frames = TestFrames.Frames(4);
            frames[2][3].y = float.NaN;
            LoadWith("md.dcd", TestFrames.Dcd(frames));
            Player.Interpolate = true;
            Player.Frame = 1.5;
            _playing.WaitUntilShown(1);
            _playing.AssertShows(1);
        }

        [Test]
        public void FilesThatEndEarlyGiveTheFramesBefore()
        {
            byte[] whole = TestFrames.Dcd(TestFrames.Frames(4));
            System.Array.Resize(ref whole, whole.Length - 10);
            LoadWith("md.dcd", whole); // with a warning in the log
            Assert.That(Player.FrameCount, Is.EqualTo(3));
            Seek(2);
            _playing.AssertShows(2);
        }

        // Bonded atoms 1.5 Å apart along x, from the first frame on; in the second frame the last three crossed the
        // border of a box of 20 Å.
        private byte[] Torn()
        {
            List<Vector3[]> frames = TestFrames.Frames(2);
            for (int i = 3; i < TestFrames.AtomCount; ++i)
                frames[1][i].x -= 20;
            return TestFrames.Dcd(frames, new Vector3(20, 30, 40));
        }

        [Test]
        public void MoleculesAreMadeWholeIfAskedFor()
        {
            LoadWith("md.dcd", Torn());
            Seek(1);
            Assert.That(_playing.Positions[4].x, Is.EqualTo(20 - TestFrames.Position(1, 5).x).Within(1e-4f));

            Player.Unwrap = true;
            _playing.Load();
            Seek(1);
            Vector3[] shown = _playing.Positions;
            for (int i = 1; i < shown.Length; ++i)
                Assert.That(Vector3.Distance(shown[i], shown[i - 1]), Is.LessThan(3.5f), "atoms {0} and {1}", i - 1, i);
        }

        [Test]
        public void AtomsDoNotFlyThroughTheBox()
        {
            LoadWith("md.dcd", Torn());
            Player.Interpolate = true;
            Player.Frame = 0.5;
            _playing.TickUntil(() => !Player.IsWaiting && Player.ShownFrame == 0, "it is shown");
            Vector3[] expected = TestFrames.Frame(0);
            for (int i = 0; i < expected.Length; ++i)
                expected[i] = 0.5f * (expected[i] + TestFrames.Position(1, i));
            _playing.TickUntil(() => _playing.Positions[0].x != -TestFrames.Position(0, 0).x, "it is between frames");
            _playing.AssertAt(expected, 1e-4f);
        }

        [Test]
        public void NothingToUnwrapIsNoFailure()
        {
            Player.Unwrap = true;
            LoadWith("md.dcd", TestFrames.Dcd(TestFrames.Frames(3)));
            Seek(2);
            _playing.AssertShows(2);
            Assert.That(_playing.Failures, Is.Empty);
        }

        [Test]
        public void AnotherFileReplacesTheFirst()
        {
            LoadWith("md.dcd", TestFrames.Dcd(TestFrames.Frames(5)));
            Seek(4);
            Player.TrajectorySource.SetFile(_folder.Write("short.dcd", TestFrames.Dcd(TestFrames.Frames(2))));
            _playing.Load();
            Assert.That(Player.FrameCount, Is.EqualTo(2));
            Assert.That(Player.Frame, Is.EqualTo(0));
            _playing.AssertShows(0);
            Assert.That(_playing.Loads, Is.EqualTo(2));
        }

        [Test]
        public void AnotherFileBeginsWhereItWasToldTo()
        {
            LoadWith("md.dcd", TestFrames.Dcd(TestFrames.Frames(3)));
            Seek(2);
            Player.TrajectorySource.SetFile(_folder.Write("long.dcd", TestFrames.Dcd(TestFrames.Frames(8))));
            Player.Frame = 6;
            _playing.Load();
            _playing.AssertShows(6);
            Player.Unload();
            Player.TrajectorySource.SetFile(_folder.Write("other.dcd", TestFrames.Dcd(TestFrames.Frames(9))));
            _playing.Load();
            _playing.AssertShows(0);
            Player.Unload();
            Player.Frame = 4;
            Player.TrajectorySource.SetFile(_folder.Write("last.dcd", TestFrames.Dcd(TestFrames.Frames(9))));
            _playing.Load();
            _playing.AssertShows(4);
        }

        [Test]
        public void TheSameFileGoesOnWhereItWas()
        {
            LoadWith("md.dcd", TestFrames.Dcd(TestFrames.Frames(5)));
            Seek(3);
            Player.StructureSource.SkipHydrogen = true;
            _playing.Load();
            _playing.AssertShows(3);
        }

        [Test]
        public void AnotherEnsembleBeginsAtItsBeginning()
        {
            _playing.UseEnsemble(5);
            _playing.Load();
            Seek(4);
            _playing.UseEnsemble(6);
            _playing.Load();
            _playing.AssertShows(0);
        }

        [Test]
        public void ModelsOfTheSurfacesSourceArePlayedWithoutBeingAskedFor()
        {
            Player.enabled = false;
            _playing.Surface.Source.SetAsset(new TextAsset(TestFrames.Pdb(5)) { name = "ensemble.pdb" });
            Player.enabled = true;
            _playing.TickUntil(() => Player.ShownFrame >= 0, "a frame is shown");
            Assert.That(Player.FrameCount, Is.EqualTo(5));
            Seek(4);
            _playing.AssertShows(4);
        }

        [Test]
        public void AnAssemblyIsNamedWhereItFitsNoTrajectory()
        {
            string operations = "REMARK 350 BIOMOLECULE: 1\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: A\n";
            for (int copy = 1; copy <= 2; ++copy)
                for (int axis = 1; axis <= 3; ++axis)
                    operations += $"REMARK 350   BIOMT{axis}{copy,4}  {(axis == 1 ? 1 : 0)}.000000  " +
                        $"{(axis == 2 ? 1 : 0)}.000000  {(axis == 3 ? 1 : 0)}.000000       {30 * copy}.00000\n";
            Player.StructureSource.SetFile(_folder.Write("pair.pdb", TestFrames.Pdb(2, operations)));
            Player.StructureSource.Assembly = "1";
            Assert.That(FailToLoad(), Does.Contain("assembly '1'").And.Contain($" {2 * TestFrames.AtomCount}"));
        }

        [TestCase(null)]
        [TestCase("HEADER")]
        [TestCase("one model")]
        public void WhatNobodyAskedForIsNoFailure(string text)
        {
            Player.enabled = false;
            if (text != null)
                _playing.Surface.Source.SetAsset(
                    new TextAsset(text == "one model" ? TestFrames.Pdb(1) : text) { name = "structure.pdb" });
            Player.enabled = true;
            _playing.TickUntil(() => !Player.IsLoading, "it knows");
            Assert.That(_playing.Surface.IsPlayed, Is.False, "the surface reads its source, and tells what is wrong");
            Assert.That(_playing.Failures, Is.Empty);
            Assert.That(Player.LastError.Status, Is.EqualTo(QuickSesStatus.Ok));
            Assert.That(Player.IsLoading || Player.IsReady || Player.Structure != null, Is.False);
        }

        [Test]
        public void LoadingWaitsUntilItIsEnabled()
        {
            Player.enabled = false;
            _playing.UseEnsemble(3);
            Assert.That(Player.Load(), Is.True);
            Assert.That(Player.Structure, Is.Null); // nothing that would be left behind if it were destroyed now
            Assert.That(Player.IsLoading, Is.False);
            Player.enabled = true;
            _playing.TickUntil(() => Player.ShownFrame >= 0, "a frame is shown");
            _playing.AssertShows(0);
            Assert.That(_playing.Loads, Is.EqualTo(1));
        }

        [Test]
        public void WhatWasPutOffFailsWhenItIsEnabled()
        {
            _playing.GameObject.SetActive(false);
            Assert.That(Player.Load(), Is.True);
            Assert.That(_playing.Failures, Is.Empty);
            _playing.GameObject.SetActive(true);
            Assert.That(_playing.FailedFrames, Is.EqualTo(new[] { -1 }));
        }

        [Test]
        public void DestroyedPlayersLetGoOfTheirFiles()
        {
            LoadWith("md.dcd", TestFrames.Dcd(TestFrames.Frames(3)));
            Structure structure = Player.Structure;
            Object.DestroyImmediate(_playing.GameObject);
            BackgroundThread.SendAllAway(); // which let go of it a little later
            Assert.That(() => structure.AtomCount, Throws.TypeOf<System.ObjectDisposedException>());
            Assert.That(() => System.IO.File.Delete(Player.TrajectorySource.Path), Throws.Nothing);
        }
    }
}
