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
        private readonly List<Row> _rows = new List<Row>(); // of the inspector, for the first listeners

        private struct Row
        {
            public Object Target;
            public string Method;
            public UnityEventCallState State;
        }

        public int GetPersistentEventCount() => _rows.Count;

        public Object GetPersistentTarget(int index) => _rows[index].Target;

        public string GetPersistentMethodName(int index) => _rows[index].Method;

        public UnityEventCallState GetPersistentListenerState(int index) => _rows[index].State;

        public void SetPersistentListenerState(int index, UnityEventCallState state)
        {
            Row row = _rows[index];
            row.State = state;
            _rows[index] = row;
        }

        /// <summary>As if it were wired in the inspector.</summary>
        internal void Wire(Object target, string method, Delegate listener, UnityEventCallState state)
        {
            _listeners.Insert(_rows.Count, listener);
            _rows.Add(new Row { Target = target, Method = method, State = state });
        }

        internal IReadOnlyList<Delegate> Listeners => _listeners;

        internal bool IsCalled(int index)
        {
            if (index >= _rows.Count)
                return true;
            Row row = _rows[index];
            return row.Target != null && row.Method.Length > 0 && (row.State == UnityEventCallState.EditorAndRuntime ||
                (row.State == UnityEventCallState.RuntimeOnly && Application.isPlaying));
        }

        internal void Add(Delegate listener) => _listeners.Add(listener);

        internal void Remove(Delegate listener)
        {
            int k = _listeners.LastIndexOf(listener);
            if (k >= _rows.Count)
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
