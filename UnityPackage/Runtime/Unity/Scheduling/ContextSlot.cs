// SPDX-License-Identifier: MIT
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
        private static readonly WaitCallback s_create = slot => ((ContextSlot)slot).Create();
        private static readonly WaitCallback s_dispose = slot => ((ContextSlot)slot).Dispose();
        private static int s_nativeContexts;

        private readonly SurfaceContextOptions _options;
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

        public uint SentAppearance { get; set; }

        public void CreateInBackground() => ThreadPool.UnsafeQueueUserWorkItem(s_create, this);

        public void Create()
        {
            try
            {
                if (SurfaceContext.TryCreate(_options, out SurfaceContext context, out _error))
                    Interlocked.Increment(ref s_nativeContexts);
                Context = context;
            }
            catch (Exception e) // on a thread of the pool it would end the program
            {
                _error = new QuickSesError(QuickSesStatus.InternalError, e.Message);
            }
            _isReady = true;
        }

        /// <summary>Ends its job, if there is one, as soon as it can; does not wait.</summary>
        public void Cancel()
        {
            if (_isReady)
                Context?.Cancel();
        }

        public void DisposeInBackground() => ThreadPool.UnsafeQueueUserWorkItem(s_dispose, this);

        /// <summary>Frees the context; waits for it to be made first.</summary>
        public void Dispose()
        {
            WaitUntil(false);
            if (Context != null)
            {
                Context.Dispose();
                Interlocked.Decrement(ref s_nativeContexts);
            }
            _isDisposed = true;
        }

        /// <summary>After <see cref="DisposeInBackground"/>.</summary>
        public void WaitUntilDisposed() => WaitUntil(true);

        private void WaitUntil(bool disposed)
        {
            var wait = new SpinWait();
            while (!(disposed ? _isDisposed : _isReady))
                wait.SpinOnce();
        }
    }
}
