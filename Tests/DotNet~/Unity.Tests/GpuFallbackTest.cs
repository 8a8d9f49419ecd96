// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using QuickSes.Interop;
using System.Collections;
using UnityEngine;
using UnityEngine.Rendering;
using UnityEngine.TestTools;

namespace QuickSes.Tests
{
    /// <summary>Surfaces that were to stay on the GPU, and what is shown where that fails: always the right picture.</summary>
    internal sealed class GpuFallbackTest
    {
        private GpuRig _gpu;

        private MolecularSurface Surface => _gpu.Surface;

        [SetUp]
        public void SetUp() => _gpu = new GpuRig();

        [TearDown]
        public void TearDown()
        {
            SurfaceScheduler.MemoryBudget = 0;
            SurfaceScheduler.ReleaseContexts();
            _gpu.Dispose();
        }

        [UnityTest]
        public IEnumerator AFailureOfTheFirstEventIsNeverSeen()
        {
            _gpu.Gpu.EventFailure = "another GPU draws";
            yield return _gpu.ShowFirst();
            AssertByHost("another GPU draws");
            Assert.That(Engine.LiveObjects<Mesh>(), Is.EqualTo(1), "buffers that are never shown go");
            Assert.That(_gpu.Gpu.TargetCount, Is.EqualTo(0));
            int submissions = _gpu.Gpu.Submissions;
            yield return _gpu.Show(_gpu.Moved(1));
            Assert.That(_gpu.Gpu.Submissions, Is.EqualTo(submissions), "it is for good");
            AssertByHost("another GPU draws");
            Assert.That(_gpu.Rig.Failures, Is.Empty);
        }

        [UnityTest]
        public IEnumerator AFailureLaterEndsInTheSamePicture([Values] GpuMeshPlan plan)
        {
            SurfaceScheduler.GpuMeshPlan = plan;
            yield return _gpu.ShowFirst();
            yield return _gpu.Show(_gpu.Moved(1));
            Engine.ChecksMeshes = false; // for a frame old vertices have new counts
            _gpu.Gpu.EventFailure = "the device was lost";
            yield return _gpu.Show(_gpu.Moved(2));
            Engine.ChecksMeshes = true;
            AssertByHost("the device was lost");
            Assert.That(_gpu.Renderer.HasOwnBounds, Is.False);
            SurfaceMeshes.AssertShows(Surface, _gpu.Moved(2), _gpu.Radii, true);
        }

        [UnityTest]
        public IEnumerator ItIsTriedAgainWhenThatIsWanted([Values] bool byDelivery)
        {
            _gpu.Gpu.EventFailure = "not now";
            yield return _gpu.ShowFirst();
            AssertByHost("not now");
            _gpu.Gpu.EventFailure = null;
            if (byDelivery)
            {
                SurfaceScheduler.Delivery = SurfaceDelivery.Device;
            }
            else
            {
                Surface.enabled = false;
                Surface.enabled = true;
            }
            yield return _gpu.Show(_gpu.Moved(1));
            AssertOnGpu();
        }

        [UnityTest]
        public IEnumerator WhereEventsStopHostMemoryGoesOn([Values] bool isFirst)
        {
            if (!isFirst)
                yield return _gpu.ShowFirst();
            yield return SubmitUndrawn();
            _gpu.Gpu.LosePatience();
            yield return _gpu.Rig.Settle();
            AssertByHost("No event");
            yield return _gpu.Show(_gpu.Moved(2));
            AssertByHost("No event");
            RenderThread.IsRunning = true;
            yield return SurfaceRig.Frames(3);
            Assert.That(Surface.DeliveryReason, Is.Empty);
            yield return _gpu.Show(_gpu.Moved(3));
            Engine.ChecksMeshes = true; // of what nobody drew, counts and vertices were of two surfaces
            AssertOnGpu();
            SurfaceMeshes.AssertShows(Surface, _gpu.Moved(3), _gpu.Radii, true);
        }

        [UnityTest]
        public IEnumerator WhatWasLetGoIsSubmittedAgainWhereEventsHaveComeBackUnseen([Values] bool isFirst)
        {
            if (!isFirst)
                yield return _gpu.ShowFirst();
            int submissions = _gpu.Gpu.Submissions;
            yield return SubmitUndrawn();
            _gpu.Gpu.LosePatience();
            GpuDelivery.Issue();
            RenderThread.IsRunning = true;
            RenderThread.Run(); // all of it within a frame
            yield return SurfaceRig.Frames(3);
            yield return _gpu.Rig.Settle();
            Engine.ChecksMeshes = true;
            AssertOnGpu();
            Assert.That(_gpu.Gpu.Submissions, Is.EqualTo(submissions + 2));
            SurfaceMeshes.AssertShows(Surface, _gpu.Moved(1), _gpu.Radii, true);
        }

        [UnityTest]
        public IEnumerator WhileTooManyWaitNothingNewerIsTaken()
        {
            yield return _gpu.ShowFirst();
            yield return SubmitAsManyAsMayWait();
            int submissions = _gpu.Gpu.Submissions, updates = _gpu.Rig.Levels.Count;
            Surface.SetPositions(_gpu.Moved(2));
            yield return SurfaceRig.Until(() => SurfaceScheduler.LentCount == 0);
            for (int frame = 3; frame < 6; ++frame)
            {
                Surface.SetPositions(_gpu.Moved(frame));
                yield return SurfaceRig.Frames(10);
            }
            Assert.That(_gpu.Gpu.Submissions, Is.EqualTo(submissions));
            Assert.That(_gpu.Rig.Levels.Count, Is.EqualTo(updates));
            Assert.That(SurfaceScheduler.LentCount, Is.EqualTo(1), "the newest stays with its context");
            RenderThread.IsRunning = true;
            yield return null;
            Engine.ChecksMeshes = true;
            yield return _gpu.Rig.Settle();
            AssertOnGpu();
            SurfaceMeshes.AssertShows(Surface, _gpu.Moved(5), _gpu.Radii, true);
        }

        [UnityTest]
        public IEnumerator WhileTooManyWaitComputeNowTakesHostMemory()
        {
            yield return _gpu.ShowFirst();
            yield return SubmitAsManyAsMayWait();
            Surface.SetPositions(_gpu.Moved(2));
            Assert.That(Surface.ComputeNow());
            Assert.That(Surface.UsedDelivery, Is.EqualTo(SurfaceDelivery.Host));
            SurfaceMeshes.AssertShows(Surface, _gpu.Moved(2), _gpu.Radii, true);
            RenderThread.IsRunning = true;
            Engine.ChecksMeshes = true;
            yield return _gpu.Rig.Settle();
            SurfaceMeshes.AssertShows(Surface, _gpu.Moved(2), _gpu.Radii, true);
            yield return _gpu.Show(_gpu.Moved(3));
            AssertOnGpu();
        }

        // What was being copied into other buffers of the host is not shown after what came later.
        [UnityTest]
        public IEnumerator AnUploadOfTheSurfaceBeforeEndsWithTheDelivery()
        {
            SurfaceScheduler.Delivery = SurfaceDelivery.Host;
            Surface.Coloring = AtomColoring.Vertices;
            Surface.Spacing = 0.15f;
            yield return _gpu.ShowFirst();
            double budget = SurfaceScheduler.UploadBudget;
            SurfaceScheduler.Delivery = SurfaceDelivery.Device;
            RenderThread.IsRunning = false;
            Surface.SetAtoms(_gpu.Moved(1), _gpu.Radii);
            yield return SurfaceRig.Until(() => _gpu.Gpu.Submissions > 0);
            SurfaceScheduler.UploadBudget = 1e-6; // in many pieces
            Surface.Coloring = AtomColoring.Texture;
            yield return SurfaceRig.Frames(2);
            RenderThread.IsRunning = true;
            int updates = _gpu.Rig.Levels.Count;
            yield return SurfaceRig.Until(() => _gpu.Rig.Levels.Count > updates);
            SurfaceScheduler.UploadBudget = budget;
            yield return _gpu.Rig.Settle();
            AssertOnGpu();
            SurfaceMeshes.AssertShows(Surface, _gpu.Moved(1), _gpu.Radii, true);
        }

        [UnityTest]
        public IEnumerator WhereTheEngineGivesNoBuffersHostMemoryGoesOn([Values] bool isFirst)
        {
            if (!isFirst)
                yield return _gpu.ShowFirst();
            GraphicsMemory.Refusal = "there are no such buffers";
            Surface.Spacing = 0.25f; // for larger ones
            Surface.SetAtoms(_gpu.Moved(1), _gpu.Radii);
            yield return _gpu.Rig.Settle();
            GraphicsMemory.Refusal = null;
            AssertByHost("there are no such buffers");
            Assert.That(Engine.LiveObjects<Mesh>(), Is.EqualTo(1));
        }

        [UnityTest]
        public IEnumerator SwitchedOffItComesHome()
        {
            SurfaceScheduler.GpuMeshPlan = GpuMeshPlan.WholeBuffers;
            yield return _gpu.ShowFirst();
            AssertOnGpu();
            SurfaceScheduler.Delivery = SurfaceDelivery.Host;
            yield return _gpu.Rig.Settle();
            AssertByHost("Host");
            Assert.That(_gpu.Renderer.HasOwnBounds, Is.False);
            Assert.That(_gpu.Gpu.TargetCount, Is.EqualTo(0));
        }

        [UnityTest]
        public IEnumerator SwitchedOnAgainItLooksTheSame()
        {
            Surface.Coloring = AtomColoring.Vertices;
            yield return _gpu.ShowFirst();
            SurfaceScheduler.Delivery = SurfaceDelivery.Host;
            yield return _gpu.Rig.Settle();
            AssertByHost("Host");
            SurfaceScheduler.Delivery = SurfaceDelivery.Device;
            yield return _gpu.Show(_gpu.Moved(1));
            AssertOnGpu();
        }

        [UnityTest]
        public IEnumerator SwitchedOffDuringADeliveryItComesHome([Values] bool isFirst)
        {
            if (!isFirst)
                yield return _gpu.ShowFirst();
            yield return SubmitUndrawn();
            SurfaceScheduler.Delivery = SurfaceDelivery.Host;
            yield return _gpu.Rig.Settle();
            Engine.ChecksMeshes = true;
            AssertByHost("Host");
            Assert.That(_gpu.Gpu.TargetCount, Is.EqualTo(0));
            Assert.That(Engine.LiveObjects<Mesh>(), Is.EqualTo(1));
            SurfaceMeshes.AssertShows(Surface, _gpu.Moved(1), _gpu.Radii, true);
        }

        [UnityTest]
        public IEnumerator WhatCannotComeHomeStaysAndIsToldOnce()
        {
            yield return _gpu.ShowFirst();
            _gpu.Gpu.DownloadsFail = true;
            SurfaceScheduler.Delivery = SurfaceDelivery.Host;
            yield return SurfaceRig.Frames(5);
            Assert.That(_gpu.Rig.Failures.Count, Is.EqualTo(1));
            Assert.That(_gpu.Rig.Failures[0].Message, Does.Contain("no memory"));
            Assert.That(Surface.UsedDelivery, Is.EqualTo(SurfaceDelivery.Device));
            Assert.Throws<QuickSesException>(() => _ = Surface.Owners);
            _gpu.Gpu.DownloadsFail = false;
            yield return _gpu.Show(_gpu.Moved(1));
            AssertByHost("Host");
            SurfaceScheduler.Delivery = SurfaceDelivery.Device;
            yield return _gpu.Show(_gpu.Moved(2));
            AssertOnGpu();
            SurfaceScheduler.Delivery = SurfaceDelivery.Host;
            yield return _gpu.Rig.Settle();
            AssertByHost("Host");
        }

        [UnityTest]
        public IEnumerator AFailureThatWasToldIsNotToldAgain()
        {
            yield return _gpu.ShowFirst();
            Engine.ChecksMeshes = false; // what the event was to write is not there
            _gpu.Gpu.DownloadsFail = true; // so that it stays
            _gpu.Gpu.EventFailure = "the device was lost";
            Surface.SetPositions(_gpu.Moved(1));
            yield return SurfaceRig.Until(() => _gpu.Rig.Failures.Count > 0);
            Assert.That(Surface.UsedDelivery, Is.EqualTo(SurfaceDelivery.Device));
            Assert.That(Surface.DeliveryReason, Is.EqualTo("the device was lost"));
            _gpu.Gpu.DownloadsFail = false;
            _gpu.Gpu.EventFailure = null;
            SurfaceScheduler.Delivery = SurfaceDelivery.Device;
            RenderThread.IsRunning = false;
            int submissions = _gpu.Gpu.Submissions;
            Surface.SetPositions(_gpu.Moved(2));
            yield return SurfaceRig.Until(() => _gpu.Gpu.Submissions > submissions);
            yield return SurfaceRig.Frames(3);
            Assert.That(Surface.DeliveryReason, Is.Empty);
            RenderThread.IsRunning = true;
            yield return _gpu.Rig.Settle();
            Engine.ChecksMeshes = true;
            AssertOnGpu();
            SurfaceMeshes.AssertShows(Surface, _gpu.Moved(2), _gpu.Radii, true);
        }

        [UnityTest]
        public IEnumerator AMeshThatSomebodyChangesIsMadeAnew([Values] bool isDestroyed)
        {
            yield return _gpu.ShowFirst();
            if (isDestroyed)
                Object.DestroyImmediate(Surface.Mesh);
            else
                Surface.Mesh.Clear();
            yield return _gpu.Show(_gpu.Moved(1));
            AssertOnGpu();
            SurfaceMeshes.AssertShows(Surface, _gpu.Moved(1), _gpu.Radii, true);
        }

        [UnityTest]
        public IEnumerator WhereTheGpuHasNoMemoryTheHostIsAsked()
        {
            SurfaceScheduler.ReleaseContexts();
            SurfaceScheduler.MemoryBudget = 1000;
            uint job = SurfaceScheduler.LastJob;
            Surface.SetAtoms(_gpu.Start, _gpu.Radii);
            yield return SurfaceRig.Until(() => _gpu.Rig.Failures.Count > 0);
            Assert.That(SurfaceScheduler.LastJob - job, Is.EqualTo(2), "a second time for host memory");
            Assert.That(_gpu.Rig.Failures[0].Status, Is.EqualTo(QuickSesStatus.OutOfMemory));
            Assert.That(Surface.DeliveryReason, Is.EqualTo(_gpu.Rig.Failures[0].Message));
            Assert.That(Surface.ComputeNow(), Is.False);
        }

        [UnityTest]
        public IEnumerator DeliveryIsPossible([Values] SurfaceDelivery delivery, [Values(GraphicsDeviceType.OpenGLCore,
            GraphicsDeviceType.Direct3D11, GraphicsDeviceType.Vulkan, GraphicsDeviceType.Direct3D12,
            GraphicsDeviceType.Null)] GraphicsDeviceType device)
        {
            SystemInfo.GraphicsDevice = device;
            SurfaceScheduler.Delivery = delivery;
            yield return _gpu.ShowFirst();
            bool isWanted = delivery == SurfaceDelivery.Device &&
                (device == GraphicsDeviceType.OpenGLCore || device == GraphicsDeviceType.Direct3D11);
            if (isWanted)
            {
                AssertOnGpu();
                Assert.That(_gpu.Gpu.AskedFor, Is.EqualTo(
                    device == GraphicsDeviceType.OpenGLCore ? GpuGraphics.Opengl : GpuGraphics.D3d11));
                yield break;
            }
            AssertByHost(delivery == SurfaceDelivery.Host ? "Host" : device == GraphicsDeviceType.OpenGLCore
                ? "not large" : device == GraphicsDeviceType.Direct3D11 ? "Device does" : device + " is not supported");
            Assert.That(_gpu.Gpu.Submissions, Is.EqualTo(0));
        }

        [UnityTest]
        public IEnumerator LargeSurfacesStayByThemselves()
        {
            SurfaceScheduler.Delivery = SurfaceDelivery.Auto;
            Surface.Spacing = 0.1f; // more than 5 MB
            yield return _gpu.ShowFirst();
            yield return _gpu.Show(_gpu.Moved(1));
            Assert.That(28L * Surface.CurrentLevel.VertexCount + 12L * Surface.CurrentLevel.TriangleCount,
                Is.GreaterThan(5000000), "else the test is of something else");
            AssertOnGpu();
            Surface.Spacing = 1;
            yield return _gpu.Rig.Settle();
            yield return _gpu.Show(_gpu.Moved(2));
            AssertByHost("not large");
        }

        [UnityTest]
        public IEnumerator TheLibraryHasTheLastWord()
        {
            _gpu.Gpu.Refusal = "there is no CUDA in here";
            SurfaceScheduler.Delivery = SurfaceDelivery.Device;
            yield return _gpu.ShowFirst();
            AssertByHost("there is no CUDA in here");
        }

        [Test]
        public void HostIsTheDefault()
        {
            SurfaceScheduler.ResetOptions();
            Assert.That(SurfaceScheduler.Delivery, Is.EqualTo(SurfaceDelivery.Host));
            Assert.That(Surface.DeliveryReason, Does.Contain("Host"));
        }

        // Of what nobody draws, meshes are not checked.
        private IEnumerator SubmitUndrawn()
        {
            RenderThread.IsRunning = false;
            Engine.ChecksMeshes = false;
            int submissions = _gpu.Gpu.Submissions;
            Surface.SetAtoms(_gpu.Moved(1), _gpu.Radii);
            yield return SurfaceRig.Until(() => _gpu.Gpu.Submissions > submissions);
        }

        private IEnumerator SubmitAsManyAsMayWait()
        {
            RenderThread.IsRunning = false;
            Engine.ChecksMeshes = false;
            for (int frame = 0; frame < 2; ++frame)
            {
                int before = _gpu.Rig.Levels.Count;
                Surface.SetPositions(_gpu.Moved(frame));
                yield return SurfaceRig.Until(() => _gpu.Rig.Levels.Count > before);
            }
        }

        private void AssertOnGpu()
        {
            Assert.That(Surface.UsedDelivery, Is.EqualTo(SurfaceDelivery.Device));
            Assert.That(Surface.DeliveryReason, Is.Empty);
            GpuRig.AssertDrawn(Surface);
        }

        private void AssertByHost(string reason)
        {
            Assert.That(Surface.UsedDelivery, Is.EqualTo(SurfaceDelivery.Host));
            Assert.That(Surface.DeliveryReason, Does.Contain(reason));
            Assert.That(Surface.Mesh.vertexBufferTarget, Is.EqualTo(GraphicsBuffer.Target.Vertex));
            GpuRig.AssertDrawn(Surface);
        }
    }
}
