// SPDX-License-Identifier: MIT
using System;
using System.Runtime.InteropServices;
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
    /// Room for some frames, which are found by their numbers. One thread changes them; others may look with the lock
    /// that it holds for <see cref="Assign"/> and <see cref="Finish"/>. Each of these takes the same short time however
    /// many slots there are, and nothing is allocated after the constructor.
    /// </summary>
    internal sealed unsafe class FrameSlots : IDisposable
    {
        private struct Slot
        {
            public int Frame; // -1: none yet
            public int Next; // in its bucket; -1: none
            public uint Plan; // the last one that wants it
            public FrameState State;
            public TrajectoryFrame Info;
            public QuickSesError Error;
        }

        private readonly int _atomCount;
        private readonly Slot[] _slots;
        private readonly int[] _buckets; // the first slot of each, -1: none. A frame's: its number, modulo their number
        private Vector3* _memory;
        private uint _plan;
        private int _emptyCount; // the last ones

        public FrameSlots(int count, int atomCount)
        {
            _atomCount = atomCount;
            _slots = new Slot[count];
            for (int k = 0; k < count; ++k)
                _slots[k].Frame = -1;
            int buckets = 1;
            while (buckets < 2 * count) // a run of as many frames has a bucket each
                buckets *= 2;
            _buckets = new int[buckets];
            Array.Fill(_buckets, -1);
            _emptyCount = count;
            _memory = (Vector3*)Marshal.AllocHGlobal((IntPtr)((long)count * atomCount * sizeof(Vector3)));
        }

        public int Count => _slots.Length;

        public Span<Vector3> Positions(int slot) => new Span<Vector3>(_memory + (long)slot * _atomCount, _atomCount);

        /// <summary>Pending: it has no slot, or is being read into it.</summary>
        public FrameState Get(int frame, out ReadOnlySpan<Vector3> positions, out TrajectoryFrame info,
            out QuickSesError error)
        {
            positions = default;
            info = default;
            error = default;
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

        /// <summary>
        /// The first frame in the order of showing that no slot has, and a slot with one that is not wanted. Only the
        /// thread that changes slots; takes time in proportion to their number, but no lock.
        /// </summary>
        public bool TryPlan(in FrameOrder order, out int frame, out int slot)
        {
            ++_plan;
            frame = slot = -1;
            for (int step = 0; step < _slots.Length; ++step)
            {
                int wanted = order[step];
                if (wanted < 0)
                    break;
                int found = Find(wanted);
                if (found >= 0)
                    _slots[found].Plan = _plan;
                else if (frame < 0)
                    frame = wanted;
            }
            if (frame < 0)
                return false;
            slot = _emptyCount > 0 ? _slots.Length - _emptyCount : 0;
            while (_slots[slot].Frame >= 0 && _slots[slot].Plan == _plan) // a frame is missing, so one is not wanted
                ++slot;
            return true;
        }

        /// <summary>Forgets what a slot has; it is being read into from now on.</summary>
        public void Assign(int slot, int frame)
        {
            ref Slot assigned = ref _slots[slot];
            if (assigned.Frame >= 0)
                Unlink(slot);
            else
                --_emptyCount;
            assigned.Frame = frame;
            assigned.State = FrameState.Pending;
            ref int first = ref BucketOf(frame);
            assigned.Next = first;
            first = slot;
        }

        /// <summary>What came of reading into a slot.</summary>
        public void Finish(int slot, FrameState state, in TrajectoryFrame info, in QuickSesError error)
        {
            _slots[slot].Info = info;
            _slots[slot].Error = error;
            _slots[slot].State = state;
        }

        public void Dispose()
        {
            Marshal.FreeHGlobal((IntPtr)_memory);
            _memory = null;
        }

        private ref int BucketOf(int frame) => ref _buckets[frame & (_buckets.Length - 1)];

        private int Find(int frame)
        {
            if (frame < 0)
                return -1;
            int slot = BucketOf(frame);
            while (slot >= 0 && _slots[slot].Frame != frame)
                slot = _slots[slot].Next;
            return slot;
        }

        private void Unlink(int slot)
        {
            ref int link = ref BucketOf(_slots[slot].Frame);
            while (link != slot)
                link = ref _slots[link].Next;
            link = _slots[slot].Next;
        }
    }
}
