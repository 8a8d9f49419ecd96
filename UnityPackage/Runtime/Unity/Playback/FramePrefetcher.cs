// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Runtime.InteropServices;
using System.Threading;
using UnityEngine;

namespace QuickSes
{
    /// <summary>How a frame that was asked for stands.</summary>
    internal enum FrameState
    {
        /// <summary>Not read yet.</summary>
        Pending,
        /// <summary>There.</summary>
        Ready,
        /// <summary>It can't be read.</summary>
        Damaged
    }

    /// <summary>
    /// Opens a reader and reads frames ahead on a thread of its own, in the order they will be shown, into a fixed
    /// number of slots of unmanaged memory. Apart from opening and errors neither thread makes garbage. The thread owns
    /// reader and memory and gives both back as it leaves, so that they never vanish under a read.
    /// </summary>
    internal sealed unsafe class FramePrefetcher : IDisposable
    {
        /// <summary>Two frames to blend, and one to read into.</summary>
        public const int LeastSlots = 3;

        /// <summary>What slots of large molecules take together at most, unless that is less than LeastSlots.</summary>
        public const long MemoryLimit = 256L << 20;

        private struct Slot
        {
            public int Frame; // -1: none yet
            public FrameState State;
            public TrajectoryFrame Info;
            public QuickSesError Error;
        }

        private const int LongestWait = 5000; // ms, before a domain is unloaded
        private const int LongestPause = 50; // ms, in the middle of a game

        // Those whose threads have not left yet. Guarded by itself.
        private static readonly List<FramePrefetcher> s_alive = new List<FramePrefetcher>();

        private readonly FrameReader _reader;
        private readonly int _slotLimit;
        private readonly long _memoryLimit;
        private readonly object _gate = new object();
        private readonly AutoResetEvent _wake = new AutoResetEvent(false);
        private readonly Thread _thread;

        // Guarded by _gate.
        private Slot[] _slots = Array.Empty<Slot>();
        private Vector3* _memory;
        private FrameOrder _order;
        private bool _hasOrder, _isStopping, _hasLeft;
        private FrameState _opening = FrameState.Pending;
        private QuickSesError _openingError;

        /// <param name="reader">Taken over.</param>
        /// <param name="slots">How many frames are kept; fewer if they are large.</param>
        /// <param name="memoryLimit">Bytes.</param>
        public FramePrefetcher(FrameReader reader, int slots, long memoryLimit = MemoryLimit)
        {
            _memoryLimit = memoryLimit;
            _reader = reader;
            _slotLimit = Math.Max(LeastSlots, slots);
            _thread = new Thread(Run) { IsBackground = true, Name = "QuickSES frames" };
            lock (s_alive)
            {
                _thread.Start();
                s_alive.Add(this);
            }
        }

        /// <summary>
        /// Disposes of all there are and waits for their threads, for 5 s at most. After it none runs code of a domain
        /// that is unloaded.
        /// </summary>
        public static void DisposeAll()
        {
            FramePrefetcher[] alive;
            lock (s_alive)
                alive = s_alive.ToArray();
            foreach (FramePrefetcher each in alive)
                each.SendAway();
            Stopwatch waited = Stopwatch.StartNew();
            foreach (FramePrefetcher each in alive)
                each._thread.Join((int)Math.Max(0, LongestWait - waited.ElapsedMilliseconds));
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
        public int SlotCount => _slots.Length;

        /// <summary>Whether the thread has left, and everything is given back.</summary>
        internal bool HasLeft => !_thread.IsAlive;

        /// <summary>Which frames are wanted from now on; others make room for them.</summary>
        public void Request(in FrameOrder order)
        {
            lock (_gate)
            {
                if (_hasOrder && order.Equals(_order))
                    return;
                _order = order;
                _hasOrder = true;
            }
            _wake.Set();
        }

        /// <summary>
        /// A frame among those wanted. Ready: <paramref name="positions"/> are valid until the next Request that does
        /// not want it, or Dispose.
        /// </summary>
        public FrameState Get(int frame, out ReadOnlySpan<Vector3> positions, out TrajectoryFrame info,
            out QuickSesError error)
        {
            positions = default;
            info = default;
            error = default;
            lock (_gate)
            {
                int slot = Find(frame);
                if (slot < 0)
                    return FrameState.Pending;
                ref readonly Slot found = ref _slots[slot];
                if (found.State == FrameState.Ready)
                    positions = Positions(slot);
                info = found.Info;
                error = found.Error;
                return found.State;
            }
        }

        /// <summary>
        /// Sends the thread away and waits until it has left, which takes as long as reading one frame, but for 50 ms at
        /// most. While a file is being opened, which may take long, it does not wait. A thread that was not waited for
        /// leaves by itself later.
        /// </summary>
        public void Dispose()
        {
            if (SendAway() != FrameState.Pending)
                _thread.Join(LongestPause);
        }

        // How opening stands.
        private FrameState SendAway()
        {
            lock (_gate)
            {
                if (!_isStopping)
                {
                    _isStopping = true;
                    if (_hasLeft)
                        _wake.Dispose();
                    else
                        _wake.Set();
                }
                return _opening;
            }
        }

        private void Run()
        {
            try
            {
                if (TryOpen())
                    ReadFrames();
            }
            finally
            {
                Marshal.FreeHGlobal((IntPtr)_memory);
                _reader.Dispose();
                lock (_gate)
                {
                    _hasLeft = true;
                    if (_isStopping)
                        _wake.Dispose();
                }
                lock (s_alive)
                    s_alive.Remove(this);
            }
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
            int count = (int)Math.Max(LeastSlots, Math.Min(_slotLimit, _memoryLimit / frameBytes));
            var slots = new Slot[count];
            for (int k = 0; k < count; ++k)
                slots[k].Frame = -1;
            lock (_gate)
            {
                _memory = (Vector3*)Marshal.AllocHGlobal((IntPtr)(count * frameBytes));
                _slots = slots;
            }
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
                bool isRead = TryRead(frame, Positions(slot), out TrajectoryFrame info, out QuickSesError error);
                lock (_gate)
                {
                    _slots[slot].Info = info;
                    _slots[slot].Error = error;
                    _slots[slot].State = isRead ? FrameState.Ready : FrameState.Damaged;
                }
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

        private static QuickSesError Describe(Exception exception) => new QuickSesError(
            exception is OutOfMemoryException ? QuickSesStatus.OutOfMemory : QuickSesStatus.InternalError,
            exception.Message);

        // The first frame in the order of showing that no slot has, and a slot with one that is not wanted.
        private bool TryWaitForWork(out int frame, out int slot)
        {
            for (;;)
            {
                lock (_gate)
                {
                    frame = slot = -1;
                    if (_isStopping)
                        return false;
                    if (_hasOrder && TryFindMissing(out frame) && TryFindUnwanted(out slot))
                    {
                        _slots[slot].Frame = frame;
                        _slots[slot].State = FrameState.Pending;
                        return true;
                    }
                }
                _wake.WaitOne();
            }
        }

        private bool TryFindMissing(out int frame)
        {
            for (int step = 0; step < _slots.Length; ++step)
            {
                frame = _order[step];
                if (frame < 0)
                    return false;
                if (Find(frame) < 0)
                    return true;
            }
            frame = -1;
            return false;
        }

        private bool TryFindUnwanted(out int slot)
        {
            slot = Find(-1);
            for (int k = 0; slot < 0 && k < _slots.Length; ++k)
                if (!IsWanted(_slots[k].Frame))
                    slot = k;
            return slot >= 0;
        }

        private bool IsWanted(int frame)
        {
            for (int step = 0; step < _slots.Length; ++step)
                if (_order[step] == frame)
                    return true;
            return false;
        }

        private int Find(int frame)
        {
            for (int k = 0; k < _slots.Length; ++k)
                if (_slots[k].Frame == frame)
                    return k;
            return -1;
        }

        private Span<Vector3> Positions(int slot) => new Span<Vector3>(_memory + (long)slot * AtomCount, AtomCount);
    }
}
