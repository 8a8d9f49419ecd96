// SPDX-License-Identifier: MIT
using System;
using System.IO;
using UnityEngine;

namespace QuickSes
{
    /// <summary>
    /// What a source leads to: bytes in memory, or the full path of a file that is there. Made on the main thread; may
    /// be read on any.
    /// </summary>
    internal sealed class MoleculeFile
    {
        private MoleculeFile(string name, string path, byte[] bytes)
        {
            Name = name;
            Path = path;
            Bytes = bytes;
        }

        /// <summary>What the format is found out by, and messages call it.</summary>
        public string Name { get; }

        /// <summary>Full path; null if it is in memory.</summary>
        public string Path { get; }

        /// <summary>Its content; null if it is on disk.</summary>
        public byte[] Bytes { get; }

        /// <summary>false: <paramref name="error"/> names what is missing.</summary>
        public static bool TryFind(MoleculeSourceKind kind, TextAsset asset, string path, out MoleculeFile file,
            out QuickSesError error)
        {
            file = null;
            switch (kind)
            {
                case MoleculeSourceKind.None:
                    return Fail(QuickSesStatus.InvalidArgument, "no file is chosen", out error);
                case MoleculeSourceKind.TextAsset:
                    return TryRead(asset, out file, out error);
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
                    $"'{path}' can't be read: on this platform StreamingAssets is no folder but '{root}'; use a text " +
                    "asset", out error);
            return TryFindOnDisk(System.IO.Path.Combine(root, path), out file, out error);
        }

        private static bool TryRead(TextAsset asset, out MoleculeFile file, out QuickSesError error)
        {
            file = null;
            if (asset == null)
                return Fail(QuickSesStatus.InvalidArgument, "no text asset is chosen", out error);
            byte[] bytes = asset.bytes;
            if (bytes == null || bytes.Length == 0)
                return Fail(QuickSesStatus.FileError, $"the text asset '{asset.name}' is empty", out error);
            file = new MoleculeFile(asset.name, null, bytes);
            error = default;
            return true;
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
            file = new MoleculeFile(path, path, null);
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
