// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections.Generic;
using System.Linq;
using System.Runtime.InteropServices;

namespace QuickSes.Tests
{
    public sealed class AppearanceTest
    {
        private static byte[] ColorsOf(int atomCount) =>
            Enumerable.Range(0, 4 * atomCount).Select(i => (byte)(37 * i + i / 256)).ToArray();

        private static float[] TexcoordsOf(int atomCount) =>
            Enumerable.Range(0, 2 * atomCount).Select(i => 0.5f * i).ToArray();

        [Test]
        public void InterleavedVerticesEqualSeparateOnes()
        {
            using SurfaceContext context = Meshes.CrambinContext();
            byte[] colors = ColorsOf(context.AtomCount);
            float[] texcoords = TexcoordsOf(context.AtomCount);
            Assert.That(context.SetColors(colors), Is.EqualTo(QuickSesStatus.Ok));
            Assert.That(context.SetTexcoords(texcoords), Is.EqualTo(QuickSesStatus.Ok));
            SurfaceSettings settings = SurfaceSettings.Default;
            settings.Texcoords = true;
            SurfaceMeshView mesh = Meshes.Compute(context, settings);
            Assert.That(mesh.VertexLayout, Is.EqualTo(SurfaceVertexLayout.Separate));
            Assert.That(() => mesh.Vertices.Length, Throws.InvalidOperationException);
            float[] positions = mesh.Positions.ToArray(), normals = mesh.Normals.ToArray(),
                uv = mesh.Texcoords.ToArray();
            byte[] rgba = mesh.Colors.ToArray();
            uint[] owners = mesh.Owners.ToArray(), indices = mesh.Indices.ToArray();
            for (int v = 0; v < owners.Length; ++v)
            {
                int atom = (int)owners[v];
                Assert.That(rgba.AsSpan(4 * v, 4).SequenceEqual(colors.AsSpan(4 * atom, 4)), Is.True);
                Assert.That(uv.AsSpan(2 * v, 2).SequenceEqual(texcoords.AsSpan(2 * atom, 2)), Is.True);
            }

            settings.VertexLayout = SurfaceVertexLayout.Interleaved;
            mesh = Meshes.Compute(context, settings);
            Assert.That(mesh.VertexLayout, Is.EqualTo(SurfaceVertexLayout.Interleaved));
            Assert.That(mesh.VertexBytes, Is.EqualTo(24));
            Assert.That(mesh.Vertices.Length, Is.EqualTo(24 * owners.Length));
            Assert.That(mesh.Colors.SequenceEqual(rgba), Is.True);
            Assert.That(mesh.Texcoords.SequenceEqual(uv), Is.True);
            Assert.That(() => mesh.Positions.Length, Throws.InvalidOperationException);
            Assert.That(mesh.Owners.SequenceEqual(owners), Is.True);
            Assert.That(mesh.Indices.SequenceEqual(indices), Is.True);
            for (int v = 0; v < owners.Length; ++v)
            {
                ReadOnlySpan<float> numbers = MemoryMarshal.Cast<byte, float>(mesh.Vertices.Slice(24 * v, 24));
                Assert.That(numbers.Slice(0, 3).SequenceEqual(positions.AsSpan(3 * v, 3)), Is.True);
                Assert.That(numbers.Slice(3, 3).SequenceEqual(normals.AsSpan(3 * v, 3)), Is.True);
            }

            settings.VertexLayout = SurfaceVertexLayout.Compact;
            mesh = Meshes.Compute(context, settings);
            Assert.That(mesh.VertexLayout, Is.EqualTo(SurfaceVertexLayout.Compact));
            Assert.That(mesh.VertexBytes, Is.EqualTo(16));
            Assert.That(() => mesh.Normals.Length, Throws.InvalidOperationException);
            Assert.That(mesh.Owners.SequenceEqual(owners), Is.True);
            for (int v = 0; v < owners.Length; ++v)
            {
                ReadOnlySpan<byte> vertex = mesh.Vertices.Slice(16 * v, 16);
                Assert.That(MemoryMarshal.Cast<byte, float>(vertex).Slice(0, 3)
                    .SequenceEqual(positions.AsSpan(3 * v, 3)), Is.True);
                for (int d = 0; d < 3; ++d)
                    Assert.That((sbyte)vertex[12 + d] / 127f, Is.EqualTo(normals[3 * v + d]).Within(0.5f / 127 + 1e-5f));
            }
        }

        [Test]
        public void HiddenAtomsTakeTheirTrianglesAway()
        {
            using SurfaceContext context = Meshes.CrambinContext();
            byte[] visible = Enumerable.Range(0, context.AtomCount).Select(i => (byte)(i % 3 == 0 ? 0 : 1)).ToArray();
            SurfaceMeshView whole = Meshes.Compute(context, SurfaceSettings.Default);
            int wholeTriangles = whole.TriangleCount;
            List<(float, float, float)> expected = ShownCorners(whole, visible);

            Assert.That(context.SetVisible(visible), Is.EqualTo(QuickSesStatus.Ok));
            SurfaceMeshView shown = Meshes.Compute(context, SurfaceSettings.Default);
            Assert.That(shown.TriangleCount, Is.InRange(1, wholeTriangles - 1));
            Assert.That(ShownCorners(shown, visible), Is.EqualTo(expected));
            Assert.That(expected.Count, Is.EqualTo(3 * shown.TriangleCount), "no hidden atom is left");
            context.TryGetReport(out SurfaceReport report);
            Assert.That(report.HiddenTriangles, Is.EqualTo(wholeTriangles - shown.TriangleCount));

            Assert.That(context.SetVisible(default), Is.EqualTo(QuickSesStatus.Ok));
            Assert.That(Meshes.Compute(context, SurfaceSettings.Default).TriangleCount, Is.EqualTo(wholeTriangles));
        }

        // Corners of the triangles whose three owners are all visible, in order.
        private static List<(float, float, float)> ShownCorners(SurfaceMeshView mesh, byte[] visible)
        {
            var corners = new List<(float, float, float)>();
            for (int t = 0; t < mesh.Indices.Length; t += 3)
            {
                uint[] triangle = mesh.Indices.Slice(t, 3).ToArray();
                if (triangle.Any(v => visible[mesh.Owners[(int)v]] == 0))
                    continue;
                foreach (uint v in triangle)
                    corners.Add(
                        (mesh.Positions[3 * (int)v], mesh.Positions[3 * (int)v + 1], mesh.Positions[3 * (int)v + 2]));
            }
            return corners;
        }

        [Test]
        public void ColorsCanBeTakenBack()
        {
            using SurfaceContext context = Meshes.CrambinContext();
            Assert.That(Meshes.Compute(context, SurfaceSettings.Default).HasColors, Is.False);
            context.SetColors(ColorsOf(context.AtomCount));
            Assert.That(Meshes.Compute(context, SurfaceSettings.Default).HasColors, Is.True);
            context.SetColors(default);
            Assert.That(Meshes.Compute(context, SurfaceSettings.Default).HasColors, Is.False);
        }
    }
}
