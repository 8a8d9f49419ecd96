// SPDX-License-Identifier: MIT
// Which atoms are shown: by a mask, or by a selection, of words or in CID syntax, which says what is shown and hides the
// rest. What was set last counts; a selection is looked at again whenever a file is read.
using System;
using System.Buffers;
using System.Collections.Generic;
using UnityEngine;

namespace QuickSes
{
    public sealed partial class MolecularSurface
    {
        private const int MostNamedChains = 12;

        [NonSerialized] private string _followedVisible; // what _visible was when it was looked at last
        [NonSerialized] private string _visibleError;

        /// <summary>
        /// Which atoms of a file are shown, such as "//A/10-40" or "(!HOH)"; "" (default): all. Setting it is <see
        /// cref="SetVisible(string)"/>. Never null.
        /// </summary>
        public string VisibleSelection
        {
            get => _visible ?? "";
            set => SetVisible(value);
        }

        /// <summary>
        /// Why <see cref="VisibleSelection"/> hides nothing, or everything since it names no atom, as of the last time
        /// it was looked at; else "".
        /// </summary>
        public string VisibleSelectionError => _visibleError ?? "";

        /// <summary>Which atoms are shown. The surface is that of all atoms, cut open where they are hidden.</summary>
        /// <param name="visible">N; empty: all.</param>
        public void SetVisible(ReadOnlySpan<bool> visible)
        {
            Session.Atoms.SetVisible(visible);
            LookChanged();
        }

        /// <inheritdoc cref="SetVisible(ReadOnlySpan{bool})"/>
        public void SetVisible(bool[] visible) => SetVisible(NotNull(visible, nameof(visible)));

        /// <summary>
        /// Shows the atoms that a selection names, and hides all others; the surface is that of all atoms, cut open where
        /// they are hidden. It is kept (<see cref="VisibleSelection"/>), and holds for atoms of files that are read
        /// later as well. Atoms must be of a file: those of scripts have no names. Reads the file again, if it is not
        /// open: see <see cref="Structure"/>. Distances are between places in the file, also where atoms have moved
        /// since: <see cref="AtomCuts"/> goes by <see cref="Positions"/>.
        /// </summary>
        /// <param name="selection">Words or CID: "protein", "within 5 of ligand", "//A/10-40"; "": all.</param>
        /// <returns>
        /// False: <see cref="VisibleSelectionError"/> says why; what was shown stays. True where there are no atoms
        /// yet, and where it names none of them, which VisibleSelectionError tells too.
        /// </returns>
        public bool SetVisible(string selection)
        {
            _visible = selection ?? throw new ArgumentNullException(nameof(selection));
            return FollowVisible();
        }

        // Looks at the selection for the atoms there are.
        private bool FollowVisible()
        {
            _followedVisible = VisibleSelection;
            _visibleError = "";
            if (!Session.Atoms.IsSet)
                return true;
            if (VisibleSelection.Length == 0)
            {
                SetVisible(default(ReadOnlySpan<bool>));
                return true;
            }
            if (Structure != null)
                return ShowSelectionOf(Structure);
            _visibleError = _structureFault ?? "The atoms are not of a file, so they have no names to select them by.";
            return false;
        }

        // Of atoms that were just set. Without a selection a mask of the same atoms stays.
        private void ShowSelectionOfNew(Structure structure)
        {
            _followedVisible = VisibleSelection;
            _visibleError = "";
            if (VisibleSelection.Length == 0)
                return;
            string consequence = "";
            if (!ShowSelectionOf(structure))
            {
                SetVisible(default(ReadOnlySpan<bool>));
                consequence = "all atoms are shown, since ";
            }
            if (_visibleError.Length > 0)
                Debug.LogWarning($"{name}: {consequence}{_visibleError}", this);
        }

        private bool ShowSelectionOf(Structure structure)
        {
            int count = structure.AtomCount;
            bool[] rented = ArrayPool<bool>.Shared.Rent(count);
            Span<bool> mask = rented.AsSpan(0, count);
            bool isUnderstood = structure.TrySelect(VisibleSelection, mask, out int named, out QuickSesError error);
            if (isUnderstood)
                SetVisible(mask);
            ArrayPool<bool>.Shared.Return(rented);
            _visibleError = !isUnderstood || named > 0 ? error.Message
                : $"no atom is shown: the selection '{VisibleSelection}' names none; the structure has " +
                    ChainsOf(structure);
            return isUnderstood;
        }

        // The first of them, for a sentence.
        private static string ChainsOf(Structure structure)
        {
            List<string> chains = StructureChains.Of(structure);
            if (chains.Count > MostNamedChains)
                return $"chains {string.Join(", ", chains.GetRange(0, MostNamedChains))}, ...";
            string all = string.Join(", ", chains);
            return chains.Count == 0 ? "no chains" : chains.Count == 1 ? $"chain {all}" : $"chains {all}";
        }
    }
}
