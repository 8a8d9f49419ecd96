// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using System;
using System.Collections.Generic;
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
            SurfaceMeshView largest = Compute(60);
            _uploader.Upload(largest, _mesh, true);
            int vertices = largest.VertexCount;
            SurfaceMeshView larger = Compute(64);
            Assert.That(larger.VertexCount, Is.InRange(vertices + 1, vertices * 5 / 4), "by less than the room there is");
            _uploader.Upload(larger, _mesh, true);
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

        [TestCaseSource(nameof(Changes))]
        public void BuffersThatSomebodyElseHasChangedAreSetUpAgain(Action<Mesh> change)
        {
            SurfaceMeshView view = Compute(30);
            var expected = new Mesh();
            using (var other = new SurfaceMeshUploader())
                other.Upload(view, expected);
            _uploader.Upload(view, _mesh);
            change(_mesh);
            _uploader.Upload(view, _mesh);
            Assert.That(_mesh.GetVertexAttributes(), Is.EqualTo(expected.GetVertexAttributes()));
            Assert.That(_mesh.vertices, Is.EqualTo(expected.vertices));
            Assert.That(_mesh.normals, Is.EqualTo(expected.normals));
            Assert.That(_mesh.colors32, Is.EqualTo(expected.colors32));
            Assert.That(_mesh.indexFormat, Is.EqualTo(IndexFormat.UInt32));
            Assert.That(_mesh.subMeshCount, Is.EqualTo(1));
            Assert.That(_mesh.triangles, Is.EqualTo(expected.triangles));
        }

        private static IEnumerable<TestCaseData> Changes()
        {
            TestCaseData Case(string name, Action<Mesh> change) => new TestCaseData(change).SetArgDisplayNames(name);

            // Instead of the attribute with its number, or after the last.
            TestCaseData Attribute(string name, int number, VertexAttribute attribute, VertexAttributeFormat format,
                int dimension, int stream) => Case(name, mesh =>
            {
                var attributes = new List<VertexAttributeDescriptor>(mesh.GetVertexAttributes());
                if (number < attributes.Count)
                    attributes.RemoveAt(number);
                attributes.Add(new VertexAttributeDescriptor(attribute, format, dimension, stream));
                mesh.SetVertexBufferParams(mesh.vertexCount, attributes.ToArray());
            });

            TestCaseData Indices(string name, int added, IndexFormat format) => Case(name, mesh =>
            {
                int count = (int)mesh.GetIndexCount(0) + added;
                mesh.SetSubMesh(0, default);
                mesh.SetIndexBufferParams(count, format);
                mesh.SetSubMesh(0, new SubMeshDescriptor(0, count), AllFour);
            });

            yield return Case("vertices", mesh => mesh.SetVertexBufferParams(mesh.vertexCount - 1, mesh.GetVertexAttributes()));
            yield return Case("submeshes", mesh => mesh.subMeshCount = 2);
            yield return Indices("indices", -3, IndexFormat.UInt32);
            yield return Indices("indices of 16 bits", 0, IndexFormat.UInt16);
            yield return Attribute("one more", 3, VertexAttribute.TexCoord3, VertexAttributeFormat.Float32, 2, 2);
            yield return Attribute("another", 2, VertexAttribute.TexCoord7, VertexAttributeFormat.UInt32, 1, 1);
            yield return Attribute("stream", 2, VertexAttribute.Color, VertexAttributeFormat.UNorm8, 4, 2);
            yield return Attribute("format", 2, VertexAttribute.Color, VertexAttributeFormat.SNorm8, 4, 1);
            yield return Attribute("dimension", 1, VertexAttribute.Normal, VertexAttributeFormat.Float32, 4, 0);
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
