// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;
using UnityEngine;

namespace QuickSes.Tests
{
    /// <summary>What must be true of meshes, found out by plain loops over what the engine holds.</summary>
    internal static class SurfaceMeshes
    {
        /// <summary>The enclosed volume, if triangles turn as the engine's front faces do.</summary>
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

        /// <summary>
        /// Each edge has one triangle on either side of it, which turn the same way, once vertices that stand for others on
        /// the other side of a crease are taken for those.
        /// </summary>
        /// <param name="mesh">What the surface shows, or a copy of it.</param>
        /// <param name="surface">Which tells which vertices those are.</param>
        public static bool IsClosed(Mesh mesh, MolecularSurface surface)
        {
            int[] triangles = mesh.triangles;
            Weld(triangles, surface.CurrentLevel.VertexCount, surface.Repeated);
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
        /// What is shown is the surface of these atoms: to the byte what the library computes with the settings of the
        /// component, at the finest level. Sharp where atoms rest, if that is wanted, and with shared vertices where they
        /// move.
        /// </summary>
        /// <param name="visible">Of each atom; null: all. The library renumbers vertices then; triangles are the same.</param>
        public static void AssertShows(MolecularSurface surface, Vector3[] positions, float[] radii, bool isMoving = false,
            bool[] visible = null)
        {
            SurfaceSettings settings = SettingsOf(surface);
            settings.Creases = settings.HardEdges =
                surface.SharpCreases && !isMoving && surface.Surface != SurfaceKind.Gaussian;
            Assert.That(surface.CurrentLevel.Spacing, Is.EqualTo(surface.Spacing));
            Assert.That(surface.CurrentLevel.HasCreases, Is.EqualTo(settings.Creases));
            string difference = "";
            using (var context = new SurfaceContext(new SurfaceContextOptions { Threads = 1 }))
            {
                context.SetAtoms(positions, radii, radii.Length);
                if (visible != null)
                    context.SetVisible(Array.ConvertAll(visible, isVisible => isVisible ? (byte)1 : (byte)0));
                float[] levels = CoarserLevels(surface);
                for (int first = 0; first <= levels.Length; ++first)
                {
                    settings.SetLevels(levels.AsSpan(first));
                    Assert.That(context.Compute(settings, out SurfaceMeshView view), Is.EqualTo(QuickSesStatus.Ok));
                    string other = visible == null ? DifferenceOf(surface, view) : DifferenceOfParts(surface, view);
                    if (other.Length == 0)
                        return;
                    difference += $"with {levels.Length - first} coarser levels: {other}\n";
                }
            }
            Assert.Fail("It is not the surface of these atoms, whichever levels the job had that computed it.\n" + difference);
        }

        /// <summary>Without the unused ends that buffers have while atoms move.</summary>
        public static T[] First<T>(T[] array, int count)
        {
            Assert.That(array.Length, Is.GreaterThanOrEqualTo(count));
            Array.Resize(ref array, count);
            return array;
        }

        private static SurfaceSettings SettingsOf(MolecularSurface surface)
        {
            SurfaceSettings settings = SurfaceSettings.Default;
            settings.Surface = surface.Surface;
            settings.Method = surface.Method;
            settings.ProbeRadius = surface.ProbeRadius;
            settings.Spacing = surface.Spacing;
            settings.RelaxationSteps = (uint)surface.RelaxationSteps;
            settings.Occlusion = surface.AmbientOcclusion;
            settings.GaussianRadiusScale = surface.GaussianRadiusScale;
            settings.GaussianIsovalue = surface.GaussianIsovalue;
            return settings;
        }

        // Coarsest first. The frame of reference of a computation, and so the last digits of its numbers, depends on which
        // of them a job has: all, or the last ones, if coarser ones were shown before.
        private static float[] CoarserLevels(MolecularSurface surface)
        {
            float[] levels = Array.FindAll(surface.Levels, level => level > surface.Spacing);
            Array.Sort(levels, (a, b) => b.CompareTo(a));
            return levels;
        }

        private static string DifferenceOf(MolecularSurface surface, in SurfaceMeshView view)
        {
            Mesh mesh = surface.Mesh;
            if (surface.CurrentLevel.VertexCount != view.VertexCount ||
                surface.CurrentLevel.TriangleCount != view.TriangleCount)
                return $"{surface.CurrentLevel.VertexCount} vertices and {surface.CurrentLevel.TriangleCount} triangles, not " +
                    $"{view.VertexCount} and {view.TriangleCount}";
            var vertices = new Vector3[view.VertexCount];
            var normals = new Vector3[view.VertexCount];
            var triangles = new int[3 * view.TriangleCount];
            view.CopyPositions(vertices);
            view.CopyNormals(normals);
            view.CopyTriangles(triangles);
            return !mesh.triangles.AsSpan().SequenceEqual(triangles) ? "other triangles"
                : !First(mesh.vertices, vertices.Length).AsSpan().SequenceEqual(vertices) ? "other positions"
                : !First(mesh.normals, normals.Length).AsSpan().SequenceEqual(normals) ? "other normals"
                : !surface.Owners.SequenceEqual(view.Owners) || !IsToldEach(surface) ? "other owners"
                : !surface.Repeated.SequenceEqual(view.Repeated) ? "other vertices that are repeated"
                : HasOtherOcclusion(mesh, view) ? "another ambient occlusion"
                : "";
        }

        // Texture coordinates of atoms may have taken its place: they are no such pairs.
        private static bool HasOtherOcclusion(Mesh mesh, in SurfaceMeshView view)
        {
            if (!view.HasTexcoords)
                return false;
            Vector2[] shown = First(mesh.uv2, view.VertexCount);
            ReadOnlySpan<Vector2> own = MemoryMarshal.Cast<float, Vector2>(view.Texcoords);
            return shown.Length > 0 && shown[0].y == 1 && !own.SequenceEqual(shown);
        }

        // Corner by corner.
        private static string DifferenceOfParts(MolecularSurface surface, in SurfaceMeshView view)
        {
            int[] shown = surface.Mesh.triangles;
            var triangles = new int[3 * view.TriangleCount];
            if (shown.Length != triangles.Length)
                return $"{shown.Length / 3} triangles, not {view.TriangleCount}";
            var vertices = new Vector3[view.VertexCount];
            var normals = new Vector3[view.VertexCount];
            view.CopyPositions(vertices);
            view.CopyNormals(normals);
            view.CopyTriangles(triangles);
            Vector3[] shownVertices = surface.Mesh.vertices, shownNormals = surface.Mesh.normals;
            for (int i = 0; i < shown.Length; ++i)
            {
                int vertex = triangles[i];
                if (!shownVertices[shown[i]].Equals(vertices[vertex]) || !shownNormals[shown[i]].Equals(normals[vertex]) ||
                    surface.OwnerAtomAt(shown[i]) != (int)view.Owners[vertex])
                    return $"another corner {i}";
            }
            return "";
        }

        private static bool IsToldEach(MolecularSurface surface)
        {
            ReadOnlySpan<uint> owners = surface.Owners;
            for (int v = 0; v < owners.Length; ++v)
                if (surface.OwnerAtomAt(v) != owners[v])
                    return false;
            return true;
        }

        private static void Weld(int[] triangles, int vertexCount, ReadOnlySpan<uint> repeated)
        {
            int single = vertexCount - repeated.Length;
            for (int i = 0; i < triangles.Length; ++i)
                if (triangles[i] >= single)
                    triangles[i] = (int)repeated[triangles[i] - single];
        }

        private static long Edge(int from, int to) => ((long)from << 32) | (uint)to;
    }
}
