// SPDX-License-Identifier: MIT
using System;
using UnityEngine;

namespace QuickSes
{
    /// <summary>The box of a frame in Unity's space, and ways between atoms in it. default: no box.</summary>
    internal readonly struct PeriodicBox
    {
        private readonly Vector3 _a, _b, _c;
        private readonly Vector3 _alongA, _alongB, _alongC; // reciprocal vectors: a . alongA = 1, b . alongA = 0, ...

        public PeriodicBox(Vector3 a, Vector3 b, Vector3 c) : this()
        {
            float volume = Vector3.Dot(a, Vector3.Cross(b, c));
            if (!(Math.Abs(volume) > 0) || float.IsInfinity(volume))
                return;
            Exists = true;
            _a = a;
            _b = b;
            _c = c;
            _alongA = Vector3.Cross(b, c) / volume;
            _alongB = Vector3.Cross(c, a) / volume;
            _alongC = Vector3.Cross(a, b) / volume;
        }

        public static PeriodicBox Of(in TrajectoryFrame frame) =>
            frame.HasBox ? new PeriodicBox(Vector(frame, 0), Vector(frame, 1), Vector(frame, 2)) : default;

        public bool Exists { get; }

        /// <summary>
        /// The way of an atom from one frame to the next, which was found as <paramref name="way"/>: less the box
        /// vectors by which it was put back into the box in between.
        /// </summary>
        public Vector3 Shortest(Vector3 way)
        {
            way -= Steps(way, _alongC) * _c;
            way -= Steps(way, _alongB) * _b;
            way -= Steps(way, _alongA) * _a;
            return way;
        }

        private static float Steps(Vector3 way, Vector3 along)
        {
            float part = way.x * along.x + way.y * along.y + way.z * along.z;
            return part > 0.5f || part < -0.5f ? (float)Math.Round(part) : 0;
        }

        private static Vector3 Vector(in TrajectoryFrame frame, int k)
        {
            (double x, double y, double z) = frame.GetBoxVector(k);
            return UnitySpace.FromFile((float)x, (float)y, (float)z);
        }
    }
}
