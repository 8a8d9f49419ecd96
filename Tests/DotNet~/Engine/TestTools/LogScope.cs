// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections.Generic;
using System.Linq;
using System.Text.RegularExpressions;
using UnityEngine;

namespace QuickSes.EngineDouble
{
    /// <summary>
    /// What one test expects in the log, and what it got besides that. Any thread may write to the log.
    /// </summary>
    internal sealed class LogScope
    {
        private sealed class Expectation
        {
            public LogType Type;
            public string Message;
            public Regex Pattern;

            public bool Matches(in LogEntry entry) => entry.Type == Type &&
                (Pattern != null ? Pattern.IsMatch(entry.Message) : entry.Message == Message);

            public override string ToString() => $"[{Type}] {Pattern?.ToString() ?? Message}";
        }

        private static LogScope s_current;

        private readonly LogScope _outer;
        private readonly Queue<Expectation> _expected = new Queue<Expectation>();
        private readonly List<LogEntry> _unexpected = new List<LogEntry>();

        static LogScope() => EngineLog.Written += entry => s_current?.Note(entry);

        private LogScope(LogScope outer) => _outer = outer;

        public static LogScope Current => s_current ?? throw new InvalidOperationException(
            "No test runs, or its assembly lacks [assembly: EngineTest].");

        public static bool IsOpen => s_current != null;

        public bool IgnoresFailures { get; set; }

        /// <summary>Until it is closed, the scope that was open before hears nothing.</summary>
        public static void Open() => s_current = new LogScope(s_current);

        /// <summary>Throws for failures that were not expected, and for what was expected and did not come.</summary>
        public static void Close()
        {
            LogScope scope = s_current;
            s_current = scope._outer;
            scope.RequireNoFailure();
            lock (scope._expected)
                if (scope._expected.Count > 0)
                    throw new AssertionException($"Expected log did not appear: {scope._expected.Peek()}");
        }

        // Messages are expected in the order in which they are asked for, those that already came included.
        public void Expect(LogType type, string message, Regex pattern)
        {
            var expectation = new Expectation { Type = type, Message = message, Pattern = pattern };
            lock (_expected)
            {
                int found = _expected.Count > 0 ? -1 : _unexpected.FindIndex(entry => expectation.Matches(entry));
                if (found >= 0)
                    _unexpected.RemoveRange(found, 1);
                else
                    _expected.Enqueue(expectation);
            }
        }

        public void RequireNoFailure()
        {
            if (IgnoresFailures)
                return;
            lock (_expected)
                foreach (LogEntry entry in _unexpected.Where(entry => entry.IsFailure))
                    throw new AssertionException($"Unhandled log message: {entry}\n{entry.StackTrace}");
        }

        private void Note(LogEntry entry)
        {
            lock (_expected)
            {
                if (_expected.Count > 0 && _expected.Peek().Matches(entry))
                    _expected.Dequeue();
                else
                    _unexpected.Add(entry);
            }
        }
    }
}
