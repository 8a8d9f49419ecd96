// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;
using System.Linq;
using System.Reflection;

namespace UnityEditor
{
    public sealed class EditorApplication
    {
        public delegate void CallbackFunction();

        /// <summary>Called once, before the next frame.</summary>
        public static CallbackFunction delayCall;

#pragma warning disable 67 // the double's Editor does not end
        public static event Action quitting;
#pragma warning restore 67

        private static bool s_isUpdateQueued;

        /// <summary>Has scripts run in the next frame, in edit mode too.</summary>
        public static void QueuePlayerLoopUpdate() => s_isUpdateQueued = true;

        /// <summary>Whether there is such a command. It is told of no object.</summary>
        public static bool ExecuteMenuItem(string menuItemPath) => Execute(menuItemPath, new MenuCommand(null));

        internal static bool Execute(string path, MenuCommand command)
        {
            (MethodInfo method, MenuItem _) = Methods.With<MenuItem>(Methods.Types).FirstOrDefault(
                found => found.Item2.menuItem == path);
            method?.Invoke(null, method.GetParameters().Length == 0 ? null : new object[] { command });
            return method != null;
        }

        /// <summary>Whether scripts run in the frame that begins.</summary>
        internal static bool BeginFrame()
        {
            CallbackFunction due = delayCall;
            delayCall = null;
            due?.Invoke();
            bool isUpdateQueued = s_isUpdateQueued;
            s_isUpdateQueued = false;
            return isUpdateQueued || UnityEngine.Application.isPlaying;
        }
    }

    public static class AssemblyReloadEvents
    {
        public delegate void AssemblyReloadCallback();

#pragma warning disable 67 // the double's driver reloads nothing of the Editor's
        public static event AssemblyReloadCallback beforeAssemblyReload;
#pragma warning restore 67
    }
}
