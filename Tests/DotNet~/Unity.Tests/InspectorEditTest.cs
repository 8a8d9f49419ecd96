// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System.Collections;
using UnityEngine;
using UnityEngine.TestTools;

namespace QuickSes.Tests
{
    /// <summary>Which edits compute the surface again: by the inspector, Undo and Revert, which all write fields.</summary>
    internal sealed class InspectorEditTest
    {
        private SurfaceRig _rig;

        [SetUp]
        public void MakeSurface() => _rig = SurfaceRig.WithBlob(40, 1);

        [TearDown]
        public void Destroy() => _rig.Dispose();

        [UnityTest]
        public IEnumerator WhatAScriptSetAndUndoTookBackIsComputedAgain()
        {
            float[] levels = _rig.Surface.Levels;
            yield return _rig.Settle();
            _rig.Surface.Spacing = 0.8f;
            _rig.Surface.Levels = new[] { 3f };
            yield return _rig.Settle();
            Assert.That(_rig.Surface.CurrentLevel.LevelCount, Is.EqualTo(2));
            Inspector.Set(_rig.Surface, "_spacing", 0.5f);
            Assert.That(_rig.Surface.IsBusy, Is.True);
            yield return _rig.Settle();
            Assert.That(_rig.Surface.CurrentLevel.Spacing, Is.EqualTo(0.5f));
            Inspector.Set(_rig.Surface, "_levels", levels);
            yield return _rig.Settle();
            Assert.That(_rig.Surface.CurrentLevel.LevelCount, Is.EqualTo(3));
        }

        [UnityTest]
        public IEnumerator WhichAtomsAreShownIsFollowed()
        {
            _rig.Surface.Source.SetAsset(new TextAsset(TestFrames.Pdb(1)) { name = "small.pdb" });
            Assert.That(_rig.Surface.LoadSource());
            _rig.Surface.Coloring = AtomColoring.Vertices; // triangles are left out
            yield return _rig.Settle();
            uint all = _rig.Surface.Mesh.GetIndexCount(0);
            Inspector.Set(_rig.Surface, "_visible", "//A/1/CA");
            yield return SurfaceRig.Frames(2);
            yield return _rig.Settle();
            Assert.That(_rig.Surface.VisibleSelectionError, Is.Empty);
            Assert.That(_rig.Surface.Mesh.GetIndexCount(0), Is.InRange(3, all - 3));
        }

        [UnityTest]
        public IEnumerator AnEditIsFollowedOnce()
        {
            yield return _rig.Settle();
            Inspector.Set(_rig.Surface, "_frameBudget", 10f);
            yield return SurfaceRig.Frames(2);
            var filter = _rig.GameObject.GetComponent<MeshFilter>();
            var theirs = new Mesh();
            filter.sharedMesh = theirs;
            yield return SurfaceRig.Frames(2);
            Assert.That(filter.sharedMesh, Is.SameAs(theirs));
            Object.DestroyImmediate(theirs);
        }

        [UnityTest]
        public IEnumerator WhatTheSurfaceDoesNotUseComputesNothingUntilItDoes()
        {
            MolecularSurface surface = _rig.Surface;
            surface.Surface = SurfaceKind.Vdw;
            yield return _rig.Settle();
            Inspector.Set(surface, "_method", SurfaceMethod.Grid);
            Assert.That(surface.IsBusy, Is.False);
            Inspector.Set(surface, "_surface", SurfaceKind.Ses);
            Assert.That(surface.IsBusy, Is.True);
            yield return _rig.Settle();
            Assert.That(surface.CurrentLevel.HasCreases, Is.False, "it is that of the grid method");
            Inspector.Set(surface, "_sharpCreases", false);
            Assert.That(surface.IsBusy, Is.False);
            Inspector.Set(surface, "_method", SurfaceMethod.Exact);
            yield return _rig.Settle();
            Inspector.Set(surface, "_sharpCreases", true);
            yield return _rig.Settle();
            Assert.That(surface.CurrentLevel.HasCreases, Is.True);
        }

        [UnityTest]
        public IEnumerator TheBackEndIsFollowedToo()
        {
            yield return _rig.Settle();
            Inspector.Set(_rig.Surface, "_backend", SurfaceBackend.Cpu);
            Assert.That(_rig.Surface.IsBusy, Is.True);
            yield return _rig.Settle();
        }

        [UnityTest]
        public IEnumerator MoreLevelsInAFileThanThereCanBeAreLeftOut()
        {
            _rig.GameObject.SetActive(false);
            Inspector.Write(_rig.Surface, "_levels", new[] { 9f, 8, 7, 6, 5, 4, 3, 2, 1, 0.9f });
            _rig.GameObject.SetActive(true);
            _rig.Surface.Recompute();
            yield return _rig.Settle();
            Assert.That(_rig.Surface.CurrentLevel.LevelCount, Is.EqualTo(SurfaceSettings.MaxLevels + 1));
        }

        [UnityTest]
        public IEnumerator EditsOfOtherThingsComputeNothing()
        {
            yield return _rig.Settle();
            _rig.Surface.Spacing = 0.8f;
            _rig.Surface.Levels = new[] { 3f };
            yield return _rig.Settle();
            int updates = _rig.Levels.Count;
            Inspector.Set(_rig.Surface, "_frameBudget", 10f);
            Assert.That(_rig.Surface.IsBusy, Is.False);
            yield return SurfaceRig.Frames(3);
            yield return _rig.Settle();
            Assert.That(_rig.Levels.Count, Is.EqualTo(updates));
        }
    }
}
