// SPDX-License-Identifier: MIT
using QuickSes.Interop;

namespace QuickSes
{
    /// <summary>How a job stood when it was asked.</summary>
    public readonly struct SurfaceProgress
    {
        internal SurfaceProgress(in NativeProgress native)
        {
            _native = native;
        }

        private readonly NativeProgress _native;

        /// <summary>What the job does.</summary>
        public SurfaceJobState State => _native.State;

        /// <summary><see cref="SurfaceSettings.Tag"/> of the job that runs, or ran last.</summary>
        public uint Tag => _native.Tag;

        /// <summary><see cref="SurfaceSettings.Tag"/> of the newest job that was begun.</summary>
        public uint TagRequested => _native.TagRequested;

        /// <summary>Levels of this job that are finished.</summary>
        public int LevelsFinished => (int)_native.LevelsFinished;

        /// <summary>Levels that this job computes: 1 with a frame budget.</summary>
        public int LevelCount => (int)_native.LevelCount;

        /// <summary>Of this job's work: from 0 to 1, never falls.</summary>
        public float Fraction => _native.Fraction;

        /// <summary>Whether <see cref="SurfaceContext.TryCollect"/> would give a mesh.</summary>
        public bool IsMeshReady => _native.MeshReady != 0;

        /// <summary>Ok unless the job failed.</summary>
        public QuickSesStatus Status => _native.Status;

        /// <summary>Why the job failed; "" if it did not. Makes a new string.</summary>
        public unsafe string Message
        {
            get
            {
                fixed (byte* message = _native.Message)
                    return NativeText.Read(message);
            }
        }
    }
}
