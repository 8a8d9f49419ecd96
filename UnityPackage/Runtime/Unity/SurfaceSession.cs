// SPDX-License-Identifier: MIT
using System;

namespace QuickSes
{
    /// <summary>
    /// One surface over time: which atoms it is of, what is shown, and the job in between. It borrows a context from a
    /// <see cref="ContextPool"/> for each job. Main thread only; no garbage while atoms move.
    /// </summary>
    internal sealed class SurfaceSession : IDisposable
    {
        private static uint s_sessions;

        private readonly MolecularSurface _owner;
        private readonly uint _series = ++s_sessions;
        private readonly float[] _ladder = new float[SurfaceSettings.MaxLevels + 1]; // as the last job was begun with
        private int _ladderCount = 1;
        private ContextSlot _slot; // while a job runs

        // Versions of atoms, colours and settings: each change makes a new one. Those of the shape leave out colours.
        private uint _version = 1;
        private uint _shape = 1;
        private uint _triedVersion; // the last that a job was begun for, or could not be
        private uint _stoppedVersion; // of this one nothing more will come: it failed, or was cancelled by the user
        private uint _shownVersion;
        private uint _shownShape;
        private uint _job; // the last that was begun
        private uint _jobVersion; // and what it is of
        private uint _jobShape;
        private SurfaceChange _pending; // since the last job began
        private SurfaceChange _begunChange; // before it
        private double _lastChange;

        private bool _updated; // events to be raised
        private bool _finished;
        private bool _failed;

        public SurfaceSession(MolecularSurface owner)
        {
            _owner = owner;
            SurfaceScheduler.Add(this);
        }

        public SurfaceAtomSet Atoms { get; } = new SurfaceAtomSet();

        public ShownSurface Shown { get; } = new ShownSurface();

        /// <summary>In which queue of its pool it waits.</summary>
        public SurfaceNeed Queued { get; set; }

        /// <summary>Whose context it has, or waits for.</summary>
        public ContextPool Pool { get; set; }

        /// <summary>The one that computed what is shown or is being computed; Auto: none yet.</summary>
        public SurfaceBackend UsedBackend { get; private set; }

        public BackendDescription UsedDevice { get; private set; }

        /// <summary>Why there is no surface of the newest atoms; Ok if there is or will be one.</summary>
        public QuickSesError LastError { get; private set; }

        public float Progress { get; private set; }

        public bool IsDisposed { get; private set; }

        /// <summary>Whether the component has been destroyed without being told.</summary>
        public bool IsOrphan => _owner == null;

        /// <summary>Whether the newest atoms are shown as finely as asked for, or never will be.</summary>
        public bool IsSettled => !Atoms.IsSet || (_slot == null && (_stoppedVersion == _version || IsDone));

        private bool IsDone => _shownVersion == _version && Shown.Level.IsFinest;

        private ReadOnlySpan<float> Ladder => new ReadOnlySpan<float>(_ladder, 0, _ladderCount);

        /// <summary>Something is new: what is shown will be replaced.</summary>
        public void Change(SurfaceChange change, double now)
        {
            ++_version;
            if (change >= SurfaceChange.Positions)
                ++_shape;
            _lastChange = now;
            if (change > _pending)
                _pending = change;
        }

        /// <summary>Once per frame: collects, shows, asks for a context.</summary>
        public void Tick(double now)
        {
            if (_slot != null)
                Advance();
            ContextPool pool = SurfaceScheduler.PoolOf(_owner.Backend);
            if (_slot == null)
            {
                SurfaceNeed need = FindNeed(now);
                if (need != SurfaceNeed.None)
                    pool.Enqueue(this, need);
                else
                    Queued = SurfaceNeed.None;
            }
            else if (_triedVersion != _version && !Pool.IsAnyUrgent && Pool == pool)
            {
                Start(_slot); // replaces the job; its coarsest level still comes
            }
            pool.Dispatch();
        }

        /// <summary>
        /// Raises what happened since the last time and is still so. Handlers may do anything; what one that throws
        /// leaves is raised the next time.
        /// </summary>
        public void RaiseEvents()
        {
            if (_updated)
            {
                _updated = false;
                _owner.RaiseUpdated(Shown.Level);
            }
            if (_finished && !IsDisposed)
            {
                _finished = false;
                if (IsDone && Atoms.IsSet)
                    _owner.RaiseFinished();
            }
            if (_failed && !IsDisposed)
            {
                _failed = false;
                if (LastError.Status != QuickSesStatus.Ok)
                    _owner.RaiseFailed(LastError);
            }
        }

        /// <summary>Begins a job with a context that is lent for it, or that it has.</summary>
        public void Start(ContextSlot slot)
        {
            bool replaces = _slot == slot;
            Borrow(slot);
            QuickSesError error = TryBegin(slot.Context);
            _triedVersion = _version;
            _begunChange = _pending;
            _pending = SurfaceChange.None;
            if (error.Status == QuickSesStatus.Ok)
                return;
            Fail(_version, error);
            if (!replaces) // else the job of the atoms before goes on
                Release(error);
        }

        /// <summary>Computes the finest level and shows it before it returns.</summary>
        public bool ComputeNow()
        {
            Drop();
            ContextSlot slot = SurfaceScheduler.PoolOf(_owner.Backend).LendNow(this, out QuickSesError error);
            if (slot == null)
            {
                FailToBegin(error);
                return false;
            }
            Borrow(slot);
            error = TryCompute(slot.Context);
            _triedVersion = _version;
            _pending = SurfaceChange.None;
            if (error.Status != QuickSesStatus.Ok)
                Fail(_version, error);
            Release(error);
            return error.Status == QuickSesStatus.Ok;
        }

        /// <summary>There is nothing to compute with, or no atoms to compute it of.</summary>
        public void FailToBegin(in QuickSesError error)
        {
            Drop();
            _triedVersion = _version;
            _pending = SurfaceChange.None;
            Fail(_version, error);
        }

        /// <summary>Ends the job; what is new meanwhile begins again later.</summary>
        public void Drop()
        {
            Queued = SurfaceNeed.None;
            if (_slot == null)
                return;
            _slot.Context.Cancel();
            Release(default);
        }

        /// <summary>Ends the job for good: nothing is computed until something changes.</summary>
        public void Stop()
        {
            Drop();
            _stoppedVersion = _triedVersion = _version;
            _pending = SurfaceChange.None;
        }

        /// <summary>No atoms and no surface.</summary>
        public void Clear()
        {
            Drop();
            ++_version;
            ++_shape;
            _pending = SurfaceChange.None;
            Atoms.Clear();
            Shown.Clear();
            LastError = default;
            _updated = _finished = _failed = false;
        }

        /// <summary>The pool takes the context back, and frees it.</summary>
        public void LoseContext()
        {
            _slot = null;
            BeginAgain(SurfaceChange.Shape);
        }

        /// <summary>After <see cref="Drop"/>: what was not finished begins again.</summary>
        public void Resume()
        {
            if (!IsSettled)
                BeginAgain(SurfaceChange.Shape);
        }

        public void Dispose()
        {
            if (IsDisposed)
                return;
            IsDisposed = true;
            Drop();
            SurfaceScheduler.Remove(this);
            Atoms.Dispose();
            Shown.Dispose();
        }

        private SurfaceNeed FindNeed(double now)
        {
            if (!Atoms.IsSet || _stoppedVersion == _version)
                return SurfaceNeed.None;
            if (_triedVersion != _version)
                return SurfaceNeed.Urgent;
            return !IsDone && now - _lastChange >= _owner.RestDelay ? SurfaceNeed.Refinement : SurfaceNeed.None;
        }

        private QuickSesError TryBegin(SurfaceContext context)
        {
            try
            {
                QuickSesStatus status = Atoms.Send(_slot);
                if (status == QuickSesStatus.Ok)
                {
                    SurfaceSettings settings = MakeSettings();
                    SurfaceJobPlan.Choose(ref settings, Ladder, _pending,
                        _shownShape == _shape ? Shown.Level.Spacing : float.PositiveInfinity, _owner.FrameBudget,
                        Pool.IsAnyUrgent);
                    status = context.Begin(settings);
                    NoteJob(settings.Tag, status);
                }
                return status == QuickSesStatus.Ok ? default : new QuickSesError(status, context.LastError);
            }
            catch (QuickSesException e) // an atom or a setting is wrong
            {
                return new QuickSesError(e.Status, e.Message);
            }
        }

        private QuickSesError TryCompute(SurfaceContext context)
        {
            try
            {
                SurfaceMeshView view = default;
                QuickSesStatus status = Atoms.Send(_slot);
                if (status == QuickSesStatus.Ok)
                {
                    SurfaceSettings settings = MakeSettings();
                    status = context.Compute(settings, out view);
                    NoteJob(settings.Tag, status);
                }
                return status == QuickSesStatus.Ok ? TryShow(view)
                    : new QuickSesError(status, context.LastError);
            }
            catch (QuickSesException e)
            {
                return new QuickSesError(e.Status, e.Message);
            }
        }

        // Shows what is ready, and gives the context back when the job is over.
        private void Advance()
        {
            SurfaceContext context = _slot.Context;
            bool hasShown = false;
            SurfaceProgress progress;
            do
            {
                if (context.TryCollect(out SurfaceMeshView view) && IsOurs(view))
                {
                    QuickSesError error = TryShow(view);
                    if (error.Status != QuickSesStatus.Ok)
                    {
                        context.Cancel();
                        FailJob(error);
                        return;
                    }
                    hasShown = true;
                }
                context.Poll(out progress);
            } while (progress.IsMeshReady);
            Progress = progress.Fraction;
            if (progress.State == SurfaceJobState.Running)
            {
                if (hasShown && Pool.IsAnyUrgent)
                    Yield();
            }
            else if (progress.State == SurfaceJobState.Failed)
            {
                FailJob(new QuickSesError(progress.Status, progress.Message));
            }
            else
            {
                Release(default);
            }
        }

        // Others have nothing yet, so finer levels come later, or, if what was shown is old by now, all of it.
        private void Yield()
        {
            Drop();
            if (_shownVersion != _version)
                BeginAgain(_begunChange);
        }

        private void BeginAgain(SurfaceChange change)
        {
            _triedVersion = _version - 1;
            if (change > _pending)
                _pending = change;
        }

        // Not what the context's last user left behind. Numbers of jobs may wrap.
        private bool IsOurs(in SurfaceMeshView view) => unchecked((int)(view.Tag - _slot.FirstJob)) >= 0;

        private QuickSesError TryShow(in SurfaceMeshView view)
        {
            bool isLast = view.Tag == _job;
            bool isCurrent = isLast && _jobVersion == _version;
            _slot.Context.TryGetReport(out SurfaceReport report);
            try
            {
                Shown.Show(view, report, Ladder, isCurrent, _owner.PadBuffers);
                if (Shown.TakeIsNewMesh())
                    _owner.AttachMesh();
            }
            catch (Exception e) // the engine refuses the mesh: it was made unreadable, say
            {
                return new QuickSesError(QuickSesStatus.InternalError, e.Message);
            }
            _shownVersion = isCurrent ? _version : _version - 1;
            _shownShape = isLast && _jobShape == _shape ? _shape : _shape - 1;
            _updated = true;
            _finished = IsDone;
            if (_stoppedVersion != _version)
                LastError = default;
            return default;
        }

        private SurfaceSettings MakeSettings()
        {
            SurfaceSettings settings = _owner.MakeSettings(_ladder, out _ladderCount);
            settings.Tag = SurfaceScheduler.NextJob();
            settings.Series = _series;
            settings.Texcoords = Atoms.HasTexcoords;
            return settings;
        }

        private void NoteJob(uint job, QuickSesStatus status)
        {
            if (status != QuickSesStatus.Ok)
                return;
            _job = job;
            _jobVersion = _version;
            _jobShape = _shape;
            Progress = 0;
        }

        private void Borrow(ContextSlot slot)
        {
            _slot = slot;
            UsedBackend = slot.Context.Backend;
            UsedDevice = slot.Context.Description;
        }

        // Of a version nothing (more) will come. That there is nothing to compute with is told once.
        private void Fail(uint version, in QuickSesError error)
        {
            _stoppedVersion = version;
            _failed |= error.Status != QuickSesStatus.BackendUnavailable || LastError.Status != error.Status;
            LastError = error;
        }

        private void FailJob(in QuickSesError error)
        {
            Fail(_jobVersion, error);
            Release(error);
        }

        private void Release(in QuickSesError error)
        {
            Pool.Release(_slot, error.Status == QuickSesStatus.DeviceError);
            _slot = null;
            Progress = 1;
        }
    }
}
