// SPDX-License-Identifier: MIT
using QuickSes.Interop;
using System;
using System.Threading;

namespace QuickSes
{
    /// <summary>
    /// One of the few contexts of a <see cref="ContextPool"/>, and who may use it. Main thread only, but for
    /// <see cref="Create"/> and <see cref="Dispose"/>, which therefore run on threads of their own where nobody has to
    /// wait for them: CUDA starts within a second, but on a GPU newer than the library its driver compiles for a minute.
    /// </summary>
    internal sealed class ContextSlot
    {
        private static readonly ParameterizedThreadStart s_create = slot => ((ContextSlot)slot).Create();
        private static readonly ParameterizedThreadStart s_dispose = slot => ((ContextSlot)slot).Dispose();
        private static int s_nativeContexts;

        private readonly SurfaceContextOptions _options;
        private readonly object _change = new object(); // pulsed when it is ready, and when it is disposed
        private volatile bool _isReady;
        private volatile bool _isDisposed;
        private QuickSesError _error;

        public ContextSlot(in SurfaceContextOptions options)
        {
            _options = options;
        }

        /// <summary>Native contexts that there are in all, those on their way out included. Any thread.</summary>
        public static int NativeContexts => Volatile.Read(ref s_nativeContexts);

        /// <summary>Whether the context is made, or could not be made (<see cref="Context"/> is null then).</summary>
        public bool IsReady => _isReady;

        public bool HasFailed => _isReady && Context == null;

        public bool IsDisposed => _isDisposed;

        public SurfaceContext Context { get; private set; }

        /// <summary>Why there is no context.</summary>
        public QuickSesError Error => _error;

        /// <summary>Who uses it now, or null.</summary>
        public SurfaceSession User { get; set; }

        /// <summary>When it was used last: higher is later.</summary>
        public uint LastUse { get; set; }

        /// <summary>Jobs of this number and later ones are its present user's.</summary>
        public uint FirstJob { get; set; }

        // Which atoms the context holds.
        public SurfaceAtomSet SentBy { get; set; }

        public uint SentAtoms { get; set; }

        public uint SentPositions { get; set; }

        /// <summary>
        /// Where there is no library, that is found out at once: nobody waits for a thread then, and none is needed, which
        /// players for the web do not have.
        /// </summary>
        public void CreateInBackground()
        {
            if (!NativeLibraryCheck.IsUsable(out string reason))
                SetReady(null, new QuickSesError(QuickSesStatus.BackendUnavailable, reason));
            else if (!TryStart(s_create))
                SetReady(null, new QuickSesError(QuickSesStatus.InternalError, "no thread can be started"));
        }

        public void Create()
        {
            SurfaceContext context = null;
            QuickSesError error;
            try
            {
                if (SurfaceContext.TryCreate(_options, out context, out error))
                    Interlocked.Increment(ref s_nativeContexts);
            }
            catch (Exception e) // on a thread of its own it would end the program
            {
                error = new QuickSesError(QuickSesStatus.InternalError, e.Message);
            }
            SetReady(context, error);
        }

        /// <summary>Ends its job, if there is one, as soon as it can; does not wait.</summary>
        public void Cancel()
        {
            if (_isReady)
                Context?.Cancel();
        }

        public void DisposeInBackground()
        {
            if ((_isReady && Context == null) || !TryStart(s_dispose))
                Dispose();
        }

        /// <summary>Frees the context; waits for it to be made first.</summary>
        public void Dispose()
        {
            WaitUntil(false);
            if (Context != null)
            {
                Context.Dispose();
                Interlocked.Decrement(ref s_nativeContexts);
            }
            lock (_change)
            {
                _isDisposed = true;
                Monitor.PulseAll(_change);
            }
        }

        /// <summary>After <see cref="DisposeInBackground"/>.</summary>
        public void WaitUntilDisposed() => WaitUntil(true);

        private void SetReady(SurfaceContext context, in QuickSesError error)
        {
            lock (_change)
            {
                Context = context;
                _error = error;
                _isReady = true;
                Monitor.PulseAll(_change);
            }
        }

        private void WaitUntil(bool disposed)
        {
            lock (_change)
                while (!(disposed ? _isDisposed : _isReady))
                    Monitor.Wait(_change);
        }

        // Not one of the shared pool: when a game has filled that with its own work, nothing else gets a thread for seconds.
        private bool TryStart(ParameterizedThreadStart start)
        {
            try
            {
                new Thread(start) { IsBackground = true, Name = "QuickSES context" }.Start(this);
                return true;
            }
            catch (Exception) // no memory, or no threads at all
            {
                return false;
            }
        }
    }
}
