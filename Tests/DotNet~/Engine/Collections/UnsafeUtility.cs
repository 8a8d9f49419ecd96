// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;

namespace Unity.Collections.LowLevel.Unsafe
{
    public static unsafe class UnsafeUtility
    {
        private struct AlignmentProbe<T> where T : struct
        {
#pragma warning disable CS0649 // Only the layout is of interest.
            public byte First;
            public T Second;
#pragma warning restore CS0649
        }

        public static void MemClear(void* destination, long size) => NativeHeap.Fill(destination, 0, size);

        [MethodImpl(MethodImplOptions.AggressiveInlining)]
        public static int SizeOf<T>() where T : struct
        {
            T value = default;
            return MemoryMarshal.AsBytes(MemoryMarshal.CreateSpan(ref value, 1)).Length;
        }

        public static int AlignOf<T>() where T : struct => SizeOf<AlignmentProbe<T>>() - SizeOf<T>();

        public static void* PinGCArrayAndGetDataAddress(Array target, out ulong gcHandle)
        {
            GCHandle handle = GCHandle.Alloc(target, GCHandleType.Pinned);
            gcHandle = (ulong)(long)GCHandle.ToIntPtr(handle);
            return (void*)handle.AddrOfPinnedObject();
        }

        public static void ReleaseGCObject(ulong gcHandle) => GCHandle.FromIntPtr(new IntPtr((long)gcHandle)).Free();
    }
}
