// SPDX-License-Identifier: MIT
using System;
using UnityEngine;

namespace QuickSes
{
    /// <summary>
    /// Plays a trajectory (DCD, XTC, PDB with several models) in the <see cref="MolecularSurface"/> beside it: reads
    /// atoms of a structure, gives them to the surface, then their positions frame by frame, with x negated, since
    /// Unity is left-handed. Frames are read ahead on a thread of its own; playing makes no garbage. In edit mode <see
    /// cref="Frame"/> can be scrubbed, but nothing plays. Main thread only.
    /// </summary>
    [ExecuteAlways, DisallowMultipleComponent, RequireComponent(typeof(MolecularSurface))]
    [AddComponentMenu("Molecular/Trajectory Player")]
    public sealed partial class TrajectoryPlayer : MonoBehaviour
    {
        private MolecularSurface _surface;
        private FramePrefetcher _prefetcher;
        private PlayHead _head;
        private readonly UnmanagedBuffer<Vector3> _between = new UnmanagedBuffer<Vector3>();
        [NonSerialized] private bool _isPlaying, _isWaiting, _isLoadRequested, _areColorsRequested;

        // What the surface shows: _shown.From is -1 before the first frame, and where it has to be sent anew.
        private static readonly FrameBlend s_nothing = new FrameBlend(-1, -1, 0);
        private FrameBlend _shown = s_nothing;
        private TrajectoryFrame _shownInfo;
        private int _damagedFrame = -1; // the one told last, so that it is told once each time it is reached
        private bool _isDamageLogged;

        // What was loaded; null: nothing.
        [NonSerialized] private MoleculeSource _loadedStructureSource;
        [NonSerialized] private TrajectorySource _loadedTrajectorySource;
        [NonSerialized] private bool _loadedUnwrap;
        [NonSerialized] private int _loadedPrefetchFrames;

        /// <summary>Frames can be shown from now on.</summary>
        public event Action Loaded;

        /// <summary>The surface was given this frame, counted from 0, or a place right behind it.</summary>
        public event Action<int> FrameShown;

        /// <summary>An end was passed: it goes on from the other end (Loop) or back (PingPong).</summary>
        public event Action Looped;

        /// <summary>It was played once, and is paused on the last frame.</summary>
        public event Action Finished;

        /// <summary>
        /// A frame is damaged: its number, counted from 0; what was shown before stays, and playing goes on. -1:
        /// nothing can be shown of the trajectory, or of the structure. Without listeners it is logged, of damaged
        /// frames the first.
        /// </summary>
        public event Action<int, QuickSesError> Failed;

        /// <summary>What Failed told last since loading; Ok if nothing.</summary>
        public QuickSesError LastError { get; private set; }

        /// <summary>
        /// The atoms, open as long as they are shown; null if nothing is loaded. In the file's coordinates; not the
        /// caller's to dispose of.
        /// </summary>
        public Structure Structure { get; private set; }

        /// <summary>Whether the trajectory is being opened.</summary>
        public bool IsLoading => _prefetcher != null && !IsReady;

        /// <summary>Whether frames can be shown.</summary>
        public bool IsReady { get; private set; }

        /// <summary>Whether it plays, or will as soon as it is loaded.</summary>
        public bool IsPlaying => _isPlaying;

        /// <summary>Whether the clock stands since what it points at is not read yet.</summary>
        internal bool IsWaiting => _isWaiting;

        /// <summary>0 until it is loaded.</summary>
        public int FrameCount => IsReady ? _head.FrameCount : 0;

        /// <summary>The frame the surface was given last, or a place right behind it; -1: none yet.</summary>
        public int ShownFrame => _shown.From;

        /// <summary>Picoseconds at <see cref="ShownFrame"/>, if the file tells.</summary>
        public bool TryGetTime(out double picoseconds)
        {
            picoseconds = _shownInfo.Time;
            return _shown.From >= 0 && _shownInfo.HasTime;
        }

        /// <summary>Plays from where it is; from the beginning if it was played once.</summary>
        public void Play()
        {
            _isPlaying = true;
            if (IsReady && _head.IsAtEnd)
                _head.Rewind();
        }

        /// <summary>Stays where it is.</summary>
        public void Pause() => _isPlaying = false;

        /// <summary>Goes back to the beginning and stays there.</summary>
        public void Stop()
        {
            _isPlaying = false;
            _head.Rewind();
            _frame = IsReady ? _head.Position : 0;
            _isWaiting = false;
            RequestUpdate();
        }

        /// <summary>
        /// Reads the structure, gives it to the surface, and begins to open the trajectory on another thread; what was
        /// loaded before is closed. Happens by itself when the component is enabled with a source. false, after Failed:
        /// <see cref="LastError"/> says why not.
        /// </summary>
        public bool Load()
        {
            Unload();
            if (_surface == null)
                _surface = GetComponent<MolecularSurface>();
            LastError = default;
            _isDamageLogged = false;
            MoleculeSource source = ActiveStructureSource;
            _loadedStructureSource = source.Copy();
            _loadedTrajectorySource = _trajectorySource.Copy();
            _loadedUnwrap = _unwrap;
            _loadedPrefetchFrames = _prefetchFrames;
            if (!source.TryFind(out MoleculeFile file, out QuickSesError error) ||
                !source.TryOpen(file, out Structure structure, out error))
                return Fail("structure", error);
            Structure = structure;
            SendAtoms();
            if (!TryFindFrames(ref file, out TrajectoryFormat format, out error))
                return Fail("trajectory", error);
            _prefetcher = new FramePrefetcher(
                new TrajectoryFrameReader(file, format, structure, _unwrap), _prefetchFrames);
            RequestUpdate();
            return true;
        }

        /// <summary>
        /// Closes structure and trajectory; the surface keeps what it shows. Waits for the frame that is being read.
        /// </summary>
        public void Unload()
        {
            if (IsReady)
                _frame = _head.Position;
            CloseFrames();
            Structure?.Dispose();
            Structure = null;
            _loadedStructureSource = null;
            _isLoadRequested = _areColorsRequested = false;
        }

        private void OnEnable()
        {
            _surface = GetComponent<MolecularSurface>();
            _surface.AtomsRequested += SendAtoms;
            if (_playOnEnable && Application.isPlaying)
                _isPlaying = true;
            if (HasSource)
                Load();
        }

        private void OnDisable()
        {
            if (_surface != null)
                _surface.AtomsRequested -= SendAtoms;
            Unload();
        }

        private void Update()
        {
            if (_isLoadRequested)
                Load();
            if (_areColorsRequested && Structure != null)
                SendColors();
            Tick(!Application.isPlaying ? 0
                : !_useUnscaledTime ? Time.deltaTime
                : Mathf.Min(Time.unscaledDeltaTime, Time.maximumDeltaTime));
        }

        /// <summary>What happens each frame of the game; seconds since the last one.</summary>
        internal void Tick(float seconds)
        {
            if (_prefetcher == null || (!IsReady && !TryGetReady()))
                return;
            _head.SetMode(_mode);
            if (_framesPerSecond != 0)
                _head.SetSign(_framesPerSecond > 0 ? 1 : -1);
            PlayHeadEvents passed = PlayHeadEvents.None;
            if (_isPlaying && !_isWaiting)
                passed = _head.Advance(seconds * Math.Abs((double)_framesPerSecond));
            if ((passed & PlayHeadEvents.Finished) != 0)
                _isPlaying = false;
            _frame = _head.Position;
            Show();
            // Last, since handlers may do anything.
            if ((passed & PlayHeadEvents.Looped) != 0)
                Looped?.Invoke();
            if ((passed & PlayHeadEvents.Finished) != 0)
                Finished?.Invoke();
        }

        private bool TryGetReady()
        {
            FrameState opening = _prefetcher.GetOpening(out QuickSesError error);
            if (opening == FrameState.Pending)
            {
                RequestUpdate();
                return false;
            }
            if (opening == FrameState.Damaged)
                return Fail("trajectory", error);
            if (_prefetcher.Warning != null)
                Debug.LogWarning($"{name}: {_prefetcher.Warning}", this);
            _head = new PlayHead(_prefetcher.FrameCount, _mode);
            if (_framesPerSecond < 0)
                _head.SetSign(-1);
            _head.MoveTo(_frame);
            if (_isPlaying && _head.IsAtEnd)
                _head.Rewind();
            _between.Resize(_prefetcher.AtomCount);
            IsReady = true;
            FramePrefetcher opened = _prefetcher;
            Loaded?.Invoke();
            return _prefetcher == opened;
        }

        // Gives the surface what the play head points at, or has the clock wait for it.
        private void Show()
        {
            FrameBlend blend = _head.Blend;
            if (!_interpolate)
                blend = new FrameBlend(blend.From, blend.From, 0);
            _prefetcher.Request(_head.Order);
            _isWaiting = false;
            if (blend.Equals(_shown) && _surface.AtomCount == _prefetcher.AtomCount)
                return;
            FrameState state = _prefetcher.Get(blend.From, out ReadOnlySpan<Vector3> from, out TrajectoryFrame info,
                out QuickSesError error);
            if (state == FrameState.Damaged)
            {
                TellDamage(blend.From, error);
                return;
            }
            ReadOnlySpan<Vector3> to = default;
            if (state == FrameState.Ready && blend.Weight > 0 &&
                _prefetcher.Get(blend.To, out to, out _, out _) == FrameState.Pending)
                state = FrameState.Pending;
            if (state == FrameState.Pending)
            {
                _isWaiting = true;
                RequestUpdate();
                return;
            }
            ShowBetween(from, to, blend, info);
        }

        // to: empty if there is no frame to go to, or it is damaged.
        private void ShowBetween(ReadOnlySpan<Vector3> from, ReadOnlySpan<Vector3> to, FrameBlend blend,
            in TrajectoryFrame info)
        {
            if (!to.IsEmpty)
            {
                FrameInterpolation.Blend(from, to, blend.Weight, PeriodicBox.Of(info), _between.Span);
                from = _between.Span;
            }
            if (_surface.AtomCount != from.Length) // somebody else gave it other atoms
                SendAtoms();
            _surface.SetPositions(from);
            bool isNewFrame = blend.From != _shown.From;
            _shown = blend;
            _shownInfo = info;
            _damagedFrame = -1;
            if (isNewFrame)
                FrameShown?.Invoke(blend.From);
        }

        private void TellDamage(int frame, QuickSesError error)
        {
            if (frame == _damagedFrame)
                return;
            _damagedFrame = frame;
            LastError = new QuickSesError(error.Status, $"frame {frame}: {error.Message}");
            RaiseFailed(frame);
        }

        private bool Fail(string what, QuickSesError error)
        {
            CloseFrames();
            LastError = new QuickSesError(error.Status, $"{what}: {error.Message}");
            RaiseFailed(-1);
            return false;
        }

        private void RaiseFailed(int frame)
        {
            if (Failed != null)
                Failed(frame, LastError);
            else if (frame < 0 || !_isDamageLogged)
                Debug.LogError($"{name}: {LastError.Message}", this);
            _isDamageLogged |= frame >= 0;
        }

        private void CloseFrames()
        {
            _prefetcher?.Dispose();
            _prefetcher = null;
            _between.Dispose();
            IsReady = _isWaiting = false;
            _shown = s_nothing;
            _damagedFrame = -1;
        }

        private bool TryFindFrames(ref MoleculeFile file, out TrajectoryFormat format, out QuickSesError error)
        {
            format = _trajectorySource.Format;
            if (_trajectorySource.Kind != MoleculeSourceKind.None)
                return _trajectorySource.TryFind(out file, out error);
            format = TrajectoryFormat.Pdb;
            bool hasFrames = Structure.Format == StructureFormat.Pdb && Structure.ModelCount > 1;
            error = hasFrames ? default : new QuickSesError(QuickSesStatus.InvalidArgument,
                $"none is chosen, and '{file.Name}' is not a PDB file with several models");
            return hasFrames;
        }

        private void SendAtoms()
        {
            if (Structure == null)
                return;
            var positions = new Vector3[Structure.AtomCount];
            UnitySpace.FromFile(Structure.Positions, positions);
            _surface.SetAtoms(positions, Structure.Radii);
            SendColors();
            _shown = s_nothing; // the frame comes again
            RequestUpdate();
        }

        private void SendColors()
        {
            _areColorsRequested = false;
            _loadedStructureSource.ColorScheme = ActiveStructureSource.ColorScheme;
            var colors = new Color32[Structure.AtomCount];
            AtomColors.Fill(Structure, ActiveStructureSource.ColorScheme, _surface.BaseColor, colors);
            _surface.SetColors(colors);
        }

        // In edit mode Update comes only when something changed.
        private static void RequestUpdate()
        {
#if UNITY_EDITOR
            if (!Application.isPlaying)
                UnityEditor.EditorApplication.QueuePlayerLoopUpdate();
#endif
        }
    }
}
