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

        public static void* Malloc(long size, int alignment, Allocator allocator) =>
            NativeHeap.Allocate(size, alignment, allocator);

        public static void Free(void* memory, Allocator allocator) => NativeHeap.Free(memory, allocator);

        public static bool IsValidAllocator(Allocator allocator) => allocator > Allocator.None;

        public static void MemCpy(void* destination, void* source, long size)
        {
            if (size < 0)
                throw new ArgumentOutOfRangeException(nameof(size));
            var to = (byte*)destination;
            var from = (byte*)source;
            if (to < from + size && from < to + size && size > 0)
                throw new ArgumentException("MemCpy of ranges that overlap; MemMove is for these.");
            Buffer.MemoryCopy(source, destination, size, size);
        }

        public static void MemMove(void* destination, void* source, long size) =>
            Buffer.MemoryCopy(source, destination, size, size);

        public static void MemCpyStride(void* destination, int destinationStride, void* source, int sourceStride,
            int elementSize, int count)
        {
            for (int i = 0; i < count; ++i)
                Buffer.MemoryCopy((byte*)source + (long)i * sourceStride,
                    (byte*)destination + (long)i * destinationStride, elementSize, elementSize);
        }

        public static void MemCpyReplicate(void* destination, void* source, int size, int count) =>
            MemCpyStride(destination, size, source, 0, size, count);

        public static void MemSet(void* destination, byte value, long size) =>
            NativeHeap.Fill(destination, value, size);

        public static void MemClear(void* destination, long size) => NativeHeap.Fill(destination, 0, size);

        public static int MemCmp(void* ptr1, void* ptr2, long size)
        {
            for (long i = 0; i < size; ++i)
            {
                int difference = ((byte*)ptr1)[i] - ((byte*)ptr2)[i];
                if (difference != 0)
                    return difference;
            }

            return 0;
        }

        [MethodImpl(MethodImplOptions.AggressiveInlining)]
        public static int SizeOf<T>() where T : struct
        {
            T value = default;
            return MemoryMarshal.AsBytes(MemoryMarshal.CreateSpan(ref value, 1)).Length;
        }

        public static int AlignOf<T>() where T : struct => SizeOf<AlignmentProbe<T>>() - SizeOf<T>();

        public static bool IsUnmanaged<T>() => !RuntimeHelpers.IsReferenceOrContainsReferences<T>();

        public static bool IsBlittable<T>() where T : struct => IsUnmanaged<T>();

        [MethodImpl(MethodImplOptions.AggressiveInlining)]
        public static T ReadArrayElement<T>(void* source, int index) where T : struct =>
            ArrayElementAsRef<T>(source, index);

        public static T ReadArrayElementWithStride<T>(void* source, int index, int stride) where T : struct =>
            AsRef<T>((byte*)source + (long)index * stride);

        [MethodImpl(MethodImplOptions.AggressiveInlining)]
        public static void WriteArrayElement<T>(void* destination, int index, T value) where T : struct =>
            ArrayElementAsRef<T>(destination, index) = value;

        public static void WriteArrayElementWithStride<T>(void* destination, int index, int stride, T value)
            where T : struct => AsRef<T>((byte*)destination + (long)index * stride) = value;

        public static void CopyPtrToStructure<T>(void* ptr, out T output) where T : struct => output = AsRef<T>(ptr);

        public static void CopyStructureToPtr<T>(ref T input, void* ptr) where T : struct => AsRef<T>(ptr) = input;

        public static void* AddressOf<T>(ref T output) where T : struct
        {
            fixed (byte* address = MemoryMarshal.AsBytes(MemoryMarshal.CreateSpan(ref output, 1)))
                return address;
        }

        [MethodImpl(MethodImplOptions.AggressiveInlining)]
        public static ref T AsRef<T>(void* ptr) where T : struct => ref MemoryMarshal.GetReference(new Span<T>(ptr, 1));

        [MethodImpl(MethodImplOptions.AggressiveInlining)]
        public static ref T ArrayElementAsRef<T>(void* ptr, int index) where T : struct =>
            ref AsRef<T>((byte*)ptr + (long)index * SizeOf<T>());

        public static void* PinGCArrayAndGetDataAddress(Array target, out ulong gcHandle)
        {
            GCHandle handle = GCHandle.Alloc(target, GCHandleType.Pinned);
            gcHandle = (ulong)(long)GCHandle.ToIntPtr(handle);
            return (void*)handle.AddrOfPinnedObject();
        }

        public static void* PinGCObjectAndGetAddress(object target, out ulong gcHandle)
        {
            GCHandle handle = GCHandle.Alloc(target, GCHandleType.Pinned);
            gcHandle = (ulong)(long)GCHandle.ToIntPtr(handle);
            return (void*)handle.AddrOfPinnedObject();
        }

        public static void ReleaseGCObject(ulong gcHandle) => GCHandle.FromIntPtr(new IntPtr((long)gcHandle)).Free();
    }
}
