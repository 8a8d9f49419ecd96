// SPDX-License-Identifier: MIT
// How files are opened and closed.
using System;
using UnityEngine;

namespace QuickSes
{
    public sealed partial class TrajectoryPlayer
    {
        // What was loaded; null: nothing.
        [NonSerialized] private MoleculeSource _loadedStructureSource;
        [NonSerialized] private TrajectorySource _loadedTrajectorySource;
        [NonSerialized] private bool _loadedUnwrap;
        [NonSerialized] private int _loadedPrefetchFrames;

        // Where _frame is a place in; null: not known, it comes from the scene.
        [NonSerialized] private TrajectorySource _frameFile;
        [NonSerialized] private double _chosenFrame = -1; // where to begin in what is loaded next; -1: not chosen

        /// <summary>
        /// Reads the structure, gives it to the surface, and begins to open the trajectory on another thread; what was
        /// loaded before is closed. Happens by itself when the component is enabled with a source. While it is not
        /// active and enabled, nothing is read: that is put off until it is. The same file goes on at <see
        /// cref="Frame"/>; another one begins at 0, or at the Frame that was set since the sources were changed. false,
        /// after Failed: <see cref="LastError"/> says why not.
        /// </summary>
        public bool Load()
        {
            Unload();
            if (!_isEnabled)
            {
                _isLoadDeferred = true;
                return true;
            }
            BeginLoading();
            MoleculeSource source = ActiveStructureSource;
            if (!source.TryFind(out MoleculeFile file, out QuickSesError error) ||
                !source.TryOpen(file, out Structure structure, out error))
                return Fail("structure", error);
            return OpenFrames(structure, file);
        }

        // Of components without sources of their own only those beside a file with several models play anything; the
        // others are no failure.
        private void LoadWhatIsSet()
        {
            if (_structureSource.Kind != MoleculeSourceKind.None || _trajectorySource.Kind != MoleculeSourceKind.None)
            {
                Load();
                return;
            }
            Unload();
            BeginLoading();
            MoleculeSource source = _surface.Source;
            if (!source.IsSet || !source.TryFind(out MoleculeFile file, out _) ||
                !source.TryOpen(file, out Structure structure, out _))
                return; // the surface tells
            if (HasModels(structure))
                OpenFrames(structure, file);
            else
                structure.Dispose();
        }

        private void BeginLoading()
        {
            LastError = default;
            _isDamageLogged = false;
            MoleculeSource source = ActiveStructureSource;
            _loadedStructureSource = source.Copy();
            _loadedTrajectorySource = _trajectorySource.Copy();
            _loadedUnwrap = _unwrap;
            _loadedPrefetchFrames = _prefetchFrames;
            if (_chosenFrame >= 0)
                _frame = _chosenFrame;
            else if (!IsFrameOfSetFile)
                _frame = 0;
            _chosenFrame = -1;
            _frameFile = TrajectorySource.OfFile(FrameSource);
        }

        private bool OpenFrames(Structure structure, MoleculeFile file)
        {
            Structure = structure;
            SendAtoms();
            if (!TryFindFrames(ref file, out TrajectoryFormat format, out QuickSesError error))
                return Fail("trajectory", error);
            _prefetcher = new FramePrefetcher(
                new TrajectoryFrameReader(file, format, structure, _unwrap), _prefetchFrames);
            RequestUpdate();
            return true;
        }

        /// <summary>
        /// Lets go of structure and trajectory; the surface keeps what it shows. Does not wait: the thread that reads
        /// closes the trajectory's file after what it is at. Disabling the component does the same.
        /// </summary>
        public void Unload()
        {
            if (IsReady)
                _frame = _head.Position;
            CloseFrames();
            Structure?.Dispose();
            Structure = null;
            _loadedStructureSource = null;
            _isLoadRequested = _isLoadDeferred = _areColorsRequested = false;
        }

        private void CloseFrames()
        {
            _prefetcher?.Dispose();
            _prefetcher = null;
            _between?.Dispose();
            _between = null;
            IsReady = _isWaiting = _isNewFrameUntold = false;
            _untold = PlayHeadEvents.None;
            _shown = s_nothing;
            _damagedFrame = -1;
        }

        private bool TryFindFrames(ref MoleculeFile file, out TrajectoryFormat format, out QuickSesError error)
        {
            format = _trajectorySource.Format;
            if (_trajectorySource.Kind != MoleculeSourceKind.None)
                return _trajectorySource.TryFind(out file, out error);
            format = TrajectoryFormat.Pdb;
            bool hasFrames = HasModels(Structure);
            error = hasFrames ? default : new QuickSesError(QuickSesStatus.InvalidArgument,
                $"none is chosen, and '{file.Name}' is not a PDB file with several models");
            return hasFrames;
        }

        private static bool HasModels(Structure structure) =>
            structure.Format == StructureFormat.Pdb && structure.ModelCount > 1;
    }
}
