// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;
using Unity.Collections;

namespace QuickSes.EngineDouble
{
    /// <summary>
    /// The memory behind native arrays and meshes: unmanaged, counted by allocator, filled with a pattern when it is
    /// given out and when it is taken back. Any thread may call it.
    /// </summary>
    public static unsafe class NativeHeap
    {
        // In front of each block.
        private struct Header
        {
            public byte* Start;
            public long Size;
            public long Allocator;
        }

        /// <summary>The label of the buffers of meshes; an allocator that code under test can't name.</summary>
        public const Allocator Meshes = (Allocator)6;

        private const byte NeverWritten = 0xff; // NaN, and an index beyond any mesh
        private const byte Freed = 0xdd;
        private const int MinimumAlignment = 16;

        private static readonly object s_lock = new object();
        private static readonly HashSet<IntPtr> s_live = new HashSet<IntPtr>();
        private static readonly int[] s_liveCounts = new int[8];

        /// <summary>Blocks of an allocator that have not been freed.</summary>
        public static int LiveCount(Allocator allocator)
        {
            lock (s_lock)
                return s_liveCounts[(int)allocator];
        }

        internal static void* Allocate(long size, int alignment, Allocator allocator)
        {
            if (size < 0)
                throw new ArgumentOutOfRangeException(nameof(size), "A block can't have a negative size.");
            if (allocator <= Allocator.Temp || (int)allocator >= s_liveCounts.Length)
                throw new ArgumentException("Allocator must be TempJob or Persistent", nameof(allocator));
            alignment = Math.Max(alignment, MinimumAlignment);
            var start = (byte*)Marshal.AllocHGlobal(new IntPtr(size + alignment + sizeof(Header)));
            long address = ((long)(start + sizeof(Header)) + alignment - 1) / alignment * alignment;
            var block = (byte*)address;
            Header* header = (Header*)block - 1;
            *header = new Header { Start = start, Size = size, Allocator = (long)allocator };
            Fill(block, NeverWritten, size);
            lock (s_lock)
            {
                s_live.Add((IntPtr)block);
                ++s_liveCounts[(int)allocator];
            }

            return block;
        }

        internal static void Free(void* block, Allocator allocator)
        {
            if (block == null)
                return;
            Header* header = (Header*)block - 1;
            lock (s_lock)
            {
                if (!s_live.Contains((IntPtr)block))
                    throw new InvalidOperationException("This block of native memory was freed before, or never lent.");
                if (header->Allocator != (long)allocator)
                    throw new InvalidOperationException(
                        $"A block of allocator {(Allocator)header->Allocator} is freed as one of {allocator}.");
                s_live.Remove((IntPtr)block);
                --s_liveCounts[(int)allocator];
            }

            Fill(block, Freed, header->Size);
            Marshal.FreeHGlobal(new IntPtr(header->Start));
        }

        internal static void Fill(void* destination, byte value, long size)
        {
            for (var to = (byte*)destination; size > 0;)
            {
                int count = (int)Math.Min(size, 1 << 30);
                new Span<byte>(to, count).Fill(value);
                to += count;
                size -= count;
            }
        }
    }
}
