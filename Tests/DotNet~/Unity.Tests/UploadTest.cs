// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using System;
using UnityEngine;
using UnityEngine.Rendering;

namespace QuickSes.Tests
{
    /// <summary>How surfaces get into meshes: which calls the engine sees.</summary>
    internal sealed class UploadTest
    {
        private const MeshUpdateFlags AllFour = MeshUpdateFlags.DontValidateIndices |
            MeshUpdateFlags.DontResetBoneBounds | MeshUpdateFlags.DontNotifyMeshUsers |
            MeshUpdateFlags.DontRecalculateBounds;

        private SurfaceContext _context;
        private SurfaceSettings _settings;
        private SurfaceMeshUploader _uploader;
        private Mesh _mesh;

        [SetUp]
        public void SetUp()
        {
            _context = new SurfaceContext();
            _settings = SurfaceSettings.Default;
            _settings.VertexLayout = SurfaceVertexLayout.Interleaved;
            _uploader = new SurfaceMeshUploader();
            _mesh = new Mesh();
        }

        [TearDown]
        public void TearDown()
        {
            _uploader.Dispose();
            _context.Dispose();
        }

        [Test]
        public void OneCopyOfEachStreamAndOneOfIndices()
        {
            SurfaceMeshView view = Compute(50);
            _uploader.Upload(view, _mesh);
            MeshRecord record = MeshRecord.Of(_mesh);
            Assert.That(record.VertexUploads, Is.EqualTo(2));
            Assert.That(record.IndexUploads, Is.EqualTo(1));
            Assert.That(record.BytesUploaded, Is.EqualTo(28L * view.VertexCount + 12L * view.TriangleCount));
            Assert.That(record.FlagsOfEach & AllFour, Is.EqualTo(AllFour));
            Assert.That(record.AwaitsNotification, Is.False, "renderers have been told");
            Assert.That(_mesh.vertexCount, Is.EqualTo(view.VertexCount));
            Assert.That(_mesh.indexFormat, Is.EqualTo(IndexFormat.UInt32));
            Assert.That(_mesh.subMeshCount, Is.EqualTo(1));
        }

        [Test]
        public void BoundsAreThoseOfTheSurface()
        {
            SurfaceMeshView view = Compute(50);
            _uploader.Upload(view, _mesh);
            Vector3[] vertices = _mesh.vertices;
            var bounds = new Bounds(vertices[0], Vector3.zero);
            foreach (Vector3 vertex in vertices)
                bounds.Encapsulate(vertex);
            Assert.That((_mesh.bounds.min - bounds.min).magnitude, Is.LessThan(1e-4));
            Assert.That((_mesh.bounds.max - bounds.max).magnitude, Is.LessThan(1e-4));
            Assert.That(_mesh.GetSubMesh(0).bounds, Is.EqualTo(_mesh.bounds));
        }

        [Test]
        public void BuffersOfTheRightSizeAreKept()
        {
            SurfaceMeshView view = Compute(50);
            _uploader.Upload(view, _mesh);
            _uploader.Upload(view, _mesh);
            Assert.That(MeshRecord.Of(_mesh).VertexParamsCalls, Is.EqualTo(1));
            Assert.That(MeshRecord.Of(_mesh).IndexParamsCalls, Is.EqualTo(1));
            _uploader.Upload(Compute(51), _mesh);
            Assert.That(MeshRecord.Of(_mesh).VertexParamsCalls, Is.EqualTo(2));
        }

        [Test]
        public void PaddedBuffersOnlyGrow()
        {
            _uploader.Upload(Compute(60), _mesh, true);
            MeshRecord.Of(_mesh).Clear();
            _uploader.Upload(Compute(20), _mesh, true);
            _uploader.Upload(Compute(60), _mesh, true);
            Assert.That(MeshRecord.Of(_mesh).VertexParamsCalls, Is.EqualTo(0));
            Assert.That(MeshRecord.Of(_mesh).IndexParamsCalls, Is.EqualTo(0));
            _uploader.Upload(Compute(200), _mesh, true);
            Assert.That(MeshRecord.Of(_mesh).VertexParamsCalls, Is.EqualTo(1));
        }

        [Test]
        public void BuffersWithoutPaddingAreReplacedAtOnceRatherThanLater()
        {
            _uploader.Upload(Compute(60), _mesh);
            _uploader.Upload(Compute(50), _mesh, true);
            Assert.That(MeshRecord.Of(_mesh).VertexParamsCalls, Is.EqualTo(2));
            Assert.That(MeshRecord.Of(_mesh).IndexParamsCalls, Is.EqualTo(2));
            MeshRecord.Of(_mesh).Clear();
            _uploader.Upload(Compute(55), _mesh, true);
            Assert.That(MeshRecord.Of(_mesh).VertexParamsCalls, Is.EqualTo(0));
            Assert.That(MeshRecord.Of(_mesh).IndexParamsCalls, Is.EqualTo(0));
        }

        [Test]
        public void AnotherMeshGetsBuffersOfItsOwn()
        {
            SurfaceMeshView view = Compute(30);
            _uploader.Upload(view, _mesh);
            var other = new Mesh();
            _uploader.Upload(view, other);
            Assert.That(other.vertexCount, Is.EqualTo(view.VertexCount));
            _uploader.Upload(view, _mesh);
            Assert.That(_mesh.triangles, Is.EqualTo(other.triangles));
        }

        [Test]
        public void TextureCoordinatesChangeTheLayout()
        {
            _context.SetAtoms(new[] { Vector3.zero }, new[] { 1.5f }, 1);
            _context.SetTexcoords(new[] { 0.25f, 0.75f });
            _settings.Texcoords = true;
            _context.Compute(_settings, out SurfaceMeshView view);
            _uploader.Upload(view, _mesh);
            Assert.That(_mesh.uv2, Is.All.EqualTo(new Vector2(0.25f, 0.75f)));
            Assert.That(MeshRecord.Of(_mesh).BytesUploaded,
                Is.EqualTo(36L * view.VertexCount + 12L * view.TriangleCount));
            _settings.Texcoords = false;
            _context.Compute(_settings, out view);
            _uploader.Upload(view, _mesh);
            Assert.That(_mesh.HasVertexAttribute(VertexAttribute.TexCoord1), Is.False);
        }

        [Test]
        public void WhatCantBeUploadedThrows()
        {
            SurfaceMeshView view = Compute(10);
            Assert.Throws<ArgumentNullException>(() => _uploader.Upload(view, null));
            Compute(11);
            Assert.Throws<ArgumentException>(() => _uploader.Upload(view, _mesh), "the view has ended");
            _settings.VertexLayout = SurfaceVertexLayout.Separate;
            SurfaceMeshView separate = Compute(12);
            Assert.Throws<ArgumentException>(() => _uploader.Upload(separate, _mesh));
            Assert.That(_mesh.vertexCount, Is.EqualTo(0));
        }

        [Test]
        public void UploadsMakeNoGarbage()
        {
            SurfaceMeshView view = Compute(50);
            _uploader.Upload(view, _mesh);
            _uploader.Upload(view, _mesh);
            long before = GC.GetAllocatedBytesForCurrentThread();
            for (int k = 0; k < 10; ++k)
                _uploader.Upload(view, _mesh);
            Assert.That(GC.GetAllocatedBytesForCurrentThread() - before, Is.EqualTo(0));
        }

        private SurfaceMeshView Compute(int atoms)
        {
            TestMolecules.Blob(atoms, atoms, out Vector3[] positions, out float[] radii);
            _context.SetAtoms(positions, radii, atoms);
            Assert.That(_context.Compute(_settings, out SurfaceMeshView view), Is.EqualTo(QuickSesStatus.Ok));
            return view;
        }
    }
}
