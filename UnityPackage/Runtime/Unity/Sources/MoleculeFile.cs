// SPDX-License-Identifier: MIT
using System;
using System.IO;
using Unity.Collections;
using Unity.Collections.LowLevel.Unsafe;
using UnityEngine;

namespace QuickSes
{
    /// <summary>
    /// What a source leads to: bytes in memory, or the full path of a file that is there. Made on the main thread; may
    /// be read on any once it is detached. One thread at a time.
    /// </summary>
    internal sealed class MoleculeFile : IDisposable
    {
        private const int MostBytesAtOnce = 4 << 20; // a millisecond or less

        private TextAsset _asset; // while its own memory is looked at
        private readonly byte[] _bytes; // of a molecule asset
        private UnmanagedBuffer<byte> _copy; // of a text asset
        private IntPtr _copiedFrom;
        private int _copied;

        private MoleculeFile(string name, string path, TextAsset asset, byte[] bytes)
        {
            Name = name;
            Path = path;
            _asset = asset;
            _bytes = bytes;
        }

        /// <summary>What the format is found out by, and messages call it.</summary>
        public string Name { get; }

        /// <summary>Full path; null if it is in memory.</summary>
        public string Path { get; }

        /// <summary>
        /// Its content, if it is in memory. Before it is detached: main thread, until anything may destroy assets.
        /// </summary>
        public ReadOnlySpan<byte> Bytes => _copy != null && IsDetached ? _copy.Span
            : !IsDetached ? BytesOf(_asset)
            : _bytes;

        /// <summary>Whether nothing of it is the engine's, so that any thread may read it.</summary>
        public bool IsDetached => _asset is null;

        /// <summary>From 0 to 1: how much is detached.</summary>
        public float DetachedPart => IsDetached ? 1 : _copy == null ? 0 : (float)_copied / Math.Max(1, _copy.Length);

        /// <summary>
        /// Copies some bytes of a text asset, whose memory the engine frees whenever the asset is destroyed, unloaded or
        /// imported anew, which no thread could prevent. Main thread; again and again until it is detached.
        /// </summary>
        /// <param name="error">The asset is gone.</param>
        public unsafe bool TryDetach(out QuickSesError error)
        {
            error = default;
            if (IsDetached)
                return true;
            if (_asset == null)
                return Fail(QuickSesStatus.FileError, $"the text asset '{Name}' was destroyed before it was read",
                    out error);
            ReadOnlySpan<byte> bytes = BytesOf(_asset);
            fixed (byte* first = bytes)
            {
                if (_copy == null || _copiedFrom != (IntPtr)first || _copy.Length != bytes.Length)
                {
                    _copy = _copy ?? new UnmanagedBuffer<byte>();
                    _copy.Resize(bytes.Length);
                    _copiedFrom = (IntPtr)first;
                    _copied = 0;
                }
            }
            int count = Math.Min(MostBytesAtOnce, bytes.Length - _copied);
            bytes.Slice(_copied, count).CopyTo(_copy.Span.Slice(_copied));
            _copied += count;
            if (_copied == bytes.Length)
                _asset = null;
            return true;
        }

        /// <summary>Frees the copy, if there is one.</summary>
        public void Dispose() => _copy?.Dispose();

        /// <summary>
        /// <paramref name="content"/> is that of the molecule. false: <paramref name="error"/> names what is missing.
        /// </summary>
        public static bool TryFind(MoleculeSourceKind kind, TextAsset asset, MoleculeAsset molecule, byte[] content,
            string path, out MoleculeFile file, out QuickSesError error)
        {
            file = null;
            switch (kind)
            {
                case MoleculeSourceKind.None:
                    return Fail(QuickSesStatus.InvalidArgument, "no file is chosen", out error);
                case MoleculeSourceKind.TextAsset:
                    return TryFindText(asset, out file, out error);
                case MoleculeSourceKind.MoleculeAsset:
                    return TryFindMolecule(molecule, content, out file, out error);
                case MoleculeSourceKind.StreamingAssets:
                    return TryFindStreamed(Application.streamingAssetsPath, path, out file, out error);
                case MoleculeSourceKind.File:
                    return TryFindFile(path, out file, out error);
                default:
                    return Fail(QuickSesStatus.InvalidArgument, $"there is no kind {(int)kind} of source", out error);
            }
        }

        /// <summary>A path below the folder <paramref name="root"/>, which need not be a folder everywhere.</summary>
        internal static bool TryFindStreamed(string root, string path, out MoleculeFile file, out QuickSesError error)
        {
            file = null;
            if (string.IsNullOrWhiteSpace(path))
                return Fail(QuickSesStatus.InvalidArgument, "no path below StreamingAssets is given", out error);
            if (System.IO.Path.IsPathRooted(path))
                return Fail(QuickSesStatus.InvalidArgument,
                    $"'{path}' is an absolute path, not one below StreamingAssets", out error);
            if (string.IsNullOrEmpty(root) || root.Contains("://"))
                return Fail(QuickSesStatus.FileError,
                    $"'{path}' can't be read: on this platform StreamingAssets is no folder but '{root}'; use an " +
                    "asset", out error);
            return TryFindOnDisk(System.IO.Path.Combine(root, path), out file, out error);
        }

        private static bool TryFindText(TextAsset asset, out MoleculeFile file, out QuickSesError error)
        {
            file = null;
            if (asset == null)
                return Fail(QuickSesStatus.InvalidArgument, "no text asset is chosen", out error);
            if (asset.dataSize == 0)
                return Fail(QuickSesStatus.FileError, $"the text asset '{asset.name}' is empty", out error);
            if (asset.dataSize > int.MaxValue)
                return Fail(QuickSesStatus.FileError,
                    $"the text asset '{asset.name}' has more than {int.MaxValue} bytes", out error);
            file = new MoleculeFile(asset.name, null, asset, null);
            error = default;
            return true;
        }

        private static bool TryFindMolecule(MoleculeAsset asset, byte[] content, out MoleculeFile file,
            out QuickSesError error)
        {
            file = null;
            if (asset == null)
                return Fail(QuickSesStatus.InvalidArgument, "no molecule asset is chosen", out error);
            if (content.Length == 0)
                return Fail(QuickSesStatus.FileError, $"the molecule asset '{asset.FileName}' is empty", out error);
            file = new MoleculeFile(asset.FileName, null, null, content);
            error = default;
            return true;
        }

        private static unsafe ReadOnlySpan<byte> BytesOf(TextAsset asset)
        {
            NativeArray<byte> data = asset.GetData<byte>();
            return new ReadOnlySpan<byte>(data.GetUnsafeReadOnlyPtr(), data.Length);
        }

        private static bool TryFindFile(string path, out MoleculeFile file, out QuickSesError error)
        {
            file = null;
            if (string.IsNullOrWhiteSpace(path))
                return Fail(QuickSesStatus.InvalidArgument, "no path is given", out error);
            if (!System.IO.Path.IsPathRooted(path))
                return Fail(QuickSesStatus.InvalidArgument, $"'{path}' is not an absolute path", out error);
            return TryFindOnDisk(path, out file, out error);
        }

        private static bool TryFindOnDisk(string path, out MoleculeFile file, out QuickSesError error)
        {
            file = null;
            if (Directory.Exists(path))
                return Fail(QuickSesStatus.FileError, $"'{path}' is a folder", out error);
            if (!File.Exists(path))
                return Fail(QuickSesStatus.FileError, $"there is no file '{path}'", out error);
            file = new MoleculeFile(path, path, null, null);
            error = default;
            return true;
        }

        private static bool Fail(QuickSesStatus status, string message, out QuickSesError error)
        {
            error = new QuickSesError(status, message);
            return false;
        }

        /// <summary>The format a name tells, Auto if none.</summary>
        public static StructureFormat StructureFormatOf(string name)
        {
            switch (Extension(name))
            {
                case ".pdb":
                case ".ent":
                case ".brk":
                    return StructureFormat.Pdb;
                case ".cif":
                case ".mmcif":
                    return StructureFormat.Mmcif;
                case ".pqr":
                    return StructureFormat.Pqr;
                case ".xyzr":
                case ".xyzrn":
                    return StructureFormat.Xyzr;
                case ".gro":
                    return StructureFormat.Gro;
                default:
                    return StructureFormat.Auto;
            }
        }

        /// <summary>The format a name tells, Auto if none.</summary>
        public static TrajectoryFormat TrajectoryFormatOf(string name)
        {
            switch (Extension(name))
            {
                case ".dcd":
                    return TrajectoryFormat.Dcd;
                case ".xtc":
                    return TrajectoryFormat.Xtc;
                case ".trr":
                    return TrajectoryFormat.Trr;
                case ".nc":
                case ".ncdf":
                case ".ncrst":
                    return TrajectoryFormat.Netcdf;
                case ".pdb":
                case ".ent":
                case ".brk":
                    return TrajectoryFormat.Pdb;
                default:
                    return TrajectoryFormat.Auto;
            }
        }

        // ".pdb" of "2k39.PDB.gz.bytes". Unity drops the last extension of an asset's name, files on disk have it.
        private static string Extension(string name)
        {
            for (;;)
            {
                string extension = System.IO.Path.GetExtension(name).ToLowerInvariant();
                if (extension != ".gz" && extension != ".bytes" && extension != ".txt")
                    return extension;
                name = System.IO.Path.GetFileNameWithoutExtension(name);
            }
        }
    }
}
