// SPDX-License-Identifier: MIT
using QuickSes.Interop;
using System;

namespace QuickSes
{
    /// <summary>What a file says about one frame, besides positions.</summary>
    public readonly struct TrajectoryFrame
    {
        internal TrajectoryFrame(in NativeFrame native)
        {
            _native = native;
        }

        private readonly NativeFrame _native;

        /// <summary>Whether the time is known.</summary>
        public bool HasTime => _native.HasTime != 0;

        /// <summary>Picoseconds; 0 if it is not known.</summary>
        public double Time => _native.Time;

        /// <summary>Whether there is a periodic box.</summary>
        public bool HasBox => _native.HasBox != 0;

        /// <summary>Whether molecules are in one piece.</summary>
        public bool IsUnwrapped => _native.IsUnwrapped != 0;

        /// <summary>Vector k of the box, Å: a, b, c are 0, 1, 2. All 0 if there is no box.</summary>
        public unsafe (double X, double Y, double Z) GetBoxVector(int k)
        {
            if ((uint)k >= 3)
                throw new ArgumentOutOfRangeException(nameof(k), k, "a box has three vectors");
            return (_native.Box[3 * k], _native.Box[3 * k + 1], _native.Box[3 * k + 2]);
        }
    }
}
