// SPDX-License-Identifier: MIT
using System;

namespace QuickSes
{
    /// <summary>The surface that is shown, and what it took to make it.</summary>
    public readonly struct SurfaceLevel
    {
        // A job may have computed a part of the ladder only, so the place in it is told by the spacing.
        internal SurfaceLevel(in SurfaceMeshView view, in SurfaceReport report, ReadOnlySpan<float> ladder,
            bool isOfNewestAtoms, double uploadMilliseconds)
        {
            int level = 0;
            while (level < ladder.Length - 1 && ladder[level] > view.Spacing)
                ++level;
            Level = level;
            LevelCount = ladder.Length;
            Spacing = view.Spacing;
            VertexCount = view.VertexCount;
            TriangleCount = view.TriangleCount;
            IsOfNewestAtoms = isOfNewestAtoms;
            ComputeMilliseconds = report.ComputeMilliseconds;
            UploadMilliseconds = uploadMilliseconds;
            WorkBytes = report.WorkBytesPeak;
            MeshBytes = report.MeshBytes;
            HostBytes = report.HostBytesPeak;
        }

        /// <summary>Its place among the levels; 0 is the coarsest.</summary>
        public int Level { get; }

        /// <summary>How many levels there are; 0: nothing is shown.</summary>
        public int LevelCount { get; }

        /// <summary>Whether it is the last of them.</summary>
        public bool IsFinest => Level == LevelCount - 1;

        /// <summary>Å between lattice points.</summary>
        public float Spacing { get; }

        /// <summary>Vertices of the surface.</summary>
        public int VertexCount { get; }

        /// <summary>Triangles of the surface.</summary>
        public int TriangleCount { get; }

        /// <summary>Whether it was of the newest atoms and settings when it was shown.</summary>
        public bool IsOfNewestAtoms { get; }

        /// <summary>From atoms to mesh in memory; for a later level: since the one before.</summary>
        public double ComputeMilliseconds { get; }

        /// <summary>Main thread, for the copy into the mesh.</summary>
        public double UploadMilliseconds { get; }

        /// <summary>Bytes of work memory: on the GPU with CUDA, else in the process.</summary>
        public ulong WorkBytes { get; }

        /// <summary>Bytes of the native mesh.</summary>
        public ulong MeshBytes { get; }

        /// <summary>Bytes of host memory of the context that computed it.</summary>
        public ulong HostBytes { get; }
    }
}
