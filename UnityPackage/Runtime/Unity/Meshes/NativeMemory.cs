// SPDX-License-Identifier: MIT
using System;
using Unity.Collections;
using Unity.Collections.LowLevel.Unsafe;

namespace QuickSes
{
    /// <summary>Lets the engine read native memory in place. Use one for long; it makes no garbage.</summary>
    internal sealed unsafe class NativeMemory : IDisposable
    {
#if ENABLE_UNITY_COLLECTIONS_CHECKS
        private AtomicSafetyHandle _safety; // the engine needs one to read
        private bool _hasSafety;
#endif

        /// <summary>For one call of the engine: don't keep it, don't dispose of it.</summary>
        public NativeArray<T> View<T>(void* memory, int length) where T : unmanaged
        {
            NativeArray<T> view =
                NativeArrayUnsafeUtility.ConvertExistingDataToNativeArray<T>(memory, length, Allocator.None);
#if ENABLE_UNITY_COLLECTIONS_CHECKS
            if (!_hasSafety)
            {
                _safety = AtomicSafetyHandle.Create();
                _hasSafety = true;
            }
            NativeArrayUnsafeUtility.SetAtomicSafetyHandle(ref view, _safety);
#endif
            return view;
        }

        /// <summary>May be used again afterwards.</summary>
        public void Dispose()
        {
#if ENABLE_UNITY_COLLECTIONS_CHECKS
            if (!_hasSafety)
                return;
            _hasSafety = false;
            AtomicSafetyHandle.CheckDeallocateAndThrow(_safety);
            AtomicSafetyHandle.Release(_safety);
#endif
        }
    }
}
