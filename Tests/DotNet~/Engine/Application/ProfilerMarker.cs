// SPDX-License-Identifier: MIT
using System;

namespace Unity.Profiling
{
    /// <summary>Inert.</summary>
    public struct ProfilerMarker
    {
        public ProfilerMarker(string name)
        {
        }

        public readonly AutoScope Auto() => default;

        public struct AutoScope : IDisposable
        {
            public readonly void Dispose()
            {
            }
        }
    }
}
