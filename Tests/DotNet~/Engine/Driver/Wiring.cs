// SPDX-License-Identifier: MIT
using UnityEngine.Events;

namespace QuickSes.EngineDouble
{
    /// <summary>What users wire to UnityEvents in the inspector.</summary>
    public static class Wiring
    {
        public static void Wire(UnityEvent unityEvent, UnityAction call) => unityEvent.Wire(call);

        public static void Wire<T>(UnityEvent<T> unityEvent, UnityAction<T> call) => unityEvent.Wire(call);
    }
}
