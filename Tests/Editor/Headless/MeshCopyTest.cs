// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.Editor;
using UnityEngine;
using UnityEngine.Rendering;

namespace QuickSes.Tests
{
    public sealed class MeshCopyTest
    {
        private Mesh _source, _target;

        [SetUp]
        public void MakeMeshes()
        {
            _source = new Mesh();
            _target = new Mesh { name = "Target" };
        }

        [TearDown]
        public void DestroyMeshes()
        {
            Object.DestroyImmediate(_source);
            Object.DestroyImmediate(_target);
        }

        [Test]
        public void UnusedEndsOfBuffersAreLeftOut()
        {
            var positions = new[] { Vector3.zero, Vector3.right, Vector3.up, new Vector3(9, 9, 9) }; // the last unused
            _source.SetVertexBufferParams(4, new VertexAttributeDescriptor(VertexAttribute.Position));
            _source.SetVertexBufferData(positions, 0, 0, 4);
            _source.SetIndexBufferParams(6, IndexFormat.UInt32);
            _source.SetIndexBufferData(new uint[] { 0, 2, 1, 0, 0, 0 }, 0, 0, 6);
            var bounds = new Bounds(new Vector3(0.5f, 0.5f, 0), new Vector3(1, 1, 0));
            _source.subMeshCount = 1;
            _source.SetSubMesh(0, new SubMeshDescriptor(0, 3) { vertexCount = 3, bounds = bounds },
                MeshUpdateFlags.DontRecalculateBounds);
            _source.bounds = bounds;

            MeshCopy.Copy(_source, _target);

            Assert.That(_target.vertexCount, Is.EqualTo(3));
            Assert.That(_target.vertices, Is.EqualTo(new[] { positions[0], positions[1], positions[2] }));
            Assert.That(_target.triangles, Is.EqualTo(new[] { 0, 2, 1 }));
            Assert.That(_target.indexFormat, Is.EqualTo(IndexFormat.UInt32));
            Assert.That(_target.bounds, Is.EqualTo(bounds));
            Assert.That(_target.name, Is.EqualTo("Target"));
        }

        [Test]
        public void ASurfaceInPaddedBuffersIsCopiedExactly()
        {
            var surface = new GameObject("surface").AddComponent<MolecularSurface>();
            surface.PadBuffers = true;
            surface.SetAtoms(new[] { Vector3.zero, new Vector3(1.5f, 0, 0) }, new[] { 1.7f, 1.5f });
            Assert.That(surface.ComputeNow(), Is.True, surface.LastError.Message);
            int count = surface.CurrentLevel.VertexCount;
            Assert.That(surface.Mesh.vertexCount, Is.GreaterThan(count));

            MeshCopy.Copy(surface.Mesh, _target);

            Assert.That(_target.vertexCount, Is.EqualTo(count));
            Assert.That(_target.GetIndexCount(0), Is.EqualTo(3 * surface.CurrentLevel.TriangleCount));
            Assert.That(_target.bounds, Is.EqualTo(surface.Mesh.bounds));
            Assert.That(_target.vertices, Is.EqualTo(First(count, surface.Mesh.vertices)));
            Assert.That(_target.normals, Is.EqualTo(First(count, surface.Mesh.normals)));
            Assert.That(_target.colors32, Is.EqualTo(First(count, surface.Mesh.colors32)));
            Object.DestroyImmediate(surface.gameObject);
        }

        private static T[] First<T>(int count, T[] array)
        {
            System.Array.Resize(ref array, count);
            return array;
        }

        [Test]
        public void WhatTheTargetHeldIsGone()
        {
            _target.vertices = new Vector3[10];
            _target.colors32 = new Color32[10];
            _target.triangles = new int[30];
            _source.SetVertexBufferParams(3, new VertexAttributeDescriptor(VertexAttribute.Position));
            _source.SetVertexBufferData(new[] { Vector3.zero, Vector3.right, Vector3.up }, 0, 0, 3);
            _source.SetIndexBufferParams(3, IndexFormat.UInt32);
            _source.SetIndexBufferData(new uint[] { 0, 2, 1 }, 0, 0, 3);
            _source.subMeshCount = 1;
            _source.SetSubMesh(0, new SubMeshDescriptor(0, 3) { vertexCount = 3 });

            MeshCopy.Copy(_source, _target);

            Assert.That(_target.vertexCount, Is.EqualTo(3));
            Assert.That(_target.HasVertexAttribute(VertexAttribute.Color), Is.False);
            Assert.That(_target.subMeshCount, Is.EqualTo(1));
        }
    }
}
