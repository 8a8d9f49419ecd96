// SPDX-License-Identifier: MIT
using System;

namespace QuickSes
{
    /// <summary>The surface that is shown, and what it took to make it.</summary>
    public readonly struct SurfaceLevel
    {
        // A job may have computed a part of the ladder only, so the place in it is told by the spacing.
        internal SurfaceLevel(in SurfaceMeshView view, in SurfaceReport report, ReadOnlySpan<float> ladder,
            bool hasCreases) : this()
        {
            int level = 0;
            while (level < ladder.Length - 1 && ladder[level] > view.Spacing)
                ++level;
            Level = level;
            LevelCount = ladder.Length;
            Spacing = view.Spacing;
            HasCreases = hasCreases && IsFinest;
            VertexCount = view.VertexCount;
            TriangleCount = view.TriangleCount;
            ComputeMilliseconds = report.ComputeMilliseconds;
            WorkBytes = report.WorkBytesPeak;
            MeshBytes = report.MeshBytes;
            HostBytes = report.HostBytesPeak;
        }

        /// <summary>The same when it is shown.</summary>
        internal SurfaceLevel(in SurfaceLevel level, bool isOfNewestAtoms, double uploadMilliseconds,
            double latencyMilliseconds)
        {
            this = level;
            IsOfNewestAtoms = isOfNewestAtoms;
            UploadMilliseconds = uploadMilliseconds;
            LatencyMilliseconds = latencyMilliseconds;
        }

        /// <summary>Its place among the levels; 0 is the coarsest.</summary>
        public int Level { get; }

        /// <summary>How many levels there are; 0: nothing is shown.</summary>
        public int LevelCount { get; }

        /// <summary>Whether it is the last of them.</summary>
        public bool IsFinest => Level == LevelCount - 1;

        /// <summary>Å between lattice points.</summary>
        public float Spacing { get; }

        /// <summary>Whether triangles follow its creases: see <see cref="MolecularSurface.SharpCreases"/>.</summary>
        public bool HasCreases { get; }

        /// <summary>
        /// Vertices of the surface, hidden parts too. While atoms move, the vertexCount of the mesh counts
        /// unused ones behind them as well.
        /// </summary>
        public int VertexCount { get; }

        /// <summary>Triangles of the surface, hidden parts too.</summary>
        public int TriangleCount { get; }

        /// <summary>Whether it was of the newest atoms and settings when it was shown.</summary>
        public bool IsOfNewestAtoms { get; }

        /// <summary>From atoms to mesh in memory; for a later level: since the one before.</summary>
        public double ComputeMilliseconds { get; }

        /// <summary>Main thread, for the copy into the mesh, in all frames it took.</summary>
        public double UploadMilliseconds { get; }

        /// <summary>
        /// From the frame that found it computed until it was shown: 0 if it fitted into that frame, else see
        /// <see cref="SurfaceScheduler.UploadBudget"/>.
        /// </summary>
        public double LatencyMilliseconds { get; }

        /// <summary>Bytes of work memory: on the GPU with CUDA, else in the process.</summary>
        public ulong WorkBytes { get; }

        /// <summary>Bytes of the native mesh.</summary>
        public ulong MeshBytes { get; }

        /// <summary>Bytes of host memory of the context that computed it.</summary>
        public ulong HostBytes { get; }
    }
}
