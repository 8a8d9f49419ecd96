// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Threading;

namespace QuickSes
{
    /// <summary>
    /// A thread of the package's own: it waits for none of the game's tasks, as one of the shared pool may have to, and
    /// it has left before a domain is unloaded. Nobody waits for it in the middle of a game.
    /// </summary>
    internal abstract class BackgroundThread
    {
        private const int LongestWait = 5000; // ms

        // Those that have not left yet. Guarded by itself.
        private static readonly List<BackgroundThread> s_running = new List<BackgroundThread>();

        private readonly Thread _thread;

        /// <summary>Starts each. In tests: one that throws, as where there are no threads left.</summary>
        internal static Action<Thread> Starter { get; set; } = thread => thread.Start();

        /// <summary>Whether no more threads should begin.</summary>
        public static bool IsDomainEnding { get; private set; }

        protected BackgroundThread(string name)
        {
            _thread = new Thread(RunAndLeave) { IsBackground = true, Name = name };
        }

        /// <summary>Before the domain is unloaded, or the program ends: <see cref="SendAllAway"/>.</summary>
        public static void EndAll()
        {
            IsDomainEnding = true;
            SendAllAway();
        }

        /// <summary>
        /// Sends all there are away and waits until they have left, for 5 s at most. It has to wait: after it none may
        /// run code of a domain that is unloaded, or of a native library whose program ends.
        /// </summary>
        public static void SendAllAway()
        {
            BackgroundThread[] running;
            lock (s_running)
                running = s_running.ToArray();
            foreach (BackgroundThread each in running)
                each.SendAway();
            Stopwatch waited = Stopwatch.StartNew();
            foreach (BackgroundThread each in running)
                each._thread.Join((int)Math.Max(0, LongestWait - waited.ElapsedMilliseconds));
        }

        /// <summary>Whether it has left, and everything it had is given back.</summary>
        internal bool HasLeft => !_thread.IsAlive;

        /// <summary>Tells it to leave as soon as it can; does not wait. Any thread, any number of times.</summary>
        public abstract void SendAway();

        /// <summary>Must not throw: that would end the program.</summary>
        protected abstract void Run();

        /// <summary>Throws if no more threads can be started.</summary>
        protected void Start()
        {
            lock (s_running)
            {
                Starter(_thread);
                s_running.Add(this);
            }
        }

        /// <summary>What an exception is for those who are told of errors.</summary>
        protected static QuickSesError Describe(Exception exception) => new QuickSesError(
            exception is OutOfMemoryException ? QuickSesStatus.OutOfMemory : QuickSesStatus.InternalError,
            exception.Message);

        private void RunAndLeave()
        {
            try
            {
                Run();
            }
            finally
            {
                lock (s_running)
                    s_running.Remove(this);
            }
        }
    }
}
