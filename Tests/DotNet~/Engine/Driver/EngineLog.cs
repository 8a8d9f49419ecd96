// SPDX-License-Identifier: MIT
using System;
using UnityEngine;

namespace QuickSes.EngineDouble
{
    internal readonly struct LogEntry
    {
        public LogEntry(LogType type, string message, string stackTrace)
        {
            Type = type;
            Message = message;
            StackTrace = stackTrace;
        }

        public LogType Type { get; }

        public string Message { get; }

        public string StackTrace { get; }

        /// <summary>True for what fails a test that does not expect it.</summary>
        public bool IsFailure => Type == LogType.Error || Type == LogType.Assert || Type == LogType.Exception;

        public override string ToString() => $"[{Type}] {Message}";
    }

    /// <summary>Passes on what is logged, from any thread.</summary>
    internal static class EngineLog
    {
        public static event Action<LogEntry> Written;

        public static void Write(LogType type, string message, string stackTrace) =>
            Written?.Invoke(new LogEntry(type, message, stackTrace));
    }
}
