// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Text.RegularExpressions;
using Unity.Collections;
using UnityEngine;
using UnityEngine.Rendering;
using UnityEngine.TestTools;
using UnityEngine.TestTools.Constraints;
using Is = UnityEngine.TestTools.Constraints.Is;
using Object = UnityEngine.Object;

namespace QuickSes.EngineDouble.Tests
{
    public sealed class MeshTest
    {
        private struct Vertex
        {
            public Vector3 Position, Normal;
            public Color32 Color;
        }

        private const MeshUpdateFlags NoChecks = MeshUpdateFlags.DontValidateIndices |
            MeshUpdateFlags.DontResetBoneBounds | MeshUpdateFlags.DontNotifyMeshUsers |
            MeshUpdateFlags.DontRecalculateBounds;

        private static readonly VertexAttributeDescriptor[] Layout =
        {
            new VertexAttributeDescriptor(VertexAttribute.Position),
            new VertexAttributeDescriptor(VertexAttribute.Normal),
            new VertexAttributeDescriptor(VertexAttribute.Color, VertexAttributeFormat.UNorm8, 4)
        };

        private static readonly Vertex[] Corners =
        {
            new Vertex { Position = Vector3.zero, Normal = Vector3.back, Color = new Color32(255, 0, 0, 255) },
            new Vertex { Position = Vector3.up, Normal = Vector3.back, Color = new Color32(0, 255, 0, 255) },
            new Vertex { Position = Vector3.right, Normal = Vector3.back, Color = new Color32(0, 7, 255, 255) }
        };

        private static readonly int[] Triangle = { 0, 1, 2 };

        private static Mesh EmptyMesh()
        {
            var mesh = new Mesh { name = "test" };
            mesh.SetVertexBufferParams(3, Layout);
            mesh.SetIndexBufferParams(3, IndexFormat.UInt32);
            mesh.subMeshCount = 1;
            return mesh;
        }

        private static void Upload(Mesh mesh, int[] indices, MeshUpdateFlags flags)
        {
            mesh.SetVertexBufferData(Corners, 0, 0, 3, 0, flags);
            mesh.SetIndexBufferData(indices, 0, 0, 3, flags);
            mesh.SetSubMesh(0, new SubMeshDescriptor(0, 3) { vertexCount = 3 }, flags);
        }

        private static Bounds CornerBounds => new Bounds(new Vector3(0.5f, 0.5f, 0), new Vector3(1, 1, 0));

        [Test]
        public void ContentsComeBack()
        {
            Mesh mesh = EmptyMesh();
            Upload(mesh, Triangle, MeshUpdateFlags.Default);
            Assert.That(mesh.vertices, Is.EqualTo(new[] { Vector3.zero, Vector3.up, Vector3.right }));
            Assert.That(mesh.normals, Is.All.EqualTo(Vector3.back));
            Assert.That(mesh.colors32, Is.EqualTo(Array.ConvertAll(Corners, corner => corner.Color)));
            Assert.That(mesh.triangles, Is.EqualTo(Triangle));
            Assert.That(mesh.bounds, Is.EqualTo(CornerBounds), "found from the contents");
            Assert.That(mesh.GetSubMesh(0).vertexCount, Is.EqualTo(3));
            Assert.That(mesh.GetVertexBufferStride(0), Is.EqualTo(28));
            using (Mesh.MeshDataArray data = Mesh.AcquireReadOnlyMeshData(mesh))
            {
                Assert.That(data[0].GetIndexData<int>().ToArray(), Is.EqualTo(Triangle));
                mesh.Clear();
                Assert.That(data[0].vertexCount, Is.EqualTo(3), "a snapshot");
            }
        }

        [Test]
        public void SimpleAccessorsMakeALayout()
        {
            var mesh = new Mesh
            {
                vertices = new[] { Vector3.zero, Vector3.up, Vector3.right },
                colors32 = new[] { Corners[0].Color, Corners[1].Color, Corners[2].Color },
                triangles = Triangle
            };
            Assert.That(mesh.vertices[2], Is.EqualTo(Vector3.right));
            Assert.That(mesh.colors32[2].g, Is.EqualTo(7));
            Assert.That(mesh.bounds, Is.EqualTo(CornerBounds));
            Assert.That(MeshCheck.FaultOf(mesh), Is.Null);
        }

        [Test]
        public void RangesAreChecked()
        {
            Mesh mesh = EmptyMesh();
            Assert.That(() => mesh.SetVertexBufferData(Corners, 0, 1, 3), Throws.TypeOf<ArgumentOutOfRangeException>());
            Assert.That(() => mesh.SetVertexBufferData(Corners, 1, 0, 3), Throws.TypeOf<ArgumentOutOfRangeException>());
            Assert.That(() => mesh.SetVertexBufferData(Corners, 0, 0, 3, 1),
                Throws.TypeOf<ArgumentOutOfRangeException>());
            Assert.That(() => mesh.SetVertexBufferData(new double[9], 0, 0, 9), Throws.ArgumentException);
            Assert.That(() => mesh.SetIndexBufferData(Triangle, 0, 1, 3), Throws.TypeOf<ArgumentOutOfRangeException>());
            Assert.That(() => mesh.SetIndexBufferData(new ushort[3], 0, 0, 3), Throws.ArgumentException);
            Assert.That(() => mesh.SetSubMesh(1, default), Throws.TypeOf<IndexOutOfRangeException>());
            Assert.That(() => mesh.SetSubMesh(0, new SubMeshDescriptor(0, 6)),
                Throws.TypeOf<ArgumentOutOfRangeException>());
            Assert.That(() => mesh.SetVertexBufferParams(3, new VertexAttributeDescriptor(VertexAttribute.Position,
                VertexAttributeFormat.Float16)), Throws.ArgumentException, "6 bytes");
            Assert.That(() => mesh.SetVertexBufferParams(3, Layout[0], Layout[0]), Throws.ArgumentException);
            Assert.That(mesh.GetVertexAttributes(), Is.EqualTo(Layout), "what is refused changes nothing");
            Object.DestroyImmediate(mesh);
        }

        [Test]
        public void IndicesAreValidatedUnlessTheFlagsSayNo()
        {
            Mesh mesh = EmptyMesh();
            Regex message = new Regex("out of bounds vertices");
            LogAssert.Expect(LogType.Error, message); // The upload
            LogAssert.Expect(LogType.Error, message); // SetSubMesh
            Upload(mesh, new[] { 0, 1, 3 }, MeshUpdateFlags.Default);
            Upload(mesh, new[] { 0, 1, 3 }, NoChecks);
            mesh.bounds = CornerBounds;
            mesh.MarkModified();
            Assert.That(MeshCheck.FaultOf(mesh), Is.EqualTo("submesh 0 has index 3, and there are 3 vertices"));
            LogAssert.Expect(LogType.Error, new Regex("can't be drawn: it submesh 0 has index 3"));
            Engine.Frame(0.1);
        }

        [Test]
        public void WhatTheFlagsLeaveOutIsNoticed()
        {
            Mesh mesh = EmptyMesh();
            Upload(mesh, Triangle, NoChecks);
            mesh.bounds = CornerBounds;
            Assert.That(MeshCheck.FaultOf(mesh), Does.Contain("not marked as modified"));
            mesh.MarkModified();
            Assert.That(MeshCheck.FaultOf(mesh), Is.Null);
            mesh.bounds = default;
            Assert.That(MeshCheck.FaultOf(mesh), Does.Contain("outside of the mesh's bounds"));
            mesh.SetVertexBufferParams(3, Layout);
            mesh.SetVertexBufferParams(4, Layout);
            mesh.bounds = new Bounds(Vector3.zero, 1e6f * Vector3.one);
            Assert.That(MeshCheck.FaultOf(mesh), Does.Contain("NaN"), "never written");
            MeshRecord record = MeshRecord.Of(mesh);
            Assert.That(record.FlagsOfEach, Is.EqualTo(NoChecks));
            Assert.That(record.BytesUploaded, Is.EqualTo(3 * 28 + 3 * 4));
            Assert.That((record.VertexUploads, record.IndexUploads, record.SubMeshCalls), Is.EqualTo((1, 1, 1)));
            Assert.That(record.VertexParamsCalls, Is.EqualTo(3));
        }

        [Test]
        public void UnreadableMeshesAreRefusedAsInTheEngine()
        {
            Mesh mesh = EmptyMesh();
            Upload(mesh, Triangle, MeshUpdateFlags.Default);
            mesh.UploadMeshData(true);
            Assert.That(mesh.isReadable, Is.False);
            Assert.That(() => mesh.SetVertexBufferData(Corners, 0, 0, 3), Throws.InvalidOperationException);
            LogAssert.Expect(LogType.Error, new Regex("isReadable is false"));
            mesh.SetIndexBufferData(Triangle, 0, 0, 3);
        }

        [Test]
        public void DestroyedMeshesGiveTheirMemoryBack()
        {
            int blocks = NativeHeap.LiveCount(NativeHeap.Meshes);
            int meshes = Engine.LiveObjects<Mesh>();
            Mesh mesh = EmptyMesh();
            Assert.That(NativeHeap.LiveCount(NativeHeap.Meshes), Is.EqualTo(blocks + 2), "vertices, indices");
            Assert.That(Engine.LiveObjects<Mesh>(), Is.EqualTo(meshes + 1));
            Mesh.MeshDataArray data = Mesh.AcquireReadOnlyMeshData(mesh);
            Object.DestroyImmediate(mesh);
            Assert.That(Engine.LiveObjects<Mesh>(), Is.EqualTo(meshes));
            Assert.That(data[0].vertexCount, Is.EqualTo(3));
            data.Dispose();
            Assert.That(NativeHeap.LiveCount(NativeHeap.Meshes), Is.EqualTo(blocks));
            Assert.That(() => mesh.vertexCount, Throws.TypeOf<MissingReferenceException>());
        }

        [Test]
        public void UploadsAndSnapshotsAllocateNothing()
        {
            Mesh mesh = EmptyMesh();
            using var vertices = new NativeArray<Vertex>(Corners, Allocator.Persistent);
            using var indices = new NativeArray<int>(Triangle, Allocator.Persistent);
            void Play(int count)
            {
                for (int i = 0; i < count; ++i)
                {
                    mesh.SetVertexBufferParams(3 + i % 2, Layout);
                    mesh.SetIndexBufferParams(3 + 3 * (i % 2), IndexFormat.UInt32);
                    mesh.SetVertexBufferData(vertices, 0, 0, 3, 0, NoChecks);
                    mesh.SetIndexBufferData(indices, 0, 0, 3, NoChecks);
                    mesh.SetSubMesh(0, new SubMeshDescriptor(0, 3) { vertexCount = 3 }, NoChecks);
                    mesh.bounds = CornerBounds;
                    mesh.MarkModified();
                    using (Mesh.MeshDataArray data = Mesh.AcquireReadOnlyMeshData(mesh))
                        if (data[0].GetVertexData<Vertex>().Length != mesh.vertexCount)
                            throw new InvalidOperationException();
                    Engine.Frame(0.1);
                }
            }

            Play(10);
            Assert.That(() => Play(100), Is.Not.AllocatingGCMemory());
        }
    }
}
