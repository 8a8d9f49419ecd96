// SPDX-License-Identifier: MIT
using System;

namespace QuickSes
{
    /// <summary>The order in which frames will be shown if nobody interferes.</summary>
    internal readonly struct FrameOrder : IEquatable<FrameOrder>
    {
        private readonly int _frameCount, _direction, _first;
        private readonly PlaybackMode _mode;

        public FrameOrder(int frameCount, PlaybackMode mode, int direction, int first)
        {
            _frameCount = frameCount;
            _mode = mode;
            _direction = direction;
            _first = first;
        }

        /// <summary>The frame after `step` others, which is shown now for step 0; -1: none.</summary>
        public int this[int step]
        {
            get
            {
                long moved = _first + (long)_direction * step;
                if (moved >= 0 && moved < _frameCount)
                    return (int)moved;
                switch (_mode)
                {
                    case PlaybackMode.Once:
                        return -1;
                    case PlaybackMode.PingPong:
                        long last = _frameCount - 1;
                        if (last == 0)
                            return 0;
                        long unrolled = Modulo(moved, 2 * last);
                        return (int)(unrolled <= last ? unrolled : 2 * last - unrolled);
                    default:
                        return (int)Modulo(moved, _frameCount);
                }
            }
        }

        public bool Equals(FrameOrder other) => _frameCount == other._frameCount && _direction == other._direction &&
            _first == other._first && _mode == other._mode;

        public override bool Equals(object other) => other is FrameOrder order && Equals(order);

        public override int GetHashCode() => _first;

        private static long Modulo(long value, long period) => (value % period + period) % period;
    }
}
