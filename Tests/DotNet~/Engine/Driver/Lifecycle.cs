// SPDX-License-Identifier: MIT
using System.Collections.Generic;
using System.Linq;
using UnityEngine;

namespace QuickSes.EngineDouble
{
    internal sealed class ScriptState
    {
        public MessageTable Messages;
        public bool IsAwake, IsEnabled, IsStarted, IsGone;
    }

    /// <summary>Which script gets which message when.</summary>
    internal static class Lifecycle
    {
        private static readonly List<MonoBehaviour> s_enabled = new List<MonoBehaviour>();
        private static MonoBehaviour[] s_running = new MonoBehaviour[64];

        /// <summary>Enabled scripts, by their execution order, then by the time they were enabled.</summary>
        public static IReadOnlyList<MonoBehaviour> Enabled => s_enabled;

        /// <summary>A script was added.</summary>
        public static void Begin(MonoBehaviour script)
        {
            script.State.Messages = MessageTable.Of(script.GetType());
            Refresh(script);
            if (Application.isPlaying || script == null)
                return;
            // The Editor's part of AddComponent.
            script.State.Messages.Send(script, Message.Reset);
            script.State.Messages.Send(script, Message.OnValidate);
        }

        /// <summary>Scripts were copied, and so were all that they may ask for.</summary>
        public static void BeginCopies(IReadOnlyList<MonoBehaviour> scripts)
        {
            foreach (MonoBehaviour script in scripts)
            {
                script.State.Messages = MessageTable.Of(script.GetType());
                if (!Application.isPlaying)
                    script.State.Messages.Send(script, Message.OnValidate); // the Editor's part
            }

            foreach (MonoBehaviour script in InOrder(scripts))
                if (script != null)
                    Refresh(script);
        }

        /// <summary>As they wake where they come at once: of a copy or a scene.</summary>
        public static IEnumerable<MonoBehaviour> InOrder(IEnumerable<MonoBehaviour> scripts) => scripts.OrderBy(OrderOf);

        /// <summary>Brings what the script was told in line with what it is now.</summary>
        public static void Refresh(MonoBehaviour script)
        {
            ScriptState state = script.State;
            if (state.Messages == null || state.IsGone)
                return;
            bool isRunning = (Application.isPlaying || state.Messages.RunsInEditMode) &&
                script.Owner.activeInHierarchy;
            if (isRunning && !state.IsAwake)
            {
                state.IsAwake = true;
                state.Messages.Send(script, Message.Awake);
                if (script == null)
                    return;
            }

            bool isEnabled = isRunning && script.isActiveAndEnabled;
            if (isEnabled == state.IsEnabled)
                return;
            if (isEnabled)
                Enable(script);
            else
                Disable(script);
        }

        public static void RefreshHierarchy(GameObject gameObject)
        {
            IReadOnlyList<Component> components = gameObject.Components;
            for (int i = 0; i < components.Count; ++i)
            {
                if (components[i] is MonoBehaviour script)
                    Refresh(script);
                if (gameObject == null)
                    return;
            }

            for (int i = 0; i < gameObject.transform.childCount; ++i)
                RefreshHierarchy(gameObject.transform.GetChild(i).Owner);
        }

        public static void Destroy(MonoBehaviour script)
        {
            ScriptState state = script.State;
            if (state.IsGone)
                return;
            if (state.IsEnabled)
                Disable(script);
            state.IsGone = true;
            if (state.IsAwake)
                state.Messages.Send(script, Message.OnDestroy);
        }

        /// <summary>OnDisable, then OnDestroy, for all scripts of the hierarchy.</summary>
        public static void DestroyScripts(GameObject gameObject)
        {
            Component[] components = new List<Component>(gameObject.Components).ToArray();
            foreach (Component component in components)
                if (component is MonoBehaviour script && script.State.IsEnabled)
                    Disable(script);
            foreach (Component component in components)
                if (component is MonoBehaviour script)
                    Destroy(script);
            Transform transform = gameObject.transform;
            for (int i = 0; i < transform.childCount; ++i)
                DestroyScripts(transform.GetChild(i).Owner);
        }

        public static void Enable(MonoBehaviour script)
        {
            script.State.IsEnabled = true;
            int place = s_enabled.Count;
            while (place > 0 && OrderOf(s_enabled[place - 1]) > OrderOf(script))
                --place;
            s_enabled.Insert(place, script);
            script.State.Messages.Send(script, Message.OnEnable);
        }

        public static void Disable(MonoBehaviour script)
        {
            script.State.IsEnabled = false;
            s_enabled.Remove(script);
            script.State.Messages.Send(script, Message.OnDisable);
        }

        /// <summary>Sends to all that are enabled now, unless an earlier one's message disables them.</summary>
        public static void Broadcast(Message message)
        {
            int count = TakeSnapshot();
            for (int i = 0; i < count; ++i)
            {
                MonoBehaviour script = s_running[i];
                if (script.State.IsEnabled && (script.State.IsStarted || message != Message.Update))
                    script.State.Messages.Send(script, message);
            }
        }

        public static void StartPending()
        {
            int count = TakeSnapshot();
            for (int i = 0; i < count; ++i)
            {
                MonoBehaviour script = s_running[i];
                if (!script.State.IsEnabled || script.State.IsStarted)
                    continue;
                script.State.IsStarted = true;
                script.State.Messages.Send(script, Message.Start);
            }
        }

        private static int OrderOf(MonoBehaviour script) => MessageTable.Of(script.GetType()).ExecutionOrder;

        private static int TakeSnapshot()
        {
            int count = s_enabled.Count;
            if (s_running.Length < count)
                s_running = new MonoBehaviour[2 * count];
            s_enabled.CopyTo(s_running);
            return count;
        }
    }
}
