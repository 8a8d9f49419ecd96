// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;
using System.Diagnostics;

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

    public enum LogOption
    {
        None,
        NoStacktrace
    }

    /// <summary>Messages go to <see cref="EngineLog"/>; any thread may write them.</summary>
    public class Debug
    {
        public static bool isDebugBuild => true;

        public static void Log(object message) => Log(message, null);

        public static void Log(object message, Object context) => Write(LogType.Log, message, context);

        public static void LogWarning(object message) => LogWarning(message, null);

        public static void LogWarning(object message, Object context) => Write(LogType.Warning, message, context);

        public static void LogError(object message) => LogError(message, null);

        public static void LogError(object message, Object context) => Write(LogType.Error, message, context);

        public static void LogException(Exception exception) => LogException(exception, null);

        public static void LogException(Exception exception, Object context) =>
            EngineLog.Write(LogType.Exception, $"{exception.GetType().Name}: {exception.Message}",
                exception.StackTrace ?? "", context);

        public static void LogAssertion(object message) => Write(LogType.Assert, message, null);

        public static void LogFormat(string format, params object[] args) =>
            Write(LogType.Log, string.Format(format, args), null);

        public static void LogFormat(LogType logType, LogOption logOptions, Object context, string format,
            params object[] args) => Write(logType, string.Format(format, args), context);

        public static void LogWarningFormat(string format, params object[] args) =>
            Write(LogType.Warning, string.Format(format, args), null);

        public static void LogErrorFormat(string format, params object[] args) =>
            Write(LogType.Error, string.Format(format, args), null);

        [Conditional("UNITY_ASSERTIONS")]
        public static void Assert(bool condition) => Assert(condition, "Assertion failed");

        [Conditional("UNITY_ASSERTIONS")]
        public static void Assert(bool condition, object message) => AssertThat(condition, message);

        [Conditional("UNITY_ASSERTIONS")]
        public static void Assert(bool condition, string message) => AssertThat(condition, message);

        public static void DrawLine(Vector3 start, Vector3 end, Color color)
        {
        }

        public static void DrawRay(Vector3 start, Vector3 dir, Color color)
        {
        }

        private static void AssertThat(bool condition, object message)
        {
            if (!condition)
                Write(LogType.Assert, message, null);
        }

        private static void Write(LogType type, object message, Object context) =>
            EngineLog.Write(type, message?.ToString() ?? "Null", "", context);
    }
}
