// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections.Generic;
using System.IO;

namespace QuickSes.Tests
{
    /// <summary>The sources keep the rules, and the rules find who breaks them.</summary>
    internal sealed class SourceRulesTest
    {
        [Test]
        public void TestsOfUnityUseItsNUnit() =>
            AssertNone(SourceRules.FindLaterNUnit, "Tests/Runtime", "Tests/Editor");

        [Test]
        public void SafetyHandlesAreWhereThereAreSome() =>
            AssertNone(SourceRules.FindUnguardedSafetyHandles, "UnityPackage");

        [Test]
        public void NothingNeedsWhatPlayersMayLack() =>
            AssertNone(SourceRules.FindUnfitForPlayers, "UnityPackage/Runtime", "Samples~");

        [Test]
        public void TheEditorIsUsedInTheEditor() =>
            AssertNone(SourceRules.FindUnguardedEditor, "UnityPackage/Runtime", "Samples~");

        [TestCase("Assert.Multiple(() => { });")]
        [TestCase("Assert.Warn(\"no\");")]
        [TestCase("using (Assert.EnterMultipleScope())")]
        [TestCase("Warn.If(a > b);")]
        [TestCase("Warn.Unless(a > b);")]
        [TestCase("Assert.That(a, Is.AnyOf(1, 2));")]
        [TestCase("Assert.That(a, Is.Not.AnyOf(1, 2));")]
        [TestCase("Assert.That(a, Is.Default);")]
        [TestCase("Assert.That(a, Has.ItemAt(0).EqualTo(1));")]
        [TestCase("Assert.That(a, Has.One.Items);")]
        [TestCase("Assert.That(a, Has.Exactly(2).Items);")]
        [TestCase("Assert.That(a, Does.ContainKey(1));")]
        [TestCase("Assert.That(a, Does.Not.ContainKey(1));")]
        [TestCase("Assert.That(a, Does.Not.ContainValue(1));")]
        [TestCase("Assert.That(a, Contains.Key(1).WithValue(2));")]
        [TestCase("TestContext.AddTestAttachment(path);")]
        [TestCase("new TestCaseData(1).SetArgDisplayNames(name)")]
        [TestCase("[NonParallelizable]")]
        [TestCase("[FixtureLifeCycle(LifeCycle.InstancePerTestCase)]")]
        [TestCase("[DefaultFloatingPointTolerance(1e-6)]")]
        [TestCase("[CancelAfter(100)]")]
        public void LaterNUnitIsFound(string line) => AssertFindsLine(SourceRules.FindLaterNUnit, line);

        [TestCase("Assert.That(a, Is.EqualTo(1).Within(1e-4), \"Assert.Multiple\");")]
        [TestCase("Assert.That(a, Has.Count.EqualTo(1).And.All.GreaterThan(0)); // Is.AnyOf is later")]
        [TestCase("Assert.That(text, Does.Contain(\"Key\").And.Not.Contain(\"Value\"));")]
        [TestCase("int copy = Default.One;")]
        public void EarlierNUnitIsNot(string line) => Assert.That(SourceRules.FindLaterNUnit(line), Is.Empty);

        [TestCase("using System.Reflection;")]
        [TestCase("var type = Type.GetType(name);")]
        [TestCase("var list = typeof(List<>).MakeGenericType(type);")]
        [TestCase("object one = Activator.CreateInstance(type);")]
        [TestCase("var f = Marshal.GetDelegateForFunctionPointer<Action>(p);")]
        [TestCase("if (UnityEngine.Input.anyKey)")]
        [TestCase("if (Input.GetMouseButton(0))")]
        [TestCase("using UnityEngine.UI;")]
        public void WhatPlayersMayLackIsFound(string line) => AssertFindsLine(SourceRules.FindUnfitForPlayers, line);

        [TestCase("// not System.Reflection")]
        [TestCase("/* Input.GetKey\n   Input.GetKey */ int input;")]
        [TestCase("Type type = value.GetType();")]
        [TestCase("using UnityEngine;")]
        [TestCase("mouseInput.Read();")]
        public void WhatPlayersHaveIsNot(string text) => Assert.That(SourceRules.FindUnfitForPlayers(text), Is.Empty);

        [TestCase("X")]
        [TestCase("#if OTHER\nX\n#endif")]
        [TestCase("#if !SYMBOL\nX\n#endif")]
        [TestCase("#if SYMBOL || OTHER\nX\n#endif")]
        [TestCase("#if SYMBOL\n#else\nX\n#endif")]
        [TestCase("#if SYMBOL\n#elif OTHER\nX\n#endif")]
        [TestCase("#if SYMBOL\n#if OTHER\n#endif\n#endif\nX")]
        [TestCase("#if !SYMBOL && OTHER\n#else\nX\n#endif")]
        [TestCase("#if !SYMBOL\n#elif OTHER\n#endif\nX")]
        [TestCase("// #if SYMBOL\nX")]
        [TestCase("#if SYMBOL_TOO\nX\n#endif")]
        public void UnguardedUsesAreFound(string text) => AssertGuard(text, 1);

        [TestCase("#if SYMBOL\nX\n#endif")]
        [TestCase("#if SYMBOL && OTHER\nX\n#endif")]
        [TestCase("  # if SYMBOL // why\n  X\n  # endif")]
        [TestCase("#if SYMBOL\n#if OTHER\n#else\nX\n#endif\n#endif")]
        [TestCase("#if OTHER\n#elif SYMBOL\nX\n#endif")]
        [TestCase("#if !SYMBOL\n#else\nX\n#endif")]
        [TestCase("#if !SYMBOL\n#elif OTHER\nX\n#endif")]
        [TestCase("// X")]
        [TestCase("Log(\"X\");")]
        [TestCase("Log(@\"a\nX\");")]
        [TestCase("#if SYMBOL\r\nX\r\n#endif\r\n")]
        public void GuardedUsesAreNot(string text) => AssertGuard(text, 0);

        private static void AssertGuard(string text, int count)
        {
            string editor = text.Replace("SYMBOL", "UNITY_EDITOR").Replace("X", "UnityEditor.Undo.Redo();");
            string checks = text.Replace("SYMBOL", "ENABLE_UNITY_COLLECTIONS_CHECKS")
                .Replace("X", "AtomicSafetyHandle handle;");
            Assert.That(SourceRules.FindUnguardedEditor(editor), Has.Count.EqualTo(count));
            Assert.That(SourceRules.FindUnguardedSafetyHandles(checks), Has.Count.EqualTo(count));
        }

        private static void AssertFindsLine(Func<string, List<string>> rule, string line) =>
            Assert.That(rule("class A\n{\n    " + line + "\n}\n"), Is.EqualTo(new[] { "3: " + WithoutText(line) }));

        private static string WithoutText(string line) => line.Replace("\"no\"", "\"\"");

        private static void AssertNone(Func<string, List<string>> rule, params string[] folders)
        {
            var found = new List<string>();
            foreach (string folder in folders)
            {
                string[] files = Directory.GetFiles(
                    Path.Combine(Repository.Root, folder), "*.cs", SearchOption.AllDirectories);
                Assert.That(files, Is.Not.Empty, folder);
                foreach (string file in files)
                    foreach (string line in rule(File.ReadAllText(file)))
                        found.Add($"{Path.GetRelativePath(Repository.Root, file)}:{line}");
            }
            Assert.That(found, Is.Empty);
        }
    }
}
