// SPDX-License-Identifier: MIT
// The structure that the atoms are of: their names, for whoever asks. Here is decided how long it stays open.
using System;
using UnityEngine;

namespace QuickSes
{
    public sealed partial class MolecularSurface
    {
        [NonSerialized] private Structure _structure; // of the atoms there are; null: not open
        [NonSerialized] private bool _ownsStructure; // else it is a player's
        [NonSerialized] private bool _keepsStructure; // somebody asked for it
        [NonSerialized] private bool _areAtomsOfSource;
        [NonSerialized] private MoleculeSource _atomsSource; // then: as it was when it was read
        [NonSerialized] private int _atomsHash; // then: what was read
        [NonSerialized] private string _structureFault; // why they are not any more; null: they never were

        /// <summary>
        /// What the file says about the atoms, in their order: names, residues, chains, selections. null if they are not of
        /// a file, but given by a script. The surface's, not the caller's to dispose of; ask again rather than keep it.
        /// <para>The first question reads the file again, which blocks; from then on the structure stays open, and is
        /// exchanged when the source is read anew, until other atoms are set, the component is disabled or destroyed,
        /// or <see cref="CloseStructure"/>. <see cref="Structure.MemoryBytes"/> tells what that costs: about 200 bytes
        /// per atom. If the file has other atoms by then, or at other places, it is null, with a warning. Of atoms that
        /// a <see cref="TrajectoryPlayer"/> brings, it is the player's, which is open as long as the player has
        /// them.</para>
        /// </summary>
        public Structure Structure
        {
            get
            {
                if (_structure != null && _structure.IsDisposed)
                    ForgetStructure();
                if (_structure == null && _areAtomsOfSource)
                    ReadStructureAgain();
                return _structure;
            }
        }

        /// <summary>
        /// Frees what <see cref="Structure"/> opened, until somebody asks again. A player's is left alone.
        /// </summary>
        public void CloseStructure()
        {
            if (_ownsStructure)
                ForgetStructure();
            _keepsStructure = false;
        }

        /// <summary>The atoms there are now are of that structure, which its owner closes.</summary>
        private void BorrowStructure(Structure structure)
        {
            ForgetStructure();
            _structure = structure;
            _areAtomsOfSource = false;
        }

        /// <summary>
        /// The player closes it. The atoms it brought stay, without names, until the source is edited from now on.
        /// </summary>
        /// <param name="structure">That which the player lent.</param>
        /// <param name="source">The surface's source, as the player read it; null: it read another one.</param>
        internal void GiveBackStructure(Structure structure, MoleculeSource source)
        {
            if (_structure != structure)
                return;
            _structure = null;
            _loadedSource = source ?? (_source.IsSet ? _source.Copy() : null);
        }

        /// <summary>The atoms there are now are of the source; nobody else closes its structure.</summary>
        private void TakeStructure(LoadedStructure loaded)
        {
            ForgetStructure();
            _areAtomsOfSource = true;
            _atomsSource = _loadedSource;
            _atomsHash = loaded.AtomsHash;
            _ownsStructure = _keepsStructure;
            if (_keepsStructure)
                _structure = loaded.TakeStructure();
            loaded.DisposeInBackground();
        }

        /// <summary>There are other atoms.</summary>
        private void LoseStructure()
        {
            ForgetStructure();
            _areAtomsOfSource = false;
        }

        private void ForgetStructure()
        {
            if (_ownsStructure)
                _structure.Dispose();
            _structure = null;
            _ownsStructure = false;
            _structureFault = null;
        }

        // The file may be another one by now.
        private void ReadStructureAgain()
        {
            string fault = null;
            if (!_atomsSource.TryOpen(out Structure structure, out QuickSesError error))
                fault = error.Message;
            else if (structure.AtomCount != AtomCount)
                fault = $"it has {structure.AtomCount} atoms now, not {AtomCount}";
            else if (LoadedStructure.HashOfAtoms(structure) != _atomsHash)
                fault = "it has other atoms now, or at other places";
            if (fault == null)
            {
                _structure = structure;
                _ownsStructure = _keepsStructure = true;
                return;
            }
            structure?.Dispose();
            _areAtomsOfSource = false; // told once
            _structureFault = $"the file of the atoms can't be read again: {fault}";
            Debug.LogWarning($"{name}: {_structureFault}", this);
        }
    }
}
