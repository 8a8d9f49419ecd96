// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using Unity.Collections;
using Unity.Collections.LowLevel.Unsafe;
using UnityEngine.TestTools.Constraints;
using Is = UnityEngine.TestTools.Constraints.Is;

namespace QuickSes.EngineDouble.Tests
{
    public sealed unsafe class NativeArrayTest
    {
        [Test]
        public void ElementsAreKept()
        {
            using var array = new NativeArray<int>(new[] { 1, 2, 3, 4 }, Allocator.Persistent);
            int sum = 0;
            foreach (int element in array)
                sum += element;
            Assert.That(sum, Is.EqualTo(10));
            NativeArray<int> middle = array.GetSubArray(1, 2);
            middle[0] = 20;
            Assert.That(array[1], Is.EqualTo(20));
            Assert.That(middle.ToArray(), Is.EqualTo(new[] { 20, 3 }));
            Assert.That(array.AsReadOnly()[3], Is.EqualTo(4));
            Assert.That(array.Reinterpret<float>().Length, Is.EqualTo(4));
            Assert.That(array.Reinterpret<byte>(4).Length, Is.EqualTo(16));
            var copy = new int[2];
            NativeArray<int>.Copy(array, 2, copy, 0, 2);
            Assert.That(copy, Is.EqualTo(new[] { 3, 4 }));
        }

        [Test]
        public void RangesAreChecked()
        {
            using var array = new NativeArray<int>(4, Allocator.Persistent);
            Assert.That(array.ToArray(), Is.All.Zero, "cleared");
            Assert.That(() => array[4], Throws.TypeOf<IndexOutOfRangeException>());
            Assert.That(() => array[-1], Throws.TypeOf<IndexOutOfRangeException>());
            Assert.That(() => array.GetSubArray(3, 2), Throws.TypeOf<ArgumentOutOfRangeException>());
            Assert.That(() => array.CopyFrom(new int[3]), Throws.ArgumentException);
            Assert.That(() => new NativeArray<int>(1, Allocator.None), Throws.ArgumentException);
            Assert.That(() => new NativeArray<(int, string)>(1, Allocator.Temp), Throws.InvalidOperationException);
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
            Assert.That(array.IsCreated, Is.False);
            Assert.That(() => array.Dispose(), Throws.TypeOf<ObjectDisposedException>());
            // An alias does not know; a player frees the memory twice. ObjectDisposedException is one of these, too.
            Assert.That(() => alias.Dispose(), Throws.InstanceOf<InvalidOperationException>());
        }

        [Test]
        public void TemporaryMemoryEndsWithTheFrame()
        {
            var array = new NativeArray<int>(10, Allocator.Temp);
            Assert.That(NativeHeap.LiveCount(Allocator.Temp), Is.EqualTo(1));
            Engine.Frame(0.1);
            Assert.That(NativeHeap.LiveCount(Allocator.Temp), Is.Zero);
            Assert.That(array.Length, Is.EqualTo(10));
        }

        [Test]
        public void ViewsAllocateNothing()
        {
            using var array = new NativeArray<int>(10, Allocator.Persistent);
            int total = 0;
            void Look()
            {
                for (int i = 0; i < 100; ++i)
                {
                    NativeArray<int> view = array.GetSubArray(i % 5, 5);
                    view[2] = i;
                    total += view.AsReadOnly()[2];
                    using var other = new NativeArray<int>(5, Allocator.Persistent);
                }
            }

            Look();
            Assert.That(Look, Is.Not.AllocatingGCMemory());
            Assert.That(total, Is.EqualTo(2 * 4950));
        }

#if ENABLE_UNITY_COLLECTIONS_CHECKS
        [Test]
        public void ViewsNeedAHandle()
        {
            int number = 7;
            NativeArray<int> view =
                NativeArrayUnsafeUtility.ConvertExistingDataToNativeArray<int>(&number, 1, Allocator.None);
            Assert.That(() => view[0], Throws.TypeOf<NullReferenceException>());
            Assert.That(() => ReadPointerOf(view), Throws.TypeOf<NullReferenceException>());
            AtomicSafetyHandle handle = AtomicSafetyHandle.Create();
            NativeArrayUnsafeUtility.SetAtomicSafetyHandle(ref view, handle);
            Assert.That(view[0], Is.EqualTo(7));
            AtomicSafetyHandle.CheckDeallocateAndThrow(handle);
            AtomicSafetyHandle.Release(handle);
            Assert.That(() => view[0], Throws.TypeOf<ObjectDisposedException>());
            Assert.That(() => AtomicSafetyHandle.CheckDeallocateAndThrow(handle),
                Throws.TypeOf<ObjectDisposedException>());
            // The node is used again, and the old handle stays stale.
            AtomicSafetyHandle next = AtomicSafetyHandle.Create();
            Assert.That(() => view[0], Throws.TypeOf<ObjectDisposedException>());
            AtomicSafetyHandle.Release(next);
        }

        [Test]
        public void ReadOnlyHandlesRefuseWrites()
        {
            using var array = new NativeArray<int>(1, Allocator.Persistent);
            AtomicSafetyHandle handle = NativeArrayUnsafeUtility.GetAtomicSafetyHandle(array);
            AtomicSafetyHandle.SetAllowSecondaryVersionWriting(handle, false);
            AtomicSafetyHandle.UseSecondaryVersion(ref handle);
            NativeArray<int> view = array;
            NativeArrayUnsafeUtility.SetAtomicSafetyHandle(ref view, handle);
            Assert.That(view[0], Is.Zero);
            Assert.That(() => view[0] = 1, Throws.InvalidOperationException);
            view = array;
            view[0] = 1;
        }

        [Test]
        public void DisposedArraysAreRefused()
        {
            var array = new NativeArray<int>(1, Allocator.Persistent);
            NativeArray<int> alias = array, part = array.GetSubArray(0, 1);
            array.Dispose();
            Assert.That(() => alias[0], Throws.TypeOf<ObjectDisposedException>());
            Assert.That(() => part[0], Throws.TypeOf<ObjectDisposedException>());
        }

        private static IntPtr ReadPointerOf(NativeArray<int> view) => (IntPtr)view.GetUnsafeReadOnlyPtr();
#else
        [Test]
        public void ViewsNeedNoHandle()
        {
            int number = 7;
            NativeArray<int> view =
                NativeArrayUnsafeUtility.ConvertExistingDataToNativeArray<int>(&number, 1, Allocator.None);
            Assert.That(view[0], Is.EqualTo(7));
            Assert.That((IntPtr)view.GetUnsafeReadOnlyPtr(), Is.EqualTo((IntPtr)(&number)));
        }
#endif
    }
}
