// SPDX-License-Identifier: MIT
using System;
using UnityEngine;

namespace QuickSes
{
    /// <summary>What came of a surface that is to be shown without leaving the GPU.</summary>
    internal enum GpuStep
    {
        /// <summary>It is to be shown from host memory: see <see cref="GpuMeshUploader.Reason"/>.</summary>
        Refused,
        /// <summary>Again in the next frame.</summary>
        Waiting,
        /// <summary>It is what is shown, from the next event on.</summary>
        Shown
    }

    /// <summary>
    /// Shows surfaces that stay on the GPU: of one component, beside what shows those from host memory. What fits into the
    /// buffers that are shown is written there, since events and draws keep their order; new buffers are shown when
    /// something is known to be in them. Who submits has to let an event be issued (<see cref="GpuDelivery.Issue"/>)
    /// before anything is drawn. Main thread only; no garbage once buffers are there.
    /// </summary>
    internal sealed class GpuMeshUploader : IDisposable
    {
        private const string Stopped =
            "No event of the thread that draws has run for a while, as while a window is minimised.";

        private IGpuTarget _target;
        private GivenLook _given; // to the target
        private GpuMesh _front; // what is shown, or was before it was hidden
        private GpuMesh _back; // in new buffers; or buffers that are not needed any more, until no event can write them
        private KeptMesh _awaited; // what the back waits for; null: nothing
        private int _done; // the last event that is known to have run
        private bool _isBusy; // what was to be submitted has to wait
        private bool _isFollowing; // events have not run yet
        private bool _isFrontLost; // what is shown was let go on its way into the buffers
        private bool _isStopped;
        private string _reason = "";
        private uint _version; // of GpuDelivery, that the reason is of

        /// <summary>Why surfaces are to be shown from host memory; "": they need not.</summary>
        public string Reason => _version != GpuDelivery.Version ? "" :
            _reason.Length > 0 ? _reason :
            _isStopped ? Stopped : "";

        /// <summary>Whether a surface is shown by it.</summary>
        public bool IsShown { get; private set; }

        /// <summary>What is shown.</summary>
        public GpuMesh Front => IsShown ? _front : null;

        /// <summary>Whether it has to be asked again in the next frame before anything newer can be shown.</summary>
        public bool IsWaiting => _isBusy || _awaited != null;

        /// <summary>Whether what was submitted is not known to have arrived yet.</summary>
        public bool IsFollowing => _isFollowing && !_isStopped;

        /// <summary>Once per frame: how the events of the frames before ended.</summary>
        public void Follow()
        {
            if (_version != GpuDelivery.Version)
                Forgive();
            if (_target == null || !(_isFollowing || _isStopped))
                return;
            GpuTargetStatus status = _target.GetStatus();
            _isStopped = status.IsStopped;
            _isFollowing = status.Waiting > 0;
            bool hasRun = status.Done != _done; // else the failure is one that was told
            _done = status.Done;
            if (status.Error.Status != QuickSesStatus.Ok && hasRun)
                Refuse(status.Error.Message);
            else if (_isStopped || status.IsNewestLost)
                Forget(); // who wants it still submits it again
            else if (!_isFollowing && !IsWaiting)
                FreeBack();
            _isFrontLost |= IsShown && status.IsNewestLost;
        }

        /// <summary>Shows a surface, or the one that is shown as it looks now; not where there is a reason not to.</summary>
        /// <param name="surface">Stays as it is until it is shown, or refused, or <see cref="Forget"/>.</param>
        /// <param name="look">Of its atoms.</param>
        /// <param name="style">For it.</param>
        /// <param name="isUrgent">Whether it is to be shown at once, without knowing whether it arrives, or refused.</param>
        public GpuStep Show(KeptMesh surface, AtomLook look, MeshStyle style, bool isUrgent)
        {
            if (_awaited == surface && !isUrgent)
                return ShowAwaited(look);
            SurfaceMeshView view = surface.View;
            try
            {
                _target ??= NewTarget();
                GpuMesh mesh = MeshFor(view, style);
                QuickSesError error = Submit(surface, look, mesh);
                _isBusy = error.Status == QuickSesStatus.Busy;
                if (_isBusy)
                    return isUrgent ? GpuStep.Refused : GpuStep.Waiting;
                if (error.Status != QuickSesStatus.Ok)
                    return Refuse(error.Message);
                _isFollowing = true;
                _awaited = null;
                if (mesh == _front || isUrgent)
                    return Draw(mesh, view, look);
                _awaited = surface;
                return GpuStep.Waiting;
            }
            catch (Exception e) // the engine has no such buffers, say
            {
                return Refuse(e.Message);
            }
        }

        /// <summary>Whether what is shown looks as it should, in buffers as they should be.</summary>
        public bool IsAsItShouldBe(MeshStyle style) => !_isFrontLost && _front.FitsTo(style, SurfaceScheduler.GpuMeshPlan) &&
            _front.Given.Equals(new GivenLook(_front.Look, style.HasAtoms));

        /// <summary>What waits is not wanted any more; what is shown stays.</summary>
        public void Forget()
        {
            _awaited = null;
            _isBusy = false;
        }

        /// <summary>
        /// What is shown is another mesh from now on. Buffers stay where surfaces are expected to come back.
        /// </summary>
        public void Hide()
        {
            IsShown = false;
            if (!_isStopped)
                Free();
        }

        /// <summary>Nothing is shown by it until the delivery is chosen again, or <see cref="Forgive"/>.</summary>
        public GpuStep Refuse(string reason)
        {
            Forget();
            _reason = reason;
            _version = GpuDelivery.Version;
            return GpuStep.Refused;
        }

        /// <summary>What failed is tried again.</summary>
        public void Forgive()
        {
            if (_reason.Length > 0 && !IsShown)
                Free(); // the target knows the failure
            _reason = "";
            _version = GpuDelivery.Version;
        }

        public void Dispose()
        {
            IsShown = false;
            Free();
        }

        private IGpuTarget NewTarget()
        {
            IGpuTarget target = GpuDelivery.Library.NewTarget();
            ++GpuDelivery.Targets;
            _given = default;
            return target;
        }

        private GpuMesh MeshFor(in SurfaceMeshView view, MeshStyle style)
        {
            GpuMeshPlan plan = SurfaceScheduler.GpuMeshPlan;
            if (_front != null && _front.Suffices(view, style, plan))
                return _front;
            if (_back == null || !_back.Suffices(view, style, plan))
            {
                FreeBack();
                _back = new GpuMesh(view, style, plan);
            }
            return _back;
        }

        private QuickSesError Submit(KeptMesh surface, AtomLook look, GpuMesh mesh)
        {
            var given = new GivenLook(look, mesh.Style.HasAtoms);
            if (!given.Equals(_given))
            {
                QuickSesError error = _target.SetLook(look.Count, mesh.Style.HasAtoms ? default : look.Colors,
                    mesh.Style.HasTexcoords ? look.Texcoords : default, mesh.Style.HasAtoms ? default : look.Visible);
                if (error.Status != QuickSesStatus.Ok)
                    return error;
                _given = given;
            }
            return _target.Submit(surface, mesh.Buffers);
        }

        private GpuStep ShowAwaited(AtomLook look)
        {
            if (_isFollowing)
                return GpuStep.Waiting; // it was the last that was submitted
            SurfaceMeshView view = _awaited.View;
            _awaited = null;
            Draw(_back, view, look);
            FreeBack();
            return GpuStep.Shown;
        }

        private GpuStep Draw(GpuMesh mesh, in SurfaceMeshView view, AtomLook look)
        {
            if (mesh == _back)
                (_front, _back) = (_back, _front);
            IsShown = true;
            _isFrontLost = false;
            _front.Draw(view, look, _given);
            return GpuStep.Shown;
        }

        private void FreeBack()
        {
            _back?.Dispose();
            _back = null;
        }

        // The thread that draws lets go of the buffers before they are deleted.
        private void Free()
        {
            Forget();
            if (_target != null)
            {
                _target.Dispose();
                _target = null;
                --GpuDelivery.Targets;
                GpuDelivery.Issue();
            }
            FreeBack();
            _front?.Dispose();
            _front = null;
            _isFollowing = _isStopped = _isFrontLost = false;
        }
    }
}
