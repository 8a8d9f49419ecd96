// SPDX-License-Identifier: MIT
using System.Threading;

namespace QuickSes
{
    /// <summary>
    /// One of the few contexts of <see cref="SurfaceScheduler"/>, and who may use it. Main thread only, but for <see
    /// cref="Create"/> and <see cref="Dispose"/>, which may take a third of a second with CUDA and therefore run on
    /// threads of their own where nobody has to wait for them.
    /// </summary>
    internal sealed class ContextSlot
    {
        private static readonly WaitCallback s_create = slot => ((ContextSlot)slot).Create();
        private static readonly WaitCallback s_dispose = slot => ((ContextSlot)slot).Dispose();

        private readonly SurfaceContextOptions _options;
        private volatile bool _isReady;
        private QuickSesError _error;

        public ContextSlot(in SurfaceContextOptions options)
        {
            _options = options;
        }

        /// <summary>What was asked for: Auto is a back end of its own here.</summary>
        public SurfaceBackend Backend => _options.Backend;

        /// <summary>Whether the context is made, or could not be made (<see cref="Context"/> is null then).</summary>
        public bool IsReady => _isReady;

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
            SurfaceContext.TryCreate(_options, out SurfaceContext context, out _error);
            Context = context;
            _isReady = true;
        }

        public void DisposeInBackground() => ThreadPool.UnsafeQueueUserWorkItem(s_dispose, this);

        /// <summary>Frees the context; waits for it to be made first.</summary>
        public void Dispose()
        {
            var wait = new SpinWait();
            while (!_isReady)
                wait.SpinOnce();
            Context?.Dispose();
        }
    }
}
