// SPDX-License-Identifier: MIT
using System;
using UnityEngine;
using Object = UnityEngine.Object;

namespace QuickSes
{
    /// <summary>
    /// Who listens to an event. What one of them throws is logged, as the engine does it with its own calls, and keeps
    /// nobody else from being told. Telling makes no garbage. Main thread only.
    /// </summary>
    internal sealed class Listeners<THandler> where THandler : Delegate
    {
        private Delegate _all;
        private Delegate[] _each = Array.Empty<Delegate>();

        public bool IsAny => _each.Length > 0;

        public void Add(THandler handler) => Set(Delegate.Combine(_all, handler));

        public void Remove(THandler handler) => Set(Delegate.Remove(_all, handler));

        /// <param name="told">Of each.</param>
        /// <param name="tell">Calls one of them; must not capture anything, or it would be garbage.</param>
        /// <param name="owner">Whose event it is.</param>
        public void Tell<TTold>(TTold told, Action<THandler, TTold> tell, Object owner)
        {
            foreach (Delegate handler in _each) // those that there are now
            {
                try
                {
                    tell((THandler)handler, told);
                }
                catch (Exception e)
                {
                    Debug.LogException(e, owner);
                }
            }
        }

        private void Set(Delegate all)
        {
            _all = all;
            _each = all != null ? all.GetInvocationList() : Array.Empty<Delegate>();
        }
    }

    internal static class Listeners
    {
        private static readonly Action<Action, bool> s_tell = (handler, told) => handler();

        /// <summary>Of an event that tells nothing else than that it happened.</summary>
        public static void Tell(this Listeners<Action> listeners, Object owner) => listeners.Tell(false, s_tell, owner);

        public static void Tell<TTold>(this Listeners<Action<TTold>> listeners, TTold told, Object owner) =>
            listeners.Tell(told, (handler, what) => handler(what), owner);
    }
}
