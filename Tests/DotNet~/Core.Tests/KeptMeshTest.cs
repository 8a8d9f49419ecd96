// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Linq;

namespace QuickSes.Tests
{
    /// <summary>Meshes that are kept for longer than their contexts keep them.</summary>
    [TestFixture(false)]
    [TestFixture(true)]
    public sealed class KeptMeshTest
    {
        private readonly bool _isSharp;
        private SurfaceContext _context;
        private KeptMesh _kept;
        private SurfaceSettings _settings;

        public KeptMeshTest(bool isSharp)
        {
            _isSharp = isSharp;
        }

        [SetUp]
        public void SetUp()
        {
            _context = Meshes.CrambinContext();
            _kept = new KeptMesh();
            _settings = SurfaceSettings.Default;
            _settings.Pickable = true;
            _settings.Creases = _settings.HardEdges = _isSharp;
        }

        [TearDown]
        public void TearDown()
        {
            _kept.Dispose();
            _context.Dispose();
        }

        [Test]
        public void OutlivesTheContext()
        {
            SurfaceMeshView computed = Meshes.Compute(_context, _settings);
            float[] positions = computed.Positions.ToArray();
            uint[] indices = computed.Indices.ToArray(), repeated = computed.Repeated.ToArray();
            Assert.That(repeated.Length > 0, Is.EqualTo(_isSharp));
            _context.TryGetReport(out SurfaceReport report);
            Assert.That(_context.Keep(_kept), Is.True);
            Assert.That(computed.IsValid, Is.False, "it went to the kept mesh");
            Assert.That(_context.TryGetMesh(out _), Is.False);
            Assert.That(_context.TryGetReport(out _), Is.False);
            Assert.That(_context.Keep(_kept), Is.False, "there is none any more");
            _context.Dispose();
            SurfaceMeshView view = _kept.View;
            Assert.That(view.IsValid, Is.True);
            Assert.That(view.Positions.SequenceEqual(positions), Is.True);
            Assert.That(view.Indices.SequenceEqual(indices), Is.True);
            Assert.That(view.Repeated.SequenceEqual(repeated), Is.True);
            Assert.That(_kept.TryGetReport(out SurfaceReport kept), Is.True);
            Assert.That(kept.Area, Is.EqualTo(report.Area));
        }

        [Test]
        public void ViewsEndWhenSomethingElseIsKept()
        {
            Meshes.Compute(_context, _settings);
            _context.Keep(_kept);
            SurfaceMeshView first = _kept.View;
            Assert.That(first.VertexCount, Is.GreaterThan(0));
            Assert.That(_context.Keep(_kept), Is.False);
            Assert.That(first.IsValid, Is.True, "nothing has changed");
            Meshes.Compute(_context, _settings);
            Assert.That(first.IsValid, Is.True);
            _context.Keep(_kept);
            Assert.That(first.IsValid, Is.False);
            Assert.That(() => first.Owners.Length, Throws.InvalidOperationException);
            SurfaceMeshView second = _kept.View;
            _kept.Clear();
            Assert.That(second.IsValid, Is.False);
            Assert.That(_kept.View.VertexCount, Is.Zero);
            Assert.That(_kept.TryGetReport(out _), Is.False);
        }

        [Test]
        public void WhatIsInHostMemoryNeedsNoDownload()
        {
            Assert.That(_kept.Download(), Is.EqualTo(QuickSesStatus.NoResult), "nothing is kept");
            Meshes.Compute(_context, _settings);
            _context.Keep(_kept);
            SurfaceMeshView view = _kept.View;
            Assert.That(_kept.Download(), Is.EqualTo(QuickSesStatus.Ok));
            Assert.That(view.IsValid, Is.True, "nothing has changed");
        }

        [Test]
        public void PaintGivesVerticesWhatTheirAtomsHave()
        {
            Meshes.Compute(_context, _settings);
            _context.Keep(_kept);
            uint[] owners = _kept.View.Owners.ToArray();
            uint[] colors = Enumerable.Range(0, _context.AtomCount).Select(i => (uint)(7919 * i)).ToArray();
            var painted = new uint[owners.Length];
            int half = owners.Length / 2;
            _kept.Paint<uint>(colors, 0, painted.AsSpan(0, half));
            _kept.Paint<uint>(colors, half, painted.AsSpan(half));
            Assert.That(painted, Is.EqualTo(owners.Select(owner => colors[owner])));
            double[] values = colors.Select(color => (double)color).ToArray();
            var wide = new double[owners.Length];
            _kept.Paint<double>(values, 0, wide);
            Assert.That(wide, Is.EqualTo(owners.Select(owner => (double)colors[owner])));

            Assert.Throws<QuickSesException>(() => _kept.Paint<uint>(new uint[3], 0, painted));
            Assert.Throws<QuickSesException>(() => _kept.Paint<uint>(colors, 1, painted), "one vertex too many");
            Assert.Throws<QuickSesException>(() => _kept.Paint<byte>(new byte[colors.Length], 0, new byte[4]));
            Assert.Throws<ArgumentOutOfRangeException>(() => _kept.Paint<uint>(colors, -1, painted));
        }

        [Test]
        public void FilterLeavesTrianglesOfVisibleAtoms()
        {
            Meshes.Compute(_context, _settings);
            _context.Keep(_kept);
            SurfaceMeshView view = _kept.View;
            uint[] owners = view.Owners.ToArray(), indices = view.Indices.ToArray();
            byte[] visible = Enumerable.Range(0, _context.AtomCount).Select(i => (byte)(i % 3 == 0 ? 0 : 1)).ToArray();
            uint[] expected = Enumerable.Range(0, view.TriangleCount)
                .Where(t => Enumerable.Range(3 * t, 3).All(k => visible[owners[indices[k]]] != 0))
                .SelectMany(t => indices.Skip(3 * t).Take(3)).ToArray();
            var room = new uint[indices.Length];
            int triangles = _kept.Filter(visible, 0, view.TriangleCount, room);
            Assert.That(triangles, Is.InRange(1, view.TriangleCount - 1));
            Assert.That(room.Take(3 * triangles), Is.EqualTo(expected));

            Assert.Throws<ArgumentException>(() => _kept.Filter(visible, 0, indices.Length / 3, new uint[3]));
            Assert.Throws<ArgumentOutOfRangeException>(() => _kept.Filter(visible, -1, 1, room));
            Assert.Throws<QuickSesException>(() => _kept.Filter(new byte[2], 0, 1, room));
            Assert.Throws<QuickSesException>(() => _kept.Filter(visible, 1, indices.Length / 3, room));
        }

        [Test]
        public void TryPickTellsAtomAndPlace()
        {
            Meshes.Compute(_context, _settings);
            _context.Keep(_kept);
            SurfaceMeshView view = _kept.View;
            (float X, float Y, float Z) low = view.BoundsMin, high = view.BoundsMax;
            (float, float, float) origin = (low.X - 10, (low.Y + high.Y) / 2, (low.Z + high.Z) / 2);
            Assert.That(_kept.TryPick(origin, (2, 0, 0), default, out SurfaceHit hit), Is.True);
            Assert.That(hit.Position.X, Is.EqualTo(origin.Item1 + 2 * hit.Distance).Within(1e-3));
            Assert.That(hit.Position.Y, Is.EqualTo(origin.Item2).Within(1e-3));
            Assert.That(hit.Normal.X, Is.LessThan(0), "towards the origin");
            Assert.That(view.Owners[hit.Vertex], Is.EqualTo((uint)hit.Owner));
            Assert.That(view.Indices.Slice(3 * hit.Triangle, 3).ToArray(), Does.Contain((uint)hit.Vertex));
            Assert.That(_kept.TryPick(origin, (-2, 0, 0), default, out SurfaceHit none), Is.False);
            Assert.That(none.Distance, Is.Zero);

            byte[] visible = Enumerable.Repeat((byte)1, _context.AtomCount).ToArray();
            visible[hit.Owner] = 0;
            Assert.That(_kept.TryPick(origin, (2, 0, 0), visible, out SurfaceHit deeper), Is.True);
            Assert.That(deeper.Owner, Is.Not.EqualTo(hit.Owner));
            Assert.That(deeper.Distance, Is.GreaterThanOrEqualTo(hit.Distance));

            Assert.Throws<QuickSesException>(() => _kept.TryPick(origin, (0, 0, 0), default, out _));
            Assert.Throws<QuickSesException>(() => _kept.TryPick((float.NaN, 0, 0), (1, 0, 0), default, out _));
            Assert.Throws<QuickSesException>(() => _kept.TryPick(origin, (1, 0, 0), new byte[2], out _));
        }

        [Test]
        public void WhatHasEndedThrows()
        {
            Meshes.Compute(_context, _settings);
            Assert.Throws<ArgumentNullException>(() => _context.Keep(null));
            _context.Keep(_kept);
            SurfaceMeshView view = _kept.View;
            _kept.Dispose();
            _kept.Dispose();
            Assert.That(view.IsValid, Is.False);
            Assert.Throws<ObjectDisposedException>(() => view.Owners.ToArray());
            Assert.Throws<ObjectDisposedException>(() => _ = _kept.View);
            Assert.Throws<ObjectDisposedException>(() => _kept.Clear());
            Assert.Throws<ObjectDisposedException>(() => _kept.TryGetReport(out _));
            Assert.Throws<ObjectDisposedException>(() => _kept.TryPick(default, (1, 0, 0), default, out _));
            Meshes.Compute(_context, _settings);
            Assert.Throws<ObjectDisposedException>(() => _context.Keep(_kept));
            Assert.That(_context.TryGetMesh(out _), Is.True, "the mesh is still there");
        }

        [Test]
        public void ForgottenOnesAreFreed()
        {
            // Finalizers run on a thread of their own, some after the context's.
            for (int k = 0; k < 20; ++k)
                Forget();
            GC.Collect();
            GC.WaitForPendingFinalizers();
            Assert.That(Meshes.Compute(_context, _settings).VertexCount, Is.GreaterThan(0));
        }

        private void Forget()
        {
            SurfaceContext context = Meshes.CrambinContext();
            Meshes.Compute(context, _settings);
            context.Keep(new KeptMesh());
        }

        [Test]
        public void MakesNoGarbage()
        {
            var colors = new uint[_context.AtomCount];
            var visible = new byte[_context.AtomCount];
            var painted = new uint[100000];
            var indices = new uint[600000];
            _settings.Spacing = 1;
            void ShowFrame()
            {
                if (_context.Compute(_settings, out _) != QuickSesStatus.Ok || !_context.Keep(_kept))
                    throw new InvalidOperationException(_context.LastError);
                SurfaceMeshView view = _kept.View;
                _kept.Paint<uint>(colors, 0, painted.AsSpan(0, view.VertexCount));
                _kept.Filter(visible, 0, view.TriangleCount, indices);
                _kept.TryPick((-100, 10, 6), (1, 0, 0), default, out _);
                _kept.TryGetReport(out _);
            }
            for (int k = 0; k < 100; ++k)
                ShowFrame();
            long before = GC.GetAllocatedBytesForCurrentThread();
            for (int k = 0; k < 100; ++k)
                ShowFrame();
            Assert.That(GC.GetAllocatedBytesForCurrentThread() - before, Is.Zero);
        }
    }
}
