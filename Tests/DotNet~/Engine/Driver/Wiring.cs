// SPDX-License-Identifier: MIT
using UnityEngine.Events;

namespace QuickSes.EngineDouble
{
    /// <summary>What users wire to UnityEvents in the inspector, which begins with Runtime Only.</summary>
    public static class Wiring
    {
        public static void Wire(UnityEvent unityEvent, UnityAction call,
            UnityEventCallState state = UnityEventCallState.RuntimeOnly) => unityEvent.Wire(call, state);

        public static void Wire<T>(UnityEvent<T> unityEvent, UnityAction<T> call,
            UnityEventCallState state = UnityEventCallState.RuntimeOnly) => unityEvent.Wire(call, state);
    }
}
