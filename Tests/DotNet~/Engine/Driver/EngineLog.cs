// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using UnityEngine;
using Object = UnityEngine.Object;

namespace QuickSes.EngineDouble
{
    public readonly struct LogEntry
    {
        public LogEntry(LogType type, string message, string stackTrace, Object context)
        {
            Type = type;
            Message = message;
            StackTrace = stackTrace;
            Context = context;
        }

        public LogType Type { get; }

        public string Message { get; }

        public string StackTrace { get; }

        public Object Context { get; }

        /// <summary>True for what fails a test that does not expect it.</summary>
        public bool IsFailure => Type == LogType.Error || Type == LogType.Assert || Type == LogType.Exception;

        public override string ToString() => $"[{Type}] {Message}";
    }

    /// <summary>What was logged since <see cref="Engine.Reset"/>.</summary>
    public static class EngineLog
    {
        private static readonly List<LogEntry> s_entries = new List<LogEntry>();

        internal static event Action<LogEntry> Written;

        public static LogEntry[] Entries
        {
            get { lock (s_entries) return s_entries.ToArray(); }
        }

        internal static void Clear()
        {
            lock (s_entries)
                s_entries.Clear();
        }

        internal static void Write(LogType type, string message, string stackTrace, Object context)
        {
            var entry = new LogEntry(type, message, stackTrace, context);
            lock (s_entries)
            {
                s_entries.Add(entry);
                Written?.Invoke(entry);
            }

            Application.RaiseLogMessage(message, stackTrace, type, EngineThread.IsMain);
        }
    }
}
