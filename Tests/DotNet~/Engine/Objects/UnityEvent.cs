// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;

namespace UnityEngine.Events
{
    public delegate void UnityAction();

    public delegate void UnityAction<T0>(T0 arg0);

    /// <summary>
    /// Listeners of scripts, and, standing in for those of the inspector, some that only count as such. A listener that
    /// throws stops the later ones, as in the engine.
    /// </summary>
    [Serializable]
    public abstract class UnityEventBase
    {
        private readonly List<Delegate> _listeners = new List<Delegate>();
        private int _persistent;

        public int GetPersistentEventCount() => _persistent;

        /// <summary>As if it were wired in the inspector.</summary>
        internal void Wire(Delegate listener)
        {
            _listeners.Insert(_persistent++, listener);
        }

        internal IReadOnlyList<Delegate> Listeners => _listeners;

        internal void Add(Delegate listener) => _listeners.Add(listener);

        internal void Remove(Delegate listener)
        {
            int k = _listeners.LastIndexOf(listener);
            if (k >= _persistent)
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
                ((UnityAction<T0>)Listeners[k])(arg0);
        }
    }
}
