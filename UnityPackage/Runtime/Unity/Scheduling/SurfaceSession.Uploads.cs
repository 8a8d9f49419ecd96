// SPDX-License-Identifier: MIT
// The mesh that a job gave: how it gets from the context into what is shown, in its turn.
using System;
using System.Diagnostics;

namespace QuickSes
{
    internal sealed partial class SurfaceSession
    {
        private const double ShareMemory = 0.5; // of a mean over surfaces
        private const double MaxShowMilliseconds = 60000; // the library's limit
        private const long VertexBytes = 28, TriangleBytes = 12; // about

        private bool _hasArrival; // a mesh the host has taken and does not show yet
        private SurfaceLevel _arrival;
        private bool _isArrivalOfNewest;
        private long _arrivalTime;
        private double _uploadMilliseconds; // what the arrival has taken so far
        private double _share = 1; // how many surfaces of this size are uploaded at a time
        private bool _isHeldReady; // buffers are held for more of its kind, until it rests
        private bool _hasArrived; // since the last tick
        private double _lastArrival;
        private uint _lastTick;

        bool IUploader.IsQueued { get; set; }

        uint IUploader.LastUpload { get; set; }

        long IUploader.Bytes => _hasArrival ? BytesOf(_arrival) : 0;

        UploadStep IUploader.Upload(in UploadShare share, out long bytes)
        {
            bytes = 0;
            if (_host.IsGone)
                return UploadStep.Painted;
            try
            {
                return _host.Upload(share, out bytes);
            }
            catch (Exception e) // the engine refuses the mesh: it was made unreadable, say
            {
                FailUpload(new QuickSesError(QuickSesStatus.InternalError, e.Message));
                return UploadStep.Painted;
            }
        }

        void IUploader.OnUploaded(UploadStep step, double milliseconds)
        {
            _uploadMilliseconds += milliseconds;
            if (step == UploadStep.Shown)
                Arrive();
            else
                _updated |= step == UploadStep.Moved;
        }

        private QuickSesError TryTake(in SurfaceMeshView mesh)
        {
            bool isLast = mesh.Tag == _job;
            bool isMoving = !isLast || _begunChange == SurfaceChange.Positions;
            _slot.Context.TryGetReport(out SurfaceReport report);
            JobLook look = TakeLook(mesh.Tag);
            var arrival = new SurfaceLevel(mesh, report, Ladder, look.HasCreases); // the view ends when the host takes the mesh
            try
            {
                _host.Take(_slot.Context, look.Look, isMoving);
            }
            catch (Exception e) // there is no memory, say
            {
                return new QuickSesError(QuickSesStatus.InternalError, e.Message);
            }
            if (!_hasArrival)
                _arrivalTime = Stopwatch.GetTimestamp();
            _arrival = arrival;
            _hasArrival = true;
            _isArrivalOfNewest = isLast && _isJobOfNewest;
            _isHeldReady |= isMoving;
            _uploadMilliseconds = 0;
            _share = ShareMemory * _share + (1 - ShareMemory) * SurfaceScheduler.Uploads.ShareOf(this);
            return default;
        }

        private void Arrive()
        {
            CurrentLevel = new SurfaceLevel(_arrival, _isArrivalOfNewest, _uploadMilliseconds,
                UploadQueue.Milliseconds(Stopwatch.GetTimestamp() - _arrivalTime));
            _isShown = _isArrivalOfNewest;
            ForgetArrival();
            _hasArrived = _updated = true;
            _finished = IsDone;
            if (!_isStopped)
                LastError = default;
        }

        private void DropArrival()
        {
            ForgetArrival();
            SurfaceScheduler.Uploads.Remove(this);
            _host.DropUpload();
        }

        private void ForgetArrival() => _hasArrival = _isArrivalOfNewest = false;

        private void FailUpload(in QuickSesError error)
        {
            bool isOfNewest = !_hasArrival || _isJobOfNewest;
            Drop();
            Fail(isOfNewest, error);
        }

        // What levels cost the user beside computing, for the choice among them: the speed of the last uploads, the part of
        // a frame that they may take, and that part shared with those that wait too: each delays this one by no more than
        // its own size, since pieces of larger ones that come later wait behind it.
        private float ShowMillisecondsPerMegabyte() =>
            (float)Math.Min(MaxShowMilliseconds, SurfaceScheduler.Uploads.MillisecondsPerMegabyte * _share);

        private static long BytesOf(in SurfaceLevel level) =>
            VertexBytes * level.VertexCount + TriangleBytes * level.TriangleCount;
    }
}
