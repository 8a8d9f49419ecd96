// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using System.Threading;
using UnityEngine;

namespace QuickSes
{
    /// <summary>
    /// Lends the few contexts there are to the many <see cref="MolecularSurface"/> components, for one job at a time.
    /// First come, first served: surfaces that have something new before those that only get finer, and nobody is left
    /// waiting for ever. A surface is given the context it had before if that is free, which then still holds its
    /// atoms. Main thread only.
    /// </summary>
    public static class SurfaceScheduler
    {
        private const int RefinementTurn = 8; // every so many jobs one that refines may go first

        private static readonly List<ContextSlot> s_slots = new List<ContextSlot>();
        private static readonly Queue<SurfaceSession> s_urgent = new Queue<SurfaceSession>();
        private static readonly Queue<SurfaceSession> s_refining = new Queue<SurfaceSession>();
        private static readonly List<SurfaceSession> s_sessions = new List<SurfaceSession>();
        private static int s_maxContexts = 4;
        private static int s_urgentInARow;
        private static uint s_uses;
        private static uint s_jobs;

        /// <summary>
        /// The most contexts per back end, at least 1; default 4. Each keeps memory for its largest surface. More let
        /// more surfaces be computed at a time. Holds for contexts made from now on: see
        /// <see cref="ReleaseContexts"/>.
        /// </summary>
        public static int MaxContexts
        {
            get => s_maxContexts;
            set => s_maxContexts = value >= 1
                ? value
                : throw new ArgumentOutOfRangeException(nameof(value), value, "at least one context is needed");
        }

        /// <summary>
        /// CPU threads of each context made from now on; default: one less than there are, so that the game keeps one,
        /// but at least two. 0: all.
        /// </summary>
        public static uint Threads { get; set; } = (uint)Math.Max(2, Environment.ProcessorCount - 1);

        /// <summary>
        /// Bytes of work memory for each context made from now on (<see cref="SurfaceContextOptions.MemoryBudget"/>);
        /// 0 (default): what is free.
        /// </summary>
        public static ulong MemoryBudget { get; set; }

        /// <summary>CUDA device of contexts made from now on; default 0.</summary>
        public static int Device { get; set; }

        /// <summary>Contexts that there are.</summary>
        public static int ContextCount => s_slots.Count;

        /// <summary>Surfaces that wait for a context.</summary>
        public static int WaitingCount => CountWaiting(s_urgent) + CountWaiting(s_refining);

        /// <summary>
        /// Frees all contexts, for instance after options were changed. What was being computed begins again with new
        /// ones; what is shown stays. Waits for the jobs to end, which they do within milliseconds.
        /// </summary>
        public static void ReleaseContexts()
        {
            foreach (ContextSlot slot in s_slots)
            {
                slot.User?.LoseContext();
                slot.Dispose();
            }
            s_slots.Clear();
            ClearQueue(s_urgent);
            ClearQueue(s_refining);
        }

        internal static bool IsAnyUrgent => TryPeek(s_urgent, out _);

        internal static uint NextJob() => ++s_jobs;

        /// <summary>A surface is there until <see cref="Remove"/>.</summary>
        internal static void Add(SurfaceSession session)
        {
            if (session.IsListed)
                return;
            session.IsListed = true;
            s_sessions.Add(session);
        }

        // When nobody is left who could use the contexts, their memory is given back, without waiting for it.
        internal static void Remove(SurfaceSession session)
        {
            if (!session.IsListed)
                return;
            session.IsListed = false;
            s_sessions.Remove(session);
            if (s_sessions.Count > 0)
                return;
            foreach (ContextSlot slot in s_slots)
                slot.DisposeInBackground();
            s_slots.Clear();
        }

        internal static void Enqueue(SurfaceSession session, SurfaceNeed need)
        {
            if (session.Queued == need)
                return;
            session.Queued = need; // an entry in the other queue is passed over
            (need == SurfaceNeed.Urgent ? s_urgent : s_refining).Enqueue(session);
        }

        internal static void Release(ContextSlot slot)
        {
            slot.User = null;
            slot.LastUse = ++s_uses;
        }

        /// <summary>Lends what is free to those who wait.</summary>
        internal static void Dispatch()
        {
            while (TryChoose(out Queue<SurfaceSession> queue, out SurfaceSession session))
            {
                ContextSlot slot = FindFree(session, out bool isHopeless, out QuickSesError error);
                if (slot == null && !isHopeless)
                    return;
                queue.Dequeue();
                session.Queued = SurfaceNeed.None;
                s_urgentInARow = queue == s_urgent ? s_urgentInARow + 1 : 0;
                if (slot == null)
                    session.FailToBegin(error);
                else
                    Lend(slot, session);
            }
        }

        /// <summary>A context at once, for work that waits; on failure null and the reason.</summary>
        internal static ContextSlot LendNow(SurfaceSession session, out QuickSesError error)
        {
            ContextSlot slot = FindIdle(session);
            error = default;
            if (slot == null)
            {
                slot = NewSlot(session.Backend);
                slot.Create();
                error = slot.Error;
                if (slot.Context == null)
                    return null;
                s_slots.Add(slot);
            }
            Occupy(slot, session);
            return slot;
        }

        private static void Lend(ContextSlot slot, SurfaceSession session)
        {
            Occupy(slot, session);
            session.Start(slot);
        }

        private static void Occupy(ContextSlot slot, SurfaceSession session)
        {
            slot.User = session;
            slot.FirstJob = s_jobs + 1;
        }

        private static bool TryChoose(out Queue<SurfaceSession> queue, out SurfaceSession session)
        {
            bool refines = TryPeek(s_refining, out SurfaceSession refining);
            bool isUrgent = TryPeek(s_urgent, out SurfaceSession urgent);
            bool takesRefining = refines && (!isUrgent || s_urgentInARow >= RefinementTurn);
            queue = takesRefining ? s_refining : s_urgent;
            session = takesRefining ? refining : urgent;
            return refines || isUrgent;
        }

        // The first in a queue who still waits in it.
        private static bool TryPeek(Queue<SurfaceSession> queue, out SurfaceSession session)
        {
            SurfaceNeed need = queue == s_urgent ? SurfaceNeed.Urgent : SurfaceNeed.Refinement;
            while (queue.TryPeek(out session))
            {
                if (session.Queued == need)
                    return true;
                queue.Dequeue();
            }
            return false;
        }

        // A context that may be used now, or null: one will be free or made later, unless there is no hope.
        private static ContextSlot FindFree(SurfaceSession session, out bool isHopeless, out QuickSesError error)
        {
            isHopeless = false;
            error = default;
            ContextSlot idle = FindIdle(session);
            if (idle != null && idle.SentBy == session.Atoms)
                return idle;
            int usable = 0;
            ContextSlot failed = null;
            foreach (ContextSlot slot in s_slots)
                if (slot.Backend == session.Backend)
                {
                    if (slot.IsReady && slot.Context == null)
                        failed = slot;
                    else
                        ++usable;
                }
            if (failed != null)
            {
                // The others go on with what there is; if there is nothing, the next who asks makes another attempt.
                isHopeless = usable == 0;
                error = failed.Error;
                if (isHopeless)
                    s_slots.Remove(failed);
            }
            else if (usable < s_maxContexts && (idle == null || idle.SentBy != null) && !IsAnyBeingMade())
            {
                ContextSlot slot = NewSlot(session.Backend);
                s_slots.Add(slot);
                slot.CreateInBackground();
            }
            return idle;
        }

        // Preferably the one that has the atoms of the session, then one that has none, then the one unused for
        // longest.
        private static ContextSlot FindIdle(SurfaceSession session)
        {
            ContextSlot best = null;
            foreach (ContextSlot slot in s_slots)
            {
                if (slot.Backend != session.Backend || !slot.IsReady || slot.Context == null || slot.User != null)
                    continue;
                if (slot.SentBy == session.Atoms)
                    return slot;
                if (best == null || IsBetter(slot, best))
                    best = slot;
            }
            return best;
        }

        private static bool IsBetter(ContextSlot slot, ContextSlot other) =>
            (slot.SentBy == null) != (other.SentBy == null) ? slot.SentBy == null : slot.LastUse < other.LastUse;

        private static bool IsAnyBeingMade()
        {
            foreach (ContextSlot slot in s_slots)
                if (!slot.IsReady)
                    return true;
            return false;
        }

        private static ContextSlot NewSlot(SurfaceBackend backend) => new ContextSlot(new SurfaceContextOptions
        {
            Backend = backend, Device = Device, Threads = Threads, MemoryBudget = MemoryBudget
        });

        private static int CountWaiting(Queue<SurfaceSession> queue)
        {
            SurfaceNeed need = queue == s_urgent ? SurfaceNeed.Urgent : SurfaceNeed.Refinement;
            int count = 0;
            foreach (SurfaceSession session in queue)
                if (session.Queued == need)
                    ++count;
            return count;
        }

        private static void ClearQueue(Queue<SurfaceSession> queue)
        {
            foreach (SurfaceSession session in queue)
                session.Queued = SurfaceNeed.None;
            queue.Clear();
        }

        // Statics outlive play mode if the domain is not reloaded, and native threads must not outlive the domain.
        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void OnPlayModeBegins()
        {
            ReleaseContexts();
            Application.quitting -= ReleaseContexts;
            Application.quitting += ReleaseContexts;
        }

        // Before a domain reload: what managed objects hold outside of the managed heap would be lost with them.
        internal static void OnDomainUnloads()
        {
            ReleaseContexts();
            for (int i = s_sessions.Count - 1; i >= 0; --i)
                s_sessions[i].Dispose();
        }

#if UNITY_EDITOR
        [UnityEditor.InitializeOnLoadMethod]
        private static void OnEditorLoads()
        {
            UnityEditor.AssemblyReloadEvents.beforeAssemblyReload += OnDomainUnloads;
            UnityEditor.EditorApplication.quitting += ReleaseContexts;
        }
#endif
    }
}
