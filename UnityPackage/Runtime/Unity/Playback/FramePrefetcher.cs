// SPDX-License-Identifier: MIT
using System;
using System.Threading;
using UnityEngine;

namespace QuickSes
{
    /// <summary>
    /// Opens a reader and reads frames ahead on a thread of its own, in the order they will be shown, into a fixed
    /// number of slots of unmanaged memory. Apart from opening and errors neither thread makes garbage. The thread owns
    /// reader and memory and gives both back as it leaves, so that they never vanish under a read. If no thread can be
    /// started, the reader can't be opened.
    /// </summary>
    internal sealed unsafe class FramePrefetcher : BackgroundThread, IDisposable
    {
        /// <summary>Two frames to blend, and one to read into.</summary>
        public const int LeastSlots = 3;

        /// <summary>What slots of large molecules take together at most, unless that is less than LeastSlots.</summary>
        public const long MemoryLimit = 256L << 20;

        private readonly FrameReader _reader;
        private readonly int _slotLimit;
        private readonly long _memoryLimit;
        private readonly AutoResetEvent _wake = new AutoResetEvent(false);

        // Guarded by _gate, which is never held for longer than it takes to look at one slot. The thread alone changes
        // _slots, so it looks at them without.
        private readonly object _gate = new object();
        private FrameSlots _slots;
        private FrameOrder _order;
        private uint _orderVersion; // 0: none yet
        private bool _isStopping, _hasFreed;
        private FrameState _opening = FrameState.Pending;
        private QuickSesError _openingError;

        /// <param name="reader">Taken over.</param>
        /// <param name="slots">How many frames are kept; fewer if they are large.</param>
        /// <param name="memoryLimit">Bytes.</param>
        public FramePrefetcher(FrameReader reader, int slots, long memoryLimit = MemoryLimit)
            : base("QuickSES frames")
        {
            _memoryLimit = memoryLimit;
            _reader = reader;
            _slotLimit = Math.Max(LeastSlots, slots);
            try
            {
                Start();
            }
            catch (Exception exception)
            {
                SetOpening(FrameState.Damaged, Describe(exception));
                Free();
            }
        }

        /// <summary>Whether the reader is open; Damaged: it can't be opened.</summary>
        public FrameState GetOpening(out QuickSesError error)
        {
            lock (_gate)
            {
                error = _openingError;
                return _opening;
            }
        }

        /// <summary>Of the reader; once it is open.</summary>
        public int FrameCount { get; private set; }

        /// <summary>Of the reader; once it is open.</summary>
        public int AtomCount { get; private set; }

        /// <summary>Of the reader; once it is open.</summary>
        public string Warning { get; private set; }

        /// <summary>How many frames are kept; once it is open.</summary>
        public int SlotCount { get; private set; }

        /// <summary>Which frames are wanted from now on; others make room for them.</summary>
        public void Request(in FrameOrder order)
        {
            lock (_gate)
            {
                if (_orderVersion != 0 && order.Equals(_order))
                    return;
                _order = order;
                _orderVersion = Math.Max(1, unchecked(_orderVersion + 1));
                Wake();
            }
        }

        /// <summary>
        /// A frame among those wanted. Ready: <paramref name="positions"/> are valid until the next Request that does
        /// not want it, or Dispose.
        /// </summary>
        public FrameState Get(int frame, out ReadOnlySpan<Vector3> positions, out TrajectoryFrame info,
            out QuickSesError error)
        {
            lock (_gate)
            {
                if (_slots != null)
                    return _slots.Get(frame, out positions, out info, out error);
            }
            positions = default;
            info = default;
            error = default;
            return FrameState.Pending;
        }

        /// <summary>
        /// Tells the thread to leave, and does not wait: it does after the read or opening that it is at, and closes
        /// the file then.
        /// </summary>
        public void Dispose() => SendAway();

        public override void SendAway()
        {
            lock (_gate)
            {
                _isStopping = true;
                Wake();
            }
        }

        protected override void Run()
        {
            try
            {
                if (TryOpen())
                    ReadFrames();
            }
            finally
            {
                Free();
            }
        }

        private void Free()
        {
            lock (_gate)
            {
                _slots?.Dispose();
                _slots = null;
                _hasFreed = true;
                _wake.Dispose();
            }
            _reader.Dispose();
        }

        // With the lock.
        private void Wake()
        {
            if (!_hasFreed)
                _wake.Set();
        }

        private bool TryOpen()
        {
            try
            {
                return Open();
            }
            catch (Exception exception)
            {
                SetOpening(FrameState.Damaged, Describe(exception));
                return false;
            }
        }

        private bool Open()
        {
            if (!_reader.TryOpen(out QuickSesError error))
            {
                SetOpening(FrameState.Damaged, error);
                return false;
            }
            FrameCount = _reader.FrameCount;
            AtomCount = _reader.AtomCount;
            Warning = _reader.Warning;
            long frameBytes = (long)AtomCount * sizeof(Vector3);
            SlotCount = (int)Math.Max(LeastSlots, Math.Min(_slotLimit, _memoryLimit / frameBytes));
            var slots = new FrameSlots(SlotCount, AtomCount);
            lock (_gate)
                _slots = slots;
            SetOpening(FrameState.Ready, default);
            return true;
        }

        private void SetOpening(FrameState state, QuickSesError error)
        {
            lock (_gate)
            {
                _opening = state;
                _openingError = error;
            }
        }

        private void ReadFrames()
        {
            while (TryWaitForWork(out int frame, out int slot))
            {
                bool isRead = TryRead(frame, _slots.Positions(slot), out TrajectoryFrame info,
                    out QuickSesError error);
                lock (_gate)
                    _slots.Finish(slot, isRead ? FrameState.Ready : FrameState.Damaged, info, error);
            }
        }

        // A reader that throws damages one frame, as a file does.
        private bool TryRead(int frame, Span<Vector3> positions, out TrajectoryFrame info, out QuickSesError error)
        {
            try
            {
                return _reader.TryRead(frame, positions, out info, out error);
            }
            catch (Exception exception)
            {
                info = default;
                error = Describe(exception);
                return false;
            }
        }

        // What to read, and into which slot. It is planned without the lock, hence anew if the order changed meanwhile:
        // the slot may be wanted by now.
        private bool TryWaitForWork(out int frame, out int slot)
        {
            uint planned = 0;
            frame = slot = -1;
            for (;;)
            {
                FrameOrder order;
                uint version;
                lock (_gate)
                {
                    if (_isStopping)
                        return false;
                    if (slot >= 0 && planned == _orderVersion)
                    {
                        _slots.Assign(slot, frame);
                        return true;
                    }
                    order = _order;
                    version = _orderVersion;
                }
                planned = version;
                if (version == 0 || !_slots.TryPlan(order, out frame, out slot))
                    _wake.WaitOne();
            }
        }
    }
}
