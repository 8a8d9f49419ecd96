// SPDX-License-Identifier: MIT
using UnityEngine;

namespace QuickSes
{
    /// <summary>What ends with play mode, the domain and the program, since it is not the engine's.</summary>
    internal static class DomainLifeCycle
    {
        // Statics outlive play mode if the domain is not reloaded.
        [RuntimeInitializeOnLoadMethod(RuntimeInitializeLoadType.SubsystemRegistration)]
        private static void OnPlayModeBegins()
        {
            SurfaceScheduler.ReleaseInBackground();
            SurfaceScheduler.ResetOptions();
            Application.quitting -= SurfaceScheduler.ReleaseContexts;
            Application.quitting += SurfaceScheduler.ReleaseContexts;
            if (Application.isEditor)
                return; // the domain stays, and so does the native library
            Application.quitting -= BackgroundThread.EndAll;
            Application.quitting += BackgroundThread.EndAll;
        }

        // Before a domain reload: what managed objects hold outside of the managed heap would be lost with them, and
        // threads must not outlive the domain. Structures are closed by OnDisable.
        internal static void OnDomainUnloads()
        {
            SurfaceScheduler.DisposeAll();
            BackgroundThread.EndAll();
        }

#if UNITY_EDITOR
        [UnityEditor.InitializeOnLoadMethod]
        private static void OnEditorLoads()
        {
            UnityEditor.AssemblyReloadEvents.beforeAssemblyReload += OnDomainUnloads;
            UnityEditor.EditorApplication.quitting += OnDomainUnloads;
        }
#endif
    }
}
