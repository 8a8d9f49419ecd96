// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using System;
using UnityEngine;
using UnityEngine.TestTools;
using Vector2 = System.Numerics.Vector2;

namespace QuickSes.Tests
{
    /// <summary>What a surface shows, without the component.</summary>
    internal sealed class ShownSurfaceTest
    {
        private SurfaceContext _context;
        private ShownSurface _shown;
        private UnmanagedBuffer<byte> _room;

        [SetUp]
        public void SetUp()
        {
            _context = new SurfaceContext(new SurfaceContextOptions { Backend = SurfaceBackend.Cpu });
            _context.SetAtoms(new float[3], new[] { 1.5f });
            _shown = new ShownSurface();
            _room = new UnmanagedBuffer<byte>();
        }

        [TearDown]
        public void TearDown()
        {
            _shown.Dispose();
            _context.Dispose();
            _room.Dispose();
        }

        [Test]
        public void LooksAreFreedWithTheirSurfaces()
        {
            var looks = new AtomLook[3];
            for (int k = 0; k < looks.Length; ++k)
                looks[k] = Take();
            Assert.That(Array.ConvertAll(looks, IsFreed), Is.EqualTo(new[] { true, true, false }));
            Assert.That(Upload(), Is.EqualTo(UploadStep.Shown));
            Assert.That(IsFreed(looks[2]), Is.False, "it is shown");
            AtomLook dropped = Take();
            _shown.DropUpload();
            Assert.That(IsFreed(dropped));
            AtomLook next = Take();
            Assert.That(Upload(), Is.EqualTo(UploadStep.Shown));
            Assert.That(IsFreed(looks[2]) && !IsFreed(next));
            _shown.Clear();
            Assert.That(IsFreed(next));
        }

        [Test]
        public void WhatIsOnTheGpuHasNothingLeftOfWhatWasBefore()
        {
            IGpuLibrary library = GpuDelivery.Library;
            using (var gpu = new StandInGpu())
            {
                GpuDelivery.Library = gpu;
                SurfaceScheduler.Delivery = SurfaceDelivery.Device;
                AtomLook byHost = Take();
                Upload();
                Take(isMoving: true);
                Assert.That(_shown.Upload(new UploadShare(1, 1, _room), out _), Is.EqualTo(UploadStep.Unfinished));
                Assert.That(Engine.LiveObjects<Mesh>(), Is.EqualTo(2), "one is being filled");
                AtomLook first = Take(gpu: gpu);
                Assert.That(Deliver(), Is.EqualTo(UploadStep.Unfinished));
                Assert.That(Deliver(), Is.EqualTo(UploadStep.Shown));
                Assert.That(IsFreed(byHost) && !IsFreed(first));
                Assert.That(Engine.LiveObjects<Mesh>(), Is.EqualTo(1));
                AtomLook second = Take(gpu: gpu);
                Assert.That(Deliver(), Is.EqualTo(UploadStep.Shown));
                Assert.That(IsFreed(first) && !IsFreed(second));
                _shown.Clear();
                Assert.That(IsFreed(second));
                SurfaceScheduler.Delivery = SurfaceDelivery.Host;
                GpuDelivery.Library = library;
                Assert.That(gpu.Faults, Is.Empty);
            }
        }

        [Test]
        public void NoSecondMeshIsLeftAtRestByWhatWasDropped()
        {
            Take();
            Upload();
            Assert.That(Engine.LiveObjects<Mesh>(), Is.EqualTo(1));
            Take(isMoving: true);
            Assert.That(_shown.Upload(new UploadShare(1, 1, _room), out _), Is.EqualTo(UploadStep.Unfinished));
            _shown.DropUpload();
            Assert.That(Engine.LiveObjects<Mesh>(), Is.EqualTo(2), "more may follow");
            _shown.Rest();
            Assert.That(Engine.LiveObjects<Mesh>(), Is.EqualTo(1));
        }

        [Test]
        public void ALookThatCantBeShownIsGivenUpAtOnce()
        {
            AtomLook look = Take(coordinates: Vector2.Zero);
            Upload();
            look.SetColors(new[] { 1u }, 0);
            look.SetTexcoords(new[] { Vector2.One });
            look.SetVisible(new[] { false });
            Assert.That(_shown.HasUpload);
            _shown.Mesh.UploadMeshData(true);
            LogAssert.ignoreFailingMessages = true; // the engine logs it as well
            Assert.Throws<InvalidOperationException>(() => Upload());
            LogAssert.ignoreFailingMessages = false;
            Assert.That(_shown.HasUpload, Is.False);
        }

        [Test]
        public void AMeshThatIsDestroyedHalfPaintedIsNotWaitedFor([Values] bool isAskedFor)
        {
            AtomLook look = Take();
            Upload();
            look.SetColors(new[] { 1u }, 0);
            Assert.That(_shown.Upload(new UploadShare(1, 1, _room), out _), Is.EqualTo(UploadStep.Unfinished));
            UnityEngine.Object.DestroyImmediate(_shown.Mesh);
            if (isAskedFor)
                Assert.That(_shown.Mesh.vertexCount, Is.EqualTo(0));
            for (int step = 0; step < 5 && _shown.HasUpload; ++step)
                Upload();
            Assert.That(_shown.HasUpload, Is.False);
            Take();
            Assert.That(Upload(), Is.EqualTo(UploadStep.Shown));
            Assert.That(_shown.Mesh.vertexCount, Is.GreaterThan(0));
        }

        // Of somebody who does not need the look any longer.
        private AtomLook Take(bool isMoving = false, Vector2? coordinates = null, IGpuLibrary gpu = null)
        {
            SurfaceSettings settings = SurfaceSettings.Default;
            settings.Tag = SurfaceScheduler.NextJob();
            if (gpu != null)
                settings.Delivery = gpu.Delivery;
            settings.VertexLayout = SurfaceVertexLayout.Interleaved;
            Assert.That(_context.Compute(settings, out _), Is.EqualTo(QuickSesStatus.Ok));
            var look = new AtomLook(1, uint.MaxValue);
            if (coordinates.HasValue)
                look.SetTexcoords(new[] { coordinates.Value });
            _shown.Take(_context, look, isMoving);
            look.Release();
            return look;
        }

        private UploadStep Upload() => _shown.Upload(new UploadShare(long.MaxValue, long.MaxValue, _room), out _);

        // A frame.
        private UploadStep Deliver()
        {
            UploadStep step = _shown.Deliver(false);
            GpuDelivery.Issue();
            RenderThread.Run();
            return step;
        }

        private static bool IsFreed(AtomLook look) => look.Colors.IsEmpty;
    }
}
