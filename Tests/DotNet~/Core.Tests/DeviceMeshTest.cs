// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.Interop;
using System;
using System.Linq;
using System.Runtime.InteropServices;

namespace QuickSes.Tests
{
    /// <summary>Meshes that stay on the GPU, with the library itself: where there is a GPU.</summary>
    [TestFixture(SurfaceVertexLayout.Interleaved)]
    [TestFixture(SurfaceVertexLayout.Compact)]
    public sealed class DeviceMeshTest
    {
        private readonly SurfaceVertexLayout _layout;
        private SurfaceContext _context;
        private KeptMesh _kept;

        public DeviceMeshTest(SurfaceVertexLayout layout)
        {
            _layout = layout;
        }

        private delegate void GraphicsEvent(int number);

        [SetUp]
        public void SetUp()
        {
            if (!SurfaceContext.IsSupported(SurfaceBackend.Cuda, out string reason))
                Assert.Ignore(reason);
            using Structure structure = Meshes.Crambin();
            _context = new SurfaceContext(new SurfaceContextOptions { Backend = SurfaceBackend.Cuda });
            Assert.That(_context.SetAtoms(structure.Positions, structure.Radii), Is.EqualTo(QuickSesStatus.Ok));
            _kept = new KeptMesh();
        }

        [TearDown]
        public void TearDown()
        {
            _kept?.Dispose();
            _context?.Dispose();
        }

        private void Keep(MeshDelivery delivery, uint tag)
        {
            SurfaceSettings settings = SurfaceSettings.Default;
            settings.VertexLayout = _layout;
            settings.Delivery = delivery;
            settings.Pickable = true;
            settings.Tag = tag;
            Meshes.Compute(_context, settings);
            Assert.That(_context.Keep(_kept), Is.True);
        }

        private static unsafe byte[] BytesOf(in SurfaceMeshView view) =>
            new ReadOnlySpan<byte>((void*)view.PositionsPointer, view.VertexCount * view.VertexBytes).ToArray();

        private static unsafe (float, float, float) FirstPosition(in SurfaceMeshView view)
        {
            float* position = view.PositionsPointer;
            return (position[0], position[1], position[2]);
        }

        [Test]
        public void ComesHomeTheSame()
        {
            Keep(MeshDelivery.Host, 1);
            SurfaceMeshView host = _kept.View;
            byte[] vertices = BytesOf(host);
            uint[] indices = host.Indices.ToArray(), owners = host.Owners.ToArray();
            Keep(MeshDelivery.Device, 2);
            SurfaceMeshView view = _kept.View;
            Assert.That(view.IsInHostMemory, Is.False);
            Assert.That(view.VertexLayout, Is.EqualTo(_layout));
            Assert.That(view.Tag, Is.EqualTo(2));
            Assert.That(view.VertexCount, Is.EqualTo(owners.Length));
            Assert.That(_kept.TryGetReport(out SurfaceReport report), Is.True);
            Assert.That(report.Area, Is.GreaterThan(0));
            Assert.That(_kept.Download(), Is.EqualTo(QuickSesStatus.Ok));
            view = _kept.View;
            Assert.That(view.IsInHostMemory, Is.True);
            Assert.That(BytesOf(view).SequenceEqual(vertices), Is.True);
            Assert.That(view.Indices.SequenceEqual(indices), Is.True);
            Assert.That(view.Owners.SequenceEqual(owners), Is.True);
            (float x, float y, float z) = FirstPosition(view);
            Assert.That(_kept.TryPick((x, y, z - 100), (0, 0, 1), default, out _), Is.True);
        }

        // Without a graphics API nothing can be written: that is said, and the mesh is still there.
        [Test]
        public void GoesToTheEvent()
        {
            var library = new GpuLibrary();
            Assert.That(library.IsUsable(GpuGraphics.Opengl, out string reason), Is.True, reason);
            Assert.That(library.WorksWith(_context.Backend), Is.True);
            Keep(library.Delivery, 3);
            Assert.That(library.IsOnGpuOnly(_kept), Is.True);
            SurfaceMeshView view = _kept.View;
            NativeGpuBuffers buffers = NativeDefaults.GpuBuffers();
            buffers.Graphics = GpuGraphics.Opengl;
            buffers.Vertices = 1;
            buffers.Indices = 2;
            buffers.VertexCapacity = (ulong)view.VertexCount;
            buffers.IndexCapacity = 3 * (ulong)view.TriangleCount;
            using IGpuTarget target = library.NewTarget();
            Assert.That(target.SetLook(5, new uint[5], default, default).Status, Is.EqualTo(QuickSesStatus.Ok));
            QuickSesError error = target.Submit(_kept, buffers);
            Assert.That(error.Status, Is.EqualTo(QuickSesStatus.InvalidArgument));
            Assert.That(error.Message, Does.Contain("5 atoms"));
            Assert.That(target.SetLook(0, default, default, default).Status, Is.EqualTo(QuickSesStatus.Ok));
            Assert.That(target.Submit(_kept, buffers).Status, Is.EqualTo(QuickSesStatus.Ok));
            Assert.That(target.GetStatus().Waiting, Is.EqualTo(1));
            int number = library.NextEvent();
            Assert.That(number, Is.Not.Zero);
            Marshal.GetDelegateForFunctionPointer<GraphicsEvent>(library.EventFunction)(number);
            GpuTargetStatus status = target.GetStatus();
            Assert.That(status.Waiting, Is.Zero);
            Assert.That(status.Done, Is.EqualTo(number));
            Assert.That(status.Error.Status, Is.Not.EqualTo(QuickSesStatus.Ok));
            Assert.That(status.Error.Message, Is.Not.Empty);
            Assert.That(library.Download(_kept).Status, Is.EqualTo(QuickSesStatus.Ok));
            Assert.That(_kept.View.IsInHostMemory, Is.True);
        }
    }
}
