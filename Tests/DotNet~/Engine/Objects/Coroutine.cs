// SPDX-License-Identifier: MIT
using System.Collections;
using System.Collections.Generic;

namespace UnityEngine
{
    /// <summary>Enumerators that are given are gone through first; whatever else is given waits for the next frame.</summary>
    public sealed class Coroutine
    {
        private static readonly List<Coroutine> s_running = new List<Coroutine>();

        private readonly MonoBehaviour _script;
        private readonly Stack<IEnumerator> _routines = new Stack<IEnumerator>();

        private Coroutine(MonoBehaviour script, IEnumerator routine)
        {
            _script = script;
            _routines.Push(routine);
        }

        internal static Coroutine Start(MonoBehaviour script, IEnumerator routine)
        {
            var started = new Coroutine(script, routine);
            if (started.Step())
                s_running.Add(started);
            return started;
        }

        internal static void RunAll()
        {
            for (int k = 0; k < s_running.Count;)
                if (s_running[k]._script != null && s_running[k]._script.gameObject.activeInHierarchy && s_running[k].Step())
                    ++k;
                else
                    s_running.RemoveAt(k);
        }

        internal static void Reset() => s_running.Clear();

        private bool Step()
        {
            while (_routines.Count > 0)
            {
                if (!_routines.Peek().MoveNext())
                    _routines.Pop();
                else if (_routines.Peek().Current is IEnumerator inner)
                    _routines.Push(inner);
                else
                    return true;
            }
            return false;
        }
    }
}
