// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections.Generic;
using UnityEngine;

namespace QuickSes.Tests
{
    /// <summary>What must be true of meshes, found out by plain loops over what the engine holds.</summary>
    internal static class SurfaceMeshes
    {
        /// <summary>Six times the enclosed volume, if triangles turn as the engine's front faces do.</summary>
        public static double SignedVolume(Mesh mesh)
        {
            Vector3[] vertices = mesh.vertices;
            int[] triangles = mesh.triangles;
            double sum = 0;
            for (int i = 0; i < triangles.Length; i += 3)
                sum += Vector3.Dot(vertices[triangles[i]],
                    Vector3.Cross(vertices[triangles[i + 1]], vertices[triangles[i + 2]]));
            return sum / 6;
        }

        /// <summary>Each edge has one triangle on either side of it, which turn the same way.</summary>
        public static bool IsClosed(Mesh mesh)
        {
            int[] triangles = mesh.triangles;
            var edges = new HashSet<long>();
            for (int i = 0; i < triangles.Length; i += 3)
                for (int k = 0; k < 3; ++k)
                    if (!edges.Add(Edge(triangles[i + k], triangles[i + (k + 1) % 3])))
                        return false;
            for (int i = 0; i < triangles.Length; i += 3)
                for (int k = 0; k < 3; ++k)
                    if (!edges.Contains(Edge(triangles[i + (k + 1) % 3], triangles[i + k])))
                        return false;
            return triangles.Length > 0;
        }

        /// <summary>
        /// The mesh is the surface of these atoms: triangles and owners to the number, positions and normals but for
        /// rounding, since the frame of reference of the computation depends on which levels a job has.
        /// </summary>
        public static void AssertIsSurfaceOf(
            Mesh mesh, Vector3[] positions, float[] radii, float spacing, Func<int, int> ownerAt = null)
        {
            using (var context = new SurfaceContext(new SurfaceContextOptions { Threads = 1 }))
            {
                context.SetAtoms(positions, radii, radii.Length);
                SurfaceSettings settings = SurfaceSettings.Default;
                settings.Spacing = spacing;
                Assert.That(context.Compute(settings, out SurfaceMeshView view), Is.EqualTo(QuickSesStatus.Ok));
                var vertices = new Vector3[view.VertexCount];
                var normals = new Vector3[view.VertexCount];
                var triangles = new int[3 * view.TriangleCount];
                view.CopyPositions(vertices);
                view.CopyNormals(normals);
                view.CopyTriangles(triangles);
                Assert.That(mesh.triangles, Is.EqualTo(triangles));
                AssertClose(First(mesh.vertices, vertices.Length), vertices);
                AssertClose(First(mesh.normals, vertices.Length), normals);
                if (ownerAt == null)
                    return;
                var owners = new int[view.VertexCount];
                view.CopyOwners(owners);
                int others = 0; // vertices on crests may be as near to one atom as to another
                for (int v = 0; v < owners.Length; ++v)
                    others += ownerAt(v) == owners[v] ? 0 : 1;
                Assert.That(others, Is.LessThanOrEqualTo(2 + owners.Length / 1000), $"of {owners.Length}");
            }
        }

        /// <summary>Without the unused ends that buffers have while atoms move.</summary>
        public static T[] First<T>(T[] array, int count)
        {
            Assert.That(array.Length, Is.GreaterThanOrEqualTo(count));
            Array.Resize(ref array, count);
            return array;
        }

        // Near cusps of the surface rounding is felt more: a few vertices only.
        private static void AssertClose(Vector3[] shown, Vector3[] expected)
        {
            Assert.That(shown.Length, Is.EqualTo(expected.Length));
            int far = 0;
            for (int i = 0; i < shown.Length; ++i)
                far += (shown[i] - expected[i]).magnitude < 1e-4f ? 0 : 1;
            Assert.That(far, Is.LessThanOrEqualTo(2 + shown.Length / 1000), $"of {shown.Length}");
        }

        private static long Edge(int from, int to) => ((long)from << 32) | (uint)to;
    }
}
