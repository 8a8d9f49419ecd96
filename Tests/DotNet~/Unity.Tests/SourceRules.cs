// SPDX-License-Identifier: MIT
using System.Collections.Generic;
using System.Text.RegularExpressions;

namespace QuickSes.Tests
{
    /// <summary>Rules that no compiler here knows, each a search in the text of C# sources.</summary>
    internal static class SourceRules
    {
        private struct Guard
        {
            public bool Guards;
            public bool AllBranchesNegate; // so far, so that the next branch is compiled with the symbol only
        }

        private static readonly Regex s_silent = new Regex(
            @"(?<text>@""(?:[^""]|"""")*""|\$?""(?:\\.|[^""\\\n])*"")|'(?:\\.|[^'\\\n])+'|//[^\n]*|/\*.*?\*/",
            RegexOptions.Singleline);

        // Unity's test framework comes with NUnit 3.5.
        private static readonly Regex s_laterNUnit = new Regex(
            @"\bAssert\.(Multiple\w*|EnterMultipleScope|Warn|ThatAsync)\b" +
            @"|\bWarn\.(If|Unless)\b|\bMultipleAssertException\b" +
            @"|\b(Is|Not|And|Or|All|Some|None|With)\.(AnyOf|Default|IgnoreWhiteSpace)\b|\.IgnoreWhiteSpace\b" +
            @"|\b(Has|Not|And|Or|With)\.(ItemAt|One)\b|\bHas\.Exactly\([^)]*\)\.Items\b" +
            @"|\b(Does|Not|And|Or)\.Contain(Key|Value)\b|\bContains\.Value\b|\.WithValue\(" +
            @"|\.UsingPropertiesComparer\b" +
            @"|\bTestContext\.(AddTestAttachment|CurrentRepeatCount|CurrentContext\.AssertCount|AddFormatter)\b" +
            @"|\bCurrentContext\.(CurrentRepeatCount|AssertCount|Test\.(Arguments|AllCategories|Expression))\b" +
            @"|\bCurrentContext\.Result\.Assertions\b|\bTestContext\.Parameters\.Names\b" +
            @"|\bSetArgDisplayNames\(|\bIgnore\([^)]*\)\.Until\(|\b(Until|StopOnError|CancelAfter)\s*=" +
            @"|\[\s*(assembly:\s*)?(NonParallelizable|FixtureLifeCycle|DefaultFloatingPointTolerance" +
            @"|NoTests|CancelAfter)\b" +
            @"|\bLifeCycle\.(InstancePerTestCase|SingleInstance)\b" +
            @"|\bParallelScope\.All\b|\bDistinct\s*=\s*true");

        // IL2CPP strips what only reflection finds; Input throws where only the Input System is;
        // uGUI is a package.
        private static readonly Regex s_unfitForPlayers = new Regex(
            @"\bSystem\.Reflection\b|\bType\.GetType\(|\bMakeGeneric(Type|Method)\b|\bActivator\.CreateInstance\b" +
            @"|\bGetDelegateForFunctionPointer\b|\bUnityEngine\.(Input|UI)\b|(?<![\w.])Input\s*\.\s*\w");

        private static readonly Regex s_editor = new Regex(@"\bUnityEditor\b");
        private static readonly Regex s_safetyHandle = new Regex(@"\bAtomicSafetyHandle\b");

        public static List<string> FindLaterNUnit(string text) => Find(text, s_laterNUnit, null);

        public static List<string> FindUnfitForPlayers(string text) => Find(text, s_unfitForPlayers, null);

        public static List<string> FindUnguardedEditor(string text) => Find(text, s_editor, "UNITY_EDITOR");

        public static List<string> FindUnguardedSafetyHandles(string text) =>
            Find(text, s_safetyHandle, "ENABLE_UNITY_COLLECTIONS_CHECKS");

        /// <summary>Lines of code, not comments or literals, that are compiled without the symbol.</summary>
        private static List<string> Find(string text, Regex unwanted, string symbol)
        {
            var found = new List<string>();
            string[] lines = CodeOf(text).Split('\n');
            var guards = new Stack<Guard>();
            for (int i = 0; i < lines.Length; ++i)
            {
                string line = lines[i].Trim();
                Match directive = Regex.Match(line, @"^#\s*(if|elif|else|endif)\b(.*)");
                if (directive.Success)
                    Follow(guards, directive.Groups[1].Value, directive.Groups[2].Value, symbol);
                else if (unwanted.IsMatch(line) && !IsGuarded(guards))
                    found.Add($"{i + 1}: {line}");
            }
            return found;
        }

        private static void Follow(Stack<Guard> guards, string directive, string condition, string symbol)
        {
            Guard before = directive == "if" ? new Guard { AllBranchesNegate = true } : guards.Pop();
            if (directive == "endif")
                return;
            var guard = new Guard();
            if (directive == "else")
            {
                guard.Guards = before.AllBranchesNegate;
            }
            else if (symbol != null)
            {
                guard.Guards = Demands(condition, symbol) || (directive == "elif" && before.AllBranchesNegate);
                guard.AllBranchesNegate = (directive == "if" || before.AllBranchesNegate) &&
                    condition.Replace(" ", "").Trim() == "!" + symbol;
            }
            guards.Push(guard);
        }

        // A conjunction that names it; of other conditions none is taken to demand it.
        private static bool Demands(string condition, string symbol)
        {
            if (condition.Contains("||") || condition.Contains("("))
                return false;
            foreach (string term in condition.Split("&&"))
                if (term.Trim() == symbol)
                    return true;
            return false;
        }

        private static bool IsGuarded(Stack<Guard> guards)
        {
            foreach (Guard guard in guards)
                if (guard.Guards)
                    return true;
            return false;
        }

        // Line ends stay, so that lines keep their numbers; what an interpolated string computes goes with it.
        private static string CodeOf(string text) => s_silent.Replace(text.Replace("\r", ""),
            match => Regex.Replace(match.Value, "[^\n]+", match.Groups["text"].Success ? "\"\"" : " "));
    }
}
