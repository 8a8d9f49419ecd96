// SPDX-License-Identifier: MIT
// What the session asks and tells.
using System;
using System.Diagnostics;
using UnityEngine;
using Debug = UnityEngine.Debug;

namespace QuickSes
{
    public sealed partial class MolecularSurface : ISurfaceHost
    {
        private QuickSesError _loggedFailure; // since a surface came last
        private bool _hasRendererBounds;

        // The engine tells components that were never enabled nothing, not even that they are destroyed.
        bool ISurfaceHost.IsGone => this == null;

        int ISurfaceHost.Frame => Time.frameCount;

        SurfaceSettings ISurfaceHost.MakeSettings(out ReadOnlySpan<float> levels)
        {
            SurfaceSettings settings = SurfaceSettings.Default;
            settings.Surface = _surface;
            settings.Method = _surface == SurfaceKind.Ses ? _method : SurfaceMethod.Exact;
            settings.ProbeRadius = _probeRadius;
            settings.Spacing = _spacing;
            settings.RelaxationSteps = (uint)_relaxationSteps;
            settings.VertexLayout =
                _compactVertices ? SurfaceVertexLayout.Compact : SurfaceVertexLayout.Interleaved;
            settings.Creases = settings.HardEdges = _sharpCreases &&
                settings.Method == SurfaceMethod.Exact && _surface != SurfaceKind.Gaussian;
            settings.GaussianRadiusScale = _gaussianRadiusScale;
            settings.GaussianIsovalue = _gaussianIsovalue;
            settings.Occlusion = _ambientOcclusion;
            settings.Components = _measureComponents;
            levels = _levels;
            return settings;
        }

        bool ISurfaceHost.IsUploading => _shown.IsUploading;

        bool ISurfaceHost.HasUpload => _shown.HasUpload;

        void ISurfaceHost.Take(SurfaceContext context, AtomLook look, bool isMoving) =>
            _shown.Take(context, look, isMoving);

        UploadStep ISurfaceHost.Upload(in UploadShare share, out long bytes)
        {
            _shown.UsesTexture = UsesTexture();
            Mesh before = _shown.MeshIfMade;
            UploadStep step = _shown.Upload(share, out bytes);
            Follow(step, before);
            return step;
        }

        bool ISurfaceHost.HasDelivery => _shown.HasDelivery;

        bool ISurfaceHost.UsesGpu => _shown.UsesGpu;

        UploadStep ISurfaceHost.Deliver(bool isUrgent)
        {
            _shown.UsesTexture = UsesTexture();
            Mesh before = _shown.MeshIfMade;
            UploadStep step = _shown.Deliver(isUrgent);
            Follow(step, before);
            return step;
        }

        string ISurfaceHost.GpuRefusal => _shown.GpuRefusal;

        void ISurfaceHost.RefuseGpu(string reason) => _shown.RefuseGpu(reason);

        void ISurfaceHost.DropUpload() => _shown.DropUpload();

        void ISurfaceHost.Rest() => _shown.Rest();

        void ISurfaceHost.OnUpdated(in SurfaceLevel level)
        {
            _loggedFailure = default;
            _updated.Tell(level, this);
            WiredListeners.Tell(_events.SurfaceUpdated, this);
        }

        void ISurfaceHost.OnFinished()
        {
            _finished.Tell(this);
            WiredListeners.Tell(_events.RefinementFinished, this);
        }

        void ISurfaceHost.OnFailed(in QuickSesError error)
        {
            if (!_failed.IsAny && !WiredListeners.AreAnyCalled(_events.Failed) && IsNewInTheLog(error))
                Debug.LogError($"{name}: {error.Message}", this);
            _failed.Tell(error, this);
            WiredListeners.Tell(_events.Failed, error.Message, this);
        }

        void ISurfaceHost.OnDisposed()
        {
            _texture?.Hide();
            _texture?.Dispose();
            _texture = null;
            if (_hasRendererBounds && _renderer != null)
                _renderer.ResetLocalBounds();
            _hasRendererBounds = false;
            ForgetOwners();
            _shown.Dispose();
        }

        private MeshRenderer OwnRenderer =>
            _renderer != null ? _renderer : _renderer = GetComponent<MeshRenderer>();

        private bool UsesTexture() => _coloring != AtomColoring.Vertices &&
            (_coloring == AtomColoring.Texture || AtomColorTexture.IsUsedBy(OwnRenderer.sharedMaterial, AtomCount));

        private void Follow(UploadStep step, Mesh before)
        {
            if (step != UploadStep.Shown && step != UploadStep.Moved)
                return;
            ForgetOwners(); // they have ended
            FollowMesh(before);
            FollowBounds();
            ShowColors();
        }

        // What the renderer is told of the component's own mesh holds for no other that somebody puts into the filter.
        private void FollowFilter()
        {
            if (_hasRendererBounds != BoundsForRenderer.HasValue)
                FollowBounds();
            ShowColors();
        }

        private bool ShowsOwnMesh =>
            _shown.MeshIfMade is Mesh mesh && GetComponent<MeshFilter>().sharedMesh == mesh;

        // Of a mesh that tells nothing of its own.
        private Bounds? BoundsForRenderer => _shown.RendererBounds.HasValue && ShowsOwnMesh ? _shown.RendererBounds : null;

        private void FollowBounds()
        {
            if (BoundsForRenderer is Bounds bounds)
                OwnRenderer.localBounds = bounds;
            else if (_hasRendererBounds)
                OwnRenderer.ResetLocalBounds();
            _hasRendererBounds = BoundsForRenderer.HasValue;
        }

        // The filter of a component that was never enabled may have somebody else's mesh, and scripts may have given it
        // one on purpose.
        private void FollowMesh(Mesh before)
        {
            var filter = GetComponent<MeshFilter>();
            Mesh present = filter.sharedMesh;
            if (!_isMeshAttached || present == null || present == before)
                AttachMesh();
        }

        // What follows the look at once; the rest is uploaded in its turn.
        private void ShowColors()
        {
            _shown.UsesTexture = UsesTexture();
            if (_shown.HasAtoms && ShowsOwnMesh)
            {
                long begin = Stopwatch.GetTimestamp();
                _texture ??= new AtomColorTexture();
                if (_texture.Show(OwnRenderer, _shown.Look))
                    SurfaceScheduler.Uploads.Charge(UploadQueue.Milliseconds(Stopwatch.GetTimestamp() - begin));
            }
            else if (_texture != null)
            {
                _texture.Hide();
                _texture.Dispose();
                _texture = null;
            }
        }

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
