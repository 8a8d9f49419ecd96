// SPDX-License-Identifier: MIT
using System;

namespace QuickSes
{
    /// <summary>
    /// One surface over time: which atoms it is of, what is shown, and the job in between. It borrows a context from
    /// <see cref="SurfaceScheduler"/> for each job. Main thread only; no garbage while atoms move.
    /// </summary>
    internal sealed class SurfaceSession : IDisposable
    {
        private static uint s_sessions;

        private readonly MolecularSurface _owner;
        private readonly uint _series = ++s_sessions;
        private readonly float[] _ladder = new float[SurfaceSettings.MaxLevels + 1]; // as the last job was begun with
        private int _ladderCount = 1;
        private ContextSlot _slot; // while a job runs
        private SurfaceChange _pending; // since the last job began
        private SurfaceChange _begunChange; // before it
        private uint _version = 1; // of atoms and settings: rises with each change
        private uint _begunVersion;
        private uint _shownVersion;
        private uint _stoppedVersion; // failed, or cancelled by the user: not tried again
        private uint _job; // the last that was begun
        private double _lastChange;
        private bool _updated; // events to be raised
        private bool _finished;
        private bool _failed;

        public SurfaceSession(MolecularSurface owner)
        {
            _owner = owner;
        }

        public SurfaceAtomSet Atoms { get; } = new SurfaceAtomSet();

        public ShownSurface Shown { get; } = new ShownSurface();

        public SurfaceBackend Backend => _owner.Backend;

        /// <summary>Whether the scheduler knows it.</summary>
        public bool IsListed { get; set; }

        /// <summary>In which queue of the scheduler it waits.</summary>
        public SurfaceNeed Queued { get; set; }

        /// <summary>The one that computed what is shown or is being computed; Auto: none yet.</summary>
        public SurfaceBackend UsedBackend { get; private set; }

        public BackendDescription UsedDevice { get; private set; }

        /// <summary>Of the last job that failed; Ok after one that didn't.</summary>
        public QuickSesError LastError { get; private set; }

        public float Progress { get; private set; }

        public bool IsDisposed { get; private set; }

        /// <summary>Whether the newest atoms are shown as finely as asked for, or never will be.</summary>
        public bool IsSettled => !Atoms.IsSet || _stoppedVersion == _version ||
            (_slot == null && _shownVersion == _version && Shown.Level.IsFinest);

        /// <summary>Something is new: what is shown will be replaced.</summary>
        public void Change(SurfaceChange change, double now)
        {
            ++_version;
            _lastChange = now;
            if (change > _pending)
                _pending = change;
        }

        /// <summary>Once per frame: collects, shows, asks for a context.</summary>
        public void Tick(double now)
        {
            if (_slot != null)
                Advance();
            if (_slot == null)
            {
                SurfaceNeed need = FindNeed(now);
                if (need != SurfaceNeed.None)
                    SurfaceScheduler.Enqueue(this, need);
                else
                    Queued = SurfaceNeed.None;
            }
            else if (_begunVersion != _version && !SurfaceScheduler.IsAnyUrgent)
            {
                Start(_slot);
            }
            SurfaceScheduler.Dispatch();
        }

        /// <summary>Raises what happened since the last time. Callers of events may do anything, this last.</summary>
        public void RaiseEvents()
        {
            bool updated = _updated, finished = _finished, failed = _failed;
            _updated = _finished = _failed = false;
            if (updated)
                _owner.RaiseUpdated(Shown.Level);
            if (finished)
                _owner.RaiseFinished();
            if (failed)
                _owner.RaiseFailed(LastError);
        }

        /// <summary>Begins a job with a context that is lent for it.</summary>
        public void Start(ContextSlot slot)
        {
            Borrow(slot);
            try
            {
                SurfaceContext context = slot.Context;
                QuickSesStatus status = Atoms.Send(slot);
                if (status == QuickSesStatus.Ok)
                {
                    SurfaceSettings settings = MakeSettings();
                    bool isCurrent = _shownVersion == _version;
                    SurfaceJobPlan.Choose(ref settings, Ladder, _pending,
                        isCurrent ? Shown.Level.Spacing : float.PositiveInfinity, Shown.Level.IsFinest,
                        _owner.FrameBudget, SurfaceScheduler.IsAnyUrgent);
                    status = context.Begin(settings);
                }
                NoteBegun();
                if (status != QuickSesStatus.Ok)
                    EndWith(new QuickSesError(status, context.LastError));
            }
            catch (QuickSesException e) // an atom or a setting is wrong
            {
                NoteBegun();
                EndWith(new QuickSesError(e.Status, e.Message));
            }
        }

        /// <summary>Computes the finest level and shows it before it returns.</summary>
        public bool ComputeNow()
        {
            Drop();
            ContextSlot slot = SurfaceScheduler.LendNow(this, out QuickSesError error);
            if (slot == null)
            {
                FailToBegin(error);
                return false;
            }
            Borrow(slot);
            try
            {
                QuickSesStatus status = Atoms.Send(slot);
                SurfaceMeshView view = default;
                if (status == QuickSesStatus.Ok)
                    status = slot.Context.Compute(MakeSettings(), out view);
                NoteBegun();
                if (status == QuickSesStatus.Ok)
                    Show(view);
                else
                    Fail(new QuickSesError(status, slot.Context.LastError));
                return status == QuickSesStatus.Ok;
            }
            catch (QuickSesException e)
            {
                NoteBegun();
                Fail(new QuickSesError(e.Status, e.Message));
                return false;
            }
            finally
            {
                Release();
            }
        }

        /// <summary>There is no context, and none will come.</summary>
        public void FailToBegin(in QuickSesError error)
        {
            NoteBegun();
            Fail(error);
        }

        /// <summary>Ends the job; what is new meanwhile begins again later.</summary>
        public void Drop()
        {
            Queued = SurfaceNeed.None;
            if (_slot == null)
                return;
            _slot.Context.Cancel();
            Release();
        }

        /// <summary>Ends the job for good: nothing is computed until something changes.</summary>
        public void Stop()
        {
            Drop();
            _stoppedVersion = _begunVersion = _version;
            _pending = SurfaceChange.None;
        }

        /// <summary>The scheduler takes the context back, and frees it.</summary>
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

        private ReadOnlySpan<float> Ladder => new ReadOnlySpan<float>(_ladder, 0, _ladderCount);

        private SurfaceNeed FindNeed(double now)
        {
            if (!Atoms.IsSet || _stoppedVersion == _version)
                return SurfaceNeed.None;
            if (_begunVersion != _version)
                return SurfaceNeed.Urgent;
            bool isDone = _shownVersion == _version && Shown.Level.IsFinest;
            return !isDone && now - _lastChange >= _owner.RestDelay ? SurfaceNeed.Refinement : SurfaceNeed.None;
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
                    Show(view);
                    hasShown = true;
                }
                context.Poll(out progress);
            } while (progress.IsMeshReady);
            Progress = progress.Fraction;
            if (progress.State == SurfaceJobState.Running)
            {
                if (hasShown && SurfaceScheduler.IsAnyUrgent)
                    Yield();
            }
            else if (progress.State == SurfaceJobState.Failed)
            {
                EndWith(new QuickSesError(progress.Status, progress.Message));
            }
            else
            {
                Release();
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
            _begunVersion = _version - 1;
            if (change > _pending)
                _pending = change;
        }

        private void Fail(in QuickSesError error)
        {
            _stoppedVersion = _begunVersion;
            LastError = error;
            _failed = true;
        }

        // Not what the context's last user left behind. Numbers of jobs may wrap.
        private bool IsOurs(in SurfaceMeshView view) => unchecked((int)(view.Frame - _slot.FirstJob)) >= 0;

        private void Show(in SurfaceMeshView view)
        {
            bool isCurrent = view.Frame == _job && _begunVersion == _version;
            _slot.Context.TryGetReport(out SurfaceReport report);
            Shown.Show(view, report, Ladder, isCurrent, _owner.PadBuffers);
            _shownVersion = isCurrent ? _version : _version - 1;
            _updated = true;
            _finished = isCurrent && Shown.Level.IsFinest;
            LastError = default;
        }

        private SurfaceSettings MakeSettings()
        {
            SurfaceSettings settings = _owner.MakeSettings(_ladder, out _ladderCount);
            settings.Frame = _job = SurfaceScheduler.NextJob();
            settings.Series = _series;
            settings.Texcoords = Atoms.HasTexcoords;
            return settings;
        }

        private void NoteBegun()
        {
            _begunVersion = _version;
            _begunChange = _pending;
            _pending = SurfaceChange.None;
            Progress = 0;
        }

        private void Borrow(ContextSlot slot)
        {
            _slot = slot;
            UsedBackend = slot.Context.Backend;
            UsedDevice = slot.Context.Description;
        }

        private void EndWith(in QuickSesError error)
        {
            Fail(error);
            Release();
        }

        private void Release()
        {
            SurfaceScheduler.Release(_slot);
            _slot = null;
            Progress = 1;
        }
    }
}
