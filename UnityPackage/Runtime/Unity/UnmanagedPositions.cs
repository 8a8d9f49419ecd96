// SPDX-License-Identifier: MIT
using System;
using System.Runtime.InteropServices;
using UnityEngine;

namespace QuickSes
{
    /// <summary>Positions outside of the garbage collector's heap.</summary>
    internal sealed unsafe class UnmanagedPositions : IDisposable
    {
        private readonly int _count;
        private Vector3* _memory;

        public UnmanagedPositions(int count)
        {
            _memory = (Vector3*)Marshal.AllocHGlobal((IntPtr)((long)count * sizeof(Vector3)));
            _count = count;
        }

        ~UnmanagedPositions() => Free();

        /// <summary>Valid until Dispose.</summary>
        public Span<Vector3> Span => new Span<Vector3>(_memory, _memory == null ? 0 : _count);

        public void Dispose()
        {
            Free();
            GC.SuppressFinalize(this);
        }

        private void Free()
        {
            Marshal.FreeHGlobal((IntPtr)_memory);
            _memory = null;
        }
    }
}
