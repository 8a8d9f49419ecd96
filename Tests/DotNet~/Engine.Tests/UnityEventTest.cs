// SPDX-License-Identifier: MIT
using NUnit.Framework;
using UnityEngine;
using UnityEngine.Events;

namespace QuickSes.EngineDouble.Tests
{
    /// <summary>As PersistentCall.GetRuntimeCall of the engine decides who is called.</summary>
    public sealed class UnityEventTest
    {
        [Test]
        public void WhatIsWiredIsCalledAsItsStateSays([Values] UnityEventCallState state, [Values] bool isEditMode)
        {
            if (isEditMode)
                Engine.EnterEditMode();
            var unityEvent = new UnityEvent<int>();
            int wired = 0, added = 0;
            var target = new GameObject("target");
            Wiring.Wire(unityEvent, target, number => wired += number);
            Assert.That(unityEvent.GetPersistentListenerState(0), Is.EqualTo(UnityEventCallState.RuntimeOnly));
            unityEvent.SetPersistentListenerState(0, state);
            unityEvent.AddListener(number => added += number);
            unityEvent.Invoke(3);
            bool isCalled = state == UnityEventCallState.EditorAndRuntime ||
                (state == UnityEventCallState.RuntimeOnly && !isEditMode);
            Assert.That(wired, Is.EqualTo(isCalled ? 3 : 0));
            Assert.That(added, Is.EqualTo(3));
            Assert.That(unityEvent.GetPersistentEventCount(), Is.EqualTo(1), "called or not");
            Object.DestroyImmediate(target);
            unityEvent.Invoke(3);
            Assert.That((wired, added), Is.EqualTo((isCalled ? 3 : 0, 6)), "a target that is gone is not called");
        }

        [Test]
        public void RowsThatAreNotFilledAreNotCalled()
        {
            var unityEvent = new UnityEvent<int>();
            var target = new GameObject("target");
            Wiring.Wire(unityEvent, null, number => Assert.Fail("no target"), UnityEventCallState.EditorAndRuntime, "");
            Wiring.Wire(unityEvent, target, number => Assert.Fail("no method"), UnityEventCallState.EditorAndRuntime, "");
            unityEvent.Invoke(1);
            Assert.That(unityEvent.GetPersistentTarget(0) == null);
            Assert.That(unityEvent.GetPersistentTarget(1), Is.SameAs(target));
            Assert.That(unityEvent.GetPersistentMethodName(1), Is.Empty);
        }
    }
}
