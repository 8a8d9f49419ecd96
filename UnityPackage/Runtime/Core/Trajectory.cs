// SPDX-License-Identifier: MIT
using QuickSes.Interop;
using System;

namespace QuickSes
{
    /// <summary>
    /// Many frames of the same atoms (DCD, XTC, TRR, NetCDF, PDB with several models; gzipped or not), read in any order. Any number
    /// of threads may read it at a time, but for <see cref="TryUnwrap"/>. Coordinates are those of the file, in Å,
    /// right-handed.
    /// </summary>
    public sealed unsafe class Trajectory : IDisposable
    {
        private readonly TrajectoryHandle _handle;
        private NativeTrajectoryDescription _info;

        private Trajectory(TrajectoryHandle handle)
        {
            _handle = handle;
            ReadInfo();
        }

        /// <summary>
        /// Opens a file, whose frames stay in it until they are asked for; false: <paramref name="error"/> says what is
        /// wrong with it. A file that ends early gives the frames before: see <see cref="IsIncomplete"/>.
        /// </summary>
        public static bool TryOpen(string path, TrajectoryFormat format, out Trajectory trajectory,
            out QuickSesError error)
        {
            if (path == null)
                throw new ArgumentNullException(nameof(path));
            fixed (byte* name = NativeText.Write(path, nameof(path)))
                return TryOpen(name, null, 0, format, out trajectory, out error);
        }

        /// <summary>The same from bytes in memory, which are copied.</summary>
        public static bool TryOpen(
            ReadOnlySpan<byte> bytes, TrajectoryFormat format, out Trajectory trajectory, out QuickSesError error)
        {
            byte nothing = 0; // the library takes no NULL, not even for 0 bytes
            fixed (byte* given = bytes)
                return TryOpen(null, given == null ? &nothing : given, bytes.Length, format, out trajectory, out error);
        }

        /// <summary>The format it was read as.</summary>
        public TrajectoryFormat Format => Info.Format;

        /// <summary>Whole frames, at least 1.</summary>
        public long FrameCount => (long)Info.FrameCount;

        /// <summary>Atoms per frame, at least 1; in PDB files all ATOM and HETATM records of a model.</summary>
        public int AtomCount => (int)Info.AtomCount;

        /// <summary>Whether frame 0 has a periodic box.</summary>
        public bool HasBox => Info.HasBox != 0;

        /// <summary>Whether <see cref="TryUnwrap"/> was called with success.</summary>
        public bool IsUnwrapped => Info.IsUnwrapped != 0;

        /// <summary>Whether the file ends, or stops making sense, before it should; a warning says where.</summary>
        public bool IsIncomplete => Info.Incomplete != 0;

        /// <summary>How many sentences for the user there are.</summary>
        public int WarningCount => (int)Info.WarningCount;

        /// <summary>Sentence k, from 0 to <see cref="WarningCount"/> - 1.</summary>
        public string GetWarning(int k)
        {
            ThrowIfDisposed();
            byte* sentence;
            QuickSesException.ThrowUnlessOk(NativeMethods.qses_trajectory_warning(_handle, (uint)k, &sentence));
            string text = NativeText.Read(sentence);
            GC.KeepAlive(this);
            return text;
        }

        /// <summary>
        /// From now on frames come with every molecule in one piece instead of torn by the borders of the box; those
        /// without a box come as they are (<see cref="TrajectoryFrame.IsUnwrapped"/>). No other thread may use the
        /// trajectory meanwhile.
        /// </summary>
        /// <param name="elements">
        /// Atomic numbers (0: unknown) of all atoms, such as <see cref="Structure.FileElements"/>.
        /// </param>
        /// <param name="error">Why frames come as before: NoBox, FileError or OutOfMemory.</param>
        public bool TryUnwrap(ReadOnlySpan<byte> elements, out QuickSesError error)
        {
            if (elements.Length != AtomCount)
                throw new ArgumentException($"has {elements.Length} elements for {AtomCount} atoms", nameof(elements));
            QuickSesStatus status;
            fixed (byte* numbers = elements)
                status = NativeMethods.qses_trajectory_unwrap(_handle, numbers, (UIntPtr)elements.Length);
            error = QuickSesError.FromLastCall(status);
            ReadInfo();
            return status == QuickSesStatus.Ok;
        }

        /// <summary>
        /// Reads a frame into the caller's memory. Makes no garbage on success. Any thread.
        /// </summary>
        /// <param name="index">From 0 to <see cref="FrameCount"/> - 1.</param>
        /// <param name="positions">Room for <see cref="AtomCount"/> x 3 numbers, Å. Undefined after an error.</param>
        /// <param name="frame">Time and box.</param>
        /// <param name="error">The frame is damaged (others may be whole), or OutOfMemory.</param>
        public bool TryReadFrame(long index, Span<float> positions, out TrajectoryFrame frame, out QuickSesError error)
        {
            if ((ulong)index >= Info.FrameCount)
                throw new ArgumentOutOfRangeException(nameof(index), index, $"there are {_info.FrameCount} frames");
            if (positions.Length != 3L * AtomCount)
                throw new ArgumentException($"has {positions.Length} numbers, but {AtomCount} atoms need 3 each",
                    nameof(positions));
            NativeFrame native = NativeDefaults.Frame();
            QuickSesStatus status;
            fixed (float* xyz = positions)
                status = NativeMethods.qses_trajectory_read_frame(
                    _handle, (ulong)index, xyz, UIntPtr.Zero, (UIntPtr)_info.AtomCount, &native);
            frame = new TrajectoryFrame(native);
            error = QuickSesError.FromLastCall(status);
            return status == QuickSesStatus.Ok;
        }

        /// <summary>Frees the trajectory and everything it handed out. May be called twice.</summary>
        public void Dispose() => _handle.Dispose();

        private ref readonly NativeTrajectoryDescription Info
        {
            get
            {
                ThrowIfDisposed();
                return ref _info;
            }
        }

        private void ThrowIfDisposed() => _handle.ThrowIfClosed(nameof(Trajectory));

        private void ReadInfo()
        {
            NativeTrajectoryDescription info = NativeDefaults.TrajectoryDescription();
            QuickSesException.ThrowUnlessOk(NativeMethods.qses_trajectory_info(_handle, &info));
            _info = info;
        }

        // Of a file, or, where path is null, of bytes.
        private static bool TryOpen(byte* path, byte* bytes, int size, TrajectoryFormat format,
            out Trajectory trajectory, out QuickSesError error)
        {
            trajectory = null;
            if (!NativeLibraryCheck.IsUsable(out string reason))
            {
                error = new QuickSesError(QuickSesStatus.BackendUnavailable, reason);
                return false;
            }
            var handle = new TrajectoryHandle();
            IntPtr opened;
            QuickSesStatus status = path != null
                ? NativeMethods.qses_trajectory_open(path, format, &opened)
                : NativeMethods.qses_trajectory_open_memory(bytes, (UIntPtr)size, format, &opened);
            error = QuickSesError.FromLastCall(status);
            if (status != QuickSesStatus.Ok)
                return false;
            handle.Take(opened);
            trajectory = new Trajectory(handle);
            return true;
        }
    }
}
