// SPDX-License-Identifier: MIT
using System;
using System.Collections.Generic;
using System.IO;

namespace QuickSes.MonoRunner
{
    /// <summary>Tests that fail by what a runtime lacks: expected-failures.txt beside the program has them by name.</summary>
    internal sealed class ExpectedFailures
    {
        private readonly List<string> _failing = new List<string>();
        private readonly List<string> _fatal = new List<string>();
        private readonly List<string> _causes = new List<string>();

        private ExpectedFailures()
        {
        }

        /// <summary>The rows whose condition is among the given ones, which are separated by commas.</summary>
        public static ExpectedFailures Read(string conditions)
        {
            var result = new ExpectedFailures();
            foreach (string line in File.ReadAllLines(Path.Combine(AppContext.BaseDirectory, "expected-failures.txt")))
            {
                if (line.Length == 0 || line[0] == '#')
                    continue;
                string[] words = line.Split(new[] { ' ' }, StringSplitOptions.RemoveEmptyEntries);
                if (Array.IndexOf(conditions.Split(','), words[0].TrimEnd('!', '@')) < 0)
                    continue;
                char kind = words[0][words[0].Length - 1];
                (kind == '!' ? result._fatal : kind == '@' ? result._causes : result._failing).Add(words[1]);
            }
            return result;
        }

        public bool Contains(string test) => Contains(_failing, test);

        /// <summary>Whether it failed where, and because, there is no compiler at run time.</summary>
        public bool HasCause(string message, string stack)
        {
            if (message.IndexOf("ExecutionEngineException : Attempting to JIT", StringComparison.Ordinal) < 0)
                return false;
            foreach (string cause in _causes)
                if (stack.IndexOf(" " + cause, StringComparison.Ordinal) >= 0)
                    return true;
            return false;
        }

        /// <summary>Whether it would end the program.</summary>
        public bool IsFatal(string test) => Contains(_fatal, test);

        private static bool Contains(List<string> names, string test)
        {
            foreach (string name in names)
                if (name.EndsWith("*", StringComparison.Ordinal)
                        ? test.StartsWith(name.Substring(0, name.Length - 1), StringComparison.Ordinal)
                        : test == name)
                    return true;
            return false;
        }
    }
}
