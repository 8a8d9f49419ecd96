// SPDX-License-Identifier: MIT
using System;

namespace Unity.Collections.LowLevel.Unsafe
{
    public static unsafe class NativeArrayUnsafeUtility
    {
#if ENABLE_UNITY_COLLECTIONS_CHECKS

        public static void SetAtomicSafetyHandle<T>(ref NativeArray<T> array, AtomicSafetyHandle safety)
            where T : struct => array._safety = safety;
#endif

        public static NativeArray<T> ConvertExistingDataToNativeArray<T>(void* dataPointer, int length,
            Allocator allocator) where T : struct
        {
            if (length < 0)
                throw new ArgumentOutOfRangeException(nameof(length), "Length must be >= 0");
            NativeArray<T>.RequireUnmanaged();
            return new NativeArray<T>(dataPointer, length, allocator);
        }

        public static void* GetUnsafeReadOnlyPtr<T>(this NativeArray<T> nativeArray) where T : struct
        {
            nativeArray.RequireReadable();
            return nativeArray._buffer;
        }
    }
}
