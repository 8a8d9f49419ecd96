// SPDX-License-Identifier: MIT
using QuickSes.Interop;

namespace QuickSes
{
    /// <summary>What computes, or why it can't.</summary>
    public readonly struct BackendDescription
    {
        internal unsafe BackendDescription(in NativeBackendDescription native)
        {
            IsAvailable = native.Available != 0;
            IsPreparing = native.Preparing != 0;
            TotalMemory = native.TotalMemory;
            FreeMemory = native.FreeMemory;
            Processors = native.Processors;
            fixed (byte* device = native.Device, reason = native.Reason)
            {
                Device = NativeText.Read(device);
                Reason = NativeText.Read(reason);
            }
        }

        /// <summary>Whether a context with this back end can be made.</summary>
        public bool IsAvailable { get; }

        /// <summary>The GPU's name, or the CPU's instruction set and thread count.</summary>
        public string Device { get; }

        /// <summary>
        /// Whether the first context for this GPU is being made, on another thread, and the driver loads the kernels.
        /// For a GPU newer than the library it compiles them then, for up to a minute, once per driver version.
        /// </summary>
        public bool IsPreparing { get; }

        /// <summary>
        /// Why it is not available, or, for <see cref="SurfaceBackend.Auto"/>, why it is not CUDA, or, while it is
        /// prepared, what is done; else "".
        /// </summary>
        public string Reason { get; }

        /// <summary>
        /// Bytes of the device, or of the machine; on Linux no more than a container or a batch job may have.
        /// </summary>
        public ulong TotalMemory { get; }

        /// <summary>Bytes of <see cref="TotalMemory"/> that were free when it was asked for.</summary>
        public ulong FreeMemory { get; }

        /// <summary>
        /// How many processors the calling thread may run on; on Linux no more than a container or a batch job has time
        /// for. No context has more threads of the CPU at work.
        /// </summary>
        public uint Processors { get; }
    }
}
