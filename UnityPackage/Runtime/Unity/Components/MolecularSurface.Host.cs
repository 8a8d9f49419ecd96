// SPDX-License-Identifier: MIT
// What the session asks and tells.
using System;
using UnityEngine;

namespace QuickSes
{
    public sealed partial class MolecularSurface : ISurfaceHost
    {
        private QuickSesError _loggedFailure; // since a surface came last

        // The engine tells components that were never enabled nothing, not even that they are destroyed.
        bool ISurfaceHost.IsGone => this == null;

        SurfaceSettings ISurfaceHost.MakeSettings(out ReadOnlySpan<float> levels)
        {
            SurfaceSettings settings = SurfaceSettings.Default;
            settings.Surface = _surface;
            settings.Method = _surface == SurfaceKind.Ses ? _method : SurfaceMethod.Exact;
            settings.ProbeRadius = _probeRadius;
            settings.Spacing = _spacing;
            settings.RelaxationSteps = (uint)_relaxationSteps;
            settings.VertexLayout = SurfaceVertexLayout.Interleaved;
            settings.Components = _measureComponents;
            levels = _levels;
            return settings;
        }

        SurfaceLevel ISurfaceHost.Show(in SurfaceMeshView mesh, in SurfaceReport report, ReadOnlySpan<float> ladder,
            bool isOfNewestAtoms)
        {
            SurfaceLevel level = _shown.Show(mesh, report, ladder, isOfNewestAtoms, _padBuffers);
            if (_shown.TakeIsNewMesh() || !_isMeshAttached)
                AttachMesh();
            return level;
        }

        void ISurfaceHost.OnUpdated(in SurfaceLevel level)
        {
            _loggedFailure = default;
            SurfaceUpdated?.Invoke(level);
            if (this != null) // handlers may destroy it
                _events.SurfaceUpdated.Invoke();
        }

        void ISurfaceHost.OnFinished()
        {
            RefinementFinished?.Invoke();
            if (this != null)
                _events.RefinementFinished.Invoke();
        }

        void ISurfaceHost.OnFailed(in QuickSesError error)
        {
            if (Failed == null && _events.Failed.GetPersistentEventCount() == 0 && IsNewInTheLog(error))
                Debug.LogError($"{name}: {error.Message}", this);
            Failed?.Invoke(error);
            if (this != null)
                _events.Failed.Invoke(error.Message);
        }

        void ISurfaceHost.OnDisposed() => _shown.Dispose();

        // Bad frames of a trajectory come at its rate, each with the number of another atom: one line for all of them, until
        // a surface comes again. Files that can't be read are few, and each has its own line.
        private bool IsNewInTheLog(in QuickSesError error)
        {
            bool isNew = error.Status != _loggedFailure.Status ||
                (error.Status == QuickSesStatus.FileError && error.Message != _loggedFailure.Message);
            _loggedFailure = error;
            return isNew;
        }
    }
}
