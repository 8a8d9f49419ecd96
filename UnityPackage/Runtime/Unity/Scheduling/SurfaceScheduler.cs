// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;

namespace QuickSes
{
    /// <summary>
    /// Lends the few contexts there are to the many <see cref="MolecularSurface"/> components, for one job at a time.
    /// First come, first served: surfaces that have something new before those that only get finer, and nobody is left
    /// waiting for ever. Main thread only.
    /// </summary>
    public static partial class SurfaceScheduler
    {
        private static readonly ContextPool[] s_pools = // by back end: Auto is one of its own
        {
            new ContextPool(SurfaceBackend.Auto), new ContextPool(SurfaceBackend.Cuda),
            new ContextPool(SurfaceBackend.Cpu)
        };

        private static readonly List<SurfaceSession> s_sessions = new List<SurfaceSession>();
        private const int MinOrphanCheck = 16;
        private static int s_orphanCheck = MinOrphanCheck; // at so many surfaces

        /// <summary>Contexts that there are, or are being made.</summary>
        public static int ContextCount => s_pools[0].Count + s_pools[1].Count + s_pools[2].Count;

        /// <summary>Surfaces that wait for a context.</summary>
        public static int WaitingCount =>
            s_pools[0].WaitingCount + s_pools[1].WaitingCount + s_pools[2].WaitingCount;

        internal static int LentCount => s_pools[0].LentCount + s_pools[1].LentCount + s_pools[2].LentCount;

        /// <summary>The number of the last job that was begun by any surface. Numbers may wrap.</summary>
        internal static uint LastJob { get; private set; }

        /// <summary>
        /// Frees all contexts, for instance after options were changed. What was being computed begins again with new
        /// ones; what is shown stays. Waits for the jobs to end, which they do within milliseconds, and for contexts that
        /// are being made.
        /// </summary>
        public static void ReleaseContexts()
        {
            ReleaseInBackground();
            foreach (ContextPool pool in s_pools)
                pool.WaitUntilReleased();
        }

        /// <summary>The same without waiting, neither for jobs nor for a GPU that is being started.</summary>
        internal static void ReleaseInBackground()
        {
            RemoveOrphans();
            foreach (ContextPool pool in s_pools)
                pool.ReleaseInBackground();
        }

        /// <summary>Ends all surfaces there are, and frees what they and the contexts hold.</summary>
        internal static void DisposeAll()
        {
            for (int k = s_sessions.Count - 1; k >= 0; --k)
                s_sessions[k].Dispose();
            ReleaseContexts();
        }

        internal static uint NextJob() => ++LastJob;

        internal static ContextPool PoolOf(SurfaceBackend backend) => s_pools[(int)backend];

        internal static ContextSlot NewSlot(SurfaceBackend backend) => new ContextSlot(new SurfaceContextOptions
        {
            Backend = backend, Device = Device, Threads = Threads, MemoryBudget = MemoryBudget,
            Background = true // the game's own threads come first
        });

        /// <summary>A surface is there, until <see cref="Remove"/>.</summary>
        internal static void Add(SurfaceSession session)
        {
            // When there are twice as many as were left by the last check, so that many surfaces are not many squared.
            if (s_sessions.Count >= s_orphanCheck)
            {
                RemoveOrphans();
                s_orphanCheck = Math.Max(MinOrphanCheck, 2 * s_sessions.Count);
            }
            session.Place = s_sessions.Count;
            s_sessions.Add(session);
        }

        // When nobody is left who could use the contexts, their memory is given back, without waiting for it.
        internal static void Remove(SurfaceSession session)
        {
            SurfaceSession last = s_sessions[s_sessions.Count - 1];
            s_sessions[session.Place] = last;
            last.Place = session.Place;
            s_sessions.RemoveAt(s_sessions.Count - 1);
            s_orphanCheck = Math.Min(s_orphanCheck, Math.Max(MinOrphanCheck, 2 * s_sessions.Count));
            foreach (ContextPool pool in s_pools)
            {
                pool.Forget(session.Atoms);
                if (s_sessions.Count == 0)
                    pool.ReleaseInBackground();
            }
            if (s_sessions.Count == 0)
                Uploads.FreeRoom();
        }

        // The engine tells components that were never enabled nothing, not even that they are destroyed.
        private static void RemoveOrphans()
        {
            for (int k = s_sessions.Count - 1; k >= 0; --k)
                if (s_sessions[k].IsOrphan)
                    s_sessions[k].Dispose();
        }
    }
}
