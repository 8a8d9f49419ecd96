// SPDX-License-Identifier: MIT
using QuickSes.Interop;
using System;
using System.Numerics;

namespace QuickSes
{
    /// <summary>
    /// What of the native library brings meshes from CUDA into buffers of the graphics API; tests have one of their own,
    /// for machines without CUDA. Main thread only.
    /// </summary>
    internal interface IGpuLibrary
    {
        /// <summary>Whether the library and the driver can; else why not.</summary>
        bool IsUsable(GpuGraphics graphics, out string reason);

        /// <summary>Whether meshes of this back end can stay on the GPU.</summary>
        bool WorksWith(SurfaceBackend backend);

        /// <summary>What jobs are asked for, so that they do.</summary>
        MeshDelivery Delivery { get; }

        /// <summary>Whether a mesh has to be brought home before its arrays are looked at.</summary>
        bool IsOnGpuOnly(KeptMesh mesh);

        /// <summary>Brings it to host memory.</summary>
        QuickSesError Download(KeptMesh mesh);

        /// <summary>Throws if there can be none.</summary>
        IGpuTarget NewTarget();

        /// <summary>The event that is to be issued now; 0: none.</summary>
        int NextEvent();

        /// <summary>What the thread that draws calls for an event.</summary>
        IntPtr EventFunction { get; }
    }

    /// <summary>The buffers of one surface, as the library knows them. No garbage unless something is wrong.</summary>
    internal interface IGpuTarget : IDisposable
    {
        /// <summary>Of meshes that are submitted from now on. Empty: as the mesh has it; all are visible.</summary>
        /// <param name="atoms">How many there are.</param>
        /// <param name="colors">Four bytes per atom.</param>
        /// <param name="texcoords">Per atom.</param>
        /// <param name="visible">Per atom, 0: hidden.</param>
        QuickSesError SetLook(int atoms, ReadOnlySpan<uint> colors, ReadOnlySpan<Vector2> texcoords,
            ReadOnlySpan<byte> visible);

        /// <summary>Puts a mesh on its way. Busy: later.</summary>
        /// <param name="mesh">Is held by the library for as long as it needs it.</param>
        /// <param name="buffers">Where it goes.</param>
        QuickSesError Submit(KeptMesh mesh, in NativeGpuBuffers buffers);

        GpuTargetStatus GetStatus();
    }

    /// <summary>How a target stands: qses_gpu_status.</summary>
    internal readonly struct GpuTargetStatus
    {
        private readonly int _submitted;

        public GpuTargetStatus(in QuickSesError error, int submitted, int done, int waiting, bool isStopped)
        {
            Error = error;
            _submitted = submitted;
            Done = done;
            Waiting = waiting;
            IsStopped = isStopped;
        }

        /// <summary>Of its last event.</summary>
        public QuickSesError Error { get; }

        /// <summary>The number of its last event; 0: none.</summary>
        public int Done { get; }

        /// <summary>Meshes that wait for their event.</summary>
        public int Waiting { get; }

        /// <summary>
        /// The newest mesh was let go before its event ran: it is in no buffer. Also when events run again.
        /// </summary>
        public bool IsNewestLost => Waiting == 0 && IsLater(_submitted, Done);

        /// <summary>Events have not run for so long that meshes were let go.</summary>
        public bool IsStopped { get; }

        // Events are numbered in turn, and 1 follows int.MaxValue. 0 comes before all.
        private static bool IsLater(int number, int than)
        {
            if (than == 0)
                return number != 0;
            int steps = unchecked(number - than) & int.MaxValue;
            return steps > 0 && steps < 1 << 30;
        }
    }
}
