// SPDX-License-Identifier: MIT
using NUnit.Framework.Api;
using NUnit.Framework.Interfaces;
using NUnit.Framework.Internal;
using System;
using System.Collections.Generic;
using System.Globalization;
using System.IO;

namespace QuickSes.MonoRunner
{
    /// <summary>
    /// program CONDITIONS [NAME]: runs the tests of this assembly, or those whose full name contains NAME. CONDITIONS
    /// (jit,boehm for example) choose the rows of expected-failures.txt: those tests must fail.
    /// </summary>
    internal static class Program
    {
        private static int Main(string[] arguments)
        {
            string conditions = arguments.Length > 0 ? arguments[0] : "";
            var runner = new NUnitTestAssemblyRunner(new DefaultTestAssemblyBuilder());
            runner.Load(typeof(Program).Assembly, new Dictionary<string, object>());
            ExpectedFailures expected = ExpectedFailures.Read(conditions);
            var filter = new Filter(arguments.Length > 1 ? arguments[1] : "", expected);
            using var output = new StreamWriter(Console.OpenStandardOutput()) { AutoFlush = true };
            var listener = new Listener(output, expected);
            runner.Run(listener, filter);
            output.WriteLine($"{Path.GetFileNameWithoutExtension(typeof(Program).Assembly.Location)}, {conditions}, " +
                $"culture {CultureInfo.CurrentCulture.Name}: {listener.Passed} passed, {listener.Failed} failed, " +
                $"{listener.Expected} failed as expected, {listener.Skipped} skipped");
            return listener.Failed == 0 && listener.Passed > 0 ? 0 : 1;
        }

        private sealed class Filter : TestFilter
        {
            private readonly string _name;
            private readonly ExpectedFailures _expected;

            public Filter(string name, ExpectedFailures expected)
            {
                _name = name;
                _expected = expected;
            }

            public override bool Match(ITest test) => !test.IsSuite && !_expected.IsFatal(test.FullName) &&
                test.FullName.IndexOf(_name, StringComparison.Ordinal) >= 0;

            public override TNode AddToXml(TNode parentNode, bool recursive) => throw new NotSupportedException();
        }
    }
}
