// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;
using System.Runtime.CompilerServices;
using Unity.Collections.LowLevel.Unsafe;

namespace Unity.Collections
{
    /// <summary>
    /// Indices and ranges are checked in both configurations: a player would read or write foreign memory. Unlike in
    /// the Editor, no array makes a managed sentinel: leaks are found by <see cref="NativeHeap"/>.
    /// </summary>
    public unsafe partial struct NativeArray<T> : IDisposable where T : struct
    {
        internal void* _buffer;
        internal int _length;
        internal Allocator _allocator;
#if ENABLE_UNITY_COLLECTIONS_CHECKS
        internal AtomicSafetyHandle _safety;
#endif

        internal NativeArray(void* buffer, int length, Allocator allocator)
        {
            _buffer = buffer;
            _length = length;
            _allocator = allocator;
#if ENABLE_UNITY_COLLECTIONS_CHECKS
            _safety = default;
#endif
        }

        public NativeArray(int length, Allocator allocator, NativeArrayOptions options = NativeArrayOptions.ClearMemory)
        {
            if (length < 0)
                throw new ArgumentOutOfRangeException(nameof(length), "Length must be >= 0");
            RequireUnmanaged();
            long bytes = (long)length * UnsafeUtility.SizeOf<T>();
            this = new NativeArray<T>(NativeHeap.Allocate(bytes, UnsafeUtility.AlignOf<T>(), allocator), length,
                allocator);
            if ((options & NativeArrayOptions.ClearMemory) != 0)
                UnsafeUtility.MemClear(_buffer, bytes);
#if ENABLE_UNITY_COLLECTIONS_CHECKS
            _safety = AtomicSafetyHandle.Create();
#endif
        }

        public NativeArray(T[] array, Allocator allocator)
            : this(array?.Length ?? throw new ArgumentNullException(nameof(array)), allocator,
                NativeArrayOptions.UninitializedMemory)
        {
            Copy(array, this);
        }

        public readonly int Length => _length;

        public void Dispose()
        {
            if (_buffer == null)
                throw new ObjectDisposedException("The NativeArray is already disposed.");
            if (_allocator == Allocator.Invalid)
                throw new InvalidOperationException(
                    "The NativeArray can not be Disposed because it was not allocated with a valid allocator.");
            if (_allocator > Allocator.None)
            {
#if ENABLE_UNITY_COLLECTIONS_CHECKS
                AtomicSafetyHandle.CheckDeallocateAndThrow(_safety);
                AtomicSafetyHandle.Release(_safety);
#endif
                NativeHeap.Free(_buffer, _allocator);
                _allocator = Allocator.Invalid;
            }

            _buffer = null;
        }

        public readonly T[] ToArray()
        {
            var array = new T[_length];
            Copy(this, array);
            return array;
        }

        internal static void RequireUnmanaged()
        {
            if (RuntimeHelpers.IsReferenceOrContainsReferences<T>())
                throw new InvalidOperationException($"{typeof(T)} used in NativeArray<{typeof(T)}> must be unmanaged " +
                    "(contain no managed types) and cannot itself be a native container type.");
        }

        [MethodImpl(MethodImplOptions.AggressiveInlining)]
        internal readonly void RequireReadable()
        {
#if ENABLE_UNITY_COLLECTIONS_CHECKS
            AtomicSafetyHandle.CheckReadAndThrow(_safety);
#endif
        }

        [MethodImpl(MethodImplOptions.AggressiveInlining)]
        internal readonly void RequireWritable()
        {
#if ENABLE_UNITY_COLLECTIONS_CHECKS
            AtomicSafetyHandle.CheckWriteAndThrow(_safety);
#endif
        }
    }
}
