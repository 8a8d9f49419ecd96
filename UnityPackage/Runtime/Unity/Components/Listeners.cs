// SPDX-License-Identifier: MIT
using System;
using UnityEngine;
using UnityEngine.Events;
using Object = UnityEngine.Object;

namespace QuickSes
{
    /// <summary>
    /// Who listens to an event. What one of them throws is logged, as the engine does it with its own calls, and keeps
    /// nobody else from being told. Telling makes no garbage, the first time either. Main thread only.
    /// </summary>
    internal class Listeners<THandler, TTold> where THandler : Delegate
    {
        private readonly Action<THandler, TTold> _tell;
        private Delegate _all;
        private Delegate[] _each = Array.Empty<Delegate>();

        /// <param name="tell">Calls one of them.</param>
        public Listeners(Action<THandler, TTold> tell)
        {
            _tell = tell;
        }

        public bool IsAny => _each.Length > 0;

        public void Add(THandler handler) => Set(Delegate.Combine(_all, handler));

        public void Remove(THandler handler) => Set(Delegate.Remove(_all, handler));

        /// <param name="told">What has happened.</param>
        /// <param name="owner">To whom.</param>
        public void Tell(TTold told, Object owner)
        {
            foreach (Delegate handler in _each) // those that there are now
            {
                try
                {
                    _tell((THandler)handler, told);
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

    /// <summary>Of an event that tells one thing.</summary>
    internal sealed class Listeners<TTold> : Listeners<Action<TTold>, TTold>
    {
        public Listeners() : base((handler, told) => handler(told))
        {
        }
    }

    /// <summary>Of an event that tells nothing else than that it happened.</summary>
    internal sealed class Listeners : Listeners<Action, bool>
    {
        public Listeners() : base((handler, told) => handler())
        {
        }

        public void Tell(Object owner) => Tell(true, owner);
    }

    /// <summary>
    /// Who listens to a UnityEvent: as <see cref="Listeners"/>, but one that throws keeps the later ones of the event from
    /// being told, which is the engine's way.
    /// </summary>
    internal static class WiredListeners
    {
        /// <param name="unityEvent">The owner's.</param>
        /// <param name="owner">Nobody is told of what listeners in code have destroyed.</param>
        public static void Tell(UnityEvent unityEvent, Object owner)
        {
            if (owner == null)
                return;
            try
            {
                unityEvent.Invoke();
            }
            catch (Exception e)
            {
                Debug.LogException(e, owner);
            }
        }

        /// <inheritdoc cref="Tell(UnityEvent, Object)"/>
        public static void Tell<TTold>(UnityEvent<TTold> unityEvent, TTold told, Object owner)
        {
            if (owner == null)
                return;
            try
            {
                unityEvent.Invoke(told);
            }
            catch (Exception e)
            {
                Debug.LogException(e, owner);
            }
        }

        /// <summary>
        /// Whether the event would call any of them now: it passes over those that are off, those for run time only,
        /// which is what the inspector begins with, outside of play mode, and rows without method or target. A static
        /// method, which only scripts can wire, has no target either and does not count: better told twice than not at all.
        /// </summary>
        public static bool AreAnyCalled(UnityEventBase unityEvent)
        {
            for (int k = 0; k < unityEvent.GetPersistentEventCount(); ++k)
            {
                UnityEventCallState state = unityEvent.GetPersistentListenerState(k);
                bool isOn = state == UnityEventCallState.EditorAndRuntime ||
                    (state == UnityEventCallState.RuntimeOnly && Application.isPlaying);
                if (isOn && unityEvent.GetPersistentTarget(k) != null &&
                    !string.IsNullOrEmpty(unityEvent.GetPersistentMethodName(k)))
                    return true;
            }
            return false;
        }
    }
}
