// SPDX-License-Identifier: MIT
using System;
using System.Collections;
using System.Collections.Generic;
using Unity.Collections.LowLevel.Unsafe;

namespace Unity.Collections
{
    public unsafe partial struct NativeArray<T>
    {
        public ReadOnly AsReadOnly() => new ReadOnly(this);

        public readonly struct ReadOnly : IEnumerable<T>
        {
            internal readonly void* _buffer;
            internal readonly int _length;
#if ENABLE_UNITY_COLLECTIONS_CHECKS
            private readonly AtomicSafetyHandle _safety;
#endif

            internal ReadOnly(NativeArray<T> array)
            {
                _buffer = array._buffer;
                _length = array._length;
#if ENABLE_UNITY_COLLECTIONS_CHECKS
                _safety = array._safety;
#endif
            }

            public int Length => _length;

            public bool IsCreated => _buffer != null;

            public T this[int index]
            {
                get
                {
                    if ((uint)index >= (uint)_length)
                        ThrowOutOfRange(index, _length);
                    RequireReadable();
                    return UnsafeUtility.ReadArrayElement<T>(_buffer, index);
                }
            }

            public void CopyTo(T[] array) => Copy(this, array);

            public void CopyTo(NativeArray<T> array) => Copy(this, array);

            public T[] ToArray()
            {
                var array = new T[_length];
                Copy(this, array);
                return array;
            }

            public NativeArray<U>.ReadOnly Reinterpret<U>() where U : struct
            {
                var array = new NativeArray<T>(_buffer, _length, Allocator.None);
#if ENABLE_UNITY_COLLECTIONS_CHECKS
                array._safety = _safety;
#endif
                return array.Reinterpret<U>().AsReadOnly();
            }

            internal Span<T> Span => new Span<T>(_buffer, _length);

            internal void RequireReadable()
            {
#if ENABLE_UNITY_COLLECTIONS_CHECKS
                AtomicSafetyHandle.CheckReadAndThrow(_safety);
#endif
            }

            public Enumerator GetEnumerator() => new Enumerator(this);

            IEnumerator<T> IEnumerable<T>.GetEnumerator() => GetEnumerator();

            IEnumerator IEnumerable.GetEnumerator() => GetEnumerator();

            public struct Enumerator : IEnumerator<T>
            {
                private readonly ReadOnly _array;
                private int _index;

                public Enumerator(in ReadOnly array)
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
}
