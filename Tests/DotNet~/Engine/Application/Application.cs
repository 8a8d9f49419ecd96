// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;
using System.IO;

namespace UnityEngine
{
    public enum RuntimePlatform
    {
        LinuxPlayer = 13,
        LinuxEditor = 16
    }

    /// <summary>The driver says what it answers.</summary>
    public class Application
    {
        static Application() =>
            EngineLog.Written += entry => logMessageReceived?.Invoke(entry.Message, entry.StackTrace, entry.Type);

        public delegate void LogCallback(string condition, string stackTrace, LogType type);

        /// <summary>Of other threads, too, which the engine's is not.</summary>
        public static event LogCallback logMessageReceived;

        public static event Action quitting;

        /// <summary>The double is a player, but for <see cref="isPlaying"/>, unless it has an Editor.</summary>
        public static bool isEditor { get; internal set; }

        public static RuntimePlatform platform =>
            isEditor ? RuntimePlatform.LinuxEditor : RuntimePlatform.LinuxPlayer;

        public static string temporaryCachePath => Path.GetTempPath();

        public static string unityVersion => "2021.3.0f1";

        public static bool isPlaying { get; internal set; } = true;

        public static string dataPath { get; internal set; } = Path.Combine(AppContext.BaseDirectory, "Assets");
        public static string streamingAssetsPath { get; internal set; } = Path.Combine(dataPath, "StreamingAssets");

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

        internal static void RaiseQuitting() => quitting?.Invoke();
    }
}
