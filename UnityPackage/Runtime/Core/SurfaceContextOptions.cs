// SPDX-License-Identifier: MIT
namespace QuickSes
{
    /// <summary>With what a <see cref="SurfaceContext"/> computes. <c>default</c> is the defaults.</summary>
    public struct SurfaceContextOptions
    {
        /// <summary>What computes; default: CUDA where it can be used, else the CPU.</summary>
        public SurfaceBackend Backend { get; set; }

        /// <summary>CUDA device, from 0 to <see cref="SurfaceContext.DeviceCount"/> - 1; default 0.</summary>
        public int Device { get; set; }

        /// <summary>
        /// CPU threads, at most 4096; 0 (default): one per hardware thread. Games leave some to themselves.
        /// </summary>
        public uint Threads { get; set; }

        /// <summary>
        /// Bytes; 0 (default): what is free at the time. With CUDA it covers everything on the device, on the CPU the
        /// work without the mesh that is handed out. The mesh is the same byte for byte; only the time grows.
        /// </summary>
        public ulong MemoryBudget { get; set; }

        /// <summary>
        /// Whether the threads that compute stand back behind others of normal priority. Kernels of the GPU have the
        /// lowest priority either way, but for those of coarser levels and those that place vertices of large meshes. A
        /// caller of <see cref="SurfaceContext.Compute"/> lends its thread as it is.
        /// </summary>
        public bool Background { get; set; }
    }
}
