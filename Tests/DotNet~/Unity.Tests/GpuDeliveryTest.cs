// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using System;
using System.Collections;
using UnityEngine;
using UnityEngine.Rendering;
using UnityEngine.TestTools;
using Object = UnityEngine.Object;

namespace QuickSes.Tests
{
    /// <summary>Surfaces that stay on the GPU, as long as everything works.</summary>
    internal sealed class GpuDeliveryTest
    {
        private GpuRig _gpu;

        private MolecularSurface Surface => _gpu.Surface;

        [SetUp]
        public void SetUp() => _gpu = new GpuRig();

        [TearDown]
        public void TearDown() => _gpu.Dispose();

        [UnityTest]
        public IEnumerator FramesAreDrawnAsByHostMemory([Values] GpuMeshPlan plan,
            [Values(AtomColoring.Vertices, AtomColoring.Texture)] AtomColoring coloring, [Values] bool isCompact)
        {
            SurfaceScheduler.GpuMeshPlan = plan;
            Surface.Coloring = coloring;
            Surface.CompactVertices = isCompact;
            yield return _gpu.ShowFirst();
            Surface.SetColors(Array.ConvertAll(_gpu.Radii, radius => new Color32((byte)(100 * radius), 7, 9, 255)));
            for (int frame = 0; frame < 4; ++frame)
            {
                yield return _gpu.Show(_gpu.Moved(frame));
                Assert.That(Surface.UsedDelivery, Is.EqualTo(SurfaceDelivery.Device));
                Assert.That(Surface.DeliveryReason, Is.Empty);
                GpuRig.AssertDrawn(Surface);
                if (plan == GpuMeshPlan.SubMeshPerFrame && !isCompact)
                    SurfaceMeshes.AssertShows(Surface, _gpu.Moved(frame), _gpu.Radii, true);
            }
            Assert.That(MeshRecord.Of(Surface.Mesh).BytesUploaded, Is.EqualTo(0));
        }

        [UnityTest]
        public IEnumerator OnceMadeTheMeshIsHardlyTouched([Values] GpuMeshPlan plan)
        {
            SurfaceScheduler.GpuMeshPlan = plan;
            yield return _gpu.ShowFirst();
            Mesh mesh = Surface.Mesh;
            MeshRecord.Of(mesh).Clear();
            for (int frame = 0; frame < 5; ++frame)
                yield return _gpu.Show(_gpu.Moved(frame));
            Assert.That(Surface.Mesh, Is.SameAs(mesh));
            MeshRecord record = MeshRecord.Of(mesh);
            Assert.That(record.NativePointerCalls + record.VertexParamsCalls + record.IndexParamsCalls, Is.EqualTo(0));
            Assert.That(record.SubMeshCalls, Is.EqualTo(plan == GpuMeshPlan.SubMeshPerFrame ? 5 : 0));
            Assert.That(_gpu.Renderer.HasOwnBounds, Is.EqualTo(plan == GpuMeshPlan.WholeBuffers));
            Assert.That(mesh.vertexBufferTarget.HasFlag(GraphicsBuffer.Target.Raw));
            Assert.That(mesh.indexBufferTarget.HasFlag(GraphicsBuffer.Target.Raw));
        }

        [UnityTest]
        public IEnumerator APlanMayChangeMeanwhile()
        {
            yield return _gpu.ShowFirst();
            foreach (GpuMeshPlan plan in new[] { GpuMeshPlan.WholeBuffers, GpuMeshPlan.SubMeshPerFrame })
            {
                SurfaceScheduler.GpuMeshPlan = plan;
                yield return SurfaceRig.Frames(2);
                yield return _gpu.Rig.Settle();
                Assert.That(_gpu.Renderer.HasOwnBounds, Is.EqualTo(plan == GpuMeshPlan.WholeBuffers));
                GpuRig.AssertDrawn(Surface);
            }
            Assert.That(Surface.UsedDelivery, Is.EqualTo(SurfaceDelivery.Device));
        }

        [UnityTest]
        public IEnumerator ALargerSurfaceIsShownWhenItIsInItsNewBuffers()
        {
            yield return _gpu.ShowFirst();
            yield return _gpu.Show(_gpu.Moved(1));
            Mesh before = Surface.Mesh;
            int triangles = Surface.CurrentLevel.TriangleCount, updates = _gpu.Rig.Levels.Count;
            RenderThread.IsRunning = false;
            Surface.SetAtoms(Spread(_gpu.Start, 2), _gpu.Radii);
            yield return SurfaceRig.Until(() => RenderThread.Waiting > 0);
            yield return SurfaceRig.Frames(3);
            Assert.That(Surface.Mesh, Is.SameAs(before));
            Assert.That(before.GetIndexCount(0), Is.EqualTo(3 * triangles), "the old one is shown");
            Assert.That(Surface.IsBusy);
            Assert.That(_gpu.Rig.Levels.Count, Is.EqualTo(updates));
            RenderThread.IsRunning = true;
            yield return _gpu.Rig.Settle();
            Assert.That(Surface.Mesh, Is.Not.SameAs(before));
            Assert.That(Surface.CurrentLevel.TriangleCount, Is.GreaterThan(triangles * 5 / 4));
            GpuRig.AssertDrawn(Surface);
            Assert.That(before == null, "the old buffers are gone");
            Assert.That(Engine.LiveObjects<Mesh>(), Is.EqualTo(1));
        }

        [UnityTest]
        public IEnumerator SurfacesShareOneEventPerFrame()
        {
            yield return _gpu.ShowFirst();
            SurfaceRig other = _gpu.NewSurface("other");
            other.Surface.SetAtoms(_gpu.Moved(9), _gpu.Radii);
            yield return other.Settle();
            bool haveBothBeenInOne = false;
            for (int frame = 0; frame < 60 || !haveBothBeenInOne; ++frame)
            {
                Surface.SetPositions(_gpu.Moved(frame));
                other.Surface.SetPositions(_gpu.Moved(frame + 1));
                System.Threading.Thread.Sleep(10); // so that often both are there
                int events = RenderThread.Issued, submissions = _gpu.Gpu.Submissions;
                yield return null;
                Assert.That(RenderThread.Issued - events, Is.LessThanOrEqualTo(1));
                haveBothBeenInOne |= _gpu.Gpu.Submissions - submissions == 2;
            }
            yield return SurfaceRig.Until(() => !Surface.IsBusy && !other.Surface.IsBusy);
            GpuRig.AssertDrawn(Surface);
            GpuRig.AssertDrawn(other.Surface);
            other.Dispose();
        }

        [UnityTest]
        public IEnumerator ColoursAndWhatIsHiddenChangeWithoutAJob(
            [Values(AtomColoring.Vertices, AtomColoring.Texture)] AtomColoring coloring)
        {
            Surface.Coloring = coloring;
            yield return _gpu.ShowFirst();
            uint job = SurfaceScheduler.LastJob;
            int updates = _gpu.Rig.Levels.Count, looks = _gpu.Gpu.LooksSet;
            Mesh mesh = Surface.Mesh;
            Surface.SetColors(Array.ConvertAll(_gpu.Radii, radius => new Color32(1, (byte)(100 * radius), 3, 4)));
            yield return null;
            yield return null;
            GpuRig.AssertDrawn(Surface);
            bool[] visible = Array.ConvertAll(_gpu.Start, place => place.x > 5);
            Surface.SetVisible(visible);
            yield return null;
            yield return null;
            GpuRig.AssertDrawn(Surface);
            if (coloring == AtomColoring.Texture)
                Assert.That(_gpu.Gpu.LooksSet, Is.EqualTo(looks), "that is the shader's business");
            else
                Assert.That(_gpu.Gpu.LooksSet, Is.EqualTo(looks + 2));
            Surface.SetVisible(Array.Empty<bool>());
            yield return _gpu.Rig.Settle();
            GpuRig.AssertDrawn(Surface);
            Assert.That(Surface.Mesh, Is.SameAs(mesh));
            Assert.That(SurfaceScheduler.LastJob, Is.EqualTo(job));
            Assert.That(_gpu.Rig.Levels.Count, Is.EqualTo(updates));
            Assert.That(Surface.UsedDelivery, Is.EqualTo(SurfaceDelivery.Device));
        }

        [UnityTest]
        public IEnumerator OtherAtomsHaveColoursOfTheirOwn()
        {
            Surface.Coloring = AtomColoring.Vertices;
            for (byte molecule = 0; molecule < 3; ++molecule)
            {
                Surface.SetAtoms(_gpu.Moved(molecule), _gpu.Radii);
                Surface.SetColors(Array.ConvertAll(_gpu.Radii, radius => new Color32((byte)(100 * radius), molecule, 3, 4)));
                yield return _gpu.Rig.Settle();
                Assert.That(Surface.UsedDelivery, Is.EqualTo(SurfaceDelivery.Device));
                GpuRig.AssertDrawn(Surface);
            }
        }

        [UnityTest]
        public IEnumerator ColoursGoFromATextureIntoTheVertices()
        {
            Surface.Coloring = AtomColoring.Texture;
            yield return _gpu.ShowFirst();
            Surface.Coloring = AtomColoring.Vertices;
            yield return _gpu.Rig.Settle();
            Assert.That(Surface.UsedDelivery, Is.EqualTo(SurfaceDelivery.Device));
            GpuRig.AssertDrawn(Surface);
        }

        [UnityTest]
        public IEnumerator WhatIsHiddenByATextureIsInTheBuffers()
        {
            Surface.Coloring = AtomColoring.Texture;
            Surface.SetAtoms(_gpu.Start, _gpu.Radii);
            Surface.SetVisible(Array.ConvertAll(_gpu.Start, place => place.x > 5));
            yield return _gpu.Rig.Settle();
            Surface.SetVisible(Array.Empty<bool>());
            yield return _gpu.Rig.Settle();
            GpuRig.AssertDrawn(Surface);
        }

        [UnityTest]
        public IEnumerator OtherAttributesTakeOtherBuffers()
        {
            Surface.Coloring = AtomColoring.Vertices;
            yield return _gpu.ShowFirst();
            Surface.SetTexcoords(Array.ConvertAll(_gpu.Start, place => new Vector2(place.x, place.z)));
            yield return _gpu.Rig.Settle();
            Assert.That(Surface.Mesh.HasVertexAttribute(VertexAttribute.TexCoord1));
            GpuRig.AssertDrawn(Surface);
            Surface.SetTexcoords(Array.ConvertAll(_gpu.Start, place => new Vector2(place.y, place.z)));
            yield return _gpu.Rig.Settle();
            GpuRig.AssertDrawn(Surface);
            Surface.Coloring = AtomColoring.Texture;
            yield return _gpu.Rig.Settle();
            Assert.That(Surface.Mesh.HasVertexAttribute(VertexAttribute.TexCoord7));
            GpuRig.AssertDrawn(Surface);
            Surface.Coloring = AtomColoring.Vertices;
            yield return _gpu.Rig.Settle();
            GpuRig.AssertDrawn(Surface);
            Assert.That(Surface.UsedDelivery, Is.EqualTo(SurfaceDelivery.Device));
        }

        [UnityTest]
        public IEnumerator AMeshOfSomebodyElsesHasItsOwnBounds()
        {
            SurfaceScheduler.GpuMeshPlan = GpuMeshPlan.WholeBuffers;
            yield return _gpu.ShowFirst();
            Assert.That(_gpu.Renderer.HasOwnBounds);
            var filter = Surface.GetComponent<MeshFilter>();
            var theirs = new Mesh { vertices = new[] { Vector3.zero, Vector3.right, Vector3.up }, triangles = new[] { 0, 2, 1 } };
            filter.sharedMesh = theirs;
            yield return SurfaceRig.Frames(2);
            Assert.That(_gpu.Renderer.HasOwnBounds, Is.False);
            yield return _gpu.Show(_gpu.Moved(1));
            Assert.That(filter.sharedMesh, Is.SameAs(theirs));
            Assert.That(_gpu.Renderer.HasOwnBounds, Is.False);
            filter.sharedMesh = Surface.Mesh;
            yield return SurfaceRig.Frames(2);
            GpuRig.AssertDrawn(Surface);
            Object.DestroyImmediate(theirs);
        }

        [UnityTest]
        public IEnumerator AComponentThatIsRemovedLeavesNoBounds()
        {
            SurfaceScheduler.GpuMeshPlan = GpuMeshPlan.WholeBuffers;
            yield return _gpu.ShowFirst();
            MeshRenderer renderer = _gpu.Renderer;
            Assert.That(renderer.HasOwnBounds);
            Object.DestroyImmediate(Surface);
            Assert.That(renderer.HasOwnBounds, Is.False);
        }

        [UnityTest]
        public IEnumerator NothingComesHomeUntilSomebodyAsks()
        {
            yield return _gpu.ShowFirst();
            yield return _gpu.Show(_gpu.Moved(3));
            Assert.That(_gpu.Gpu.Downloads, Is.EqualTo(0));
            Assert.That(Surface.Area, Is.GreaterThan(0));
            int last = Surface.CurrentLevel.VertexCount - 1;
            Assert.That(Surface.OwnerAtomAt(last), Is.InRange(0, GpuRig.Atoms - 1));
            Assert.That(_gpu.Gpu.Downloads, Is.EqualTo(1));
            Assert.That(Surface.Owners.Length, Is.EqualTo(last + 1));
            Assert.That((int)Surface.Owners[last], Is.EqualTo(Surface.OwnerAtomAt(last)));
            Assert.Throws<ArgumentOutOfRangeException>(() => Surface.OwnerAtomAt(last + 1));
            Vector3 centre = _gpu.Renderer.localBounds.center;
            Assert.That(Surface.TryPick(new Ray(centre + 100 * Vector3.right, -Vector3.right), out int atom, out _));
            Assert.That(atom, Is.InRange(0, GpuRig.Atoms - 1));
            Assert.That(_gpu.Gpu.Downloads, Is.EqualTo(1));
            SurfaceMeshes.AssertShows(Surface, _gpu.Moved(3), _gpu.Radii, true);
            yield return _gpu.Show(_gpu.Moved(4));
            Assert.That(_gpu.Gpu.Downloads, Is.EqualTo(1));
            Assert.That(Surface.TryPick(new Ray(centre + 100 * Vector3.up, -Vector3.up), out _, out _));
            Assert.That(_gpu.Gpu.Downloads, Is.EqualTo(2));
        }

        [UnityTest]
        public IEnumerator ComputeNowShowsAtOnce([Values] bool isFirst, [Values] bool isLarger)
        {
            if (!isFirst)
                yield return _gpu.ShowFirst();
            Surface.SetAtoms(Spread(_gpu.Moved(5), isLarger ? 2 : 1), _gpu.Radii);
            int events = RenderThread.Issued;
            Assert.That(Surface.ComputeNow());
            Assert.That(RenderThread.Issued, Is.EqualTo(events + 1), "before anything of this frame is drawn");
            Assert.That(Surface.UsedDelivery, Is.EqualTo(SurfaceDelivery.Device));
            RenderThread.Run();
            GpuRig.AssertDrawn(Surface);
            yield return _gpu.Rig.Settle();
            GpuRig.AssertDrawn(Surface);
            Assert.That(Engine.LiveObjects<Mesh>(), Is.EqualTo(1), "the old buffers are gone");
        }

        [UnityTest]
        public IEnumerator TheEndMayComeDuringADelivery([Values] bool isFirst, [Values] bool isDestroyed)
        {
            if (!isFirst)
                yield return _gpu.ShowFirst();
            RenderThread.IsRunning = false;
            Surface.SetAtoms(Spread(_gpu.Start, 2), _gpu.Radii);
            yield return SurfaceRig.Until(() => RenderThread.Waiting > 0);
            if (isDestroyed)
            {
                Object.DestroyImmediate(_gpu.Rig.GameObject);
                RenderThread.Run();
                Assert.That(Engine.LiveObjects<Mesh>(), Is.EqualTo(0));
                yield break;
            }
            Surface.ClearAtoms();
            yield return null;
            RenderThread.Run();
            Assert.That(Surface.UsedDelivery, Is.EqualTo(SurfaceDelivery.Auto));
            Assert.That(Surface.GetComponent<MeshFilter>().sharedMesh, Is.SameAs(Surface.Mesh));
            Assert.That(Surface.Mesh.vertexCount, Is.EqualTo(0));
            RenderThread.IsRunning = true;
            yield return _gpu.ShowFirst();
            GpuRig.AssertDrawn(Surface);
        }

        [UnityTest]
        public IEnumerator WhatIsDroppedDoesNotCountLater()
        {
            yield return _gpu.ShowFirst();
            Mesh before = Surface.Mesh;
            RenderThread.IsRunning = false;
            Surface.SetAtoms(Spread(_gpu.Start, 2), _gpu.Radii);
            yield return SurfaceRig.Until(() => RenderThread.Waiting > 0);
            Surface.enabled = false;
            RenderThread.IsRunning = true;
            yield return SurfaceRig.Frames(3);
            Assert.That(Surface.Mesh, Is.SameAs(before));
            GpuRig.AssertDrawn(Surface);
            Surface.SetAtoms(Spread(_gpu.Moved(1), 2), _gpu.Radii);
            Surface.enabled = true;
            yield return _gpu.Rig.Settle();
            GpuRig.AssertDrawn(Surface);
            SurfaceMeshes.AssertShows(Surface, Spread(_gpu.Moved(1), 2), _gpu.Radii, true);
        }

        [UnityTest]
        public IEnumerator BuffersThatAreTooSmallBeforeTheyAreShownGo()
        {
            yield return _gpu.ShowFirst();
            RenderThread.IsRunning = false;
            foreach (float spacing in new[] { 0.4f, 0.3f, 0.2f })
            {
                int submissions = _gpu.Gpu.Submissions;
                Surface.enabled = false;
                Surface.Spacing = spacing;
                Surface.enabled = true;
                if (spacing == 0.2f)
                    RenderThread.IsRunning = true; // two may wait
                yield return SurfaceRig.Until(() => _gpu.Gpu.Submissions > submissions);
            }
            yield return _gpu.Rig.Settle();
            GpuRig.AssertDrawn(Surface);
            Assert.That(Engine.LiveObjects<Mesh>(), Is.EqualTo(1));
        }

        [UnityTest]
        public IEnumerator FramesMakeNoGarbage([Values] GpuMeshPlan plan,
            [Values(AtomColoring.Vertices, AtomColoring.Texture)] AtomColoring coloring)
        {
            SurfaceScheduler.GpuMeshPlan = plan;
            Surface.Coloring = coloring;
            yield return _gpu.ShowFirst();
            Engine.ChecksMeshes = false;
            var frames = new Vector3[16][];
            for (int k = 0; k < frames.Length; ++k)
                frames[k] = _gpu.Moved(k);
            var colors = new[] { new Color32[GpuRig.Atoms], Array.ConvertAll(_gpu.Radii, r => new Color32(9, 9, 9, 255)) };
            int count = 0, shown = 0;
            Surface.SurfaceUpdated += level => ++shown;
            _gpu.Rig.Levels.Capacity = 100000;
            TestDelegate play = () =>
            {
                for (int until = shown + 20; shown < until;)
                {
                    Surface.SetPositions(frames[++count % frames.Length]);
                    Surface.SetColors(colors[count / 5 % 2]);
                    Engine.Frame(0.01);
                    System.Threading.Thread.Sleep(1);
                }
            };
            Garbage.AssertNone(play);
            Assert.That(Surface.UsedDelivery, Is.EqualTo(SurfaceDelivery.Device));
        }

        private static Vector3[] Spread(Vector3[] positions, float factor) =>
            Array.ConvertAll(positions, place => factor * place);
    }
}
