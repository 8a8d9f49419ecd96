// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections.Generic;
using System.Diagnostics;

namespace QuickSes.Tests
{
    /// <summary>Who may upload how much in which frame; with a clock that uploads move.</summary>
    internal sealed class UploadQueueTest
    {
        private const double MillisecondsPerByte = 1e-6;

        private UploadQueue _queue;
        private double _now; // ms
        private int _frame;
        private uint _lastFrame;
        private readonly List<Upload> _served = new List<Upload>(); // a piece each

        [SetUp]
        public void SetUp()
        {
            _now = 0;
            _queue = new UploadQueue(() => (long)(_now * Stopwatch.Frequency / 1000));
            _served.Clear();
        }

        [TearDown]
        public void TearDown() => _queue.FreeRoom();

        [Test]
        public void NoFrameTakesMoreThanTheBudget()
        {
            for (int k = 0; k < 5; ++k)
                _queue.Enqueue(new Upload(this, 20 << 20));
            int frames = 0;
            while (_queue.Count > 0)
            {
                double spent = NextFrame();
                Assert.That(spent, Is.LessThanOrEqualTo(2.001));
                Assert.That(spent, Is.GreaterThan(_queue.Count > 0 ? 1.2 : 0), "nor much less");
                ++frames;
            }
            Assert.That(frames, Is.InRange(52, 90), "105 ms of work");
        }

        [Test]
        public void ASlowMachineHasSmallerPieces()
        {
            long before = _queue.PieceBytes;
            _queue.Enqueue(new Upload(this, 20 << 20, 10 * MillisecondsPerByte));
            for (int k = 0; k < 40; ++k)
                NextFrame();
            Assert.That(_queue.PieceBytes, Is.LessThan(before / 5));
            Assert.That(_queue.PieceBytes, Is.GreaterThanOrEqualTo(UploadQueue.MinPiece));
            Assert.That(NextFrame(), Is.LessThanOrEqualTo(2.001));
        }

        [Test]
        public void APieceGoesThroughHoweverSlowItIs()
        {
            var upload = new Upload(this, 1 << 20, 1000 * MillisecondsPerByte); // 32 KiB take 33 ms
            _queue.Enqueue(upload);
            int frames = 0;
            while (_queue.Count > 0)
            {
                int served = _served.Count;
                NextFrame();
                Assert.That(_served.Count, Is.GreaterThan(served));
                Assert.That(++frames, Is.LessThanOrEqualTo(32));
            }
        }

        [Test]
        public void WhatTheSystemInterruptsOrIsTinyTellsLittleOfTheSpeed()
        {
            long before = _queue.PieceBytes;
            _queue.Enqueue(new Upload(this, UploadQueue.MinPiece - 1, 1000 * MillisecondsPerByte));
            NextFrame();
            Assert.That(_queue.PieceBytes, Is.EqualTo(before));
            _queue.Enqueue(new Upload(this, UploadQueue.MinPiece, 1000 * MillisecondsPerByte));
            NextFrame();
            Assert.That(_queue.PieceBytes, Is.InRange(before / 2, before - 1));
        }

        [Test]
        public void APauseOfTheGameIsNoLongFrame()
        {
            for (int frame = 0; frame < 100; ++frame)
                NextFrame();
            double before = _queue.MillisecondsPerMegabyte;
            _now += 3600e3;
            NextFrame();
            Assert.That(_queue.MillisecondsPerMegabyte, Is.InRange(before, 2 * before));
        }

        [Test]
        public void TheOldestComesFirst()
        {
            var uploads = new[] { new Upload(this, 5 << 20), new Upload(this, 1 << 10), new Upload(this, 5 << 20) };
            foreach (Upload upload in uploads)
                _queue.Enqueue(upload);
            while (_queue.Count > 0)
                NextFrame();
            for (int k = 1; k < _served.Count; ++k)
                Assert.That(Array.IndexOf(uploads, _served[k]),
                    Is.GreaterThanOrEqualTo(Array.IndexOf(uploads, _served[k - 1])));
        }

        [Test]
        public void ThirtyThatNeverStopAllHaveTheirTurn()
        {
            var uploads = new Upload[30];
            for (int k = 0; k < uploads.Length; ++k)
                _queue.Enqueue(uploads[k] = new Upload(this, 3 << 20));
            for (int frame = 0; frame < 600; ++frame)
            {
                NextFrame();
                foreach (Upload upload in uploads)
                    if (!upload.IsQueued)
                        _queue.Enqueue(upload);
            }
            foreach (Upload upload in uploads)
                Assert.That(upload.Finished, Is.InRange(8, 16), "all the same number of times");
        }

        [Test]
        public void NobodyFinishesTwiceInAFrame()
        {
            var upload = new Upload(this, 1 << 10);
            for (int round = 0; round < 5; ++round)
            {
                _queue.Enqueue(upload);
                NextFrame();
                Assert.That(upload.Finished, Is.EqualTo(round + 1));
                _queue.Enqueue(upload);
                _queue.Run();
                Assert.That(upload.Finished, Is.EqualTo(round + 1));
                _queue.Remove(upload);
            }
        }

        [Test]
        public void WithoutABudgetEverythingIsUploadedAtOnce()
        {
            _queue.Budget = 0;
            for (int k = 0; k < 5; ++k)
                _queue.Enqueue(new Upload(this, 50 << 20));
            NextFrame();
            Assert.That(_queue.Count, Is.EqualTo(0));
        }

        [Test]
        public void WhoCantWaitIsUploadedAtOnce()
        {
            _queue.Enqueue(new Upload(this, 50 << 20));
            var upload = new Upload(this, 50 << 20);
            _queue.Enqueue(upload);
            _queue.RunNow(upload);
            Assert.That(upload.Finished, Is.EqualTo(1));
            Assert.That(_queue.Count, Is.EqualTo(1));
        }

        [Test]
        public void WhoLeavesIsNotServed()
        {
            var upload = new Upload(this, 1 << 10);
            _queue.Enqueue(upload);
            _queue.Enqueue(upload);
            Assert.That(_queue.Count, Is.EqualTo(1));
            _queue.Remove(upload);
            _queue.Remove(upload);
            NextFrame();
            Assert.That(_served, Is.Empty);
        }

        [Test]
        public void WithoutFramesOfTheEngineWhoComesAgainBeginsOne()
        {
            uint a = 0, b = 0;
            _queue.Budget = 1e-9; // a piece per frame
            _queue.Enqueue(new Upload(this, 100 << 20));
            for (int frame = 0; frame < 5; ++frame)
            {
                _queue.Note(0, ref a);
                _queue.Run();
                _queue.Note(0, ref b);
                _queue.Run();
                Assert.That(_served.Count, Is.EqualTo(frame + 1));
            }
        }

        [Test]
        public void WhatAMegabyteCostsIsWhatItTakesToShowIt()
        {
            var upload = new Upload(this, 60_000_000);
            for (int round = 0; round < 10; ++round)
            {
                double begin = _now;
                _queue.Enqueue(upload);
                while (_queue.Count > 0)
                    NextFrame();
                if (round > 5)
                    Assert.That(_queue.MillisecondsPerMegabyte, Is.EqualTo((_now - begin) / 60).Within(25).Percent);
            }
            double alone = _queue.MillisecondsPerMegabyte;
            _queue.Budget = 0;
            Assert.That(_queue.MillisecondsPerMegabyte, Is.LessThan(alone / 3));
        }

        [Test]
        public void WhoWaitsBesideOthersSharesWithThem()
        {
            var large = new Upload(this, 50 << 20);
            var small = new Upload(this, 1 << 20);
            Assert.That(_queue.ShareOf(large), Is.EqualTo(1));
            _queue.Enqueue(small);
            Assert.That(_queue.ShareOf(large), Is.EqualTo(1.02));
            Assert.That(_queue.ShareOf(small), Is.EqualTo(1));
            _queue.Enqueue(large);
            Assert.That(_queue.ShareOf(small), Is.EqualTo(2));
        }

        [Test]
        public void NothingIsAllocated()
        {
            var uploads = new Upload[20];
            for (int k = 0; k < uploads.Length; ++k)
                uploads[k] = new Upload(this, 1 << 20);
            _served.Capacity = 10000;
            for (int round = 0; round < 3; ++round)
            {
                long before = GC.GetAllocatedBytesForCurrentThread();
                foreach (Upload upload in uploads)
                    _queue.Enqueue(upload);
                while (_queue.Count > 0)
                    NextFrame();
                if (round > 0)
                    Assert.That(GC.GetAllocatedBytesForCurrentThread() - before, Is.EqualTo(0));
            }
        }

        // Of a game at 90 frames a second, which is as long however much is uploaded.
        private double NextFrame()
        {
            double begin = _now = Math.Max(_now, 1000.0 / 90 * ++_frame);
            _queue.Note(_frame, ref _lastFrame);
            _queue.Run();
            return _now - begin;
        }

        private sealed class Upload : IUploader
        {
            private readonly UploadQueueTest _test;
            private readonly double _millisecondsPerByte;
            private long _left;

            public Upload(UploadQueueTest test, long bytes, double millisecondsPerByte = MillisecondsPerByte)
            {
                _test = test;
                _millisecondsPerByte = millisecondsPerByte;
                Bytes = _left = bytes;
            }

            public int Finished { get; private set; }

            public bool IsQueued { get; set; }

            public uint LastUpload { get; set; }

            public long Bytes { get; }

            UploadStep IUploader.Upload(in UploadShare share, out long bytes)
            {
                bytes = Math.Min(_left, share.PieceBytes);
                _left -= bytes;
                _test._now += bytes * _millisecondsPerByte;
                _test._served.Add(this);
                if (_left > 0)
                    return UploadStep.Unfinished;
                _left = Bytes;
                ++Finished;
                return UploadStep.Shown;
            }

            void IUploader.OnUploaded(UploadStep step, double milliseconds)
            {
            }
        }
    }
}
