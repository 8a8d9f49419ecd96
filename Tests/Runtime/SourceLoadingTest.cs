// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections;
using UnityEngine;
using UnityEngine.TestTools;
using Object = UnityEngine.Object;

namespace QuickSes.Tests
{
    /// <summary>Sources that are read while frames go by.</summary>
    public sealed class SourceLoadingTest
    {
        private SurfaceRig _rig;
        private TestFolder _folder;
        private int _loaded;

        private MolecularSurface Surface => _rig.Surface;

        [SetUp]
        public void MakeSurface()
        {
            _folder = new TestFolder();
            _rig = new SurfaceRig();
            _loaded = 0;
            Surface.Loaded += () => ++_loaded;
        }

        [TearDown]
        public void DestroySurface()
        {
            _rig.Dispose();
            _folder.Dispose();
        }

        private static TextAsset Text(string text) => new TextAsset(text) { name = "small.pdb" };

        // So long that it is not copied in one frame.
        private static TextAsset LongText()
        {
            string remark = "REMARK 999".PadRight(80) + "\n";
            return Text(string.Concat(System.Linq.Enumerable.Repeat(remark, 150000)) + TestFrames.Pdb(1));
        }

        private void AssertShowsFile(int frame)
        {
            Assert.That(Surface.AtomCount, Is.EqualTo(TestFrames.WithoutWater.Length));
            for (int i = 0; i < TestFrames.WithoutWater.Length; ++i)
            {
                Vector3 file = TestFrames.Position(frame, TestFrames.WithoutWater[i]);
                Assert.That(Surface.Positions[i], Is.EqualTo(new Vector3(-file.x, file.y, file.z)));
            }
        }

        [UnityTest]
        public IEnumerator AtomsComeInALaterFrame()
        {
            Surface.Source.SetAsset(Text(TestFrames.Pdb(1)));
            Assert.That(Surface.LoadProgress, Is.EqualTo(1));
            Surface.BeginLoadSource();
            Assert.That(Surface.IsLoading && Surface.IsBusy, Is.True);
            Assert.That(Surface.LoadProgress, Is.LessThan(1));
            Assert.That(Surface.AtomCount, Is.EqualTo(0));
            yield return SurfaceRig.Until(() => !Surface.IsLoading);
            Assert.That(_loaded, Is.EqualTo(1));
            Assert.That(Surface.LoadProgress, Is.EqualTo(1));
            AssertShowsFile(0);
            yield return _rig.Settle();
            Assert.That(Surface.CurrentLevel.IsFinest, Is.True);
            Assert.That(_rig.Failures, Is.Empty);
        }

        [UnityTest]
        public IEnumerator AnEnabledSurfaceReadsItsSourceByItself()
        {
            _rig.GameObject.SetActive(false);
            Surface.Source.SetFile(_folder.Write("small.pdb", TestFrames.Pdb(1)));
            _rig.GameObject.SetActive(true);
            yield return SurfaceRig.Until(() => _loaded > 0);
            AssertShowsFile(0);
            Assert.That(_rig.Requests, Is.EqualTo(0));
        }

        [UnityTest]
        public IEnumerator TheResultIsThatOfReadingAtOnce()
        {
            Surface.Coloring = AtomColoring.Vertices;
            foreach (AtomColorScheme scheme in Enum.GetValues(typeof(AtomColorScheme)))
            {
                Surface.Source.SetAsset(Text(TestFrames.Pdb(1)));
                Surface.Source.ColorScheme = scheme;
                Assert.That(Surface.LoadSource(), Is.True);
                yield return _rig.Settle();
                Color32[] colors = Surface.Mesh.colors32;
                Vector3[] positions = Surface.Positions.ToArray();
                Surface.ClearAtoms();
                Surface.BeginLoadSource();
                yield return _rig.Settle();
                Assert.That(Surface.Positions.ToArray(), Is.EqualTo(positions));
                Assert.That(Surface.Mesh.colors32, Is.Not.Empty.And.EqualTo(colors), "{0}", scheme);
            }
        }

        [UnityTest]
        public IEnumerator NothingComesOfWhatIsCancelled()
        {
            for (int frames = 0; frames < 4; ++frames)
            {
                Surface.ClearAtoms();
                _loaded = 0;
                Surface.Source.SetAsset(frames % 2 == 0 ? LongText() : Text(TestFrames.Pdb(1)));
                Surface.BeginLoadSource();
                yield return SurfaceRig.Frames(frames);
                if (!Surface.IsLoading)
                    continue;
                Surface.CancelLoading();
                Assert.That(Surface.IsLoading || Surface.IsBusy, Is.False);
                BackgroundThread.SendAllAway();
                yield return SurfaceRig.Frames(5);
                Assert.That(Surface.IsLoading, Is.False); // nor does it begin again
                Assert.That(Surface.AtomCount, Is.EqualTo(0));
                Assert.That(_loaded, Is.EqualTo(0));
                Assert.That(_rig.Failures, Is.Empty);
            }
            Surface.BeginLoadSource();
            yield return SurfaceRig.Until(() => _loaded > 0);
        }

        [UnityTest]
        public IEnumerator AtomsOfScriptsStay()
        {
            Surface.Source.SetAsset(LongText());
            Surface.BeginLoadSource();
            yield return null;
            Surface.SetAtoms(new[] { Vector3.zero }, new[] { 1f });
            yield return SurfaceRig.Until(() => !Surface.IsLoading);
            yield return SurfaceRig.Frames(5);
            Assert.That(Surface.AtomCount, Is.EqualTo(1));
            Assert.That(_loaded, Is.EqualTo(0));
        }

        [UnityTest]
        public IEnumerator AtomsThatScriptsGaveWhileItIsDisabledStay()
        {
            Surface.Source.SetAsset(LongText());
            Surface.BeginLoadSource();
            Surface.enabled = false;
            Surface.SetAtoms(new[] { Vector3.zero }, new[] { 1f });
            Assert.That(Surface.IsLoading, Is.False);
            Surface.enabled = true;
            yield return _rig.Settle();
            Assert.That(Surface.AtomCount, Is.EqualTo(1));
            Assert.That(_loaded, Is.EqualTo(0));
        }

        [Test]
        public void AtomsOfScriptsAreComputedNow()
        {
            Surface.Source.SetAsset(LongText());
            Surface.BeginLoadSource();
            Surface.SetAtoms(new[] { Vector3.zero }, new[] { 1f });
            Assert.That(Surface.ComputeNow(), Is.True);
            Assert.That(Surface.AtomCount, Is.EqualTo(1));
            Surface.BeginLoadSource();
            Surface.ClearAtoms();
            Assert.That(Surface.IsLoading, Is.False);
        }

        [Test]
        public void WhatIsBeingReadIsComputedNow()
        {
            Surface.SetAtoms(new[] { Vector3.zero }, new[] { 1f });
            Surface.Source.SetAsset(Text(TestFrames.Pdb(1)));
            Surface.BeginLoadSource();
            Assert.That(Surface.ComputeNow(), Is.True);
            Assert.That(Surface.IsLoading, Is.False);
            AssertShowsFile(0);
        }

        [UnityTest]
        public IEnumerator TheLastOneCounts()
        {
            Surface.Source.SetFile(_folder.Write("many.pdb", TestFrames.Pdb(8)));
            for (int model = 1; model <= 8; ++model)
            {
                Surface.Source.Model = model;
                Surface.BeginLoadSource();
                if (model % 3 == 0)
                    yield return null;
            }
            int before = _loaded;
            yield return SurfaceRig.Until(() => !Surface.IsLoading);
            Assert.That(_loaded, Is.EqualTo(before + 1));
            AssertShowsFile(7);
        }

        [UnityTest]
        public IEnumerator ReadingAtOnceEndsWhatIsBeingRead()
        {
            Surface.Source.SetFile(_folder.Write("many.pdb", TestFrames.Pdb(2)));
            Surface.BeginLoadSource();
            Surface.Source.Model = 2;
            Assert.That(Surface.LoadSource(), Is.True);
            Assert.That(Surface.IsLoading, Is.False);
            AssertShowsFile(1);
            yield return SurfaceRig.Frames(10);
            AssertShowsFile(1);
            Assert.That(_loaded, Is.EqualTo(1));
        }

        [UnityTest]
        public IEnumerator DisabledSurfacesGoOnWhenTheyAreEnabled([Values] bool isEnabledAtFirst)
        {
            Surface.enabled = isEnabledAtFirst;
            Surface.Source.SetAsset(Text(TestFrames.Pdb(1)));
            Surface.BeginLoadSource();
            Surface.enabled = false;
            Assert.That(Surface.IsLoading, Is.True);
            Assert.That(Surface.LoadProgress, Is.EqualTo(0));
            yield return SurfaceRig.Frames(5);
            Assert.That(Surface.AtomCount, Is.EqualTo(0));
            Surface.enabled = true;
            yield return SurfaceRig.Until(() => _loaded > 0);
            AssertShowsFile(0);
        }

        [UnityTest]
        public IEnumerator WhatIsDestroyedLoadsNothing()
        {
            Surface.Source.SetAsset(LongText());
            Surface.BeginLoadSource();
            yield return null;
            _rig.Dispose();
            yield return SurfaceRig.Frames(5);
            Assert.That(_loaded, Is.EqualTo(0));
        }

        [UnityTest]
        public IEnumerator WhatIsWrongIsToldOnceAndTheSurfaceStays()
        {
            Surface.SetAtoms(new[] { Vector3.zero }, new[] { 1f });
            yield return _rig.Settle();
            int vertices = Surface.Mesh.vertexCount;
            Surface.Source.SetAsset(Text("ATOM  nonsense\n"));
            Surface.BeginLoadSource();
            yield return SurfaceRig.Until(() => !Surface.IsLoading);
            yield return SurfaceRig.Frames(3);
            Assert.That(_rig.Failures.Count, Is.EqualTo(1));
            Assert.That(_rig.Failures[0].Message, Does.Contain("small.pdb"));
            Surface.Source.SetFile(_folder.Root + "/none.pdb");
            Surface.BeginLoadSource();
            Assert.That(_rig.Failures.Count, Is.EqualTo(2));
            Assert.That(_rig.Failures[1].Message, Does.Contain("none.pdb"));
            Assert.That(Surface.IsLoading, Is.False);
            Assert.That(Surface.AtomCount, Is.EqualTo(1));
            Assert.That(Surface.Mesh.vertexCount, Is.EqualTo(vertices));
        }

        [UnityTest]
        public IEnumerator TextAssetsMayBeDestroyedAtAnyTime()
        {
            for (int frames = 0; frames < 5; ++frames)
            {
                Surface.ClearAtoms();
                _loaded = 0;
                _rig.Failures.Clear();
                TextAsset asset = LongText();
                Surface.Source.SetAsset(asset);
                Surface.BeginLoadSource();
                yield return SurfaceRig.Frames(frames);
                Object.DestroyImmediate(asset);
                yield return SurfaceRig.Until(() => !Surface.IsLoading);
                Assert.That(_loaded + _rig.Failures.Count, Is.EqualTo(1));
                if (frames < 2) // it takes three to copy
                    Assert.That(_rig.Failures[0].Message, Does.Contain("destroyed").And.Contain("small.pdb"));
                if (_loaded == 1)
                    AssertShowsFile(0);
            }
        }

        [UnityTest]
        public IEnumerator WhatAHandlerBeginsToReadBringsItsAtoms()
        {
            Surface.Source.SetFile(_folder.Write("many.pdb", TestFrames.Pdb(3)));
            Surface.Loaded += () =>
            {
                AssertShowsFile(Surface.Source.Model - 1);
                if (Surface.Source.Model == 3)
                    return;
                ++Surface.Source.Model;
                Surface.BeginLoadSource();
            };
            Surface.BeginLoadSource();
            yield return SurfaceRig.Until(() => !Surface.IsLoading);
            Assert.That(_loaded, Is.EqualTo(3));
            AssertShowsFile(2);
            Assert.That(Surface.Structure, Is.Not.Null);
        }

        [UnityTest]
        public IEnumerator WhatIsReadForNewColoursBringsAtomsThatAreElsewhereByNow()
        {
            Surface.Source.SetFile(_folder.Write("small.pdb", TestFrames.Pdb(1)));
            Surface.BeginLoadSource();
            yield return SurfaceRig.Until(() => _loaded == 1);
            _folder.Write("small.pdb", TestFrames.Pdb(new[] { TestFrames.Frame(4) }));
            Surface.Source.ColorScheme = AtomColorScheme.Chain;
            Surface.FollowSourceSoon();
            yield return SurfaceRig.Until(() => _loaded == 2);
            AssertShowsFile(4);
        }

        [UnityTest]
        public IEnumerator NewColoursLeaveAtomsWhereScriptsMovedThem()
        {
            Surface.Source.SetFile(_folder.Write("small.pdb", TestFrames.Pdb(1)));
            Surface.BeginLoadSource();
            yield return SurfaceRig.Until(() => _loaded == 1);
            Vector3[] moved = TestMolecules.Moved(Surface.Positions.ToArray(), 1);
            Surface.SetPositions(moved);
            Surface.Source.ColorScheme = AtomColorScheme.Chain;
            Surface.FollowSourceSoon();
            yield return SurfaceRig.Until(() => _loaded == 2);
            Assert.That(Surface.Positions.ToArray(), Is.EqualTo(moved));
        }

        [UnityTest]
        public IEnumerator HandlersMayDoAnything()
        {
            int wired = 0;
            Surface.Events.Loaded.AddListener(() => ++wired);
            Surface.Source.SetAsset(Text(TestFrames.Pdb(1)));
            Surface.Loaded += () =>
            {
                if (_loaded == 1)
                    Surface.BeginLoadSource();
                else
                    Object.DestroyImmediate(_rig.GameObject);
            };
            Surface.BeginLoadSource();
            yield return SurfaceRig.Until(() => _rig.GameObject == null);
            Assert.That(_loaded, Is.EqualTo(2));
            Assert.That(wired, Is.EqualTo(1), "what is destroyed raises nothing");
        }
    }
}
