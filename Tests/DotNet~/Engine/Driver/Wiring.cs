// SPDX-License-Identifier: MIT
using UnityEngine;
using UnityEngine.Events;

namespace QuickSes.EngineDouble
{
    /// <summary>
    /// What users wire to UnityEvents in the inspector, which begins with Runtime Only, without target and method (null, "").
    /// </summary>
    public static class Wiring
    {
        public static void Wire<T>(UnityEvent<T> unityEvent, Object target, UnityAction<T> call,
            UnityEventCallState state = UnityEventCallState.RuntimeOnly, string method = "Call") =>
            unityEvent.Wire(target, method, call, state);
    }
}
