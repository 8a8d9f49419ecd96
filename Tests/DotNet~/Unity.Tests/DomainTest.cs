// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using System.Collections;
using Unity.Collections;
using UnityEngine;
using UnityEngine.TestTools;

namespace QuickSes.Tests
{
    /// <summary>Reloads of the domain, play mode without one, and the end of the program.</summary>
    internal sealed class DomainTest
    {
        private Vector3[] _positions;
        private float[] _radii;

        [SetUp]
        public void SetUp()
        {
            TestMolecules.Blob(300, 1, out _positions, out _radii);
            Engine.BeforeReload += DomainLifeCycle.OnDomainUnloads; // as the Editor calls it
        }

        [UnityTest]
        public IEnumerator AReloadDuringAJobAsksForTheAtomsAgain()
        {
            for (int frames = 0; frames < 5; ++frames)
            {
                var rig = new SurfaceRig();
                rig.Surface.SetAtoms(_positions, _radii);
                yield return SurfaceRig.Frames(frames);
                Engine.Reload();
                Assert.That(SurfaceScheduler.ContextCount, Is.EqualTo(0));
                Assert.That(Engine.LiveObjects<Mesh>(), Is.EqualTo(1), "the new one; the old one was not left behind");
                int requests = 0;
                rig.Surface.AtomsRequested += () =>
                {
                    ++requests;
                    rig.Surface.SetAtoms(_positions, _radii);
                };
                yield return SurfaceRig.Until(() => requests > 0 && !rig.Surface.IsBusy);
                Assert.That(requests, Is.EqualTo(1));
                SurfaceMeshes.AssertShows(rig.Surface, _positions, _radii);
                rig.Dispose();
                Assert.That(Engine.LiveObjects<Mesh>(), Is.EqualTo(0));
            }
        }

        [UnityTest]
        public IEnumerator AReloadWhileASourceIsReadReadsItAnew([Values] bool selects)
        {
            for (int frames = 0; frames < 5; ++frames)
            {
                var rig = new SurfaceRig();
                rig.Surface.Source.SetAsset(new TextAsset(TestFrames.Pdb(1)) { name = "small.pdb" });
                if (selects)
                    rig.Surface.VisibleSelection = "//A/1/CA";
                rig.Surface.BeginLoadSource();
                yield return SurfaceRig.Frames(frames);
                Engine.Reload();
                yield return SurfaceRig.Until(() => !rig.Surface.IsBusy);
                Assert.That(rig.Surface.AtomCount, Is.EqualTo(TestFrames.WithoutWater.Length));
                Assert.That(rig.Surface.CurrentLevel.IsFinest);
                Assert.That(rig.Surface.VisibleSelectionError, Is.Empty);
                rig.Dispose();
                Assert.That(Engine.LiveObjects<Mesh>(), Is.EqualTo(0));
            }
        }

        [UnityTest]
        public IEnumerator AReloadKeepsTheSettings()
        {
            var rig = new SurfaceRig();
            rig.Surface.ProbeRadius = 2;
            rig.Surface.Levels = new[] { 3f };
            Engine.Reload();
            Assert.That(rig.Surface.ProbeRadius, Is.EqualTo(2));
            Assert.That(rig.Surface.Levels, Is.EqualTo(new[] { 3f }));
            yield return null;
            rig.Dispose();
        }

        [UnityTest]
        public IEnumerator AMaterialThatWasChosenStays()
        {
            var chosen = new Material();
            var rig = new SurfaceRig();
            var renderer = rig.GameObject.GetComponent<MeshRenderer>();
            Assert.That(renderer.sharedMaterial != null, "the usual one");
            renderer.sharedMaterial = chosen;
            Engine.Reload();
            Assert.That(renderer.sharedMaterial, Is.SameAs(chosen));
            yield return null;
            rig.Dispose();
        }

        [UnityTest]
        public IEnumerator EditModeShowsSurfacesToo()
        {
            Engine.EnterEditMode();
            var rig = new SurfaceRig();
            rig.Surface.SetAtoms(_positions, _radii);
            yield return rig.Settle();
            SurfaceMeshes.AssertShows(rig.Surface, _positions, _radii);
            rig.Dispose();
            Assert.That(Engine.LiveObjects<Mesh>(), Is.EqualTo(0));
        }

        [UnityTest]
        public IEnumerator PlayModeWithoutReloadBeginsAfresh([Values] bool isDone)
        {
            Engine.EnterEditMode();
            var edited = new SurfaceRig();
            edited.Surface.SetAtoms(_positions, _radii);
            yield return isDone ? edited.Settle() : SurfaceRig.Frames(3);
            Engine.EnterPlayModeWithoutReload(typeof(MolecularSurface).Assembly);
            Assert.That(SurfaceScheduler.ContextCount, Is.EqualTo(0));
            Assert.That(SurfaceScheduler.WaitingCount, Is.EqualTo(0));
            var played = new SurfaceRig();
            played.Surface.SetAtoms(_positions, _radii);
            yield return played.Settle();
            SurfaceMeshes.AssertShows(played.Surface, _positions, _radii);
            played.Dispose();
        }

        private sealed class Feeder : MonoBehaviour
        {
            public MolecularSurface Surface;

            private void Awake()
            {
                TestMolecules.Blob(300, 1, out Vector3[] positions, out float[] radii);
                Surface.SetAtoms(positions, radii);
            }
        }

        [UnityTest]
        public IEnumerator InTheSceneOfEditModeASourceIsReadAgainAndTold()
        {
            Engine.EnterEditMode();
            var rig = new SurfaceRig();
            int loaded = 0;
            rig.Surface.Loaded += () => ++loaded;
            rig.Surface.Source.SetAsset(new TextAsset(TestFrames.Pdb(1)) { name = "small.pdb" });
            rig.Surface.BeginLoadSource();
            yield return rig.Settle();
            Assert.That((loaded, rig.Finished), Is.EqualTo((1, 1)));
            Engine.EnterPlayModeInTheSameScene(typeof(MolecularSurface).Assembly);
            rig.Levels.Clear();
            yield return SurfaceRig.Until(() => rig.Finished > 1);
            Assert.That((loaded, rig.Finished), Is.EqualTo((2, 2)));
            Assert.That(rig.Levels, Is.Not.Empty);
            Assert.That(rig.GameObject.GetComponent<MeshFilter>().sharedMesh, Is.SameAs(rig.Surface.Mesh));
            Assert.That(Engine.LiveObjects<Mesh>(), Is.EqualTo(1));
            rig.Dispose();
            Assert.That(Engine.LiveObjects<Mesh>(), Is.EqualTo(0));
        }

        [UnityTest]
        public IEnumerator InTheSceneOfEditModeScriptsFeedAgain([Values] bool areFirst)
        {
            Engine.EnterEditMode();
            Feeder feeder = areFirst ? new GameObject("feeder").AddComponent<Feeder>() : null;
            var rig = new SurfaceRig();
            if (areFirst)
                feeder.Surface = rig.Surface;
            rig.Surface.SetAtoms(_positions, _radii);
            yield return rig.Settle();
            Engine.EnterPlayModeInTheSameScene(typeof(MolecularSurface).Assembly);
            rig.Levels.Clear();
            rig.Finished = rig.Requests = 0;
            if (!areFirst)
                rig.Surface.AtomsRequested += () => rig.Surface.SetAtoms(_positions, _radii);
            yield return SurfaceRig.Until(() => rig.Finished > 0);
            Assert.That(rig.Requests, Is.EqualTo(areFirst ? 0 : 1));
            Assert.That(rig.Levels, Is.Not.Empty);
            SurfaceMeshes.AssertShows(rig.Surface, _positions, _radii);
            rig.Dispose();
        }

        [UnityTest]
        public IEnumerator InTheSceneOfEditModeASourceComesBeforeWhatAScriptGaveThere()
        {
            Engine.EnterEditMode();
            var rig = new SurfaceRig();
            rig.Surface.Source.SetAsset(new TextAsset(TestFrames.Pdb(1)) { name = "small.pdb" });
            rig.Surface.SetAtoms(_positions, _radii);
            yield return rig.Settle();
            Assert.That(rig.Surface.AtomCount, Is.EqualTo(_positions.Length));
            Engine.EnterPlayModeInTheSameScene(typeof(MolecularSurface).Assembly);
            yield return SurfaceRig.Until(() => rig.Surface.AtomCount > 0);
            Assert.That(rig.Surface.AtomCount, Is.EqualTo(TestFrames.WithoutWater.Length));
            rig.Dispose();
        }

        [UnityTest]
        public IEnumerator InTheSceneOfEditModeNobodyAsksForTheStructureOfAtomsThatAreGone()
        {
            Engine.EnterEditMode();
            var rig = new SurfaceRig();
            rig.Surface.Source.SetAsset(new TextAsset(TestFrames.Pdb(1)) { name = "small.pdb" });
            rig.Surface.BeginLoadSource();
            yield return rig.Settle();
            Assert.That(rig.Surface.Structure, Is.Not.Null);
            Engine.EnterPlayModeInTheSameScene(typeof(MolecularSurface).Assembly);
            int lines = 0;
            void Count(string line, string stack, LogType type) => ++lines;
            Application.logMessageReceived += Count;
            Assert.That(rig.Surface.Structure, Is.Null);
            Application.logMessageReceived -= Count;
            Assert.That(lines, Is.EqualTo(0), "nobody is told that it can't be read");
            yield return SurfaceRig.Until(() => rig.Surface.AtomCount > 0);
            Assert.That(rig.Surface.Structure, Is.Not.Null);
            rig.Dispose();
        }

        [UnityTest]
        public IEnumerator AnOpenPrefabStaysAsItIsInPlayMode()
        {
            Engine.EnterEditMode();
            var rig = new SurfaceRig();
            Engine.OpenAsPrefab(rig.GameObject);
            rig.Surface.SetAtoms(_positions, _radii);
            yield return rig.Settle();
            Assert.That(SurfaceScheduler.ContextCount, Is.GreaterThan(0));
            Engine.EnterPlayModeInTheSameScene(typeof(MolecularSurface).Assembly);
            Assert.That(SurfaceScheduler.ContextCount, Is.EqualTo(0), "they had the options of edit mode");
            SurfaceMeshes.AssertShows(rig.Surface, _positions, _radii);
            rig.Dispose();
        }

        [UnityTest]
        public IEnumerator AMeshThatASurfaceReplacedComesBackWithoutTheComponent([Values] bool isReloaded)
        {
            Engine.EnterEditMode();
            var cube = new Mesh();
            var made = new GameObject("cube", typeof(MeshFilter));
            var filter = made.GetComponent<MeshFilter>();
            filter.sharedMesh = cube;
            var surface = made.AddComponent<MolecularSurface>();
            surface.SetAtoms(_positions, _radii);
            yield return SurfaceRig.Until(() => !surface.IsBusy);
            if (isReloaded)
                Engine.Reload();
            Assert.That(filter.sharedMesh, Is.SameAs(surface.Mesh));
            Object.DestroyImmediate(surface);
            Assert.That(filter.sharedMesh, Is.SameAs(cube));
            Object.DestroyImmediate(made);
            Object.DestroyImmediate(cube);
        }

        [UnityTest]
        public IEnumerator PlayModeWithoutReloadOfTheSceneEither()
        {
            var rig = new SurfaceRig();
            rig.Surface.SetAtoms(_positions, _radii);
            yield return SurfaceRig.Frames(3);
            SurfaceScheduler.ReleaseContexts(); // what SubsystemRegistration does; the components stay as they are
            yield return rig.Settle();
            SurfaceMeshes.AssertShows(rig.Surface, _positions, _radii);
            rig.Dispose();
        }

        [UnityTest]
        public IEnumerator QuittingFreesEverything()
        {
            Engine.EnterPlayModeWithoutReload(typeof(MolecularSurface).Assembly);
            int blocks = NativeHeap.LiveCount(Allocator.Persistent);
            var rig = new SurfaceRig();
            rig.Surface.SetAtoms(_positions, _radii);
            yield return SurfaceRig.Until(() => SurfaceScheduler.ContextCount > 0);
            int contexts = -1;
            void Count() => contexts = SurfaceScheduler.ContextCount;
            Application.quitting += Count; // after the package
            Engine.Quit();
            Application.quitting -= Count;
            Assert.That(contexts, Is.EqualTo(0), "before anything of the scene goes");
            Assert.That(SurfaceScheduler.ContextCount, Is.EqualTo(0));
            Assert.That(Engine.LiveObjects<Mesh>(), Is.EqualTo(0));
            Assert.That(NativeHeap.LiveCount(NativeHeap.Meshes), Is.EqualTo(0));
            Assert.That(NativeHeap.LiveCount(Allocator.Persistent), Is.EqualTo(blocks));
        }
    }
}
