// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.Interop;
using System;
using UnityEngine;

namespace QuickSes.Tests
{
    /// <summary>The engine's arrays in and out of a context.</summary>
    internal sealed class SurfaceArraysTest
    {
        [Test]
        public void BothLayoutsGiveTheSameArrays()
        {
            TestMolecules.Blob(30, 1, out Vector3[] positions, out float[] radii);
            var colors = new Color32[30];
            for (int i = 0; i < colors.Length; ++i)
                colors[i] = new Color32((byte)i, 2, 3, 4);
            using (var context = new SurfaceContext())
            {
                context.SetAtoms(positions, radii, 30);
                context.SetColors(colors, 30);
                Arrays separate = Compute(context, SurfaceVertexLayout.Separate);
                Arrays interleaved = Compute(context, SurfaceVertexLayout.Interleaved);
                Assert.That(separate.Positions.Length, Is.GreaterThan(100));
                Assert.That(interleaved.Positions, Is.EqualTo(separate.Positions));
                Assert.That(interleaved.Normals, Is.EqualTo(separate.Normals));
                Assert.That(interleaved.Colors, Is.EqualTo(separate.Colors));
                Assert.That(interleaved.Triangles, Is.EqualTo(separate.Triangles));
                Assert.That(interleaved.Owners, Is.EqualTo(separate.Owners));
                for (int v = 0; v < separate.Owners.Length; ++v)
                    Assert.That(separate.Colors[v], Is.EqualTo(colors[separate.Owners[v]]));
            }
        }

        [Test]
        public void ArraysMayBeLongerThanWhatIsUsedOfThem()
        {
            var positions = new[] { Vector3.zero, new Vector3(float.NaN, 0, 0) };
            using (var context = new SurfaceContext())
            {
                context.SetAtoms(positions, new[] { 1.5f, -1 }, 1);
                Assert.That(context.AtomCount, Is.EqualTo(1));
                context.SetPositions(positions, 1);
                context.SetPositions(positions, new[] { 0, 1 }, 1);
                Assert.Throws<ArgumentOutOfRangeException>(() => context.SetPositions(positions, 3));
                Assert.Throws<ArgumentOutOfRangeException>(() => context.SetAtoms(positions, new float[1], 2));
                Assert.Throws<ArgumentNullException>(() => context.SetAtoms((Vector3[])null, new float[1], 1));
                Assert.Throws<QuickSesException>(() => context.SetPositions(positions, new[] { -1 }, 1));
            }
        }

        [Test]
        public void ArraysThatAreTooShortThrow()
        {
            using (var context = new SurfaceContext())
            {
                context.SetAtoms(new[] { Vector3.zero }, new[] { 1.5f }, 1);
                context.Compute(SurfaceSettings.Default, out SurfaceMeshView view);
                int count = view.VertexCount;
                Assert.Throws<ArgumentException>(() => Copy(context, v => v.CopyPositions(new Vector3[count - 1])));
                Assert.Throws<ArgumentException>(() => Copy(context, v => v.CopyOwners(new int[count - 1])));
                Assert.Throws<ArgumentException>(() => Copy(context, v => v.CopyTriangles(new int[3])));
                Assert.Throws<ArgumentNullException>(() => Copy(context, v => v.CopyNormals(null)));
            }
        }

        [Test]
        public void WhatIsHandedOutNowhereIsNotCopied()
        {
            using (var context = new SurfaceContext())
            {
                context.SetAtoms(new[] { Vector3.zero }, new[] { 1.5f }, 1);
                SurfaceSettings settings = SurfaceSettings.Default;
                settings.Delivery = MeshDelivery.None;
                Assert.That(context.Compute(settings, out SurfaceMeshView view), Is.EqualTo(QuickSesStatus.Ok));
                AssertIsNotCopied(view);
            }
        }

        // As on a CUDA device only.
        [TestCase(24u)]
        [TestCase(16u)]
        public void WhatIsNotInHostMemoryIsNotCopied(uint vertexBytes)
        {
            NativeMesh mesh = NativeDefaults.Mesh();
            mesh.VertexCount = 100;
            mesh.TriangleCount = 196;
            mesh.VertexBytes = vertexBytes;
            AssertIsNotCopied(new SurfaceMeshView(null, 0, mesh));
        }

        [Test]
        public void WithoutColoursAllIsWhite()
        {
            using (var context = new SurfaceContext())
            {
                context.SetAtoms(new[] { Vector3.zero }, new[] { 1.5f }, 1);
                var white = new Color32(255, 255, 255, 255);
                Assert.That(Compute(context, SurfaceVertexLayout.Separate).Colors, Is.All.EqualTo(white));
                Assert.That(Compute(context, SurfaceVertexLayout.Interleaved).Colors, Is.All.EqualTo(white));
            }
        }

        private static void Copy(SurfaceContext context, Action<SurfaceMeshView> copy)
        {
            context.TryGetMesh(out SurfaceMeshView view);
            copy(view);
        }

        private static void AssertIsNotCopied(SurfaceMeshView view)
        {
            Assert.That(view.VertexCount, Is.GreaterThan(0));
            var vectors = new Vector3[view.VertexCount];
            var colors = new Color32[view.VertexCount];
            var numbers = new int[3 * Math.Max(view.VertexCount, view.TriangleCount)];
            Assert.Throws<InvalidOperationException>(() => view.CopyPositions(vectors));
            Assert.Throws<InvalidOperationException>(() => view.CopyNormals(vectors));
            Assert.Throws<InvalidOperationException>(() => view.CopyColors(colors));
            Assert.Throws<InvalidOperationException>(() => view.CopyOwners(numbers));
            Assert.Throws<InvalidOperationException>(() => view.CopyTriangles(numbers));
            var mesh = new Mesh { vertices = new[] { Vector3.zero } };
            using (var uploader = new SurfaceMeshUploader())
                Assert.Throws<InvalidOperationException>(() => uploader.Upload(view, mesh));
            Assert.That(mesh.vertexCount, Is.EqualTo(1));
            UnityEngine.Object.DestroyImmediate(mesh);
        }

        private static Arrays Compute(SurfaceContext context, SurfaceVertexLayout layout)
        {
            SurfaceSettings settings = SurfaceSettings.Default;
            settings.VertexLayout = layout;
            Assert.That(context.Compute(settings, out SurfaceMeshView view), Is.EqualTo(QuickSesStatus.Ok));
            int count = view.VertexCount;
            var arrays = new Arrays
            {
                Positions = new Vector3[count], Normals = new Vector3[count], Colors = new Color32[count],
                Owners = new int[count], Triangles = new int[3 * view.TriangleCount]
            };
            view.CopyPositions(arrays.Positions);
            view.CopyNormals(arrays.Normals);
            view.CopyColors(arrays.Colors);
            view.CopyOwners(arrays.Owners);
            view.CopyTriangles(arrays.Triangles);
            return arrays;
        }

        private sealed class Arrays
        {
            public Vector3[] Positions;
            public Vector3[] Normals;
            public Color32[] Colors;
            public int[] Owners;
            public int[] Triangles;
        }
    }
}
