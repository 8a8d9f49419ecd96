// SPDX-License-Identifier: MIT
using System;
using UnityEngine;

namespace QuickSes
{
    /// <summary>
    /// Where atoms come from, which of them are taken, and how they are coloured: PDB, mmCIF, PQR, XYZR or GRO, each
    /// also gzipped. Serialised with the component it belongs to. Main thread only.
    /// </summary>
    [Serializable]
    public sealed class MoleculeSource : FileSource
    {
        [SerializeField, Tooltip("Auto: by the name, also before .gz, .bytes and .txt, else by the content.")]
        private StructureFormat _format = StructureFormat.Auto;
        [SerializeField, Min(1), Tooltip("Which model of a file with several, from 1.")]
        private int _model = 1;
        [SerializeField, Tooltip(
            "The biological assembly of a PDB or mmCIF file, mostly 1. Empty: the atoms of the file. It fits no " +
            "trajectory of the file.")]
        private string _assembly = "";
        [SerializeField, Tooltip(
            "Which alternate locations: first, highest (of the greatest occupancy), or a label such as B. Empty: first.")]
        private string _alternateLocation = "";
        [SerializeField, Tooltip("Leaves out waters.")]
        private bool _skipWater = true;
        [SerializeField, Tooltip("Leaves out hydrogen and deuterium.")]
        private bool _skipHydrogen;
        [SerializeField, Tooltip("Leaves out HETATM records: ligands, ions, most waters.")]
        private bool _skipHetero;
        [SerializeField, Tooltip("Which atoms: words such as protein, or CID such as //A/10-40. Empty: all.")]
        private string _selection = "";
        [SerializeField, Tooltip(
            "quickses, bondi, or the absolute path of a text file with lines ELEMENT radius or RESIDUE ATOM radius " +
            "(Å). Empty: the file's own radii (PQR, XYZR), else quickses.")]
        private string _radii = "";
        [SerializeField, Tooltip("How atoms are coloured.")]
        private AtomColorScheme _colorScheme = AtomColorScheme.Element;

        /// <summary>Auto (default): by the name, also before ".gz", ".bytes" and ".txt", else by the content.</summary>
        public StructureFormat Format { get => _format; set => _format = value; }

        /// <summary>Which model of a file with several, from 1.</summary>
        public int Model { get => _model; set => _model = value; }

        /// <summary>As <see cref="StructureOptions.Assembly"/>; "": the atoms of the file. Never null.</summary>
        public string Assembly { get => _assembly ?? ""; set => _assembly = value; }

        /// <summary>As <see cref="StructureOptions.AlternateLocation"/>; "": the default. Never null.</summary>
        public string AlternateLocation { get => _alternateLocation ?? ""; set => _alternateLocation = value; }

        /// <summary>Leaves out waters; default true.</summary>
        public bool SkipWater { get => _skipWater; set => _skipWater = value; }

        /// <summary>Leaves out hydrogen and deuterium.</summary>
        public bool SkipHydrogen { get => _skipHydrogen; set => _skipHydrogen = value; }

        /// <summary>Leaves out HETATM records: ligands, ions, most waters.</summary>
        public bool SkipHetero { get => _skipHetero; set => _skipHetero = value; }

        /// <summary>Which atoms: words such as "chain A", or CID such as "//A"; "": all. Never null.</summary>
        public string Selection { get => _selection ?? ""; set => _selection = value; }

        /// <summary>
        /// As <see cref="StructureOptions.Radii"/>; "": the default. Never null. A path should be absolute, such as
        /// below Application.streamingAssetsPath: others are below the working folder of the process, which is the
        /// project in the Editor, and any folder in players.
        /// </summary>
        public string Radii { get => _radii ?? ""; set => _radii = value; }

        /// <summary>How atoms are coloured; default by element.</summary>
        public AtomColorScheme ColorScheme { get => _colorScheme; set => _colorScheme = value; }

        /// <summary>
        /// Reads the file, on the calling thread. false: <paramref name="error"/> says what is wrong with it or with
        /// the options. The structure is the caller's to dispose of. Its coordinates are those of the file: see
        /// <see cref="UnitySpace"/>.
        /// </summary>
        public bool TryOpen(out Structure structure, out QuickSesError error)
        {
            structure = null;
            return TryFind(out MoleculeFile file, out error) && TryOpen(file, out structure, out error);
        }

        /// <summary>The same atoms' file with other filters and colours.</summary>
        internal MoleculeSource With(string selection, bool skipWater, bool skipHydrogen, bool skipHetero,
            AtomColorScheme colorScheme)
        {
            MoleculeSource source = Copy();
            source._selection = selection;
            source._skipWater = skipWater;
            source._skipHydrogen = skipHydrogen;
            source._skipHetero = skipHetero;
            source._colorScheme = colorScheme;
            return source;
        }

        /// <summary>As it is now, also if its asset is imported anew later.</summary>
        internal MoleculeSource Copy()
        {
            var copy = (MoleculeSource)MemberwiseClone();
            copy.KeepContent();
            return copy;
        }

        internal void CopyFrom(MoleculeSource other)
        {
            CopyFileFrom(other);
            _format = other._format;
            _model = other._model;
            _assembly = other._assembly;
            _alternateLocation = other._alternateLocation;
            _skipWater = other._skipWater;
            _skipHydrogen = other._skipHydrogen;
            _skipHetero = other._skipHetero;
            _selection = other._selection;
            _radii = other._radii;
            _colorScheme = other._colorScheme;
        }

        /// <summary>Whether the other would read the same atoms; colours may differ.</summary>
        internal bool IsSameAs(MoleculeSource other) => HasSameContentAs(other) && _format == other._format &&
            _model == other._model && Assembly == other.Assembly && AlternateLocation == other.AlternateLocation &&
            _skipWater == other._skipWater && _skipHydrogen == other._skipHydrogen &&
            _skipHetero == other._skipHetero && Selection == other.Selection && Radii == other.Radii;

        /// <summary>Of a copy that nobody changes: on any thread that may read the file.</summary>
        internal bool TryOpen(MoleculeFile file, out Structure structure, out QuickSesError error)
        {
            var options = new StructureOptions
            {
                Format = _format == StructureFormat.Auto ? MoleculeFile.StructureFormatOf(file.Name) : _format,
                Model = _model,
                Assembly = NullIfBlank(_assembly),
                AlternateLocation = NullIfBlank(_alternateLocation),
                SkipHydrogen = _skipHydrogen,
                SkipHetero = _skipHetero,
                Selection = NullIfBlank(_selection),
                Radii = NullIfBlank(_radii)
            };
            // XYZR has no residues, hence no waters, and its reader takes no filter; this one is on by default.
            options.SkipWater = _skipWater && options.Format != StructureFormat.Xyzr;
            if (file.Path != null)
                return Structure.TryOpen(file.Path, options, out structure, out error);
            if (Structure.TryOpen(file.Bytes, options, out structure, out error))
                return true;
            // The library does not know what bytes in memory are called.
            error = new QuickSesError(error.Status, $"asset '{file.Name}': {error.Message}");
            return false;
        }

        private static string NullIfBlank(string text) => string.IsNullOrWhiteSpace(text) ? null : text;
    }
}
