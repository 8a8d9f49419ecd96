// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using System;
using System.Collections;
using System.Collections.Generic;
using UnityEngine;
using UnityEngine.TestTools;

namespace QuickSes.Tests
{
    /// <summary>
    /// Whatever is done to some surfaces in whatever order: in the end each shows its own atoms, finest. What a step does,
    /// and what a surface's handler does the n-th time, is a matter of the seed alone; when meshes come is not.
    /// </summary>
    internal sealed class RandomUseTest
    {
        private const int Count = 8;
        private const int Steps = 600;

        private readonly SurfaceRig[] _rigs = new SurfaceRig[Count];
        private readonly Vector3[][] _positions = new Vector3[Count][]; // null: no atoms
        private readonly float[][] _radii = new float[Count][];
        private readonly List<string> _done = new List<string>();
        private int _seed;
        private bool _isOver;

        [TearDown]
        public void TellWhatWasDone()
        {
            if (TestContext.CurrentContext.Result.Outcome.Status == NUnit.Framework.Interfaces.TestStatus.Failed)
                TestContext.Out.WriteLine(string.Join("\n", _done));
        }

        [UnityTest]
        public IEnumerator EachShowsItsOwnInTheEnd([Values(1, 2, 3, 4, 5, 6)] int seed) => UseAtRandom(seed);

        [UnityTest]
        public IEnumerator SoItDoesOnTheGpu([Values(7, 8, 9, 10)] int seed)
        {
            IGpuLibrary library = GpuDelivery.Library;
            using (var gpu = new StandInGpu())
            {
                GpuDelivery.Library = gpu;
                SurfaceScheduler.Delivery = SurfaceDelivery.Device;
                yield return UseAtRandom(seed);
                Assert.That(gpu.Submissions, Is.GreaterThan(0));
                Assert.That(gpu.Faults, Is.Empty);
                Assert.That(GpuDelivery.Targets, Is.EqualTo(0));
                SurfaceScheduler.Delivery = SurfaceDelivery.Host;
                GpuDelivery.Library = library;
            }
        }

        private IEnumerator UseAtRandom(int seed)
        {
            _isOver = false;
            _seed = seed;
            _done.Clear();
            int most = SurfaceScheduler.MaxContexts;
            double budget = SurfaceScheduler.UploadBudget;
            SurfaceScheduler.ReleaseContexts();
            SurfaceScheduler.MaxContexts = 1 + seed % 3;
            for (int k = 0; k < Count; ++k)
                Renew(k, 0);
            for (int step = 1; step <= Steps; ++step)
            {
                System.Random random = RandomOf(step, 0);
                bool isFrame = random.Next(2) > 0;
                DoSomething(random.Next(Count), random, step, $"step {step}");
                if (isFrame)
                    yield return null;
            }
            SurfaceScheduler.UploadBudget = budget;
            _isOver = true;
            foreach (SurfaceRig rig in _rigs)
            {
                rig.GameObject.SetActive(true);
                rig.Surface.enabled = true;
                rig.Surface.SetVisible(Array.Empty<bool>());
                rig.Surface.Recompute();
            }
            for (int k = 0; k < Count; ++k)
            {
                if (!HasAtoms(k)) // those of its source, that is
                {
                    _rigs[k].Surface.ClearAtoms();
                    _positions[k] = null;
                    continue;
                }
                _rigs[k].Surface.SetAtoms(_positions[k], _radii[k]);
                _rigs[k].Surface.SetColors(ColorsOf(k));
            }
            yield return SurfaceRig.Until(() => Array.TrueForAll(_rigs, rig => !rig.Surface.IsBusy));
            for (int k = 0; k < Count; ++k)
            {
                MolecularSurface surface = _rigs[k].Surface;
                if (_positions[k] == null)
                    Assert.That(surface.Mesh.vertexCount, Is.EqualTo(0));
                else
                    AssertShows(k);
            }
            Assert.That(SurfaceScheduler.LentCount, Is.EqualTo(0));
            Assert.That(SurfaceScheduler.WaitingCount, Is.EqualTo(0));
            Assert.That(SurfaceScheduler.UploadingCount, Is.EqualTo(0));
            foreach (SurfaceRig rig in _rigs)
                Retire(rig);
            SurfaceScheduler.MaxContexts = most;
            SurfaceScheduler.UploadBudget = budget;
        }

        // A sequence of its own for each: how many numbers are drawn in between is a matter of time.
        private System.Random RandomOf(int step, int number) =>
            TestMolecules.RandomOf(unchecked((_seed * 1000 + step) * 1000 + number));

        private void Renew(int k, int step)
        {
            int calls = 0;
            var rig = new SurfaceRig("surface " + k);
            _rigs[k] = rig;
            _positions[k] = null;
            rig.Surface.Source.SetAsset(new TextAsset(TestFrames.Pdb(1)) { name = "small.pdb" });
            rig.Surface.ClearAtoms();
            rig.Surface.SurfaceUpdated += level => // handlers may do anything, too
            {
                if (_isOver)
                    return;
                System.Random random = RandomOf(step, 1 + k + Count * ++calls);
                if (random.Next(6) == 0)
                    DoSomething(k, random, step, $"handler of {k}, call {calls}");
            };
        }

        private static void Retire(SurfaceRig rig)
        {
            Assert.That(rig.Failures, Has.None.Matches<QuickSesError>(
                error => error.Status != QuickSesStatus.InvalidArgument), "but positions that are no numbers");
            rig.Dispose();
        }

        private bool HasAtoms(int k) =>
            _positions[k] != null && _rigs[k].Surface.AtomCount == _positions[k].Length;

        private Color32[] ColorsOf(int k) =>
            Array.ConvertAll(_radii[k], radius => new Color32((byte)(90 * radius), (byte)k, 3, 255));

        private void AssertShows(int k)
        {
            MolecularSurface surface = _rigs[k].Surface;
            SurfaceMeshes.AssertShows(surface, _positions[k], _radii[k]);
            if (!surface.Mesh.HasVertexAttribute(UnityEngine.Rendering.VertexAttribute.Color))
                return; // a texture, then
            Color32[] expected = ColorsOf(k), painted = surface.Mesh.colors32;
            for (int v = 0; v < surface.CurrentLevel.VertexCount; ++v)
                Assert.That(painted[v], Is.EqualTo(expected[surface.OwnerAtomAt(v)]));
        }

        private void DoSomething(int k, System.Random random, int step, string who)
        {
            MolecularSurface surface = _rigs[k].Surface;
            int what = random.Next(22);
            _done.Add($"{who}: {what} of surface {k}, which has {surface.AtomCount} atoms");
            switch (what)
            {
                case 0:
                case 1:
                    TestMolecules.Blob(1 + random.Next(300), random.Next(), out _positions[k], out _radii[k]);
                    surface.SetAtoms(_positions[k], _radii[k]);
                    break;
                case 2:
                case 3:
                    if (!HasAtoms(k))
                        break;
                    _positions[k] = TestMolecules.Moved(_positions[k], random.Next());
                    surface.SetPositions(_positions[k]);
                    break;
                case 4:
                    if (HasAtoms(k))
                        surface.SetColors(new Color32[_positions[k].Length]);
                    break;
                case 5:
                    surface.Cancel();
                    break;
                case 6:
                    surface.Recompute();
                    break;
                case 7:
                    surface.ClearAtoms();
                    _positions[k] = null;
                    break;
                case 8:
                    if (HasAtoms(k))
                        surface.ComputeNow();
                    break;
                case 9:
                    surface.enabled = !surface.enabled;
                    break;
                case 10:
                    _rigs[k].GameObject.SetActive(!_rigs[k].GameObject.activeSelf);
                    break;
                case 11:
                    surface.Backend = surface.Backend == SurfaceBackend.Auto ? SurfaceBackend.Cpu : SurfaceBackend.Auto;
                    if (random.Next(5) == 0)
                        SurfaceScheduler.ReleaseContexts();
                    break;
                case 12:
                    if (!HasAtoms(k))
                        break;
                    var bad = (Vector3[])_positions[k].Clone();
                    bad[0].x = float.NaN;
                    surface.SetPositions(bad);
                    Engine.Frame(0.01);
                    if (HasAtoms(k))
                        _rigs[k].Surface.SetPositions(_positions[k]);
                    break;
                case 13:
                    SurfaceScheduler.UploadBudget = random.Next(3) switch { 0 => 0, 1 => 1e-6, _ => 2 };
                    break;
                case 14:
                    surface.Coloring = (AtomColoring)random.Next(3);
                    break;
                case 15:
                    if (HasAtoms(k))
                        surface.SetVisible(Array.ConvertAll(_positions[k], place => random.Next(3) > 0));
                    break;
                case 16:
                    if (HasAtoms(k))
                        surface.SetTexcoords(new Vector2[random.Next(2) * _positions[k].Length]);
                    break;
                case 17:
                    surface.CompactVertices = false;
                    surface.RestDelay = random.Next(2) * 0.05f;
                    break;
                case 18:
                    RenderThread.Run(); // what was on its way to it is there
                    if (random.Next(2) > 0)
                        surface.Mesh.Clear();
                    else
                        surface.Mesh.uv2 = new Vector2[surface.Mesh.vertexCount];
                    surface.TryPick(new Ray(Vector3.back * 99, Vector3.forward), out _, out _);
                    break;
                case 19:
                    if (random.Next(4) > 0)
                        break;
                    Retire(_rigs[k]);
                    Renew(k, step);
                    break;
                case 20:
                    surface.BeginLoadSource();
                    surface.VisibleSelection = random.Next(2) > 0 ? "(!HOH)" : "";
                    break;
                case 21:
                    if (random.Next(3) == 0)
                        UnityEngine.Object.DestroyImmediate(surface.Mesh);
                    break;
            }
        }
    }
}
