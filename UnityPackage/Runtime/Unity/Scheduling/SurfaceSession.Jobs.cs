// SPDX-License-Identifier: MIT
// The job of a surface: how it is begun, followed, and ended.
using System;

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
        private bool _isJobOfNewest; // whether it is of the newest atoms, colours and settings
        private bool _isJobOfShape; // maybe in other colours
        private SurfaceChange _begunChange; // what was new when it was begun

        private ReadOnlySpan<float> Ladder => new ReadOnlySpan<float>(_ladder, 0, _ladderCount);

        /// <summary>Begins a job with a context that is lent for it, or that it has.</summary>
        public void Start(ContextSlot slot) => TryStart(slot, false);

        /// <summary>The pool takes the context back, and frees it.</summary>
        public void LoseContext()
        {
            _slot = null;
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
                        NoteJob(settings.Tag);
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
            settings.Texcoords = Atoms.HasTexcoords;
            _ladderCount = SurfaceJobPlan.MakeLadder(levels, settings.Spacing, _ladder);
            if (isFinestOnly)
                settings.SetLevels(default);
            else
                SurfaceJobPlan.Choose(ref settings, Ladder, _pending,
                    _isShapeShown ? CurrentLevel.Spacing : float.PositiveInfinity, _host.FrameBudget,
                    Pool.IsAnyUrgent);
            return settings;
        }

        private void NoteJob(uint job)
        {
            _job = job;
            _isJobOfNewest = _isJobOfShape = true;
            Progress = 0;
        }

        // Shows what is ready, and gives the context back when the job is over.
        private void Advance()
        {
            SurfaceContext context = _slot.Context;
            bool hasShown = false;
            SurfaceProgress progress;
            do
            {
                if (context.TryCollect(out SurfaceMeshView mesh) && IsOurs(mesh))
                {
                    QuickSesError error = TryShow(mesh);
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
            if (!_isShown)
                BeginAgain(_begunChange);
        }

        // Not what the context's last user left behind. Numbers of jobs may wrap.
        private bool IsOurs(in SurfaceMeshView mesh) => unchecked((int)(mesh.Tag - _slot.FirstJob)) >= 0;

        private QuickSesError TryShow(in SurfaceMeshView mesh)
        {
            bool isLast = mesh.Tag == _job;
            _slot.Context.TryGetReport(out SurfaceReport report);
            try
            {
                CurrentLevel = _host.Show(mesh, report, Ladder, isLast && _isJobOfNewest);
            }
            catch (Exception e) // the engine refuses the mesh: it was made unreadable, say
            {
                return new QuickSesError(QuickSesStatus.InternalError, e.Message);
            }
            _isShown = isLast && _isJobOfNewest;
            _isShapeShown = isLast && _isJobOfShape;
            _updated = true;
            _finished = IsDone;
            if (!_isStopped)
                LastError = default;
            return default;
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
            Progress = 1;
        }
    }
}
