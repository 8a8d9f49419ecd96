// SPDX-License-Identifier: MIT
// The job of a surface: how it is begun, followed, and ended.
using System;
using System.Collections.Generic;

namespace QuickSes
{
    internal sealed partial class SurfaceSession
    {
        private static uint s_sessions;

        private readonly uint _series = ++s_sessions;
        private readonly float[] _ladder = new float[SurfaceSettings.MaxLevels + 1]; // as the last job was begun with
        private int _ladderCount = 1;
        private ContextSlot _slot; // while a job runs
        private uint _job; // the last that was begun
        private bool _isJobOfNewest; // whether it is of the newest atoms and settings
        private bool _wantsCreases; // for the finest level, when atoms rest
        private SurfaceChange _begunChange; // what was new when it was begun
        private readonly List<JobLook> _looks = new List<JobLook>(4); // of the jobs whose meshes may still come

        // The look of the atoms of a job and of those after it, up to the next entry.
        private readonly struct JobLook
        {
            public JobLook(uint firstJob, AtomLook look, bool hasCreases)
            {
                FirstJob = firstJob;
                Look = look;
                HasCreases = hasCreases;
            }

            public uint FirstJob { get; }

            public AtomLook Look { get; }

            public bool HasCreases { get; } // at the finest level
        }

        private ReadOnlySpan<float> Ladder => new ReadOnlySpan<float>(_ladder, 0, _ladderCount);

        /// <summary>Begins a job with a context that is lent for it, or that it has.</summary>
        public void Start(ContextSlot slot) => TryStart(slot, false);

        /// <summary>The pool takes the context back, and frees it.</summary>
        public void LoseContext()
        {
            _slot = null;
            ForgetLooks();
            BeginAgain(SurfaceChange.Shape);
        }

        private bool TryStart(ContextSlot slot, bool isFinestOnly)
        {
            bool replaces = _slot == slot;
            _slot = slot;
            UsedBackend = slot.Context.Backend;
            UsedDevice = slot.Context.Description;
            QuickSesError error = TryBegin(slot.Context, isFinestOnly);
            _isTried = true;
            _begunChange = _pending;
            _pending = SurfaceChange.None;
            if (error.Status == QuickSesStatus.Ok)
                return true;
            Fail(true, error);
            if (!replaces) // else the job of the atoms before goes on
                Release(error);
            return false;
        }

        private QuickSesError TryBegin(SurfaceContext context, bool isFinestOnly)
        {
            try
            {
                QuickSesStatus status = Atoms.Send(_slot);
                if (status == QuickSesStatus.Ok)
                {
                    SurfaceSettings settings = MakeSettings(isFinestOnly);
                    status = context.Begin(settings);
                    if (status == QuickSesStatus.Ok)
                        NoteJob(settings.Tag, settings.Creases);
                }
                return status == QuickSesStatus.Ok ? default : new QuickSesError(status, context.LastError);
            }
            catch (QuickSesException e) // an atom or a setting is wrong
            {
                return new QuickSesError(e.Status, e.Message);
            }
        }

        private SurfaceSettings MakeSettings(bool isFinestOnly)
        {
            SurfaceSettings settings = _host.MakeSettings(out ReadOnlySpan<float> levels);
            settings.Tag = SurfaceScheduler.NextJob();
            settings.Series = _series;
            settings.Pickable = true;
            _isJobForGpu = DeliveryReason.Length == 0;
            _wantsHostMemory = false;
            if (_isJobForGpu)
                settings.Delivery = GpuDelivery.Library.Delivery; // and showing it takes nothing
            else
                settings.ShowMillisecondsPerMegabyte = ShowMillisecondsPerMegabyte();
            _ladderCount = SurfaceJobPlan.MakeLadder(levels, settings.Spacing, _ladder);
            _wantsCreases = settings.Creases;
            if (isFinestOnly)
                settings.SetLevels(default);
            else
                SurfaceJobPlan.Choose(ref settings, Ladder, _pending,
                    _isArrivalOfNewest ? _arrival.Spacing :
                    _isShown ? CurrentLevel.Spacing : float.PositiveInfinity, _host.FrameBudget,
                    Pool.IsAnyUrgent);
            return settings;
        }

        private void NoteJob(uint job, bool hasCreases)
        {
            _job = job;
            NoteLook(job, hasCreases);
            _isJobOfNewest = true;
            Progress = 0;
        }

        // Takes what is ready, and gives the context back when the job is over. What is ready while an upload is under way
        // stays with the context, where newer ones replace it, and the context with the session.
        private void Advance()
        {
            SurfaceContext context = _slot.Context;
            bool hasTaken = false;
            SurfaceProgress progress;
            do
            {
                if (!_host.IsUploading && context.TryCollect(out SurfaceMeshView mesh) && IsOurs(mesh))
                {
                    QuickSesError error = TryTake(mesh);
                    if (error.Status != QuickSesStatus.Ok)
                    {
                        context.Cancel();
                        FailJob(error);
                        return;
                    }
                    hasTaken = true;
                }
                context.Poll(out progress);
            } while (progress.IsMeshReady && !_host.IsUploading);
            Progress = progress.Fraction;
            if (progress.State == SurfaceJobState.Running)
            {
                if (hasTaken && Pool.IsAnyUrgent)
                    Yield();
            }
            else if (progress.IsMeshReady)
            {
                return;
            }
            else if (progress.State == SurfaceJobState.Failed && _isJobForGpu &&
                progress.Status == QuickSesStatus.OutOfMemory)
            {
                ComputeForHostMemory(progress.Message);
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
            EndJob();
            if (!_isShown && !_isArrivalOfNewest)
                BeginAgain(_begunChange);
        }

        // Not what the context's last user left behind. Numbers of jobs may wrap.
        private bool IsOurs(in SurfaceMeshView mesh) => unchecked((int)(mesh.Tag - _slot.FirstJob)) >= 0;

        private void NoteLook(uint job, bool hasCreases)
        {
            AtomLook look = Atoms.Look;
            if (_looks.Count > 0 && _looks[_looks.Count - 1].Look == look &&
                _looks[_looks.Count - 1].HasCreases == hasCreases)
                return;
            // Jobs between the one that runs and this one never began.
            _slot.Context.Poll(out SurfaceProgress progress);
            int running = LookOf(progress.Tag);
            while (_looks.Count > Math.Max(1, running + 1))
            {
                _looks[_looks.Count - 1].Look.Release();
                _looks.RemoveAt(_looks.Count - 1);
            }
            _looks.Add(new JobLook(job, look.Hold(), hasCreases));
        }

        // Of a job whose mesh has come; those of older ones are not needed any more.
        private JobLook TakeLook(uint job)
        {
            int place = Math.Max(0, LookOf(job));
            JobLook look = _looks[place];
            for (int k = 0; k < place; ++k)
                _looks[k].Look.Release();
            _looks.RemoveRange(0, place);
            return look;
        }

        // Numbers of jobs may wrap.
        private int LookOf(uint job)
        {
            int place = _looks.Count - 1;
            while (place >= 0 && unchecked((int)(job - _looks[place].FirstJob)) < 0)
                --place;
            return place;
        }

        private void ForgetLooks()
        {
            foreach (JobLook job in _looks)
                job.Look.Release();
            _looks.Clear();
        }

        private void EndJob()
        {
            QueuedAs = QueuePriority.None;
            if (_slot == null)
                return;
            _slot.Context.Cancel();
            Release(default);
        }

        private void FailJob(in QuickSesError error)
        {
            Fail(_isJobOfNewest, error);
            Release(error);
        }

        private void Release(in QuickSesError error)
        {
            Pool.Release(_slot, error.Status == QuickSesStatus.DeviceError);
            _slot = null;
            ForgetLooks();
            Progress = 1;
        }
    }
}
