// SPDX-License-Identifier: MIT
using System;
using UnityEngine;

namespace QuickSes
{
    /// <summary>
    /// Where a file is: what <see cref="MoleculeSource"/> and <see cref="TrajectorySource"/> have in common. Serialised
    /// with the component it belongs to. Main thread only.
    /// </summary>
    [Serializable]
    public abstract class FileSource
    {
        [SerializeField, Tooltip("Where the file is.")]
        private MoleculeSourceKind _kind = MoleculeSourceKind.None;
        [SerializeField, Tooltip("A file that Unity imports as text, such as 1crn.pdb.txt or 2k39.pdb.gz.bytes.")]
        private TextAsset _asset;
        [SerializeField, Tooltip("A file in Assets that the package imported, such as 1crn.pdb or md.xtc.")]
        private MoleculeAsset _molecule;
        [SerializeField, Tooltip("Absolute, or relative to Assets/StreamingAssets.")]
        private string _path = "";
        [NonSerialized] private byte[] _keptContent; // of the molecule, by copies of a source

        private protected FileSource()
        {
        }

        /// <summary>
        /// Which of <see cref="Asset"/>, <see cref="Molecule"/> and <see cref="Path"/> counts.
        /// </summary>
        public MoleculeSourceKind Kind { get => _kind; set => _kind = value; }

        /// <summary>For <see cref="MoleculeSourceKind.TextAsset"/>.</summary>
        public TextAsset Asset { get => _asset; set => _asset = value; }

        /// <summary>For <see cref="MoleculeSourceKind.MoleculeAsset"/>.</summary>
        public MoleculeAsset Molecule { get => _molecule; set => _molecule = value; }

        /// <summary>For the kinds File (absolute) and StreamingAssets (relative to that folder). Never null.</summary>
        public string Path { get => _path ?? ""; set => _path = value; }

        /// <summary>Whether a file is named; it need not be there.</summary>
        public bool IsSet => _kind == MoleculeSourceKind.TextAsset
            ? _asset != null
            : _kind == MoleculeSourceKind.MoleculeAsset
            ? _molecule != null
            : _kind != MoleculeSourceKind.None && !string.IsNullOrWhiteSpace(_path);

        /// <summary>Names a text asset, which is not read yet.</summary>
        public void SetAsset(TextAsset asset)
        {
            _kind = MoleculeSourceKind.TextAsset;
            _asset = asset;
        }

        /// <summary>Names a molecule asset, which is not read yet.</summary>
        public void SetAsset(MoleculeAsset asset)
        {
            _kind = MoleculeSourceKind.MoleculeAsset;
            _molecule = asset;
        }

        /// <summary>Names a file by its absolute path, which is not read yet.</summary>
        public void SetFile(string path)
        {
            _kind = MoleculeSourceKind.File;
            _path = path;
        }

        internal bool TryFind(out MoleculeFile file, out QuickSesError error) =>
            MoleculeFile.TryFind(_kind, _asset, _molecule, Content, _path, out file, out error);

        private protected void CopyFileFrom(FileSource other)
        {
            _kind = other._kind;
            _asset = other._asset;
            _molecule = other._molecule;
            _path = other._path;
        }

        private protected bool HasSameFileAs(FileSource other) =>
            _kind == other._kind && _asset == other._asset && _molecule == other._molecule && Path == other.Path;

        /// <summary>Of a copy: a new import of the molecule does not change what is in it.</summary>
        private protected void KeepContent() => _keptContent = Content;

        /// <summary>Also that the molecule was not imported anew since one of them was copied.</summary>
        private protected bool HasSameContentAs(FileSource other) => HasSameFileAs(other) &&
            (_kind != MoleculeSourceKind.MoleculeAsset || _molecule == null || Content == other.Content);

        private byte[] Content => _keptContent ?? (_molecule != null ? _molecule.Content : null);
    }
}
