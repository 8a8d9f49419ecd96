// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using UnityEngine;

namespace QuickSes
{
    public sealed partial class TrajectoryPlayer
    {
        [SerializeField, Tooltip("Which atoms. None: the source of the Molecular Surface, with its filters.")]
        private MoleculeSource _structureSource = new MoleculeSource();
        [SerializeField, Tooltip("Where they are in each frame. None: the models of the structure's own PDB file.")]
        private TrajectorySource _trajectorySource = new TrajectorySource();
        [SerializeField, Tooltip("Other surfaces that are given the same frames, of other atoms of the same file.")]
        private List<PlayedSurface> _surfaces = new List<PlayedSurface>();
        [SerializeField, Tooltip("Moves atoms by whole box vectors so that every molecule is in one piece.")]
        private bool _unwrap;
        [SerializeField, Tooltip("Frames of the trajectory per second. Negative: backwards.")]
        private float _framesPerSecond = 10;
        [SerializeField, Tooltip("What happens at the ends.")]
        private PlaybackMode _mode = PlaybackMode.Loop;
        [SerializeField, Tooltip("Moves atoms on straight lines between frames.")]
        private bool _interpolate;
        [SerializeField, Tooltip("Starts playing when it is enabled in play mode.")]
        private bool _playOnEnable = true;
        [SerializeField, Tooltip("Goes on at the same rate where the game's time is scaled or stopped.")]
        private bool _useUnscaledTime;
        [SerializeField, Range(FramePrefetcher.LeastSlots, MostPrefetchFrames), Tooltip(
            "How many frames are read ahead and kept: 12 bytes per atom each, 256 MiB at most.")]
        private int _prefetchFrames = 16;
        // A float, since Unity animates no doubles; on a whole frame up to 16 million exactly.
        [SerializeField, Min(0), Tooltip(
            "The place shown, counted from 0; between two frames if they are interpolated. Can be animated.")]
        private float _frame;
        [NonSerialized] private float _knownFrame; // unless _frame is it, somebody else wrote _frame

        private const int MostPrefetchFrames = 256;

        /// <summary>
        /// Which atoms; of kind None (default): those of <see cref="MolecularSurface.Source"/>, with its filters: those
        /// here are not looked at. Takes effect with <see cref="Load"/>.
        /// </summary>
        public MoleculeSource StructureSource => _structureSource;

        /// <summary>
        /// Where the atoms are in each frame; of kind None (default): the structure's own file, which must then be a
        /// PDB file with several models. It must have all atoms of the file of the structure, in the same order;
        /// filters of the structure choose among them. Takes effect with <see cref="Load"/>.
        /// </summary>
        public TrajectorySource TrajectorySource => _trajectorySource;

        /// <summary>
        /// Surfaces beside its own, such as those of a ligand or a membrane. All are given the same frame, which is read
        /// once, in the same frame of the game; each computes its mesh by itself. Changes take effect with <see
        /// cref="Load"/>.
        /// </summary>
        public IReadOnlyList<PlayedSurface> Surfaces => _surfaces;

        /// <summary>Adds a surface. Takes effect with <see cref="Load"/>.</summary>
        /// <param name="surface">Not the player's own, and not there yet.</param>
        /// <param name="selection">Which atoms, as of <see cref="PlayedSurface.Selection"/>.</param>
        /// <returns>For more filters, and colours.</returns>
        public PlayedSurface AddSurface(MolecularSurface surface, string selection = "")
        {
            if (surface == null)
                throw new ArgumentNullException(nameof(surface));
            var added = new PlayedSurface(surface, selection);
            _surfaces.Add(added);
            return added;
        }

        /// <summary>Leaves a surface alone from the next <see cref="Load"/> on; false: it is not there.</summary>
        public bool RemoveSurface(MolecularSurface surface) => _surfaces.RemoveAll(each => each.Surface == surface) > 0;

        /// <summary>
        /// Moves atoms by whole box vectors so that every molecule is in one piece; default false. Without a periodic
        /// box there is a warning, and frames stay as they are. Single frames without a box are shown as they are.
        /// Takes effect with <see cref="Load"/>.
        /// </summary>
        public bool Unwrap { get => _unwrap; set => _unwrap = value; }

        /// <summary>
        /// How many frames are read ahead and kept, from 3 to 256; default 16. 12 bytes per atom each; of large
        /// molecules fewer, so that they take 256 MiB at most. Takes effect with <see cref="Load"/>.
        /// </summary>
        public int PrefetchFrames
        {
            get => _prefetchFrames;
            set => _prefetchFrames = Mathf.Clamp(value, FramePrefetcher.LeastSlots, MostPrefetchFrames);
        }

        /// <summary>
        /// Frames of the trajectory per second; default 10. Negative: backwards. A frame that is not read in time is
        /// waited for, not left out.
        /// </summary>
        public float FramesPerSecond
        {
            get => IsFinite(_framesPerSecond) ? _framesPerSecond : 0; // the inspector and animations may write others
            set
            {
                if (!IsFinite(value))
                    throw new ArgumentOutOfRangeException(nameof(value), value, "must be a finite number");
                _framesPerSecond = value;
            }
        }

        /// <summary>What happens at the ends; default Loop.</summary>
        public PlaybackMode Mode { get => _mode; set => _mode = value; }

        /// <summary>
        /// Moves atoms on straight lines between frames; default false. Nothing lies between the last frame and the
        /// first. Atoms that left a periodic box on one side and came back on the other go on out of it, and are on the
        /// other side with the next frame.
        /// </summary>
        public bool Interpolate { get => _interpolate; set => _interpolate = value; }

        /// <summary>Starts playing when it is enabled in play mode; default true.</summary>
        public bool PlayOnEnable { get => _playOnEnable; set => _playOnEnable = value; }

        /// <summary>Goes on at the same rate where the game's time is scaled or stopped; default false.</summary>
        public bool UseUnscaledTime { get => _useUnscaledTime; set => _useUnscaledTime = value; }

        /// <summary>
        /// The place in the trajectory, from 0 to <see cref="FrameCount"/> - 1; between two whole numbers while it
        /// plays or where it was put. Setting it shows that place as soon as its frames are read, playing or not, in
        /// edit mode too; what is out of range is clamped. Before frames are there it says where to begin.
        /// </summary>
        public double Frame
        {
            get => IsReady ? _head.Position : _frame;
            set
            {
                double place = double.IsNaN(value) ? 0 : Math.Max(0, value);
                if (_loadedStructureSource == null || !IsFrameOfSetFile)
                    _chosenFrame = place;
                if (IsReady)
                {
                    _head.MoveTo(place);
                    place = _head.Position;
                    _isWaiting = false;
                }
                SetPlace(place);
                RequestUpdate();
            }
        }

        /// <summary>
        /// The same from 0 (first frame) to 1 (last frame). Only once frames are there: before, it is 0, also when it is
        /// set.
        /// </summary>
        public double NormalizedTime
        {
            get => FrameCount > 1 ? Frame / (FrameCount - 1) : 0;
            set => Frame = value * Math.Max(0, FrameCount - 1);
        }

        /// <summary>How atoms are coloured: that of the source in use. Takes effect at once.</summary>
        public AtomColorScheme ColorScheme
        {
            get => ActiveStructureSource.ColorScheme;
            set
            {
                ActiveStructureSource.ColorScheme = value;
                SendColors();
            }
        }

        private static bool IsFinite(float value) => !float.IsNaN(value) && !float.IsInfinity(value);

        private void SetPlace(double place) => _frame = _knownFrame = (float)place;

        /// <summary>
        /// Goes where the inspector, Undo, an animation or Timeline put the serialised place. Whether that is elsewhere.
        /// </summary>
        private bool FollowFrame()
        {
            if (!IsReady || _frame == _knownFrame) // before, it says where to begin
                return false;
            Frame = _frame;
            return true;
        }

#if UNITY_EDITOR
        private void OnValidate() => FollowEdits();
#endif

        /// <summary>The inspector, Undo or a prefab wrote its fields, or an asset was imported anew.</summary>
        internal void FollowEdits()
        {
            if (!isActiveAndEnabled)
                return;
            if (_loadedStructureSource == null || !IsLoadedAsSet())
                _isLoadRequested = true; // not here: a mesh must not change while values are validated
            else
                FollowFrame();
            FollowColorScheme();
            RequestUpdate();
        }

        /// <summary>The source of the surface beside it may have been edited.</summary>
        /// <returns>Whether the player reads it, or will look into it, so that the surface leaves it alone.</returns>
        internal bool FollowSurfaceSource()
        {
            if (!_isEnabled || _structureSource.Kind != MoleculeSourceKind.None || _loadedStructureSource == null)
                return false;
            _isLoadRequested |= !_loadedStructureSource.IsSameAs(_surface.Source);
            FollowColorScheme();
            RequestUpdate();
            return _isLoadRequested;
        }

        private void FollowColorScheme()
        {
            if (_played.Length > 0 && _loadedStructureSource.ColorScheme != ActiveStructureSource.ColorScheme)
                _areColorsRequested = true;
        }

        private MoleculeSource ActiveStructureSource =>
            _structureSource.Kind != MoleculeSourceKind.None || _surface == null ? _structureSource : _surface.Source;

        private FileSource FrameSource =>
            _trajectorySource.Kind != MoleculeSourceKind.None ? (FileSource)_trajectorySource : ActiveStructureSource;

        private bool IsFrameOfSetFile => _frameFile == null || _frameFile.HasFileOf(FrameSource);

        private bool IsLoadedAsSet() => _loadedStructureSource.IsSameAs(ActiveStructureSource) &&
            _loadedTrajectorySource.IsSameAs(_trajectorySource) && _loadedUnwrap == _unwrap &&
            _loadedPrefetchFrames == _prefetchFrames && AreSurfacesAsLoaded();

        private bool AreSurfacesAsLoaded()
        {
            int count = 0;
            foreach (PlayedSurface each in _surfaces)
                if (each.Surface != null && // empty entries are left out
                    (count == _loadedSurfaces.Count || !each.IsSameAs(_loadedSurfaces[count++])))
                    return false;
            return count == _loadedSurfaces.Count;
        }
    }
}
