// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;

namespace UnityEngine.Events
{
    public delegate void UnityAction();

    public delegate void UnityAction<T0>(T0 arg0);

    public enum UnityEventCallState
    {
        Off = 0,
        EditorAndRuntime = 1,
        RuntimeOnly = 2
    }

    /// <summary>
    /// Listeners of scripts, and, standing in for those of the inspector, some that only count as such, and are called
    /// as their state says. A listener that throws stops the later ones, as in the engine.
    /// </summary>
    [Serializable]
    public abstract class UnityEventBase
    {
        private readonly List<Delegate> _listeners = new List<Delegate>();
        private readonly List<UnityEventCallState> _states = new List<UnityEventCallState>(); // of the persistent ones

        public int GetPersistentEventCount() => _states.Count;

        public UnityEventCallState GetPersistentListenerState(int index) => _states[index];

        public void SetPersistentListenerState(int index, UnityEventCallState state) => _states[index] = state;

        /// <summary>As if it were wired in the inspector.</summary>
        internal void Wire(Delegate listener, UnityEventCallState state)
        {
            _listeners.Insert(_states.Count, listener);
            _states.Add(state);
        }

        internal IReadOnlyList<Delegate> Listeners => _listeners;

        internal bool IsCalled(int index) => index >= _states.Count ||
            _states[index] == UnityEventCallState.EditorAndRuntime ||
            (_states[index] == UnityEventCallState.RuntimeOnly && Application.isPlaying);

        internal void Add(Delegate listener) => _listeners.Add(listener);

        internal void Remove(Delegate listener)
        {
            int k = _listeners.LastIndexOf(listener);
            if (k >= _states.Count)
                _listeners.RemoveAt(k);
        }
    }

    [Serializable]
    public class UnityEvent : UnityEventBase
    {
        public void AddListener(UnityAction call) => Add(call);

        public void RemoveListener(UnityAction call) => Remove(call);

        public void Invoke()
        {
            for (int k = 0; k < Listeners.Count; ++k)
                if (IsCalled(k))
                    ((UnityAction)Listeners[k])();
        }
    }

    [Serializable]
    public class UnityEvent<T0> : UnityEventBase
    {
        public void AddListener(UnityAction<T0> call) => Add(call);

        public void RemoveListener(UnityAction<T0> call) => Remove(call);

        public void Invoke(T0 arg0)
        {
            for (int k = 0; k < Listeners.Count; ++k)
                if (IsCalled(k))
                    ((UnityAction<T0>)Listeners[k])(arg0);
        }
    }
}
