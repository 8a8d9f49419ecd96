// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.EngineDouble;
using System;
using System.Collections.Generic;
using UnityEngine;
using UnityEngine.Rendering;

namespace QuickSes.EngineDouble.Tests
{
    /// <summary>Buffers that native code writes, and the events it does that in.</summary>
    internal sealed class GraphicsBufferTest
    {
        private static readonly VertexAttributeDescriptor[] s_layout =
        {
            new VertexAttributeDescriptor(VertexAttribute.Position),
            new VertexAttributeDescriptor(VertexAttribute.Color, VertexAttributeFormat.UNorm8, 4, 1)
        };

        [SetUp]
        public void SetUp() => Engine.Reset();

        [Test]
        public void WhatIsWrittenToABufferIsInTheMesh()
        {
            Mesh mesh = NewMesh(3);
            Assert.That(GraphicsMemory.TryFind((long)mesh.GetNativeVertexBufferPtr(1), out _, out Span<byte> bytes));
            Assert.That(bytes.Length, Is.EqualTo(12));
            bytes.Fill(7);
            Assert.That(mesh.colors32[2], Is.EqualTo(new Color32(7, 7, 7, 7)));
            var read = new byte[12];
            using (GraphicsBuffer buffer = mesh.GetVertexBuffer(1))
                buffer.GetData(read, 0, 0, read.Length);
            Assert.That(read, Is.All.EqualTo(7));
        }

        [Test]
        public void NamesComeAgainForOtherBuffers()
        {
            Mesh mesh = NewMesh(3);
            IntPtr name = mesh.GetNativeVertexBufferPtr(0);
            Assert.That(mesh.GetNativeVertexBufferPtr(0), Is.EqualTo(name));
            GraphicsMemory.TryFind((long)name, out long before, out _);
            mesh.SetVertexBufferParams(9, s_layout);
            Assert.That(GraphicsMemory.TryFind((long)name, out _, out _), Is.False, "it is gone");
            Assert.That(mesh.GetNativeVertexBufferPtr(0), Is.EqualTo(name));
            Assert.That(GraphicsMemory.TryFind((long)name, out long after, out _));
            Assert.That(after, Is.Not.EqualTo(before));
            UnityEngine.Object.DestroyImmediate(mesh);
            Assert.That(GraphicsMemory.TryFind((long)name, out _, out _), Is.False);
        }

        [Test]
        public void AnotherTargetMakesOtherBuffers()
        {
            Mesh mesh = NewMesh(3);
            GraphicsMemory.TryFind((long)mesh.GetNativeVertexBufferPtr(0), out long before, out _);
            mesh.vertexBufferTarget |= GraphicsBuffer.Target.Raw;
            GraphicsMemory.TryFind((long)mesh.GetNativeVertexBufferPtr(0), out long after, out _);
            Assert.That(after, Is.Not.EqualTo(before));
            mesh.vertexBufferTarget |= GraphicsBuffer.Target.Raw;
            GraphicsMemory.TryFind((long)mesh.GetNativeVertexBufferPtr(0), out long still, out _);
            Assert.That(still, Is.EqualTo(after));
        }

        [Test]
        public void EventsRunInOrderAtTheEndOfTheFrame()
        {
            var ran = new List<int>();
            RenderThread.Declare((IntPtr)77, ran.Add);
            GL.IssuePluginEvent((IntPtr)77, 1);
            GL.IssuePluginEvent((IntPtr)77, 2);
            Assert.That(ran, Is.Empty);
            Engine.Frame(0.01);
            Assert.That(ran, Is.EqualTo(new[] { 1, 2 }));
            RenderThread.IsRunning = false;
            GL.IssuePluginEvent((IntPtr)77, 3);
            Engine.Frame(0.01);
            Assert.That(ran, Is.EqualTo(new[] { 1, 2 }));
            RenderThread.IsRunning = true;
            Engine.Frame(0.01);
            Assert.That(ran, Is.EqualTo(new[] { 1, 2, 3 }));
            Assert.Throws<ArgumentException>(() => GL.IssuePluginEvent(IntPtr.Zero, 1));
        }

        [Test]
        public void BoundsOfARendererAreTheMeshsUntilItHasItsOwn()
        {
            var item = new GameObject("item");
            var filter = item.AddComponent<MeshFilter>();
            var renderer = item.AddComponent<MeshRenderer>();
            filter.sharedMesh = NewMesh(3);
            filter.sharedMesh.bounds = new Bounds(Vector3.up, Vector3.one);
            Assert.That(renderer.localBounds.center, Is.EqualTo(Vector3.up));
            renderer.localBounds = new Bounds(Vector3.right, Vector3.one);
            Assert.That(renderer.localBounds.center, Is.EqualTo(Vector3.right));
            renderer.ResetLocalBounds();
            Assert.That(renderer.localBounds.center, Is.EqualTo(Vector3.up));
        }

        private static Mesh NewMesh(int vertices)
        {
            var mesh = new Mesh();
            mesh.SetVertexBufferParams(vertices, s_layout);
            return mesh;
        }
    }
}
