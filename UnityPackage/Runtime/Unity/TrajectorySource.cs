// SPDX-License-Identifier: MIT
using System;
using UnityEngine;

namespace QuickSes
{
    /// <summary>
    /// Where frames come from: DCD, XTC or PDB with several models, each also gzipped. Serialised with the component it
    /// belongs to. Main thread only.
    /// </summary>
    [Serializable]
    public sealed class TrajectorySource
    {
        [SerializeField, Tooltip("Where the file of frames is. None: the structure's own file has several models.")]
        private MoleculeSourceKind _kind = MoleculeSourceKind.None;
        [SerializeField, Tooltip("A file that Unity imports as text, such as md.xtc.bytes.")]
        private TextAsset _asset;
        [SerializeField, Tooltip("Absolute, or relative to Assets/StreamingAssets.")]
        private string _path = "";
        [SerializeField, Tooltip("Auto: by the name, also before .gz, .bytes and .txt, else by the content.")]
        private TrajectoryFormat _format = TrajectoryFormat.Auto;

        /// <summary>
        /// Which of <see cref="Asset"/> and <see cref="Path"/> counts; None: the file of the structure, which must then
        /// be a PDB file with several models.
        /// </summary>
        public MoleculeSourceKind Kind { get => _kind; set => _kind = value; }

        /// <summary>For <see cref="MoleculeSourceKind.TextAsset"/>.</summary>
        public TextAsset Asset { get => _asset; set => _asset = value; }

        /// <summary>For the kinds File (absolute) and StreamingAssets (relative to that folder). Never null.</summary>
        public string Path { get => _path ?? ""; set => _path = value; }

        /// <summary>Auto (default): by the name, also before ".gz", ".bytes" and ".txt", else by the content.</summary>
        public TrajectoryFormat Format { get => _format; set => _format = value; }

        /// <summary>Whether a file of its own is named; it need not be there.</summary>
        public bool IsSet => _kind == MoleculeSourceKind.TextAsset
            ? _asset != null
            : _kind != MoleculeSourceKind.None && !string.IsNullOrWhiteSpace(_path);

        /// <summary>Names a text asset, which is not read yet.</summary>
        public void SetAsset(TextAsset asset)
        {
            _kind = MoleculeSourceKind.TextAsset;
            _asset = asset;
        }

        /// <summary>Names a file by its absolute path, which is not read yet.</summary>
        public void SetFile(string path)
        {
            _kind = MoleculeSourceKind.File;
            _path = path;
        }

        internal bool TryFind(out MoleculeFile file, out QuickSesError error) =>
            MoleculeFile.TryFind(_kind, _asset, _path, out file, out error);

        internal TrajectorySource Copy() => (TrajectorySource)MemberwiseClone();

        internal void CopyFrom(TrajectorySource other)
        {
            _kind = other._kind;
            _asset = other._asset;
            _path = other._path;
            _format = other._format;
        }

        internal bool IsSameAs(TrajectorySource other) => _kind == other._kind && _asset == other._asset &&
            Path == other.Path && _format == other._format;
    }
}
