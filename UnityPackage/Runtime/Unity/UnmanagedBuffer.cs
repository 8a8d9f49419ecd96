// SPDX-License-Identifier: MIT
using System;
using System.Runtime.InteropServices;

namespace QuickSes
{
    /// <summary>
    /// An array outside the managed heap that only grows, so that frames of any size make no garbage. One thread at a
    /// time. Spans of it end when it grows and with Dispose.
    /// </summary>
    internal sealed unsafe class UnmanagedBuffer<T> : IDisposable where T : unmanaged
    {
        private T* _memory;
        private int _capacity;

        ~UnmanagedBuffer() => Free();

        public int Length { get; private set; }

        public T* Pointer => _memory;

        public Span<T> Span => new Span<T>(_memory, Length);

        /// <summary>Sets the length; what was in it is undefined afterwards.</summary>
        public Span<T> Resize(int length)
        {
            if (length > _capacity)
            {
                Length = 0;
                Free();
                long capacity = Math.Min(length + (long)length / 4, int.MaxValue);
                _memory = (T*)Marshal.AllocHGlobal(new IntPtr(capacity * sizeof(T)));
                _capacity = (int)capacity;
            }
            Length = length;
            return Span;
        }

        public void CopyFrom(ReadOnlySpan<T> values) => values.CopyTo(Resize(values.Length));

        public void Dispose()
        {
            Free();
            Length = 0;
            GC.SuppressFinalize(this);
        }

        private void Free()
        {
            Marshal.FreeHGlobal((IntPtr)_memory);
            _memory = null;
            _capacity = 0;
        }
    }
}
