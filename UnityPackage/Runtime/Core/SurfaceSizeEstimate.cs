// SPDX-License-Identifier: MIT
using QuickSes.Interop;

namespace QuickSes
{
    /// <summary>What a computation would give and need: within 25 % of the truth as a rule.</summary>
    public readonly struct SurfaceSizeEstimate
    {
        internal SurfaceSizeEstimate(in NativeSizeEstimate native)
        {
            _native = native;
        }

        private readonly NativeSizeEstimate _native;

        /// <summary>Whether it can be done within the context's memory budget, or else in the memory that is free.</summary>
        public bool Fits => _native.Fits != 0;

        /// <summary>Vertices of the mesh.</summary>
        public ulong Vertices => _native.Vertices;

        /// <summary>Triangles of the mesh.</summary>
        public ulong Triangles => _native.Triangles;

        /// <summary>Bytes of the mesh that is handed out, in host memory.</summary>
        public ulong MeshBytes => _native.MeshBytes;

        /// <summary>Bytes for the work: on the device with CUDA, else in host memory.</summary>
        public ulong WorkBytes => _native.WorkBytes;

        /// <summary>
        /// The least <see cref="SurfaceContextOptions.MemoryBudget"/> that would do, with some reserve.
        /// </summary>
        public ulong SmallestBudget => _native.SmallestBudget;
    }
}
