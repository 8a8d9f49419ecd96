// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using Unity.Collections;
using Unity.Collections.LowLevel.Unsafe;

namespace QuickSes.EngineDouble.Tests
{
    public sealed unsafe class NativeArrayTest
    {
        [Test]
        public void ElementsAreKept()
        {
            using var array = new NativeArray<int>(new[] { 1, 2, 3, 4 }, Allocator.Persistent);
            Assert.That(array.ToArray(), Is.EqualTo(new[] { 1, 2, 3, 4 }));
            var copy = new int[2];
            NativeArray<int>.Copy(array, 2, copy, 0, 2);
            Assert.That(copy, Is.EqualTo(new[] { 3, 4 }));
            Assert.That(() => NativeArray<int>.Copy(array, 3, copy, 0, 2), Throws.ArgumentException);
            Assert.That(() => NativeArray<int>.Copy(array, copy), Throws.ArgumentException);
        }

        [Test]
        public void TextAssetsLendTheirMemory()
        {
            var asset = new UnityEngine.TextAsset("abcd");
            Assert.That(asset.dataSize, Is.EqualTo(4));
            NativeArray<byte> bytes = asset.GetData<byte>();
            Assert.That(bytes.ToArray(), Is.EqualTo(asset.bytes));
            Assert.That((IntPtr)bytes.GetUnsafeReadOnlyPtr(),
                Is.EqualTo((IntPtr)asset.GetData<byte>().GetUnsafeReadOnlyPtr()), "not a copy");
            Assert.That(asset.GetData<int>().Length, Is.EqualTo(1));
            Assert.That(() => asset.GetData<long>(), Throws.ArgumentException);
            UnityEngine.Object.DestroyImmediate(asset);
            Assert.That(() => asset.GetData<byte>(), Throws.Exception);
#if ENABLE_UNITY_COLLECTIONS_CHECKS
            Assert.That(() => (IntPtr)bytes.GetUnsafeReadOnlyPtr(), Throws.Exception, "it went with the asset");
#endif
        }

        [Test]
        public void AllocationsAreChecked()
        {
            using (var array = new NativeArray<int>(4, Allocator.Persistent))
                Assert.That(array.ToArray(), Is.All.Zero, "cleared");
            Assert.That(() => new NativeArray<int>(1, Allocator.None), Throws.ArgumentException);
            Assert.That(() => new NativeArray<(int, string)>(1, Allocator.Persistent),
                Throws.InvalidOperationException);
        }

        [Test]
        public void LiveMemoryIsCounted()
        {
            int live = NativeHeap.LiveCount(Allocator.Persistent);
            var array = new NativeArray<float>(100, Allocator.Persistent);
            Assert.That(NativeHeap.LiveCount(Allocator.Persistent), Is.EqualTo(live + 1));
            NativeArray<float> alias = array;
            array.Dispose();
            Assert.That(NativeHeap.LiveCount(Allocator.Persistent), Is.EqualTo(live));
            Assert.That(() => array.Dispose(), Throws.TypeOf<ObjectDisposedException>());
            // An alias does not know; a player frees the memory twice. ObjectDisposedException is one of these, too.
            Assert.That(() => alias.Dispose(), Throws.InstanceOf<InvalidOperationException>());
        }

#if ENABLE_UNITY_COLLECTIONS_CHECKS
        [Test]
        public void ViewsNeedAHandle()
        {
            int number = 7;
            NativeArray<int> view =
                NativeArrayUnsafeUtility.ConvertExistingDataToNativeArray<int>(&number, 1, Allocator.None);
            Assert.That(() => view.ToArray(), Throws.TypeOf<NullReferenceException>());
            Assert.That(() => ReadPointerOf(view), Throws.TypeOf<NullReferenceException>());
            AtomicSafetyHandle handle = AtomicSafetyHandle.Create();
            NativeArrayUnsafeUtility.SetAtomicSafetyHandle(ref view, handle);
            Assert.That(view.ToArray(), Is.EqualTo(new[] { 7 }));
            AtomicSafetyHandle.CheckDeallocateAndThrow(handle);
            AtomicSafetyHandle.Release(handle);
            Assert.That(() => view.ToArray(), Throws.TypeOf<ObjectDisposedException>());
            Assert.That(() => AtomicSafetyHandle.CheckDeallocateAndThrow(handle),
                Throws.TypeOf<ObjectDisposedException>());
            // The node is used again, and the old handle stays stale.
            AtomicSafetyHandle next = AtomicSafetyHandle.Create();
            Assert.That(() => view.ToArray(), Throws.TypeOf<ObjectDisposedException>());
            AtomicSafetyHandle.Release(next);
        }

        [Test]
        public void ReadOnlyHandlesRefuseWrites()
        {
            int number = 7;
            NativeArray<int> view =
                NativeArrayUnsafeUtility.ConvertExistingDataToNativeArray<int>(&number, 1, Allocator.None);
            AtomicSafetyHandle handle = AtomicSafetyHandle.Create();
            AtomicSafetyHandle.SetAllowSecondaryVersionWriting(handle, false);
            AtomicSafetyHandle.UseSecondaryVersion(ref handle);
            NativeArrayUnsafeUtility.SetAtomicSafetyHandle(ref view, handle);
            Assert.That(view.ToArray(), Is.EqualTo(new[] { 7 }));
            Assert.That(() => NativeArray<int>.Copy(new[] { 8 }, view), Throws.InvalidOperationException);
            AtomicSafetyHandle.Release(handle);
        }

        [Test]
        public void DisposedArraysAreRefused()
        {
            var array = new NativeArray<int>(1, Allocator.Persistent);
            NativeArray<int> alias = array;
            array.Dispose();
            Assert.That(() => alias.ToArray(), Throws.TypeOf<ObjectDisposedException>());
        }

        private static IntPtr ReadPointerOf(NativeArray<int> view) => (IntPtr)view.GetUnsafeReadOnlyPtr();
#else
        [Test]
        public void ViewsNeedNoHandle()
        {
            int number = 7;
            NativeArray<int> view =
                NativeArrayUnsafeUtility.ConvertExistingDataToNativeArray<int>(&number, 1, Allocator.None);
            Assert.That(view.ToArray(), Is.EqualTo(new[] { 7 }));
            Assert.That((IntPtr)view.GetUnsafeReadOnlyPtr(), Is.EqualTo((IntPtr)(&number)));
        }
#endif
    }
}
