// SPDX-License-Identifier: MIT
using System;
using UnityEngine;

namespace QuickSes
{
    /// <summary>
    /// A surface that a <see cref="TrajectoryPlayer"/> moves together with its own: which atoms of the same file it is
    /// of. Serialised with the player. Changes take effect with <see cref="TrajectoryPlayer.Load"/>. Main thread only.
    /// </summary>
    [Serializable]
    public sealed class PlayedSurface
    {
        // Members of lists come from the inspector with zeros: these must be the defaults.
        [SerializeField, Tooltip("Gets its atoms from the player; its own source is left alone.")]
        private MolecularSurface _surface;
        [SerializeField, Tooltip("Which atoms: words such as ligand or chain A, or CID such as //A. Empty: all.")]
        private string _selection = "";
        [SerializeField, Tooltip("Takes waters, too.")]
        private bool _keepWater;
        [SerializeField, Tooltip("Leaves out hydrogen and deuterium.")]
        private bool _skipHydrogen;
        [SerializeField, Tooltip("Leaves out HETATM records: ligands, ions, most waters.")]
        private bool _skipHetero;
        [SerializeField, Tooltip("How atoms are coloured.")]
        private AtomColorScheme _colorScheme;

        /// <param name="surface">Not the player's own.</param>
        /// <param name="selection">As of <see cref="Selection"/>.</param>
        public PlayedSurface(MolecularSurface surface, string selection = "")
        {
            _surface = surface;
            _selection = selection;
        }

        /// <summary>The surface; null: the entry is left out.</summary>
        public MolecularSurface Surface { get => _surface; set => _surface = value; }

        /// <summary>Which atoms: words such as "ligand", or CID such as "//A"; "": all. Never null.</summary>
        public string Selection { get => _selection ?? ""; set => _selection = value; }

        /// <summary>Takes waters, too; default false.</summary>
        public bool KeepWater { get => _keepWater; set => _keepWater = value; }

        /// <summary>Leaves out hydrogen and deuterium.</summary>
        public bool SkipHydrogen { get => _skipHydrogen; set => _skipHydrogen = value; }

        /// <summary>Leaves out HETATM records: ligands, ions, most waters.</summary>
        public bool SkipHetero { get => _skipHetero; set => _skipHetero = value; }

        /// <summary>How atoms are coloured; default in one colour, the surface's own.</summary>
        public AtomColorScheme ColorScheme { get => _colorScheme; set => _colorScheme = value; }

        internal PlayedSurface Copy() => (PlayedSurface)MemberwiseClone();

        internal bool IsSameAs(PlayedSurface other) => _surface == other._surface && Selection == other.Selection &&
            _keepWater == other._keepWater && _skipHydrogen == other._skipHydrogen &&
            _skipHetero == other._skipHetero && _colorScheme == other._colorScheme;

        /// <summary>Its atoms out of the player's file.</summary>
        internal MoleculeSource SourceOf(MoleculeSource structure) =>
            structure.With(Selection, !_keepWater, _skipHydrogen, _skipHetero, _colorScheme);
    }
}
