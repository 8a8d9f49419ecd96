// SPDX-License-Identifier: MIT
// How the source is read.
using System;
using UnityEngine;

namespace QuickSes
{
    public sealed partial class MolecularSurface
    {
        [NonSerialized] private StructureLoad _load; // null: nothing is being read
        [NonSerialized] private bool _loadsAtoms; // not only their colours
        [NonSerialized] private TrajectoryPlayer _player;
        [NonSerialized] private bool _isLoadDeferred; // until it is enabled
        [NonSerialized] private MoleculeSource _loadedSource; // edits are measured by it: as it was read; null: it was not

        /// <summary>The atoms of the source are there, and their colours. Not raised for atoms of scripts.</summary>
        public event Action Loaded
        {
            add => _loaded.Add(value);
            remove => _loaded.Remove(value);
        }

        /// <summary>Whether the source is being read, or will be when the component is enabled.</summary>
        public bool IsLoading => _load != null || _isLoadDeferred;

        /// <summary>
        /// How far the source is read, from 0 to 1; 1 if nothing is being read. It goes in steps: while the library is at
        /// the file itself, which is most of the time, it stands still.
        /// </summary>
        public float LoadProgress => _load != null ? _load.Progress : _isLoadDeferred ? 0 : 1;

        /// <summary>Who brings the atoms, so that the source is left alone; null: nobody.</summary>
        internal TrajectoryPlayer Player
        {
            get => _player;
            set
            {
                _player = value;
                if (!IsPlayed)
                {
                    AskForAtoms();
                    return;
                }
                if (IsLoading)
                    _loadedSource = null; // it was not
                CancelLoading();
            }
        }

        internal bool IsPlayed => _player != null;

        /// <summary>
        /// Begins to read the <see cref="Source"/> on a thread of its own, in place of what is being read. What is shown
        /// stays until <see cref="Loaded"/>, which comes in a later frame, or <see cref="Failed"/>. If scripts give it
        /// atoms meanwhile, these stay. While the component is not active and enabled, it is put off until it is.
        /// </summary>
        public void BeginLoadSource() => BeginLoad(true);

        /// <summary>
        /// Nothing comes of what is being read any more, and no event tells so. The thread can't be stopped in the file:
        /// it leaves by itself, and frees what it has read, after at most as long as that takes.
        /// </summary>
        public void CancelLoading()
        {
            _load?.Dispose();
            _load = null;
            _isLoadDeferred = false;
        }

        /// <summary>
        /// Reads the <see cref="Source"/> and takes its atoms and colours before it returns, enabled or not. For tools:
        /// it blocks for as long as it takes. What is wrong is told by <see cref="Failed"/>.
        /// </summary>
        /// <returns>Whether there was a structure to read.</returns>
        public bool LoadSource()
        {
            if (!TryMakeLoad(out StructureLoad load))
                return false;
            load.RunHere();
            return TakeLoaded(load, true);
        }

        // The inspector wrote another source.
        private void FollowSource()
        {
            bool isSameFile = _loadedSource != null && _source.IsSameAs(_loadedSource);
            if (!isSameFile || _source.ColorScheme != _loadedSource.ColorScheme)
                BeginLoad(!isSameFile || _loadsAtoms || !_areAtomsOfSource);
        }

        private void BeginLoad(bool withAtoms)
        {
            if (!isActiveAndEnabled)
            {
                _isScriptFed = false;
                _isLoadDeferred = true;
                return;
            }
            if (!TryMakeLoad(out StructureLoad load))
                return;
            _load = load;
            _loadsAtoms = withAtoms;
            QueueEditorUpdate();
        }

        private bool TryMakeLoad(out StructureLoad load)
        {
            CancelLoading();
            load = null;
            _isScriptFed = false;
            _asksForAtoms &= !_source.IsSet; // these are the ones, also if they are cancelled before it could ask
            _loadedSource = _source.Copy();
            if (!_loadedSource.TryFind(out MoleculeFile file, out QuickSesError error))
                return FailToLoad(error);
            load = new StructureLoad(file, _loadedSource);
            return true;
        }

        // Each frame, while it is enabled.
        private void TickLoading()
        {
            if (_isLoadDeferred)
                BeginLoad(true);
            if (_load == null)
                return;
            if (_load.Tick())
            {
                StructureLoad load = _load;
                bool withAtoms = _loadsAtoms;
                _load = null;
                _loadsAtoms = false; // first, since handlers may begin another one
                TakeLoaded(load, withAtoms);
            }
            else
            {
                QueueEditorUpdate();
            }
        }

        // OnDisable. What was being read is read when it is enabled again.
        private void SuspendLoading()
        {
            bool isLoading = IsLoading;
            CancelLoading();
            _isLoadDeferred = isLoading;
        }

        private bool TakeLoaded(StructureLoad load, bool withAtoms)
        {
            if (!load.TryTake(out LoadedStructure[] structures, out QuickSesError error))
                return FailToLoad(error);
            load.File.Dispose();
            LoadedStructure loaded = structures[0];
            if (withAtoms || loaded.AtomsHash != _atomsHash) // the file may be another one by now
                SetAtomsOf(loaded);
            else
                ColorAtomsOf(loaded);
            TakeStructure(loaded);
            _loaded.Tell(this);
            WiredListeners.Tell(_events.Loaded, this);
            return true;
        }

        private bool FailToLoad(in QuickSesError error)
        {
            Session.FailToBegin(error);
            Session.RaiseEvents();
            QueueEditorUpdate(); // for what was found by a handler of Failed
            return false;
        }

        /// <summary>The atoms of a file, and their colours; its structure is borrowed.</summary>
        internal void SetAtomsOf(LoadedStructure loaded)
        {
            TakeAtoms(loaded.Positions, loaded.Radii);
            _isScriptFed = false;
            BorrowStructure(loaded.Structure);
            ShowSelectionOfNew(loaded.Structure);
            ColorAtomsOf(loaded);
        }

        /// <summary>
        /// Colours by what a file says of the same atoms; those of which it says nothing have <see cref="BaseColor"/>,
        /// also when that is another one later.
        /// </summary>
        internal void ColorAtomsOf(LoadedStructure loaded)
        {
            Session.Atoms.SetSchemeColors(Numbers(loaded.Colors));
            LookChanged();
        }

        // If there are none by then.
        private void AskForAtoms()
        {
            _asksForAtoms = true;
            QueueEditorUpdate();
        }

        private bool HasOtherAtoms => _isScriptFed || IsPlayed || Session.Atoms.IsSet || !_source.IsSet;

        private void BeginLoadSourceUnlessFed()
        {
            if (!IsLoading && !HasOtherAtoms)
                BeginLoadSource();
        }

        // false: there is a source, and it can't be read.
        private bool LoadSourceUnlessFed() => (!IsLoading && HasOtherAtoms) || LoadSource();
    }
}
