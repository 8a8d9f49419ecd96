// SPDX-License-Identifier: MIT
using QuickSes.Interop;
using System;

namespace QuickSes
{
    /// <summary>
    /// The atoms of one model of a file (PDB, mmCIF, PQR, XYZR, GRO; gzipped or not), after filters, with radii. It
    /// never changes: any number of threads may use it at a time. Spans are views of its native memory, valid until
    /// Dispose; keep the structure itself alive while they are used. Coordinates are those of the file, hence
    /// right-handed.
    /// </summary>
    public sealed unsafe partial class Structure : IDisposable
    {
        private readonly StructureHandle _handle;
        private readonly NativeStructureDescription _info;

        private Structure(StructureHandle handle)
        {
            _handle = handle;
            NativeStructureDescription info = NativeDefaults.StructureDescription();
            QuickSesException.ThrowUnlessOk(NativeMethods.qses_structure_info(handle, &info));
            _info = info;
        }

        /// <summary>
        /// Reads a file; false: <paramref name="error"/> says what is wrong with it or with the options.
        /// </summary>
        public static bool TryOpen(string path, in StructureOptions options, out Structure structure,
            out QuickSesError error)
        {
            if (path == null)
                throw new ArgumentNullException(nameof(path));
            fixed (byte* name = NativeText.Write(path, nameof(path)))
                return TryOpen(name, null, 0, options, out structure, out error);
        }

        /// <summary>
        /// Reads bytes in memory, which are only looked at during the call. options.Format should name the format: Auto
        /// tells PDB from mmCIF and knows no other.
        /// </summary>
        public static bool TryOpen(
            ReadOnlySpan<byte> bytes, in StructureOptions options, out Structure structure, out QuickSesError error)
        {
            byte nothing = 0; // the library takes no NULL, not even for 0 bytes
            fixed (byte* given = bytes)
                return TryOpen(null, given == null ? &nothing : given, bytes.Length, options, out structure, out error);
        }

        /// <summary>The format it was read as.</summary>
        public StructureFormat Format => Info.Format;

        /// <summary>Place of the model in the file, from 1.</summary>
        public int Model => Info.Model;

        /// <summary>Models in the file.</summary>
        public int ModelCount => Info.ModelCount;

        /// <summary>N, those kept, at least 1; in the order of the file.</summary>
        public int AtomCount => (int)Info.AtomCount;

        /// <summary>M, atom records of the model in the file.</summary>
        public int FileAtomCount => (int)Info.FileAtomCount;

        /// <summary>N x 3, Å: as <see cref="SurfaceContext.SetAtoms"/> takes them.</summary>
        public ReadOnlySpan<float> Positions => new ReadOnlySpan<float>(Info.Positions, checked(3 * AtomCount));

        /// <summary>N, Å.</summary>
        public ReadOnlySpan<float> Radii => new ReadOnlySpan<float>(Info.Radii, AtomCount);

        /// <summary>
        /// N, rising, each below M: pick these atoms out of a frame of a trajectory that has all M
        /// (<see cref="SurfaceContext.SetPositions(ReadOnlySpan{float}, ReadOnlySpan{uint})"/>).
        /// </summary>
        public ReadOnlySpan<uint> FileIndices => new ReadOnlySpan<uint>(Info.FileIndices, AtomCount);

        /// <summary>
        /// M atomic numbers, also of atoms that were left out: for <see cref="Trajectory.TryUnwrap"/>.
        /// </summary>
        public ReadOnlySpan<byte> FileElements => new ReadOnlySpan<byte>(Info.FileElements, FileAtomCount);

        /// <summary>
        /// N, rising from 0 by 1 at most: which residue an atom is of. Neighbours of the same chain, residue number,
        /// insertion code and residue name are of one; in XYZR files each atom is one by itself.
        /// </summary>
        public ReadOnlySpan<uint> Residues => new ReadOnlySpan<uint>(Info.Residues, AtomCount);

        /// <summary>Bytes of native memory that it takes until it is disposed of.</summary>
        public long MemoryBytes => (long)Info.Memory;

        /// <summary>What the file says about atom i, from 0 to N - 1. Makes new strings.</summary>
        public StructureAtom GetAtom(int i)
        {
            if ((uint)i >= Info.AtomCount)
                throw new ArgumentOutOfRangeException(nameof(i), i, $"there are {Info.AtomCount} atoms");
            NativeAtom native = NativeDefaults.Atom();
            QuickSesException.ThrowUnlessOk(NativeMethods.qses_structure_atom(_handle, (uint)i, &native));
            var atom = new StructureAtom(native);
            GC.KeepAlive(this);
            return atom;
        }

        /// <summary>
        /// How many sentences for the user there are, such as about elements that had to be inferred.
        /// </summary>
        public int WarningCount => (int)Info.WarningCount;

        /// <summary>Sentence k, from 0 to <see cref="WarningCount"/> - 1.</summary>
        public string GetWarning(int k)
        {
            ThrowIfDisposed();
            byte* sentence;
            QuickSesException.ThrowUnlessOk(NativeMethods.qses_structure_warning(_handle, (uint)k, &sentence));
            string text = NativeText.Read(sentence);
            GC.KeepAlive(this);
            return text;
        }

        /// <summary>Frees the structure and everything it handed out. May be called twice.</summary>
        public void Dispose() => _handle.Dispose();

        internal bool IsDisposed => _handle.IsClosed;

        private ref readonly NativeStructureDescription Info
        {
            get
            {
                ThrowIfDisposed();
                return ref _info;
            }
        }

        private void ThrowIfDisposed() => _handle.ThrowIfClosed(nameof(Structure));

        // Of a file, or, where path is null, of bytes.
        private static bool TryOpen(byte* path, byte* bytes, int size, in StructureOptions options,
            out Structure structure, out QuickSesError error)
        {
            structure = null;
            if (!NativeLibraryCheck.IsUsable(out string reason))
            {
                error = new QuickSesError(QuickSesStatus.BackendUnavailable, reason);
                return false;
            }
            NativeStructureOptions native = NativeDefaults.StructureOptions();
            native.Format = options.Format;
            if (options.Model != 0)
                native.Model = options.Model;
            native.Water = options.SkipWater ? 0 : 1;
            native.Hetero = options.SkipHetero ? 0 : 1;
            native.Hydrogen = options.SkipHydrogen ? 0 : 1;
            var handle = new StructureHandle();
            IntPtr opened;
            QuickSesStatus status;
            fixed (byte* selection = NativeText.Write(options.Selection, nameof(options)))
            fixed (byte* radii = NativeText.Write(options.Radii, nameof(options)))
            fixed (byte* assembly = NativeText.Write(options.Assembly, nameof(options)))
            fixed (byte* altloc = NativeText.Write(options.AlternateLocation, nameof(options)))
            {
                native.Selection = selection;
                native.Radii = radii;
                native.Assembly = assembly;
                native.Altloc = altloc;
                status = path != null
                    ? NativeMethods.qses_structure_open(path, &native, &opened)
                    : NativeMethods.qses_structure_open_memory(bytes, (UIntPtr)size, &native, &opened);
            }
            error = QuickSesError.FromLastCall(status);
            if (status != QuickSesStatus.Ok)
                return false;
            handle.Take(opened);
            structure = new Structure(handle);
            return true;
        }
    }
}
