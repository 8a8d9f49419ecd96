// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;
using System.Collections;
using System.Collections.Generic;
using System.Runtime.CompilerServices;
using Unity.Collections.LowLevel.Unsafe;

namespace Unity.Collections
{
    /// <summary>
    /// Indices and ranges are checked in both configurations: a player would read or write foreign memory. Unlike in
    /// the Editor, no array makes a managed sentinel: leaks are found by <see cref="NativeHeap"/>.
    /// </summary>
    public unsafe partial struct NativeArray<T> : IDisposable, IEnumerable<T>, IEquatable<NativeArray<T>>
        where T : struct
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
            _safety = allocator == Allocator.Temp
                ? AtomicSafetyHandle.GetTempMemoryHandle()
                : AtomicSafetyHandle.Create();
#endif
        }

        public NativeArray(T[] array, Allocator allocator)
            : this(array?.Length ?? throw new ArgumentNullException(nameof(array)), allocator,
                NativeArrayOptions.UninitializedMemory)
        {
            Copy(array, this);
        }

        public NativeArray(NativeArray<T> array, Allocator allocator)
            : this(array.Length, allocator, NativeArrayOptions.UninitializedMemory)
        {
            Copy(array, this);
        }

        public readonly int Length => _length;

        public readonly bool IsCreated => _buffer != null;

        public T this[int index]
        {
            [MethodImpl(MethodImplOptions.AggressiveInlining)]
            readonly get
            {
                if ((uint)index >= (uint)_length)
                    ThrowOutOfRange(index, _length);
                RequireReadable();
                return UnsafeUtility.ReadArrayElement<T>(_buffer, index);
            }

            [MethodImpl(MethodImplOptions.AggressiveInlining)]
            set
            {
                if ((uint)index >= (uint)_length)
                    ThrowOutOfRange(index, _length);
                RequireWritable();
                UnsafeUtility.WriteArrayElement(_buffer, index, value);
            }
        }

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
                if (!AtomicSafetyHandle.IsTempMemoryHandle(_safety))
                    AtomicSafetyHandle.Release(_safety);
#endif
                NativeHeap.Free(_buffer, _allocator);
                _allocator = Allocator.Invalid;
            }

            _buffer = null;
        }

        public void CopyFrom(T[] array) => Copy(array, this);

        public void CopyFrom(NativeArray<T> array) => Copy(array, this);

        public readonly void CopyTo(T[] array) => Copy(this, array);

        public readonly void CopyTo(NativeArray<T> array) => Copy(this, array);

        public readonly T[] ToArray()
        {
            var array = new T[_length];
            Copy(this, array);
            return array;
        }

        public readonly NativeArray<T> GetSubArray(int start, int length)
        {
            if (start < 0)
                throw new ArgumentOutOfRangeException(nameof(start), "start must be >= 0");
            if (length < 0 || (long)start + length > _length)
                throw new ArgumentOutOfRangeException(nameof(length),
                    $"sub array range {start}-{(long)start + length - 1} is outside the range of the native array " +
                    $"0-{_length - 1}");
            NativeArray<T> result = this;
            result._buffer = (byte*)_buffer + (long)start * UnsafeUtility.SizeOf<T>();
            result._length = length;
            result._allocator = Allocator.None;
            return result;
        }

        public readonly NativeArray<U> Reinterpret<U>() where U : struct
        {
            if (UnsafeUtility.SizeOf<T>() != UnsafeUtility.SizeOf<U>())
                throw new InvalidOperationException($"Types {typeof(T)} and {typeof(U)} are different sizes - direct " +
                    "reinterpretation is not possible. If this is what you intended, use Reinterpret(<type size>)");
            return Reinterpreted<U>(_length);
        }

        public readonly NativeArray<U> Reinterpret<U>(int expectedTypeSize) where U : struct
        {
            long size = UnsafeUtility.SizeOf<T>(), bytes = _length * size, length = bytes / UnsafeUtility.SizeOf<U>();
            if (size != expectedTypeSize)
                throw new InvalidOperationException(
                    $"Type {typeof(T)} was expected to be {expectedTypeSize} but is {size} bytes");
            if (length * UnsafeUtility.SizeOf<U>() != bytes)
                throw new InvalidOperationException(
                    $"{_length} elements of {typeof(T)} are no whole number of {typeof(U)}");
            return Reinterpreted<U>((int)length);
        }

        private readonly NativeArray<U> Reinterpreted<U>(int length) where U : struct
        {
            var result = new NativeArray<U>(_buffer, length, _allocator);
#if ENABLE_UNITY_COLLECTIONS_CHECKS
            result._safety = _safety;
#endif
            return result;
        }

        public readonly bool Equals(NativeArray<T> other) => _buffer == other._buffer && _length == other._length;

        public override readonly bool Equals(object obj) => obj is NativeArray<T> other && Equals(other);

        public override readonly int GetHashCode() => (int)(long)_buffer * 397 ^ _length;

        public static bool operator ==(NativeArray<T> left, NativeArray<T> right) => left.Equals(right);

        public static bool operator !=(NativeArray<T> left, NativeArray<T> right) => !left.Equals(right);

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

        internal static void ThrowOutOfRange(int index, int length) =>
            throw new IndexOutOfRangeException($"Index {index} is out of range of '{length}' Length.");

        public Enumerator GetEnumerator() => new Enumerator(ref this);

        IEnumerator<T> IEnumerable<T>.GetEnumerator() => GetEnumerator();

        IEnumerator IEnumerable.GetEnumerator() => GetEnumerator();

        public struct Enumerator : IEnumerator<T>
        {
            private readonly NativeArray<T> _array;
            private int _index;

            public Enumerator(ref NativeArray<T> array)
            {
                _array = array;
                _index = -1;
            }

            public readonly T Current => _array[_index];

            readonly object IEnumerator.Current => Current;

            public bool MoveNext() => ++_index < _array._length;

            public void Reset() => _index = -1;

            public readonly void Dispose()
            {
            }
        }
    }
}
