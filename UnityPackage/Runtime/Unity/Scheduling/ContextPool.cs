// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using System.Threading;

namespace QuickSes
{
    /// <summary>Why a surface wants a context.</summary>
    internal enum QueuePriority
    {
        None,
        /// <summary>What is shown is not finest yet, but of the newest atoms.</summary>
        Refinement,
        /// <summary>There are newer atoms or settings than what is shown.</summary>
        Urgent
    }

    /// <summary>
    /// The contexts of one back end, and the surfaces that wait for one. Each is lent for one job at a time, and
    /// preferably to the surface that had it before, since it still holds its atoms. Main thread only.
    /// </summary>
    internal sealed class ContextPool
    {
        private const int InitialQueue = 64; // so that the first to wait in the middle of playback makes no garbage
        private const int RefinementTurn = 8; // every so many jobs one that refines may go first

        private readonly SurfaceBackend _backend;
        private readonly List<ContextSlot> _slots = new List<ContextSlot>();
        private readonly List<ContextSlot> _retired = new List<ContextSlot>(); // being freed by other threads
        private readonly Queue<SurfaceSession> _urgent = new Queue<SurfaceSession>(InitialQueue);
        private readonly Queue<SurfaceSession> _refining = new Queue<SurfaceSession>(InitialQueue);
        private int _urgentInARow;
        private uint _uses;

        public ContextPool(SurfaceBackend backend)
        {
            _backend = backend;
        }

        /// <summary>How many there are or are being made; those that could not be made are none.</summary>
        public int Count
        {
            get
            {
                int count = 0;
                foreach (ContextSlot slot in _slots)
                    count += slot.HasFailed ? 0 : 1;
                return count;
            }
        }

        /// <summary>How many are in use.</summary>
        public int LentCount
        {
            get
            {
                int count = 0;
                foreach (ContextSlot slot in _slots)
                    count += slot.User != null ? 1 : 0;
                return count;
            }
        }

        /// <summary>Whether nothing can be computed yet, because the first context is being made.</summary>
        public bool IsStarting
        {
            get
            {
                bool isOneMade = false;
                foreach (ContextSlot slot in _slots)
                {
                    if (slot.IsReady && !slot.HasFailed)
                        return false;
                    isOneMade |= !slot.IsReady;
                }
                return isOneMade;
            }
        }

        public int WaitingCount => CountWaiting(_urgent, QueuePriority.Urgent) +
            CountWaiting(_refining, QueuePriority.Refinement);

        /// <summary>Whether a surface waits that has nothing new to show yet.</summary>
        public bool IsAnyUrgent => TryPeek(_urgent, QueuePriority.Urgent, out _);

        public void Enqueue(SurfaceSession session, QueuePriority priority)
        {
            if (session.QueuedAs == priority && session.Pool == this)
                return;
            session.QueuedAs = priority; // entries in other queues are passed over
            session.Pool = this;
            (priority == QueuePriority.Urgent ? _urgent : _refining).Enqueue(session);
        }

        /// <summary>Lends what is free to those who wait.</summary>
        public void Dispatch()
        {
            while (TryChoose(out SurfaceSession session, out bool isUrgent))
            {
                ContextSlot slot = FindFree(session, out bool isHopeless, out QuickSesError error);
                if (slot == null && !isHopeless)
                    return;
                (isUrgent ? _urgent : _refining).Dequeue();
                session.QueuedAs = QueuePriority.None;
                _urgentInARow = isUrgent ? _urgentInARow + 1 : 0;
                if (slot == null)
                    session.FailToBegin(error);
                else
                    Lend(slot, session).Start(slot);
            }
        }

        /// <summary>
        /// A context at once, for work that waits, one more than there should be if all are lent; on failure null and
        /// the reason. With goesOn it is made by another thread, and goesOn called now and then until it is there; if
        /// that returns false, nobody wants the context any more (Cancelled).
        /// </summary>
        public ContextSlot LendNow(SurfaceSession session, Func<bool> goesOn, out QuickSesError error)
        {
            ContextSlot slot = FindIdle(session);
            error = default;
            if (slot == null)
            {
                slot = SurfaceScheduler.NewSlot(_backend);
                if (!TryMake(slot, goesOn))
                {
                    error = new QuickSesError(QuickSesStatus.Cancelled, "cancelled while the back end was started");
                    return null;
                }
                error = slot.Error;
                if (slot.HasFailed)
                    return null;
                _slots.Add(slot);
            }
            Lend(slot, session);
            return slot;
        }

        /// <summary>The job is over.</summary>
        /// <param name="slot">What was lent.</param>
        /// <param name="isBroken">The device has failed, and with it the context.</param>
        public void Release(ContextSlot slot, bool isBroken)
        {
            slot.User = null;
            slot.LastUse = ++_uses;
            if (!isBroken && Count <= SurfaceScheduler.MaxContexts)
                return;
            _slots.Remove(slot);
            Retire(slot);
        }

        /// <summary>Nobody has these atoms any more.</summary>
        public void Forget(SurfaceAtomSet atoms)
        {
            foreach (ContextSlot slot in _slots)
                if (slot.SentBy == atoms)
                    slot.SentBy = null;
        }

        /// <summary>What could not be made is tried again.</summary>
        public void ForgetFailures()
        {
            for (int k = _slots.Count - 1; k >= 0; --k)
                if (_slots[k].HasFailed)
                    _slots.RemoveAt(k);
        }

        /// <summary>Takes all contexts back and has them freed, without waiting for it.</summary>
        public void ReleaseInBackground()
        {
            foreach (ContextSlot slot in _slots)
            {
                slot.Cancel();
                slot.User?.LoseContext();
                Retire(slot);
            }
            _slots.Clear();
            Clear(_urgent);
            Clear(_refining);
            _urgentInARow = 0;
        }

        /// <summary>Waits until what was taken back is freed.</summary>
        public void WaitUntilReleased()
        {
            foreach (ContextSlot slot in _retired)
                slot.WaitUntilDisposed();
            _retired.Clear();
        }

        private bool TryMake(ContextSlot slot, Func<bool> goesOn)
        {
            if (goesOn == null)
            {
                slot.Create();
                return true;
            }
            slot.CreateInBackground();
            bool isMade = false;
            try
            {
                while (!slot.IsReady && goesOn())
                    Thread.Sleep(SurfaceSession.Pause);
                isMade = slot.IsReady;
            }
            finally
            {
                if (!isMade)
                    Retire(slot); // goesOn is somebody else's, and may throw
            }
            return isMade;
        }

        private void Retire(ContextSlot slot)
        {
            for (int k = _retired.Count - 1; k >= 0; --k)
                if (_retired[k].IsDisposed)
                    _retired.RemoveAt(k);
            _retired.Add(slot);
            slot.DisposeInBackground();
        }

        private SurfaceSession Lend(ContextSlot slot, SurfaceSession session)
        {
            session.Pool = this;
            slot.User = session;
            slot.FirstJob = SurfaceScheduler.LastJob + 1;
            return session;
        }

        private bool TryChoose(out SurfaceSession session, out bool isUrgent)
        {
            bool refines = TryPeek(_refining, QueuePriority.Refinement, out SurfaceSession refining);
            isUrgent = TryPeek(_urgent, QueuePriority.Urgent, out session);
            if (refines && (!isUrgent || _urgentInARow >= RefinementTurn))
            {
                session = refining;
                isUrgent = false;
            }
            return session != null;
        }

        // The first in a queue who still waits in it.
        private bool TryPeek(Queue<SurfaceSession> queue, QueuePriority priority, out SurfaceSession session)
        {
            while (queue.TryPeek(out session))
            {
                if (session.QueuedAs == priority && session.Pool == this)
                    return true;
                queue.Dequeue();
            }
            return false;
        }

        // A context that may be used now. Null: the session has to wait for one, which is hopeless if none can be made;
        // `error` says why.
        private ContextSlot FindFree(SurfaceSession session, out bool isHopeless, out QuickSesError error)
        {
            isHopeless = false;
            error = default;
            int usable = Count;
            bool isOneMade = false;
            ContextSlot failed = null;
            foreach (ContextSlot slot in _slots)
            {
                isOneMade |= !slot.IsReady;
                failed = slot.HasFailed ? slot : failed;
            }
            ContextSlot idle = FindIdle(session); // after that: one that gets ready meanwhile is found
            if (idle != null && idle.SentBy == session.Atoms)
                return idle;
            if (failed != null)
            {
                isHopeless = usable == 0; // else the others go on with what there is
                error = failed.Error;
            }
            else if (!isOneMade && usable < SurfaceScheduler.MaxContexts && (idle == null || idle.SentBy != null))
            {
                ContextSlot slot = SurfaceScheduler.NewSlot(_backend);
                _slots.Add(slot);
                slot.CreateInBackground();
            }
            return idle;
        }

        // Preferably the one that has the session's atoms, then one that has none, then the one unused for longest.
        private ContextSlot FindIdle(SurfaceSession session)
        {
            ContextSlot best = null;
            foreach (ContextSlot slot in _slots)
            {
                if (!slot.IsReady || slot.Context == null || slot.User != null)
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

        private int CountWaiting(Queue<SurfaceSession> queue, QueuePriority priority)
        {
            int count = 0;
            foreach (SurfaceSession session in queue)
                if (session.QueuedAs == priority && session.Pool == this)
                    ++count;
            return count;
        }

        private void Clear(Queue<SurfaceSession> queue)
        {
            foreach (SurfaceSession session in queue)
                if (session.Pool == this)
                    session.QueuedAs = QueuePriority.None;
            queue.Clear();
        }
    }
}
