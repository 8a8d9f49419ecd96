// SPDX-License-Identifier: MIT
using System;
using System.IO;

namespace UnityEngine
{
    public enum RuntimePlatform
    {
        OSXEditor = 0,
        OSXPlayer = 1,
        WindowsPlayer = 2,
        WindowsEditor = 7,
        LinuxPlayer = 13,
        LinuxEditor = 16
    }

    /// <summary>The driver says what it answers.</summary>
    public class Application
    {
        public delegate void LogCallback(string condition, string stackTrace, LogType type);

        public static event LogCallback logMessageReceived;
        public static event LogCallback logMessageReceivedThreaded;
        public static event Action quitting;
        public static event Action unloading;
        public static event Action<bool> focusChanged;
        public static event Func<bool> wantsToQuit;

        public static bool isPlaying { get; internal set; } = true;

#if ENABLE_UNITY_COLLECTIONS_CHECKS
        public static bool isEditor => true;
        public static RuntimePlatform platform { get; internal set; } = RuntimePlatform.LinuxEditor;
#else
        public static bool isEditor => false;
        public static RuntimePlatform platform { get; internal set; } = RuntimePlatform.LinuxPlayer;
#endif

        public static bool isFocused => true;
        public static bool isBatchMode => true;
        public static bool runInBackground { get; set; } = true;
        public static int targetFrameRate { get; set; } = -1;
        public static string unityVersion => "2021.3.0f1";
        public static string version => "1.0";
        public static string productName => "double";
        public static string dataPath { get; internal set; } = Path.Combine(AppContext.BaseDirectory, "Assets");
        public static string streamingAssetsPath { get; internal set; } = Path.Combine(dataPath, "StreamingAssets");
        public static string persistentDataPath => Path.Combine(Path.GetTempPath(), "UnityEngine.Double");
        public static string temporaryCachePath => persistentDataPath;

        public static bool IsPlaying(Object obj)
        {
            if (obj == null)
                throw new NullReferenceException("IsPlaying of no object, or of a destroyed one");
            GameObject at = obj is Component component ? component.gameObject : obj as GameObject;
            for (; at != null; at = at.transform.parent?.gameObject)
                if (at.IsInPrefabStage)
                    return false;
            return isPlaying;
        }

        public static void Quit() => Quit(0);

        /// <summary>Nothing happens before the driver quits, as nothing happens in the Editor.</summary>
        public static void Quit(int exitCode) => wantsToQuit?.Invoke();

        internal static void RaiseQuitting() => quitting?.Invoke();

        internal static void RaiseUnloading() => unloading?.Invoke();

        internal static void RaiseFocusChanged(bool focus) => focusChanged?.Invoke(focus);

        internal static void RaiseLogMessage(string message, string stackTrace, LogType type, bool isMainThread)
        {
            if (isMainThread)
                logMessageReceived?.Invoke(message, stackTrace, type);
            logMessageReceivedThreaded?.Invoke(message, stackTrace, type);
        }
    }
}
