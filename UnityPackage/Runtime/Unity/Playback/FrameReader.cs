// SPDX-License-Identifier: MIT
using System;
using UnityEngine;

namespace QuickSes
{
    /// <summary>Where a <see cref="FramePrefetcher"/> gets frames from. Only its thread calls these.</summary>
    internal abstract class FrameReader : IDisposable
    {
        /// <summary>Called once, first. false: what is said then is not to be used, but disposed of.</summary>
        public abstract bool TryOpen(out QuickSesError error);

        /// <summary>At least 1.</summary>
        public abstract int FrameCount { get; }

        /// <summary>Of those asked for, at least 1.</summary>
        public abstract int AtomCount { get; }

        /// <summary>A sentence for the user, or null.</summary>
        public abstract string Warning { get; }

        /// <summary>Reads AtomCount positions in Unity's space; makes no garbage on success.</summary>
        public abstract bool TryRead(int frame, Span<Vector3> positions, out TrajectoryFrame info,
            out QuickSesError error);

        public abstract void Dispose();
    }
}
