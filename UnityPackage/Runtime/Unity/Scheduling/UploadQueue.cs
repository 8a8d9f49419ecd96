// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using System.Diagnostics;

namespace QuickSes
{
    /// <summary>What came of one step of an upload.</summary>
    internal enum UploadStep
    {
        /// <summary>There is more to do.</summary>
        Unfinished,
        /// <summary>Nothing is left; the surface is the one before, maybe in other colours.</summary>
        Painted,
        /// <summary>Nothing is left; the same surface is in other buffers now.</summary>
        Moved,
        /// <summary>Nothing is left; a surface that was computed is shown now.</summary>
        Shown
    }

    /// <summary>What a step of an upload may do.</summary>
    internal readonly struct UploadShare
    {
        public UploadShare(long piece, long rest, UnmanagedBuffer<byte> room)
        {
            PieceBytes = piece;
            RestBytes = rest;
            Room = room;
        }

        /// <summary>Bytes of a piece, at most.</summary>
        public long PieceBytes { get; }

        /// <summary>Bytes that are expected to fit into what is left of the frame.</summary>
        public long RestBytes { get; }

        /// <summary>For what has to be made of a piece first; used by all in turn.</summary>
        public UnmanagedBuffer<byte> Room { get; }
    }

    /// <summary>Who has something to upload.</summary>
    internal interface IUploader
    {
        /// <summary>The queue's: whether it is in it.</summary>
        bool IsQueued { get; set; }

        /// <summary>The queue's: the last frame in which it finished something.</summary>
        uint LastUpload { get; set; }

        /// <summary>About how much it has to upload; 0: little.</summary>
        long Bytes { get; }

        /// <summary>The next step, which must not throw.</summary>
        /// <param name="share">What it may do.</param>
        /// <param name="bytes">What it did, as bytes that were written or looked at.</param>
        UploadStep Upload(in UploadShare share, out long bytes);

        /// <summary>That step took so many milliseconds.</summary>
        void OnUploaded(UploadStep step, double milliseconds);
    }

    /// <summary>
    /// The milliseconds per frame that uploads may take, and who waits for a part of them: oldest first, piece by piece,
    /// at least one piece in each frame, so that everybody's turn comes. The size of a piece follows the speed of the
    /// machine. Main thread only; no garbage once it has grown.
    /// </summary>
    internal sealed class UploadQueue
    {
        internal const long MinPiece = 32 << 10, MaxPiece = 512 << 10;
        private const int PiecesPerBudget = 8;
        private const double FirstGuess = 1e-6; // ms per byte: 1 GB/s, which any machine has
        private const double Slack = 1.5; // for pieces that take longer than the mean
        private const double Memory = 0.9; // of averages, for the next piece
        private const double LongestFrame = 100, FirstInterval = 1000.0 / 60; // ms

        private readonly List<IUploader> _waiting = new List<IUploader>(64); // oldest first
        private readonly Func<long> _clock; // as of Stopwatch
        private readonly UnmanagedBuffer<byte> _room = new UnmanagedBuffer<byte>();
        private uint _frame = 1;
        private int _engineFrame;
        private long _frameBegin;
        private double _interval = FirstInterval;
        private double _spent; // ms of this frame
        private bool _hasUploaded; // in this frame
        private double _millisecondsPerByte = FirstGuess;

        public UploadQueue(Func<long> clock = null)
        {
            _clock = clock ?? Stopwatch.GetTimestamp;
            _frameBegin = _clock();
        }

        /// <summary>Milliseconds per frame; 0: no limit.</summary>
        public double Budget { get; set; } = 2;

        public int Count => _waiting.Count;

        /// <summary>Bytes of a piece now.</summary>
        public long PieceBytes => Budget > 0
            ? Math.Min(MaxPiece, Math.Max(MinPiece, (long)(Budget / PiecesPerBudget / _millisecondsPerByte)))
            : MaxPiece;

        /// <summary>
        /// What it takes from a mesh in memory to a mesh that is shown, per 10^6 bytes, where nobody else uploads: with
        /// a budget, so many frames of which each lets a budget's worth of bytes through, at the speed of the last
        /// pieces and the interval of the last frames.
        /// </summary>
        public double MillisecondsPerMegabyte =>
            1e6 * _millisecondsPerByte * (Budget > 0 ? Math.Max(1, _interval / Budget) : 1);

        /// <summary>
        /// Somebody who is asked once per frame is asked: if in another frame of the engine than the one before, or for
        /// the second time (in edit mode nothing else tells), it is a new one.
        /// </summary>
        /// <returns>Whether it is a new one.</returns>
        public bool Note(int engineFrame, ref uint lastFrame)
        {
            bool isNew = engineFrame != _engineFrame || lastFrame == _frame;
            if (isNew)
                BeginFrame();
            _engineFrame = engineFrame;
            lastFrame = _frame;
            return isNew;
        }

        public void Enqueue(IUploader uploader)
        {
            if (uploader.IsQueued)
                return;
            uploader.IsQueued = true;
            _waiting.Add(uploader);
        }

        public void Remove(IUploader uploader)
        {
            if (!uploader.IsQueued)
                return;
            uploader.IsQueued = false;
            _waiting.Remove(uploader);
        }

        /// <summary>How many uploads of this one's size are waiting, its own counted; larger ones count once.</summary>
        public double ShareOf(IUploader uploader)
        {
            double share = 1;
            foreach (IUploader other in _waiting)
                if (other != uploader)
                    share += (double)Math.Min(other.Bytes, uploader.Bytes) / Math.Max(1, uploader.Bytes);
            return share;
        }

        /// <summary>Uploads what fits into this frame; who has finished something in it has to wait for the next.</summary>
        public void Run()
        {
            for (int k = 0; k < _waiting.Count && IsTimeLeft();)
            {
                IUploader uploader = _waiting[k];
                if (uploader.LastUpload == _frame)
                    ++k;
                else
                    Step(uploader, Budget > 0
                        ? Math.Max(PieceBytes, (long)((Budget - _spent) / _millisecondsPerByte))
                        : long.MaxValue);
            }
        }

        /// <summary>Uploads all there is of one, whatever it takes.</summary>
        public void RunNow(IUploader uploader)
        {
            while (uploader.IsQueued)
                Step(uploader, long.MaxValue);
        }

        /// <summary>Other work of the same kind, which does not wait.</summary>
        public void Charge(double milliseconds) => _spent += milliseconds;

        /// <summary>Nobody will upload soon.</summary>
        public void FreeRoom() => _room.Dispose();

        private bool IsTimeLeft() =>
            Budget <= 0 || !_hasUploaded || _spent + Slack * PieceBytes * _millisecondsPerByte <= Budget;

        private void BeginFrame()
        {
            ++_frame;
            _spent = 0;
            _hasUploaded = false;
            long now = _clock();
            _interval = Mean(_interval, Math.Min(LongestFrame, Milliseconds(now - _frameBegin)));
            _frameBegin = now;
        }

        private void Step(IUploader uploader, long rest)
        {
            long begin = _clock();
            UploadStep step = uploader.Upload(new UploadShare(PieceBytes, rest, _room), out long bytes);
            double milliseconds = Milliseconds(_clock() - begin);
            _spent += milliseconds;
            _hasUploaded |= bytes > 0;
            if (bytes >= MinPiece) // one that the system interrupted tells nothing, so it counts little
                _millisecondsPerByte = Mean(_millisecondsPerByte,
                    Math.Min(milliseconds / bytes, 4 * _millisecondsPerByte));
            if (step != UploadStep.Unfinished)
            {
                uploader.LastUpload = _frame;
                Remove(uploader);
            }
            uploader.OnUploaded(step, milliseconds);
        }

        private static double Mean(double mean, double value) => Memory * mean + (1 - Memory) * value;

        /// <summary>Of ticks of Stopwatch.</summary>
        public static double Milliseconds(long ticks) => ticks * 1000.0 / Stopwatch.Frequency;
    }
}
