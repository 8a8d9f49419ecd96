// SPDX-License-Identifier: MIT
// Surfaces that are kept on the GPU: shown without leaving it, or brought home.
using UnityEngine;

namespace QuickSes
{
    internal sealed partial class ShownSurface
    {
        private GpuMeshUploader _gpu; // null: not needed so far
        private bool _isArrivalForGpu; // and not to be uploaded
        private bool _staysOnGpu; // since it could not be brought home

        /// <summary>Whether what is shown is in buffers that C# has not filled.</summary>
        public bool IsOnGpu => _gpu != null && _gpu.IsShown;

        /// <summary>Why surfaces are to be delivered in host memory, if that is this one's own matter; else "".</summary>
        public string GpuRefusal => _gpu?.Reason ?? "";

        /// <summary>Bounds that the renderer has to have; null: those of the mesh.</summary>
        public Bounds? RendererBounds => IsOnGpu && _gpu.Front.HasBoundsInRenderer ? _gpu.Front.Bounds : default(Bounds?);

        /// <summary>As of <see cref="ISurfaceHost.UsesGpu"/>.</summary>
        public bool UsesGpu => _gpu != null;

        /// <summary>As of <see cref="ISurfaceHost.HasDelivery"/>.</summary>
        public bool HasDelivery =>
            _gpu != null && ((_hasArrival && _isArrivalForGpu) || _gpu.IsFollowing || MustPaintOnGpu);

        private bool MustLeaveGpu => IsOnGpu && !_staysOnGpu && !CanUseGpu;

        private bool MustPaintOnGpu => IsOnGpu && CanUseGpu && !_gpu.IsAsItShouldBe(StyleOf(_kept.View, Look));

        private bool CanUseGpu => _gpu.Reason.Length == 0 && GpuDelivery.IsPossible(out _);

        /// <summary>As of <see cref="ISurfaceHost.Deliver"/>.</summary>
        public UploadStep Deliver(bool isUrgent)
        {
            _gpu.Follow();
            if (_hasArrival && _isArrivalForGpu)
                return DeliverArrival(isUrgent);
            if (!MustPaintOnGpu)
                return UploadStep.Unfinished;
            Mesh before = Mesh;
            GpuStep step = _gpu.Show(_kept, Look, StyleOf(_kept.View, Look), isUrgent);
            return step != GpuStep.Shown ? UploadStep.Unfinished : Mesh == before ? UploadStep.Painted : UploadStep.Moved;
        }

        /// <summary>As of <see cref="ISurfaceHost.RefuseGpu"/>.</summary>
        public void RefuseGpu(string reason)
        {
            _gpu ??= new GpuMeshUploader();
            _gpu.Refuse(reason);
        }

        /// <summary>What failed is tried again.</summary>
        public void ForgiveGpu() => _gpu?.Forgive();

        private bool IsForGpu(KeptMesh mesh)
        {
            if (!GpuDelivery.Library.IsOnGpuOnly(mesh))
                return false;
            _gpu ??= new GpuMeshUploader();
            return CanUseGpu;
        }

        private UploadStep DeliverArrival(bool isUrgent)
        {
            GpuStep step = CanUseGpu
                ? _gpu.Show(_arriving, _arrivingLook, StyleOf(_arriving.View, _arrivingLook), isUrgent)
                : GpuStep.Refused;
            _isArrivalForGpu = step != GpuStep.Refused; // else it is uploaded
            if (step != GpuStep.Shown)
                return UploadStep.Unfinished;
            _front.FreeMesh();
            _front.Look = null;
            _back.FreeMesh();
            _isResting = false;
            return Arrive();
        }

        private static KeptMesh BroughtHome(KeptMesh mesh)
        {
            if (GpuDelivery.Library.IsOnGpuOnly(mesh))
            {
                QuickSesError error = GpuDelivery.Library.Download(mesh);
                if (error.Status != QuickSesStatus.Ok)
                    throw error.ToException();
            }
            return mesh;
        }
    }
}
