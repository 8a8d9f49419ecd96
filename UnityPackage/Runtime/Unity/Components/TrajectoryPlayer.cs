// SPDX-License-Identifier: MIT
using System;
using UnityEngine;

namespace QuickSes
{
    /// <summary>
    /// Plays a trajectory (DCD, XTC, TRR, NetCDF, PDB with several models) in the <see cref="MolecularSurface"/> beside it, and in
    /// any number of others (<see cref="Surfaces"/>), which are all given the same frame at the same time: reads atoms
    /// of a structure, gives them to the surfaces, then their positions frame by frame, with x negated, since Unity is
    /// left-handed. Files are read, and frames read ahead, on threads of its own; playing makes no garbage. In edit
    /// mode <see cref="Frame"/> can be scrubbed, but nothing plays. Main thread only.
    /// </summary>
    [ExecuteAlways, DisallowMultipleComponent, RequireComponent(typeof(MolecularSurface))]
    [AddComponentMenu("Molecular/Trajectory Player")]
    public sealed partial class TrajectoryPlayer : MonoBehaviour
    {
        private MolecularSurface _surface;
        private PlayHead _head;
        private UnmanagedBuffer<Vector3> _between; // while it is ready
        [NonSerialized] private bool _isEnabled, _isPlaying, _isWaiting, _areColorsRequested;
        [NonSerialized] private bool _isAnimated; // in this frame of the game
        [NonSerialized] private bool _isLoadRequested; // by the inspector
        [NonSerialized] private bool _isLoadDeferred; // by Load, until it is enabled

        // Told at the end of a tick; what comes up outside of one, at the beginning of the next.
        [NonSerialized] private bool _isNewFrameUntold;
        [NonSerialized] private PlayHeadEvents _untold;
        [NonSerialized] private bool _isFailureUntold, _isTellingFailure;

        // What the surface shows: _shown.From is -1 before the first frame, and where it has to be sent anew.
        private static readonly FrameBlend s_nothing = new FrameBlend(-1, -1, 0);
        private FrameBlend _shown = s_nothing;
        private TrajectoryFrame _shownInfo;
        private int _damagedFrame = -1; // the one told last, so that it is told once each time it is reached
        private bool _isDamageLogged;

        /// <summary>Atoms are there, and frames can be shown from now on.</summary>
        public event Action Loaded
        {
            add => _loaded.Add(value);
            remove => _loaded.Remove(value);
        }

        /// <summary>All surfaces were given this frame, counted from 0, or a place right behind it.</summary>
        public event Action<int> FrameShown
        {
            add => _frameShown.Add(value);
            remove => _frameShown.Remove(value);
        }

        /// <summary>An end was passed: it goes on from the other end (Loop) or back (PingPong).</summary>
        public event Action Looped
        {
            add => _looped.Add(value);
            remove => _looped.Remove(value);
        }

        /// <summary>It was played once, and is paused at the end: with a negative rate, on the first frame.</summary>
        public event Action Finished
        {
            add => _finished.Add(value);
            remove => _finished.Remove(value);
        }

        /// <summary>
        /// A frame is damaged: its number, counted from 0; what was shown before stays, and playing goes on. -1:
        /// nothing can be shown of the trajectory, or of the structure. Without listeners it is logged, of damaged
        /// frames the first.
        /// </summary>
        public event Action<int, QuickSesError> Failed
        {
            add => _failed.Add(value);
            remove => _failed.Remove(value);
        }

        /// <summary>What Failed told last since loading; Ok if nothing.</summary>
        public QuickSesError LastError { get; private set; }

        /// <summary>
        /// The atoms, open as long as they are shown; null if nothing is loaded. In the file's coordinates; not the
        /// caller's to dispose of.
        /// </summary>
        public Structure Structure => _played.Length > 0 ? _played[0].Structure : null;

        /// <summary>Whether the structure is being read, or the trajectory opened.</summary>
        public bool IsLoading => _load != null || (_prefetcher != null && !IsReady);

        /// <summary>
        /// From 0 to 1; 1 if nothing is being loaded. It goes in steps: while the library is at a file, it stands still.
        /// </summary>
        public float LoadProgress => _load != null ? 0.9f * _load.Progress : IsLoading ? 0.9f : 1;

        /// <summary>Whether frames can be shown.</summary>
        public bool IsReady { get; private set; }

        /// <summary>Whether it plays, or will as soon as it is loaded.</summary>
        public bool IsPlaying => _isPlaying;

        /// <summary>Whether the clock stands since what it points at is not read yet.</summary>
        internal bool IsWaiting => _isWaiting;

        /// <summary>0 until it is loaded.</summary>
        public int FrameCount => IsReady ? _head.FrameCount : 0;

        /// <summary>
        /// The frame the surface was given last, or a place right behind it in playing direction; -1: none yet.
        /// </summary>
        public int ShownFrame => _shown.From;

        /// <summary>Picoseconds at <see cref="ShownFrame"/>, if the file tells.</summary>
        public bool TryGetTime(out double picoseconds)
        {
            picoseconds = _shownInfo.Time;
            return _shown.From >= 0 && _shownInfo.HasTime;
        }

        /// <summary>
        /// Plays from where it is; from the beginning, with a negative rate the last frame, if it was played once.
        /// </summary>
        public void Play()
        {
            _isPlaying = true;
            if (!IsReady)
                return;
            SteerHead();
            if (_head.IsAtEnd)
                _head.Rewind();
        }

        /// <summary>Stays where it is.</summary>
        public void Pause() => _isPlaying = false;

        /// <summary>Goes back to the beginning and stays there.</summary>
        public void Stop()
        {
            _isPlaying = false;
            SetPlace(Beginning);
            _head.Rewind();
            _chosenFrame = -1;
            _isWaiting = false;
            RequestUpdate();
        }

        /// <summary>Where <see cref="Stop"/> goes.</summary>
        internal double Beginning
        {
            get
            {
                SteerHead();
                PlayHead head = _head;
                head.Rewind();
                return IsReady ? head.Position : 0;
            }
        }

        private void OnEnable()
        {
            _isEnabled = true;
            _surface = GetComponent<MolecularSurface>();
            if (_playOnEnable && Application.IsPlaying(this))
                _isPlaying = true;
            if (_isLoadDeferred)
                Load();
            else
                LoadWhatIsSet();
        }

        // Whatever is open, is open only while it is enabled: OnDestroy does not come to what never was active.
        private void OnDisable()
        {
            _isEnabled = false;
            Unload();
        }

        private void Update()
        {
            bool passesTime = Application.IsPlaying(this); // first, since handlers may destroy it
            if (_isLoadRequested)
                LoadWhatIsSet();
            if (_areColorsRequested)
                SendColors();
            FollowFrame();
            Tick(!passesTime ? 0
                : !_useUnscaledTime ? Time.deltaTime
                : Mathf.Min(Time.unscaledDeltaTime, Time.maximumDeltaTime));
        }

        // The engine calls it after an animation, or its preview in the Editor, wrote serialised fields: after Update.
        private void OnDidApplyAnimationProperties()
        {
            if (FollowFrame())
                _isAnimated = true;
        }

        // Shows where an animation went in the same frame of the game.
        private void LateUpdate()
        {
            if (!_isAnimated)
                return;
            _isAnimated = false;
            Tick(0);
        }

        /// <summary>What happens each frame of the game; seconds since the last one.</summary>
        internal void Tick(float seconds)
        {
            TellAll();
            if (_load != null)
                TickLoading();
            else if (IsReady)
                TickFrames(seconds);
            else if (_prefetcher != null && TryGetReady())
                TickFrames(0);
        }

        // The way it is to go, which the inspector may have changed as well.
        private void SteerHead()
        {
            _head.SetMode(_mode);
            if (FramesPerSecond != 0)
                _head.SetSign(FramesPerSecond > 0 ? 1 : -1);
        }

        private void TickFrames(float seconds)
        {
            SteerHead();
            if (_isPlaying && !_isWaiting)
            {
                PlayHeadEvents passed = _head.Advance(seconds * Math.Abs((double)FramesPerSecond));
                _isPlaying = (passed & PlayHeadEvents.Finished) == 0;
                _untold |= passed;
            }
            SetPlace(_head.Position);
            Show();
            TellAll();
        }

        // Handlers may do anything: what they unload, disable or destroy has nothing left to tell (CloseFrames). It has not
        // finished as long as it waits for the last frame.
        private void TellAll()
        {
            TellFailure();
            if (_isNewFrameUntold)
            {
                _isNewFrameUntold = false;
                RaiseFrameShown(_shown.From);
            }
            if (TakeUntold(PlayHeadEvents.Looped))
                RaiseLooped();
            if (!_isWaiting && TakeUntold(PlayHeadEvents.Finished))
                RaiseFinished();
        }

        private bool TakeUntold(PlayHeadEvents which)
        {
            bool isThere = (_untold & which) != 0;
            _untold &= ~which;
            return isThere;
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
            SteerHead();
            _head.MoveTo(_frame);
            if (_isPlaying && _head.IsAtEnd)
                _head.Rewind();
            _between = new UnmanagedBuffer<Vector3>();
            _between.Resize(_prefetcher.AtomCount);
            IsReady = true;
            FramePrefetcher opened = _prefetcher;
            RaiseLoaded();
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
            if (blend.Equals(_shown) && AreAtomsInPlace())
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
            foreach (PlayedAtoms each in _played)
            {
                each.SendPositions(from.Slice(0, each.Count));
                from = from.Slice(each.Count);
            }
            _isNewFrameUntold |= blend.From != _shown.From;
            _shown = blend;
            _shownInfo = info;
            _damagedFrame = -1;
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
            if (_played.Length == 0)
                ReleaseSurfaces();
            LastError = new QuickSesError(error.Status, $"{what}: {error.Message}");
            _isFailureUntold = true;
            TellFailure();
            RequestUpdate();
            return false;
        }

        // What fails at once when a handler tries again is told in the next tick, or that would never end.
        private void TellFailure()
        {
            if (!_isFailureUntold || _isTellingFailure)
                return;
            _isFailureUntold = false;
            _isTellingFailure = true;
            RaiseFailed(-1);
            _isTellingFailure = false;
        }

        private bool AreAtomsInPlace()
        {
            foreach (PlayedAtoms each in _played)
                if (!each.IsInPlace)
                    return false;
            return true;
        }

        private void SendColors()
        {
            _areColorsRequested = false;
            if (_played.Length == 0)
                return;
            _loadedStructureSource.ColorScheme = ActiveStructureSource.ColorScheme;
            _played[0].SendColors(ActiveStructureSource.ColorScheme);
        }

        // A surface got its atoms anew: the frame comes again.
        private void ShowAgain()
        {
            _shown = s_nothing;
            RequestUpdate();
        }

        // In edit mode Update comes only when something changed.
        private void RequestUpdate()
        {
#if UNITY_EDITOR
            if (this != null && !Application.IsPlaying(this))
                UnityEditor.EditorApplication.QueuePlayerLoopUpdate();
#endif
        }
    }
}
