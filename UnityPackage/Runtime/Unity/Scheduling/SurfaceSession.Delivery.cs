// SPDX-License-Identifier: MIT
// Meshes that stay on the GPU: which do, and how they get into what is shown.
using System;
using System.Diagnostics;

namespace QuickSes
{
    internal sealed partial class SurfaceSession
    {
        // Below it a frame takes no longer by host memory: CUDA and the graphics API take turns, which costs time as well.
        private const long LargeMesh = 5000000, StillLargeMesh = 4000000; // bytes

        private bool _isJobForGpu; // whether its meshes are to stay there
        private bool _wantsHostMemory; // a job whose meshes were to stay there had no memory

        /// <summary>Why meshes are delivered in host memory; "": they stay on the GPU. No garbage.</summary>
        public string DeliveryReason
        {
            get
            {
                if (!GpuDelivery.IsPossible(out string reason))
                    return reason;
                if (_host.GpuRefusal.Length > 0)
                    return _host.GpuRefusal;
                if (UsedBackend == SurfaceBackend.Auto)
                    return "Nothing has been computed yet.";
                if (!GpuDelivery.Library.WorksWith(UsedBackend))
                    return "It is not CUDA that computes.";
                long bytes = BytesOf(_hasArrival ? _arrival : CurrentLevel);
                long least = _isJobForGpu ? StillLargeMesh : LargeMesh;
                return SurfaceScheduler.Delivery == SurfaceDelivery.Auto && bytes < least
                    ? "By host memory it takes no longer: the mesh is not large."
                    : "";
            }
        }

        /// <summary>In a new frame, of all surfaces, before anything of the frame is drawn: shows what is there.</summary>
        public void Deliver()
        {
            if (_host.IsGone)
                return;
            if (_slot != null && _isJobForGpu)
                Advance();
            if (_host.UsesGpu)
                Deliver(false);
        }

        private void DeliverNow()
        {
            Deliver(true);
            GpuDelivery.Issue();
        }

        private void Deliver(bool isUrgent)
        {
            long begin = Stopwatch.GetTimestamp();
            try
            {
                UploadStep step = _host.Deliver(isUrgent);
                ((IUploader)this).OnUploaded(step, UploadQueue.Milliseconds(Stopwatch.GetTimestamp() - begin));
            }
            catch (Exception e) // the device has failed, say
            {
                FailUpload(new QuickSesError(QuickSesStatus.InternalError, e.Message));
            }
        }

        // The GPU has no room for meshes; the host has.
        private void ComputeForHostMemory(string message)
        {
            _wantsHostMemory = true;
            _host.RefuseGpu(message);
            BeginAgain(_begunChange);
            Release(default);
        }
    }
}
