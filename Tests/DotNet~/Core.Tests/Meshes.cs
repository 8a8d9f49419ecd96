// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections.Generic;

namespace QuickSes.Tests
{
    /// <summary>Molecules to compute, and what is true of their meshes.</summary>
    internal static class Meshes
    {
        public static Structure Crambin()
        {
            Assert.That(
                Structure.TryOpen(Repository.CrambinPath, default, out Structure structure, out QuickSesError error),
                Is.True, error.ToString());
            return structure;
        }

        public static SurfaceContext ContextOf(Structure structure, SurfaceContextOptions options = default)
        {
            var context = new SurfaceContext(options);
            Assert.That(context.SetAtoms(structure.Positions, structure.Radii), Is.EqualTo(QuickSesStatus.Ok));
            return context;
        }

        public static SurfaceContext CrambinContext()
        {
            using Structure structure = Crambin();
            return ContextOf(structure);
        }

        public static SurfaceMeshView Compute(SurfaceContext context, in SurfaceSettings settings)
        {
            QuickSesStatus status = context.Compute(settings, out SurfaceMeshView mesh);
            Assert.That(status, Is.EqualTo(QuickSesStatus.Ok), context.LastError);
            return mesh;
        }

        /// <summary>
        /// Every edge has one triangle on each of its sides, which run along it in opposite directions.
        /// </summary>
        public static bool IsClosed(ReadOnlySpan<uint> indices)
        {
            var edges = new HashSet<(uint, uint)>();
            for (int t = 0; t < indices.Length; t += 3)
                for (int k = 0; k < 3; ++k)
                    if (!edges.Add((indices[t + k], indices[t + (k + 1) % 3])))
                        return false;
            foreach ((uint a, uint b) in edges)
                if (!edges.Contains((b, a)))
                    return false;
            return true;
        }

        /// <summary>Sum over the triangles: area, and signed volume by the divergence theorem.</summary>
        public static (double Area, double Volume) Measure(ReadOnlySpan<float> positions, ReadOnlySpan<uint> indices)
        {
            double area = 0, volume = 0;
            for (int t = 0; t < indices.Length; t += 3)
            {
                int a = 3 * (int)indices[t], b = 3 * (int)indices[t + 1], c = 3 * (int)indices[t + 2];
                double ux = positions[b] - (double)positions[a], uy = positions[b + 1] - (double)positions[a + 1],
                    uz = positions[b + 2] - (double)positions[a + 2];
                double vx = positions[c] - (double)positions[a], vy = positions[c + 1] - (double)positions[a + 1],
                    vz = positions[c + 2] - (double)positions[a + 2];
                double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
                area += Math.Sqrt(nx * nx + ny * ny + nz * nz) / 2;
                volume += (positions[a] * nx + positions[a + 1] * ny + positions[a + 2] * nz) / 6;
            }
            return (area, volume);
        }
    }
}
