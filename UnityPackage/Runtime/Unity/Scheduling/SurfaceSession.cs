// SPDX-License-Identifier: MIT
using System;

namespace QuickSes
{
    /// <summary>
    /// One surface over time: which atoms it is of, what is shown, and the job in between. It borrows a context from a
    /// <see cref="ContextPool"/> for each job. Main thread only; no garbage while atoms move.
    /// </summary>
    internal sealed partial class SurfaceSession : IUploader, IDisposable
    {
        /// <summary>Milliseconds between two looks at work that a thread waits for.</summary>
        internal const int Pause = 20;

        private readonly ISurfaceHost _host;

        // Of the newest atoms and settings.
        private bool _isTried; // a job was begun, or could not be
        private bool _isStopped; // nothing more will come: it failed, or was cancelled by the user
        private bool _isShown;
        private SurfaceChange _pending; // since the last job began
        private double _lastChange;

        private bool _updated; // events to be raised
        private bool _finished;
        private bool _failed;
        private bool _isTellingFailure;

        public SurfaceSession(ISurfaceHost host)
        {
            _host = host;
            SurfaceScheduler.Add(this);
        }

        public SurfaceAtomSet Atoms { get; } = new SurfaceAtomSet();

        /// <summary>What is shown.</summary>
        public SurfaceLevel CurrentLevel { get; private set; }

        /// <summary>In which queue of its pool it waits.</summary>
        public QueuePriority QueuedAs { get; set; }

        /// <summary>Whose context it has, or waits for.</summary>
        public ContextPool Pool { get; set; }

        /// <summary>The one that computed what is shown or is being computed; Auto: none yet.</summary>
        public SurfaceBackend UsedBackend { get; private set; }

        public BackendDescription UsedDevice { get; private set; }

        /// <summary>Why there is no surface of the newest atoms; Ok if there is or will be one.</summary>
        public QuickSesError LastError { get; private set; }

        public float Progress { get; private set; }

        /// <summary>Whether it waits for the first context, which is being made: with CUDA, the GPU is started.</summary>
        public bool IsStarting => _slot == null && QueuedAs != QueuePriority.None && Pool.IsStarting;

        public bool IsDisposed { get; private set; }

        /// <summary>The scheduler's: where it is in its list.</summary>
        public int Place { get; set; }

        public bool IsOrphan => _host.IsGone;

        /// <summary>
        /// Whether nothing is left to do: the best surface of the newest atoms that there will be is shown as they look
        /// now, or failed, or was cancelled, or there are no atoms.
        /// </summary>
        public bool IsUpToDate => IsComputed && !_host.HasUpload && !_host.HasDelivery;

        /// <summary>Whether <see cref="Tick"/> has something to wait for.</summary>
        public bool IsWaiting => !IsUpToDate || (_isHeldReady && !double.IsInfinity(_host.RestDelay));

        /// <summary>Whether <see cref="ComputeNow"/> would give what is shown.</summary>
        public bool IsFinestShown =>
            _isShown && CurrentLevel.IsFinest && (CurrentLevel.HasCreases || !_wantsCreases);

        private bool IsComputed =>
            !Atoms.IsSet || (_slot == null && !_hasArrival && (_isStopped || IsDone || IsLeftCoarse));

        private bool IsDone => _isShown && IsBest(CurrentLevel);

        // What never rests is not refined.
        private bool IsLeftCoarse => _isShown && _isTried && double.IsInfinity(_host.RestDelay);

        /// <summary>Something is new: what is shown will be replaced.</summary>
        public void Change(SurfaceChange change, double now)
        {
            Outdate();
            _lastChange = now;
            if (change > _pending)
                _pending = change;
        }

        /// <summary>Once per frame: collects, shows, asks for a context.</summary>
        public void Tick(double now)
        {
            UploadQueue uploads = SurfaceScheduler.Uploads;
            if (uploads.Note(_host.Frame, ref _lastTick))
                SurfaceScheduler.Deliver();
            uploads.Run(); // what has waited, also of others
            if (_slot != null)
                Advance();
            ContextPool pool = SurfaceScheduler.PoolOf(_host.Backend);
            if (_slot == null)
            {
                QueuePriority priority = FindPriority(now);
                if (priority != QueuePriority.None)
                    pool.Enqueue(this, priority);
                else
                    QueuedAs = QueuePriority.None;
            }
            else if (!_isTried && !Pool.IsAnyUrgent && Pool == pool)
            {
                Start(_slot); // replaces the job; its coarsest level still comes
            }
            pool.Dispatch();
            if (_hasArrived)
            {
                _hasArrived = false;
                _lastArrival = now; // who answers it with new positions has not had the time to
            }
            else if (_isHeldReady && IsComputed && now - Math.Max(_lastChange, _lastArrival) >= _host.RestDelay)
            {
                _isHeldReady = false;
                _host.Rest();
            }
            if (_host.HasUpload)
                uploads.Enqueue(this);
            uploads.Run();
        }

        /// <summary>
        /// Raises what happened since the last time and is still so. Handlers may do anything; what one that throws
        /// leaves is raised the next time. So is what fails at once when a handler of a failure tries again, or that would
        /// never end.
        /// </summary>
        public void RaiseEvents()
        {
            if (_updated)
            {
                _updated = false;
                _host.OnUpdated(CurrentLevel);
            }
            if (_finished && !IsDisposed)
            {
                _finished = false;
                if (IsDone && Atoms.IsSet)
                    _host.OnFinished();
            }
            if (_failed && !IsDisposed && !_isTellingFailure)
            {
                _failed = false;
                if (LastError.Status != QuickSesStatus.Ok)
                    TellFailure();
            }
        }

        private void TellFailure()
        {
            _isTellingFailure = true;
            try
            {
                _host.OnFailed(LastError);
            }
            finally
            {
                _isTellingFailure = false;
            }
        }

        /// <summary>Computes the finest level and shows it before it returns.</summary>
        /// <param name="goesOn">If not null: called now and then meanwhile; false ends it.</param>
        public bool ComputeNow(Func<bool> goesOn = null)
        {
            Drop();
            Progress = 0;
            ContextSlot slot = SurfaceScheduler.PoolOf(_host.Backend).LendNow(this, goesOn, out QuickSesError error);
            if (slot == null)
            {
                if (error.Status == QuickSesStatus.Cancelled)
                    LastError = error; // by who waits for it, to whom it is no failure
                else
                    FailToBegin(error);
                return false;
            }
            _isStopped = false;
            if (TryStart(slot, true))
            {
                while (!slot.Context.Wait(goesOn == null ? -1 : Pause))
                {
                    slot.Context.Poll(out SurfaceProgress progress);
                    Progress = progress.Fraction;
                    if (!goesOn())
                        slot.Context.Cancel();
                }
                _begunChange = SurfaceChange.None; // who waits for it wants it for itself
                Advance();
                if (_wantsHostMemory)
                    return ComputeNow(goesOn);
                if (_hasArrival && _host.HasDelivery)
                    DeliverNow();
                if (_hasArrival)
                {
                    SurfaceScheduler.Uploads.Enqueue(this);
                    SurfaceScheduler.Uploads.RunNow(this);
                }
            }
            return IsDone && !_isStopped;
        }

        /// <summary>There is nothing to compute with, or no atoms to compute it of.</summary>
        public void FailToBegin(in QuickSesError error)
        {
            Drop();
            _isTried = true;
            _pending = SurfaceChange.None;
            Fail(true, error);
        }

        /// <summary>
        /// Ends the job, and forgets what it gave and is not shown yet; what is not finished begins again later.
        /// </summary>
        public void Drop()
        {
            EndJob();
            DropArrival();
        }

        /// <summary>Ends the job for good: nothing is computed until something changes.</summary>
        public void Stop()
        {
            Drop();
            _isStopped = _isTried = true;
            _pending = SurfaceChange.None;
        }

        /// <summary>No atoms and no surface; who shows it clears that.</summary>
        public void Clear()
        {
            Drop();
            _isHeldReady = false;
            Outdate();
            _pending = SurfaceChange.None;
            Atoms.Clear();
            CurrentLevel = default;
            LastError = default;
            _updated = _finished = _failed = false;
        }

        /// <summary>After <see cref="Drop"/>: what was not finished begins again.</summary>
        public void Resume()
        {
            if (Atoms.IsSet && !_isStopped && !IsDone)
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
            CurrentLevel = default;
            _host.OnDisposed();
        }

        // What is known of the newest atoms is of older ones from now on.
        private void Outdate() => _isTried = _isStopped = _isShown = _isJobOfNewest = _isArrivalOfNewest = false;

        // What never rests never gets creases.
        private bool IsBest(in SurfaceLevel level) => level.IsFinest &&
            (level.HasCreases || !_wantsCreases || double.IsInfinity(_host.RestDelay));

        private QueuePriority FindPriority(double now)
        {
            if (!Atoms.IsSet || _isStopped)
                return QueuePriority.None;
            if (!_isTried)
                return QueuePriority.Urgent;
            bool isDone = IsDone || (_isArrivalOfNewest && IsBest(_arrival));
            return !isDone && now - _lastChange >= _host.RestDelay ? QueuePriority.Refinement : QueuePriority.None;
        }

        private void BeginAgain(SurfaceChange change)
        {
            _isTried = false;
            if (change > _pending)
                _pending = change;
        }

        // That there is nothing to compute with is told once.
        private void Fail(bool isOfNewest, in QuickSesError error)
        {
            _isStopped |= isOfNewest;
            _failed |= error.Status != QuickSesStatus.BackendUnavailable || LastError.Status != error.Status;
            LastError = error;
        }
    }
}
