// SPDX-License-Identifier: MIT
// How files are opened and closed.
using System;
using System.Collections.Generic;
using UnityEngine;

namespace QuickSes
{
    public sealed partial class TrajectoryPlayer
    {
        private StructureLoad _load; // until the structure is read
        private PlayedAtoms[] _played = Array.Empty<PlayedAtoms>(); // from then on: its own surface first, then Surfaces
        private FramePrefetcher _prefetcher; // from when the frames' file may be opened
        private readonly List<MolecularSurface> _claimed = new List<MolecularSurface>(); // read no source of their own

        // Where frames are, from Load until they are opened; null, if there is no error: in the structure's file.
        private MoleculeFile _framesFile;
        private QuickSesError _framesError;

        // What was loaded; null: nothing.
        [NonSerialized] private MoleculeSource _loadedStructureSource;
        [NonSerialized] private TrajectorySource _loadedTrajectorySource;
        [NonSerialized] private bool _loadedUnwrap;
        [NonSerialized] private int _loadedPrefetchFrames;
        private readonly List<PlayedSurface> _loadedSurfaces = new List<PlayedSurface>();

        [NonSerialized] private bool _isWish; // nobody asked for it, so that it is no failure if there are no frames

        // Where _frame is a place in; null: not known, it comes from the scene.
        [NonSerialized] private TrajectorySource _frameFile;
        [NonSerialized] private double _chosenFrame = -1; // where to begin in what is loaded next; -1: not chosen

        /// <summary>
        /// Begins to read the structure on another thread, then to open the trajectory; what was loaded before is let go
        /// of. The surfaces get their atoms when the structure is read, frames from <see cref="Loaded"/> on. Happens by
        /// itself when the component is enabled with a source. While it is not active and enabled, nothing is read: that
        /// is put off until it is. The same file goes on at <see cref="Frame"/>; another one begins at 0, or at the
        /// Frame that was set since the sources were changed. false, after Failed: there is no such structure, or another
        /// player has one of the surfaces; <see cref="LastError"/> says which. What is wrong inside of files is told later
        /// by Failed.
        /// </summary>
        public bool Load() => TryLoad(false);

        private bool TryLoad(bool isWish)
        {
            Unload();
            if (!_isEnabled)
            {
                _isLoadDeferred = true;
                return true;
            }
            _isWish = isWish;
            BeginLoading();
            if (!TryClaimSurfaces(out QuickSesError error) && !isWish)
                return Fail("surfaces", error);
            MoleculeSource source = _loadedStructureSource;
            if (!source.TryFind(out MoleculeFile file, out error))
                return Fail("structure", error);
            if (!TryMakeSources(source, out MoleculeSource[] sources, out error))
                return Fail("surfaces", error);
            if (_trajectorySource.Kind != MoleculeSourceKind.None)
                _trajectorySource.TryFind(out _framesFile, out _framesError);
            _load = new StructureLoad(file, sources);
            RequestUpdate();
            return true;
        }

        // Of components without sources of their own only those beside a file with several models play anything; the
        // others are no failure.
        private void LoadWhatIsSet()
        {
            bool isAskedFor = _structureSource.Kind != MoleculeSourceKind.None ||
                _trajectorySource.Kind != MoleculeSourceKind.None;
            if (isAskedFor || (_surface.Source.IsSet && _surface.Source.TryFind(out _, out _)))
            {
                TryLoad(!isAskedFor);
                return;
            }
            Unload();
            BeginLoading(); // nothing
            LeaveToSurface();
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
            foreach (PlayedSurface each in _surfaces)
                if (each.Surface != null)
                    _loadedSurfaces.Add(each.Copy());
            if (_chosenFrame >= 0)
                SetPlace(_chosenFrame);
            else if (!IsFrameOfSetFile)
                SetPlace(0);
            _chosenFrame = -1;
            _frameFile = TrajectorySource.OfFile(FrameSource);
        }

        // All that nobody else has. false: another player has the one that is named.
        private bool TryClaimSurfaces(out QuickSesError error)
        {
            error = default;
            Claim(_surface, ref error);
            foreach (PlayedSurface each in _loadedSurfaces)
                if (each.Surface != null)
                    Claim(each.Surface, ref error);
            return error.Status == QuickSesStatus.Ok;
        }

        private void Claim(MolecularSurface surface, ref QuickSesError error)
        {
            TrajectoryPlayer other = surface.Player;
            if (other == this)
                return;
            if (other != null && (_isWish || !other.IsUndecided))
            {
                error = new QuickSesError(QuickSesStatus.InvalidArgument,
                    $"the player '{other.name}' has '{surface.name}', so the player '{name}' can't have it");
                return;
            }
            surface.Player = this;
            _claimed.Add(surface);
        }

        // It may have nothing to play, so that who was asked to play comes first.
        private bool IsUndecided => _isWish && _played.Length == 0;

        private void ReleaseSurfaces()
        {
            foreach (MolecularSurface each in _claimed)
                if (each != null && each.Player == this)
                    each.Player = null;
            _claimed.Clear();
        }

        // There is nothing to play: the surface reads its source, and tells what is wrong with it.
        private void LeaveToSurface()
        {
            ReleaseSurfaces();
            _surface.FollowSourceSoon();
        }

        // One per surface, its own first.
        private bool TryMakeSources(MoleculeSource structure, out MoleculeSource[] sources, out QuickSesError error)
        {
            error = default;
            var made = new List<MoleculeSource> { structure.Copy() };
            foreach (PlayedSurface each in _loadedSurfaces)
            {
                bool isTwice = each.Surface == _surface ||
                    _loadedSurfaces.Exists(other => other != each && other.Surface == each.Surface);
                if (isTwice)
                    error = new QuickSesError(QuickSesStatus.InvalidArgument,
                        each.Surface == _surface
                        ? $"'{each.Surface.name}' is the player's own"
                        : $"'{each.Surface.name}' is there twice");
                made.Add(each.SourceOf(structure));
            }
            sources = made.ToArray();
            return error.Status == QuickSesStatus.Ok;
        }

        private void TickLoading()
        {
            if (_framesFile != null && !_framesFile.TryDetach(out QuickSesError error))
            {
                _framesFile = null;
                _framesError = error;
            }
            if (!_load.Tick() || (_framesFile != null && !_framesFile.IsDetached))
            {
                RequestUpdate();
                return;
            }
            StructureLoad load = _load;
            _load = null;
            if (load.TryTake(out LoadedStructure[] structures, out error))
                TakeStructures(structures, load.File);
            else if (_isWish)
                LeaveToSurface();
            else
                Fail(load.FailedSource > 0 ? NameOf(_loadedSurfaces[load.FailedSource - 1].Surface) : "structure", error);
        }

        private static string NameOf(MolecularSurface surface) =>
            surface != null ? $"surface '{surface.name}'" : "a surface that was destroyed";

        private void TakeStructures(LoadedStructure[] structures, MoleculeFile file)
        {
            bool isNothing = _isWish && !HasModels(structures[0].Structure);
            QuickSesError error = default;
            if (isNothing || !TryClaimSurfaces(out error))
            {
                foreach (LoadedStructure each in structures)
                    each.DisposeInBackground();
                file.Dispose();
                if (isNothing)
                    LeaveToSurface();
                else
                    Fail("surfaces", error);
                return;
            }
            MoleculeSource ofSurface = _structureSource.Kind == MoleculeSourceKind.None ? _loadedStructureSource : null;
            _played = new PlayedAtoms[structures.Length];
            _played[0] = new PlayedAtoms(_surface, structures[0], ofSurface, ShowAgain);
            for (int k = 1; k < structures.Length; ++k)
                _played[k] = new PlayedAtoms(_loadedSurfaces[k - 1].Surface, structures[k], null, ShowAgain);
            ShowAgain();
            FollowColorScheme(); // it may be another one since they began to be read
            OpenFrames(file);
        }

        private void OpenFrames(MoleculeFile structureFile)
        {
            MoleculeFile file = _framesFile ?? structureFile;
            TrajectoryFormat format = _framesFile != null ? _loadedTrajectorySource.Format : TrajectoryFormat.Pdb;
            if (file != structureFile)
                structureFile.Dispose();
            _framesFile = null;
            QuickSesError error = _framesError;
            if (error.Status == QuickSesStatus.Ok && file == structureFile && !HasModels(Structure))
                error = new QuickSesError(QuickSesStatus.InvalidArgument,
                    $"none is chosen, and '{file.Name}' is not a PDB file with several models");
            if (error.Status != QuickSesStatus.Ok)
            {
                file.Dispose();
                Fail("trajectory", error);
                return;
            }
            string assembly = _loadedStructureSource.Assembly;
            string structure = string.IsNullOrWhiteSpace(assembly) ? "the file of the structure"
                : $"assembly '{assembly}' of the structure, which fits no trajectory,";
            _prefetcher = new FramePrefetcher(new TrajectoryFrameReader(file, format, IndicesOfAll(),
                Structure.FileElements.ToArray(), structure, _loadedUnwrap), _loadedPrefetchFrames);
            RequestUpdate();
        }

        // Frames hold the atoms of one surface after those of the other, so that each is read and blended once.
        private uint[] IndicesOfAll()
        {
            int count = 0;
            foreach (PlayedAtoms each in _played)
                count = checked(count + each.Count);
            var indices = new uint[count];
            Span<uint> rest = indices;
            foreach (PlayedAtoms each in _played)
            {
                each.Structure.FileIndices.CopyTo(rest);
                rest = rest.Slice(each.Count);
            }
            return indices;
        }

        /// <summary>
        /// Lets go of structure and trajectory; the surfaces keep what they show, until their own sources are edited. Does
        /// not wait: the threads that read close their files after what they are at. Disabling the component does the same.
        /// </summary>
        public void Unload()
        {
            if (IsReady)
                SetPlace(_head.Position);
            CloseFrames();
            _load?.Dispose();
            _load = null;
            foreach (PlayedAtoms each in _played)
                each.Dispose();
            _played = Array.Empty<PlayedAtoms>();
            ReleaseSurfaces();
            _loadedStructureSource = null;
            _loadedTrajectorySource = null;
            _loadedSurfaces.Clear();
            _isLoadRequested = _isLoadDeferred = _areColorsRequested = _isWish = false;
        }

        /// <summary>
        /// Lets go of what is being loaded, and no event tells so; once frames can be shown it does nothing. The threads
        /// can't be stopped in a file: they leave by themselves after at most as long as reading it takes.
        /// </summary>
        public void CancelLoading()
        {
            if (IsLoading || _isLoadDeferred)
                Unload();
        }

        private void CloseFrames()
        {
            _framesFile?.Dispose();
            _framesFile = null;
            _framesError = default;
            _prefetcher?.Dispose();
            _prefetcher = null;
            _between?.Dispose();
            _between = null;
            IsReady = _isWaiting = _isNewFrameUntold = _isFailureUntold = false;
            _untold = PlayHeadEvents.None;
            _shown = s_nothing;
            _damagedFrame = -1;
        }

        private static bool HasModels(Structure structure) =>
            structure.Format == StructureFormat.Pdb && structure.ModelCount > 1;
    }
}
