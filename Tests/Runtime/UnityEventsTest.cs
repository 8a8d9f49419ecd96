// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System.Collections;
using System.Collections.Generic;
using UnityEngine;
using UnityEngine.TestTools;
using Object = UnityEngine.Object;

namespace QuickSes.Tests
{
    /// <summary>UnityEvents tell what the C# events tell, right after them.</summary>
    internal sealed class UnityEventsTest
    {
        private SurfaceRig _rig;
        private int _updated, _finished, _requested;
        private string _failed;

        [SetUp]
        public void SetUp()
        {
            _updated = _finished = _requested = 0;
            _failed = null;
            _rig = new SurfaceRig();
            SurfaceEvents events = _rig.Surface.Events;
            events.SurfaceUpdated.AddListener(() => Assert.That(++_updated, Is.EqualTo(_rig.Levels.Count)));
            events.RefinementFinished.AddListener(() => Assert.That(++_finished, Is.EqualTo(_rig.Finished)));
            events.Failed.AddListener(message => _failed = message);
            events.AtomsRequested.AddListener(() => Assert.That(++_requested, Is.EqualTo(_rig.Requests)));
        }

        [TearDown]
        public void TearDown() => _rig.Dispose();

        [UnityTest]
        public IEnumerator EachIsRaised()
        {
            yield return SurfaceRig.Frames(3);
            Assert.That(_requested, Is.EqualTo(1));
            TestMolecules.Blob(60, 1, out Vector3[] positions, out float[] radii);
            _rig.Surface.SetAtoms(positions, radii);
            yield return _rig.Settle();
            Assert.That((_updated, _finished), Is.EqualTo((_rig.Levels.Count, 1)));
            Assert.That(_updated, Is.GreaterThan(0));
            Assert.That(_failed, Is.Null);
            positions[3].x = float.NaN;
            _rig.Surface.SetPositions(positions);
            yield return SurfaceRig.Until(() => _rig.Failures.Count > 0);
            Assert.That(_failed, Is.EqualTo(_rig.Failures[0].Message));
        }

        [UnityTest]
        public IEnumerator HandlersMayDestroyTheSurface()
        {
            GameObject doomed = _rig.GameObject;
            _rig.Surface.Events.SurfaceUpdated.AddListener(() => Object.DestroyImmediate(doomed));
            TestMolecules.Blob(60, 1, out Vector3[] positions, out float[] radii);
            _rig.Surface.SetAtoms(positions, radii);
            yield return SurfaceRig.Until(() => doomed == null);
            yield return SurfaceRig.Frames(3);
            Assert.That((_updated, _finished), Is.EqualTo((1, 0)));
        }

        [UnityTest]
        public IEnumerator WhoAnswersInCodeIsNotAskedAgain()
        {
            _rig.Surface.AtomsRequested += () => _rig.Surface.SetAtoms(new[] { Vector3.zero }, new[] { 1.5f });
            yield return _rig.Settle();
            Assert.That(_rig.Requests, Is.EqualTo(1));
            Assert.That(_requested, Is.EqualTo(0));
        }

        [Test]
        public void ASourceThatIsReadIsTold()
        {
            int loaded = 0;
            _rig.Surface.Events.Loaded.AddListener(() => ++loaded);
            _rig.Surface.Source.SetAsset(new TextAsset(TestFrames.Pdb(1)) { name = "small.pdb" });
            Assert.That(_rig.Surface.LoadSource(), Is.True);
            Assert.That(loaded, Is.EqualTo(1));
            _rig.Surface.Source.SetFile("/no/such/folder/molecule.pdb");
            Assert.That(_rig.Surface.LoadSource(), Is.False);
            Assert.That(loaded, Is.EqualTo(1));
        }

        [Test]
        public void ThoseOfAPlayer()
        {
            using (var playing = new PlayerFixture())
            {
                var shown = new List<int>();
                int loads = 0, loops = 0, finishes = 0;
                string failed = null;
                PlayerEvents events = playing.Player.Events;
                events.Loaded.AddListener(() => Assert.That(++loads, Is.EqualTo(playing.Loads)));
                events.FrameShown.AddListener(frame => shown.Add(frame));
                events.Looped.AddListener(() => ++loops);
                events.Finished.AddListener(() => ++finishes);
                events.Failed.AddListener(message => failed = message);
                playing.UseEnsemble(3);
                playing.Load();
                playing.Player.FramesPerSecond = 10;
                playing.Player.Play();
                for (int step = 0; step < 4; ++step)
                    playing.Pass(0.1f);
                playing.Player.Mode = PlaybackMode.Once;
                for (int step = 0; step < 3; ++step)
                    playing.Pass(0.1f);
                Assert.That(loads, Is.EqualTo(1));
                Assert.That(shown, Is.EqualTo(playing.Shown).And.Not.Empty);
                Assert.That((loops, finishes), Is.EqualTo((playing.Loops, playing.Finishes)).And.EqualTo((1, 1)));
                Assert.That(failed, Is.Null);
                playing.Player.StructureSource.SetFile("/no/such/folder/molecule.pdb");
                Assert.That(playing.Player.Load(), Is.False);
                Assert.That(failed, Is.EqualTo(playing.Failures[0]));
            }
        }
    }
}
