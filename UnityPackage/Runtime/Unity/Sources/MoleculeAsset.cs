// SPDX-License-Identifier: MIT
using System;
using UnityEngine;

namespace QuickSes
{
    /// <summary>
    /// A file of atoms or frames as an asset, byte for byte: what becomes of .cif, .pdb, .gro, .xtc, ... in Assets. It
    /// travels with scenes and builds, and is in memory, once, while something that is loaded refers to it. Main thread
    /// only.
    /// </summary>
    public sealed class MoleculeAsset : ScriptableObject
    {
        [SerializeField, HideInInspector] private string _fileName = "";
        [SerializeField, HideInInspector] private byte[] _bytes = Array.Empty<byte>();

        /// <summary>With extensions, such as "1aon.cif.gz": they tell the format. Never null.</summary>
        public string FileName => _fileName ?? "";

        /// <summary>Bytes.</summary>
        public long Size => Content.Length;

        /// <summary>What is in the file.</summary>
        public ReadOnlySpan<byte> Bytes => Content;

        /// <summary>Makes one at run time, of bytes that were downloaded, say. Destroy it after use.</summary>
        /// <param name="fileName">With extensions, such as "1aon.cif.gz".</param>
        /// <param name="bytes">Taken over, not copied: must not change any more.</param>
        public static MoleculeAsset Create(string fileName, byte[] bytes)
        {
            var asset = CreateInstance<MoleculeAsset>();
            asset._fileName = fileName ?? throw new ArgumentNullException(nameof(fileName));
            asset._bytes = bytes ?? throw new ArgumentNullException(nameof(bytes));
            asset.name = System.IO.Path.GetFileNameWithoutExtension(fileName);
            return asset;
        }

        /// <summary>Never changed, so other threads may go on reading it when the asset is destroyed.</summary>
        internal byte[] Content => _bytes ?? Array.Empty<byte>();
    }
}
