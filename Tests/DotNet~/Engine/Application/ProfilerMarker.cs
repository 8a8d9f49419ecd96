// SPDX-License-Identifier: MIT
using System;
using System.Diagnostics;

namespace Unity.Profiling
{
    public readonly struct ProfilerCategory
    {
        public static ProfilerCategory Scripts => default;

        public static ProfilerCategory Render => default;
    }

    /// <summary>Inert.</summary>
    public struct ProfilerMarker
    {
        public ProfilerMarker(string name)
        {
        }

        public ProfilerMarker(ProfilerCategory category, string name)
        {
        }

        [Conditional("ENABLE_PROFILER")]
        public readonly void Begin()
        {
        }

        [Conditional("ENABLE_PROFILER")]
        public readonly void End()
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

namespace UnityEngine.Profiling
{
    /// <summary>Inert.</summary>
    public sealed class Profiler
    {
        [Conditional("ENABLE_PROFILER")]
        public static void BeginSample(string name)
        {
        }

        [Conditional("ENABLE_PROFILER")]
        public static void EndSample()
        {
        }
    }
}
