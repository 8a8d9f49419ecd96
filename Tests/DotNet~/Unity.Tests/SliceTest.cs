// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using System;
using System.Collections;
using System.Collections.Generic;
using Unity.Collections;
using UnityEngine;
using UnityEngine.Rendering;
using UnityEngine.TestTools;
using Object = UnityEngine.Object;

namespace QuickSes.Tests
{
    /// <summary>Surfaces that are uploaded in pieces, and what may happen meanwhile. A piece per frame.</summary>
    internal sealed class SliceTest
    {
        private const int Atoms = 400; // a surface of many pieces of the least size
        private const double PiecePerFrame = 1e-6; // ms

        private SurfaceRig _rig;
        private double _budget;
        private Vector3[] _positions;
        private float[] _radii;

        [SetUp]
        public void SetUp()
        {
            _budget = SurfaceScheduler.UploadBudget;
            TestMolecules.Blob(Atoms, 1, out _positions, out _radii);
        }

        [TearDown]
        public void TearDown()
        {
            SurfaceScheduler.UploadBudget = _budget;
            SurfaceScheduler.MaxContexts = 4;
            _rig?.Dispose();
            Assert.That(SurfaceScheduler.UploadingCount, Is.EqualTo(0));
        }

        [UnityTest]
        public IEnumerator TheOldSurfaceIsShownUntilTheNewOneIsFull()
        {
            yield return ShowFirst();
            Mesh before = _rig.Surface.Mesh;
            int vertices = before.vertexCount, triangles = _rig.Surface.CurrentLevel.TriangleCount;
            Vector3[] shown = before.vertices;
            MeshRecord.Of(before).Clear();
            int updates = _rig.Levels.Count, frames = 0;
            _rig.Surface.SetPositions(Moved(1));
            yield return UntilUploading();
            while (_rig.Levels.Count == updates)
            {
                Assert.That(_rig.Surface.Mesh, Is.SameAs(before));
                Assert.That(Filter.sharedMesh, Is.SameAs(before));
                Assert.That(before.vertexCount, Is.EqualTo(vertices));
                Assert.That(before.GetIndexCount(0), Is.EqualTo(3 * triangles));
                Assert.That(MeshRecord.Of(before).BytesUploaded, Is.EqualTo(0));
                Assert.That(_rig.Surface.Owners.Length, Is.EqualTo(vertices));
                ++frames;
                long bytes = MeshRecord.AllBytesUploaded;
                yield return null;
                Assert.That(MeshRecord.AllBytesUploaded - bytes, Is.LessThanOrEqualTo(UploadQueue.MaxPiece));
            }
            Assert.That(frames, Is.GreaterThan(3));
            Assert.That(before.vertices, Is.EqualTo(shown), "it is the other one now, and was not touched");
            Assert.That(_rig.Surface.Mesh, Is.Not.SameAs(before));
            Assert.That(Filter.sharedMesh, Is.SameAs(_rig.Surface.Mesh));
            Assert.That(_rig.Surface.CurrentLevel.LatencyMilliseconds, Is.GreaterThan(0));
            SurfaceMeshes.AssertShows(_rig.Surface, Moved(1), _radii, true);
        }

        [UnityTest]
        public IEnumerator TwoMeshesTakeTurnsWhileAtomsMoveAndOneIsLeftAtRest()
        {
            yield return ShowFirst();
            var meshes = new HashSet<Mesh>();
            _rig.Surface.RestDelay = 1e6f;
            for (int frame = 0; frame < 6; ++frame)
            {
                int updates = _rig.Levels.Count;
                _rig.Surface.SetPositions(Moved(frame));
                yield return SurfaceRig.Until(() => _rig.Levels.Count > updates);
                meshes.Add(_rig.Surface.Mesh);
            }
            Assert.That(meshes.Count, Is.EqualTo(2));
            Assert.That(Engine.LiveObjects<Mesh>(), Is.EqualTo(2));
            _rig.Surface.RestDelay = 0;
            yield return SurfaceRig.Until(() => Engine.LiveObjects<Mesh>() == 1);
            Assert.That(_rig.Surface.Mesh.vertexCount, Is.EqualTo(_rig.Surface.CurrentLevel.VertexCount));
            SurfaceMeshes.AssertShows(_rig.Surface, Moved(5), _radii);
        }

        [UnityTest]
        public IEnumerator InPiecesOrAtOnceTheBytesAreTheSame(
            [Values(AtomColoring.Vertices, AtomColoring.Texture)] AtomColoring coloring, [Values] bool hides,
            [Values] bool isCompact)
        {
            var meshes = new Mesh[2];
            var rigs = new SurfaceRig[2];
            var frames = new int[2]; // that uploaded something
            for (int k = 0; k < 2; ++k)
            {
                rigs[k] = new SurfaceRig("surface " + k);
                MolecularSurface surface = rigs[k].Surface;
                surface.Levels = Array.Empty<float>();
                surface.Coloring = coloring;
                surface.CompactVertices = isCompact;
                surface.SetAtoms(_positions, _radii);
                surface.SetColors(Array.ConvertAll(_radii, radius => new Color32((byte)(100 * radius), 7, 9, 255)));
                surface.SetTexcoords(Array.ConvertAll(_positions, place => new Vector2(place.x, place.z)));
                if (hides)
                    surface.SetVisible(Array.ConvertAll(_positions, place => place.x > 0));
                SurfaceScheduler.UploadBudget = k == 0 ? 0 : PiecePerFrame;
                long bytes = MeshRecord.AllBytesUploaded;
                yield return SurfaceRig.Until(() =>
                {
                    frames[k] += MeshRecord.AllBytesUploaded > bytes ? 1 : 0;
                    bytes = MeshRecord.AllBytesUploaded;
                    return !surface.IsBusy;
                });
                meshes[k] = surface.Mesh;
            }
            Assert.That(frames[0], Is.EqualTo(1));
            Assert.That(frames[1], Is.GreaterThan(3));
            AssertSameBytes(meshes[0], meshes[1]);
            foreach (SurfaceRig rig in rigs)
                rig.Dispose();
        }

        [UnityTest]
        public IEnumerator TextureCoordinatesMayGoAndComeMeanwhile([Values] bool hasThemFirst)
        {
            yield return ShowFirst();
            _rig.Surface.AmbientOcclusion = false;
            yield return _rig.Settle();
            Vector2[] texcoords = Array.ConvertAll(_positions, place => new Vector2(place.x, place.z));
            _rig.Surface.SetTexcoords(hasThemFirst ? texcoords : Array.Empty<Vector2>());
            for (int frames = 0; frames < 12; ++frames)
            {
                yield return _rig.Settle();
                _rig.Surface.SetPositions(Moved(frames));
                yield return UntilUploading();
                yield return SurfaceRig.Frames(frames);
                hasThemFirst = !hasThemFirst;
                _rig.Surface.SetTexcoords(hasThemFirst ? texcoords : Array.Empty<Vector2>());
            }
            yield return _rig.Settle();
            Assert.That(_rig.Failures, Is.Empty);
            Assert.That(_rig.Surface.Mesh.HasVertexAttribute(VertexAttribute.TexCoord1), Is.EqualTo(hasThemFirst));
            SurfaceMeshes.AssertShows(_rig.Surface, Moved(11), _radii);
        }

        [UnityTest]
        public IEnumerator AfterAFailureItRestsToo([Values] bool isCancelled)
        {
            yield return ShowFirst();
            _rig.Surface.RestDelay = 0;
            for (int frame = 0; frame < 3; ++frame)
            {
                int updates = _rig.Levels.Count;
                _rig.Surface.SetPositions(Moved(frame));
                yield return SurfaceRig.Until(
                    () => _rig.Levels.Count > updates && _rig.Surface.CurrentLevel.IsOfNewestAtoms);
                _rig.Surface.RestDelay = 1e6f;
            }
            Vector3[] bad = Moved(9);
            bad[3].x = float.NaN;
            _rig.Surface.SetPositions(isCancelled ? Moved(9) : bad);
            if (isCancelled)
                _rig.Surface.Cancel();
            yield return _rig.Settle();
            Assert.That(_rig.Failures.Count, Is.EqualTo(isCancelled ? 0 : 1));
            _rig.Surface.RestDelay = 0;
            yield return SurfaceRig.Until(() => Engine.LiveObjects<Mesh>() == 1);
            yield return _rig.Settle();
            Assert.That(_rig.Surface.Mesh.vertexCount, Is.EqualTo(_rig.Surface.CurrentLevel.VertexCount));
            SurfaceMeshes.AssertShows(_rig.Surface, Moved(2), _radii, true);
        }

        [UnityTest]
        public IEnumerator NobodyStarves([Values(1, 4)] int contexts)
        {
            SurfaceScheduler.MaxContexts = contexts;
            SurfaceScheduler.UploadBudget = PiecePerFrame;
            var rigs = new SurfaceRig[30];
            var positions = new Vector3[rigs.Length][];
            for (int k = 0; k < rigs.Length; ++k)
            {
                TestMolecules.Blob(30 + k, k, out positions[k], out float[] radii);
                rigs[k] = new SurfaceRig("surface " + k);
                rigs[k].Surface.SetAtoms(positions[k], radii);
            }
            int frame = 0;
            yield return SurfaceRig.Until(() =>
            {
                ++frame;
                for (int k = 0; k < rigs.Length; ++k)
                    rigs[k].Surface.SetPositions(TestMolecules.Moved(positions[k], frame));
                return Array.TrueForAll(rigs, rig => rig.Levels.Count >= 3);
            });
            yield return SurfaceRig.Until(() => Array.TrueForAll(rigs, rig => !rig.Surface.IsBusy));
            foreach (SurfaceRig rig in rigs)
            {
                Assert.That(rig.Surface.CurrentLevel.IsOfNewestAtoms && rig.Surface.CurrentLevel.IsFinest);
                Assert.That(rig.Failures, Is.Empty);
                rig.Dispose();
            }
        }

        [UnityTest]
        public IEnumerator DestroyedMeanwhileItLeavesNothing([Values] bool reloads)
        {
            Engine.BeforeReload += DomainLifeCycle.OnDomainUnloads;
            int blocks = NativeHeap.LiveCount(Allocator.Persistent);
            for (int frames = 0; frames < 5; ++frames)
            {
                yield return ShowFirst();
                _rig.Surface.SetPositions(Moved(2));
                yield return UntilUploading();
                yield return SurfaceRig.Frames(frames);
                if (reloads)
                    Engine.Reload();
                _rig.Dispose();
                yield return null;
                Assert.That(Engine.LiveObjects<Mesh>(), Is.EqualTo(0));
                Assert.That(SurfaceScheduler.UploadingCount, Is.EqualTo(0));
            }
            Assert.That(NativeHeap.LiveCount(NativeHeap.Meshes), Is.EqualTo(0));
            Assert.That(NativeHeap.LiveCount(Allocator.Persistent), Is.EqualTo(blocks));
        }

        [UnityTest]
        public IEnumerator DisabledMeanwhileItKeepsThePictureAndGoesOnLater([Values(0, 1, 4)] int frames)
        {
            yield return ShowFirst();
            _rig.Surface.SetPositions(Moved(3));
            yield return UntilUploading();
            yield return SurfaceRig.Frames(frames);
            _rig.Surface.enabled = false;
            Mesh shown = _rig.Surface.Mesh;
            Assert.That(SurfaceScheduler.UploadingCount, Is.EqualTo(0));
            yield return SurfaceRig.Frames(10);
            Assert.That(_rig.Surface.Mesh, Is.SameAs(shown));
            SurfaceMeshes.AssertShows(_rig.Surface, _positions, _radii);
            Assert.That(Filter.sharedMesh, Is.SameAs(shown));
            _rig.Surface.enabled = true;
            yield return _rig.Settle();
            SurfaceMeshes.AssertShows(_rig.Surface, Moved(3), _radii);
        }

        [UnityTest]
        public IEnumerator ComputedNowItIsShownAtOnce()
        {
            yield return ShowFirst();
            _rig.Surface.SetPositions(Moved(4));
            yield return UntilUploading();
            _rig.Surface.SetPositions(Moved(5));
            Assert.That(_rig.Surface.ComputeNow());
            Assert.That(_rig.Surface.IsBusy, Is.False);
            Assert.That(_rig.Surface.Mesh.vertexCount, Is.EqualTo(_rig.Surface.CurrentLevel.VertexCount));
            SurfaceMeshes.AssertShows(_rig.Surface, Moved(5), _radii);
        }

        [UnityTest]
        public IEnumerator WhoChangesTheHiddenMeshHarmsNobody([Values] bool clears)
        {
            yield return ShowFirst();
            _rig.Surface.RestDelay = 1e6f;
            Mesh first = _rig.Surface.Mesh;
            for (int frame = 0; frame < 4; ++frame)
            {
                int updates = _rig.Levels.Count;
                _rig.Surface.SetPositions(Moved(frame));
                yield return SurfaceRig.Until(() =>
                {
                    if (first != null && _rig.Surface.Mesh != first)
                        Change(first, clears); // in every frame, while it is filled anew
                    return _rig.Levels.Count > updates;
                });
            }
            Assert.That(_rig.Failures, Is.Empty);
            SurfaceMeshes.AssertShows(_rig.Surface, Moved(3), _radii, true);
        }

        [UnityTest]
        public IEnumerator WhoChangesTheMeshHasItUntilTheNextSurface(
            [Values] bool clears, [Values(PiecePerFrame, 0)] double budget)
        {
            yield return ShowFirst();
            _rig.Surface.AmbientOcclusion = false; // or the mesh would have a TexCoord1 of its own
            yield return _rig.Settle();
            SurfaceScheduler.UploadBudget = budget;
            Change(_rig.Surface.Mesh, clears);
            _rig.Surface.SetPositions(Moved(1));
            yield return _rig.Settle();
            Assert.That(_rig.Failures, Is.Empty);
            SurfaceMeshes.AssertShows(_rig.Surface, Moved(1), _radii);

            Change(_rig.Surface.Mesh, clears);
            uint jobs = SurfaceScheduler.LastJob;
            _rig.Surface.SetColors(new Color32[Atoms]);
            yield return _rig.Settle();
            Assert.That(_rig.Failures, Is.Empty);
            Assert.That(SurfaceScheduler.LastJob, Is.EqualTo(jobs));
            SurfaceMeshes.AssertShows(_rig.Surface, Moved(1), _radii);
            Assert.That(_rig.Surface.Mesh.HasVertexAttribute(VertexAttribute.TexCoord1), Is.False);
        }

        [UnityTest]
        public IEnumerator WhatTheEngineRefusesKeepsTheOldSurface()
        {
            yield return ShowFirst();
            _rig.Surface.RestDelay = 1e6f;
            _rig.Surface.SetPositions(Moved(1));
            int updates = _rig.Levels.Count;
            yield return SurfaceRig.Until(() => _rig.Levels.Count > updates);
            Mesh shown = _rig.Surface.Mesh, hidden = null;
            foreach (Mesh mesh in Engine.AllObjects<Mesh>())
                hidden = mesh == shown ? hidden : mesh;
            _rig.Surface.SetPositions(Moved(2));
            yield return UntilUploading();
            LogAssert.ignoreFailingMessages = true;
            hidden.UploadMeshData(true);
            yield return SurfaceRig.Until(() => _rig.Failures.Count > 0);
            LogAssert.ignoreFailingMessages = false;
            Assert.That(_rig.Surface.LastError.Status, Is.EqualTo(QuickSesStatus.InternalError));
            Assert.That(Filter.sharedMesh, Is.SameAs(shown));
            Assert.That(_rig.Surface.Mesh, Is.SameAs(shown));
            SurfaceMeshes.AssertShows(_rig.Surface, Moved(1), _radii, true);
        }

        [UnityTest]
        public IEnumerator AFilterWithAnotherMeshIsLeftAlone()
        {
            yield return ShowFirst();
            var other = new Mesh();
            Filter.sharedMesh = other;
            _rig.Surface.SetPositions(Moved(1));
            yield return _rig.Settle();
            Assert.That(Filter.sharedMesh, Is.SameAs(other));
            Object.DestroyImmediate(other);
        }

        [UnityTest]
        public IEnumerator OneColourTouchesOnlyItsVertices()
        {
            yield return ShowFirst();
            var colors = new Color32[Atoms];
            _rig.Surface.SetColors(colors);
            yield return _rig.Settle();
            SurfaceScheduler.UploadBudget = 0;
            colors[5] = new Color32(255, 0, 0, 255);
            long bytes = MeshRecord.AllBytesUploaded;
            _rig.Surface.SetColors(colors);
            yield return _rig.Settle();
            bytes = MeshRecord.AllBytesUploaded - bytes;
            uint[] owners = _rig.Surface.Owners.ToArray();
            int sides = _rig.Surface.Repeated.Length; // on the other side of a crease: after all others
            Assert.That(sides, Is.GreaterThan(0));
            Assert.That(bytes, Is.EqualTo(
                4L * (Extent(owners.AsSpan(0, owners.Length - sides), 5) + Extent(owners.AsSpan(owners.Length - sides), 5))));
            Color32[] painted = _rig.Surface.Mesh.colors32;
            for (int v = 0; v < owners.Length; ++v)
                Assert.That(painted[v], Is.EqualTo(colors[owners[v]]));
        }

        [UnityTest]
        public IEnumerator PlayingInPiecesMakesNoGarbage(
            [Values(AtomColoring.Vertices, AtomColoring.Texture)] AtomColoring coloring)
        {
            yield return ShowFirst(coloring);
            Engine.ChecksMeshes = false;
            _rig.Surface.RestDelay = 1e6f;
            var frames = new Vector3[16][];
            for (int k = 0; k < frames.Length; ++k)
                frames[k] = Moved(k);
            var colors = new[] { new Color32[Atoms], Array.ConvertAll(_radii, r => new Color32(9, 9, 9, 255)) };
            int count = 0;
            int shown = 0;
            _rig.Surface.SurfaceUpdated += level => ++shown;
            _rig.Levels.Capacity = 100000;
            TestDelegate play = () =>
            {
                for (int until = shown + 6; shown < until;)
                {
                    _rig.Surface.SetPositions(frames[++count % frames.Length]);
                    _rig.Surface.SetColors(colors[count / 50 % 2]);
                    Engine.Frame(0.01);
                    System.Threading.Thread.Sleep(1);
                }
            };
            Garbage.AssertNone(play);
        }

        private MeshFilter Filter => _rig.GameObject.GetComponent<MeshFilter>();

        private Vector3[] Moved(int seed) => TestMolecules.Moved(_positions, seed);

        private IEnumerator ShowFirst(AtomColoring coloring = AtomColoring.Vertices)
        {
            SurfaceScheduler.UploadBudget = PiecePerFrame;
            _rig = new SurfaceRig();
            _rig.Surface.Coloring = coloring;
            _rig.Surface.Levels = Array.Empty<float>();
            _rig.Surface.FrameBudget = 0;
            _rig.Surface.SetAtoms(_positions, _radii);
            yield return _rig.Settle();
        }

        private static int Extent(ReadOnlySpan<uint> owners, uint owner) => owners.IndexOf(owner) < 0
            ? 0
            : owners.LastIndexOf(owner) - owners.IndexOf(owner) + 1;

        private static IEnumerator UntilUploading() => SurfaceRig.Until(() => SurfaceScheduler.UploadingCount > 0);

        private static void Change(Mesh mesh, bool clears)
        {
            if (clears)
                mesh.Clear();
            else
                mesh.uv2 = new Vector2[mesh.vertexCount];
        }

        private static void AssertSameBytes(Mesh a, Mesh b)
        {
            Assert.That(a.GetVertexAttributes(), Is.EqualTo(b.GetVertexAttributes()));
            Assert.That(a.vertexCount, Is.EqualTo(b.vertexCount));
            using (Mesh.MeshDataArray first = Mesh.AcquireReadOnlyMeshData(a), second = Mesh.AcquireReadOnlyMeshData(b))
            {
                for (int stream = 0; stream < 3; ++stream)
                    Assert.That(first[0].GetVertexData<byte>(stream).ToArray()
                        .AsSpan().SequenceEqual(second[0].GetVertexData<byte>(stream).ToArray()), $"stream {stream}");
                int count = first[0].GetSubMesh(0).indexCount;
                Assert.That(second[0].GetSubMesh(0).indexCount, Is.EqualTo(count).And.GreaterThan(0));
                Assert.That(first[0].GetIndexData<uint>().ToArray().AsSpan(0, count)
                    .SequenceEqual(second[0].GetIndexData<uint>().ToArray().AsSpan(0, count)));
            }
        }
    }
}
