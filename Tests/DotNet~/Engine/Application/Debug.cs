// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;

namespace UnityEngine
{
    public enum LogType
    {
        Error = 0,
        Assert = 1,
        Warning = 2,
        Log = 3,
        Exception = 4
    }

    /// <summary>Messages go to <see cref="EngineLog"/>; any thread may write them.</summary>
    public class Debug
    {
        public static void Log(object message) => Log(message, null);

        public static void Log(object message, Object context) => Write(LogType.Log, message);

        public static void LogWarning(object message, Object context) => Write(LogType.Warning, message);

        public static void LogError(object message) => LogError(message, null);

        public static void LogError(object message, Object context) => Write(LogType.Error, message);

        public static void LogException(Exception exception, Object context) =>
            EngineLog.Write(LogType.Exception, $"{exception.GetType().Name}: {exception.Message}",
                exception.StackTrace ?? "");

        private static void Write(LogType type, object message) =>
            EngineLog.Write(type, message?.ToString() ?? "Null", "");
    }
}
