// SPDX-License-Identifier: MIT
using QuickSes.Interop;
using System;
using System.Threading;

namespace QuickSes
{
    /// <summary>
    /// Atoms, the memory and threads (of CPU or GPU) that compute their surface, and the last mesh. Making one takes
    /// long and it keeps its memory: use it again for the next frame.
    /// <para>Threads: one at a time, but for <see cref="Poll"/> and <see cref="Cancel"/>, which any thread may call at
    /// any time. Contexts are independent of each other.</para>
    /// <para>Errors: what the caller could have known to be wrong throws (<see cref="QuickSesException"/>,
    /// <see cref="ArgumentException"/>, <see cref="ObjectDisposedException"/>); what depends on the machine or on the
    /// size of the molecule is returned, with a sentence in <see cref="LastError"/>. After any of them the context is
    /// still usable, the atoms are those set before, and the last mesh stays valid. Only a fault of the GPU ends CUDA for
    /// the whole process: contexts with it return DeviceError from then on.</para>
    /// <para>Garbage: none in <see cref="SetPositions(ReadOnlySpan{float})"/>, <see cref="Begin"/>, <see cref="Poll"/>,
    /// <see cref="TryCollect"/> and their like, unless something goes wrong.</para>
    /// </summary>
    public sealed partial class SurfaceContext : IMeshHolder, IDisposable
    {
        private readonly ContextHandle _handle;
        private int _generation; // of the mesh: views of older ones have ended

        /// <summary>
        /// Makes a context with what <paramref name="options"/> says, or throws <see cref="QuickSesException"/>. Where
        /// the back end may be missing, use <see cref="TryCreate"/>.
        /// </summary>
        public SurfaceContext(SurfaceContextOptions options = default) : this(CreateOrThrow(options))
        {
        }

        private SurfaceContext(ContextHandle handle)
        {
            _handle = handle;
            Describe(out SurfaceBackend backend, out BackendDescription description);
            Backend = backend;
            Description = description;
        }

        /// <summary>
        /// Makes a context; false: <paramref name="error"/> says why there is none (and context is null).
        /// </summary>
        public static bool TryCreate(SurfaceContextOptions options, out SurfaceContext context, out QuickSesError error)
        {
            var handle = new ContextHandle();
            error = Create(options, handle);
            context = error.Status == QuickSesStatus.Ok ? new SurfaceContext(handle) : null;
            return context != null;
        }

        /// <summary>CUDA or CPU, never Auto.</summary>
        public SurfaceBackend Backend { get; }

        /// <summary>The device, and for a context made with Auto why it is not CUDA.</summary>
        public BackendDescription Description { get; }

        /// <summary>
        /// What went wrong in the last call on this context that returned something else than Ok; "" if none has.
        /// </summary>
        public string LastError { get; private set; } = "";

        /// <summary>The version of the native library, such as "0.1.0".</summary>
        public static unsafe string NativeVersion
        {
            get
            {
                NativeLibraryCheck.ThrowIfUnusable();
                return NativeText.Read(NativeMethods.qses_version());
            }
        }

        /// <summary>
        /// How many CUDA devices there are; 0 without CUDA. Throws if the library can't be used. Starts CUDA, as
        /// <see cref="GetBackendDescription"/>.
        /// </summary>
        public static unsafe int DeviceCount
        {
            get
            {
                NativeLibraryCheck.ThrowIfUnusable();
                uint count;
                QuickSesException.ThrowUnlessOk(NativeMethods.qses_device_count(&count));
                return (int)count;
            }
        }

        /// <summary>
        /// Whether surfaces can be computed here. Never throws: a native library that is missing, too old, too new or
        /// of another architecture is told in <paramref name="reason"/> ("" if all is well). Does not start CUDA, so it
        /// takes no time. Any thread.
        /// </summary>
        public static bool IsSupported(out string reason) => IsSupported(SurfaceBackend.Auto, out reason);

        /// <summary>
        /// Whether one back end can be used here, and if not, why; Auto always can where the library can. Never throws.
        /// Any thread; the first question for CUDA in a process starts it, which takes up to a second.
        /// </summary>
        public static bool IsSupported(SurfaceBackend backend, out string reason)
        {
            if (!NativeLibraryCheck.IsUsable(out reason))
                return false;
            SurfaceBackend needed = backend == SurfaceBackend.Auto ? SurfaceBackend.Cpu : backend;
            QuickSesStatus status = BackendInfo(needed, out BackendDescription description);
            if (status != QuickSesStatus.Ok)
                reason = NativeText.LastError();
            else if (!description.IsAvailable)
                reason = description.Reason;
            return status == QuickSesStatus.Ok && description.IsAvailable;
        }

        /// <summary>
        /// Describes a back end; Auto is the one that would be chosen. Throws <see cref="QuickSesException"/> if the
        /// library can't be used or there is no such back end. Any thread; the first question for CUDA or Auto in a
        /// process starts CUDA, which takes up to a second, so a game's main thread better leaves it to another one.
        /// </summary>
        public static BackendDescription GetBackendDescription(SurfaceBackend backend)
        {
            NativeLibraryCheck.ThrowIfUnusable();
            QuickSesException.ThrowUnlessOk(BackendInfo(backend, out BackendDescription description));
            return description;
        }

        /// <summary>
        /// Cancels and joins what still runs, then frees the context and everything it handed out. May be called twice.
        /// A call that runs on another thread is cancelled, and the memory is freed when it returns.
        /// </summary>
        public void Dispose()
        {
            if (_handle.IsClosed)
                return;
            try
            {
                NativeMethods.qses_cancel(_handle);
            }
            catch (ObjectDisposedException)
            {
                return; // another thread was faster
            }
            _handle.Dispose();
        }

        internal void ThrowIfDisposed() => _handle.ThrowIfClosed(nameof(SurfaceContext));

        void IMeshHolder.ThrowIfDisposed() => ThrowIfDisposed();

        bool IMeshHolder.IsCurrent(int generation) =>
            !_handle.IsClosed && Volatile.Read(ref _generation) == generation;

        private static ContextHandle CreateOrThrow(in SurfaceContextOptions options)
        {
            var handle = new ContextHandle();
            QuickSesError error = Create(options, handle);
            return error.Status == QuickSesStatus.Ok ? handle : throw error.ToException();
        }

        private static unsafe QuickSesError Create(in SurfaceContextOptions options, ContextHandle handle)
        {
            if (!NativeLibraryCheck.IsUsable(out string reason))
                return new QuickSesError(QuickSesStatus.BackendUnavailable, reason);
            NativeContextOptions native = NativeDefaults.ContextOptions();
            native.Backend = options.Backend;
            native.Device = options.Device;
            native.Threads = options.Threads;
            native.MemoryBudget = options.MemoryBudget;
            native.Background = options.Background ? 1 : 0;
            IntPtr context;
            QuickSesStatus status = NativeMethods.qses_context_create(&native, &context);
            if (status == QuickSesStatus.Ok)
                handle.Take(context);
            return QuickSesError.FromLastCall(status);
        }

        private static unsafe QuickSesStatus BackendInfo(SurfaceBackend backend, out BackendDescription description)
        {
            NativeBackendDescription native = NativeDefaults.BackendDescription();
            QuickSesStatus status = NativeMethods.qses_backend_info(backend, &native);
            description = new BackendDescription(native);
            return status;
        }

        private unsafe void Describe(out SurfaceBackend backend, out BackendDescription description)
        {
            NativeBackendDescription native = NativeDefaults.BackendDescription();
            fixed (SurfaceBackend* which = &backend)
                QuickSesException.ThrowUnlessOk(NativeMethods.qses_context_info(_handle, which, &native));
            description = new BackendDescription(native);
        }

        // The one rule of errors: see the summary of the class.
        private QuickSesStatus Check(QuickSesStatus status)
        {
            switch (status)
            {
                case QuickSesStatus.Ok:
                    return status;
                case QuickSesStatus.InvalidArgument:
                case QuickSesStatus.NoAtoms:
                    throw QuickSesException.FromLastCall(status);
                default:
                    LastError = NativeText.LastError();
                    return status;
            }
        }
    }
}
