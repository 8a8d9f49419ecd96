// SPDX-License-Identifier: MIT
using NUnit.Framework.Interfaces;
using System.Collections.Generic;
using System.IO;

namespace QuickSes.MonoRunner
{
    /// <summary>Counts results, and prints those that nobody expected.</summary>
    internal sealed class Listener : ITestListener
    {
        private readonly TextWriter _output;
        private readonly ExpectedFailures _expected;
        private readonly HangGuard _guard;

        public Listener(TextWriter output, ExpectedFailures expected)
        {
            _output = output;
            _expected = expected;
            _guard = new HangGuard(output);
        }

        public int Passed { get; private set; }
        public int Failed { get; private set; }
        public int Expected { get; private set; }
        public int Skipped { get; private set; }

        public void TestStarted(ITest test)
        {
            if (!test.IsSuite)
                _guard.Begin(test.FullName);
        }

        public void TestFinished(ITestResult result)
        {
            _guard.End();
            if (result.Test.IsSuite)
            {
                // What goes wrong before and after all tests of a class; else only the sum of its tests.
                if (result.ResultState.Status == TestStatus.Failed && result.ResultState.Site != FailureSite.Child &&
                    result.ResultState.Site != FailureSite.Parent)
                    Fail(result);
                return;
            }
            bool isExpected = _expected.Contains(result.FullName);
            switch (result.ResultState.Status)
            {
                case TestStatus.Passed when isExpected:
                    ++Failed;
                    _output.WriteLine($"PASSED, but is in expected-failures.txt: {result.FullName}");
                    break;
                case TestStatus.Passed:
                    ++Passed;
                    break;
                case TestStatus.Failed when isExpected ||
                    _expected.HasCause(result.Message ?? "", result.StackTrace ?? ""):
                    ++Expected;
                    break;
                case TestStatus.Failed:
                    Fail(result);
                    break;
                default:
                    ++Skipped;
                    _output.WriteLine($"not run: {result.FullName}: {result.Message}");
                    break;
            }
        }

        public void TestOutput(TestOutput output)
        {
        }

        public void SendMessage(TestMessage message)
        {
        }

        private void Fail(ITestResult result)
        {
            ++Failed;
            if (result.ResultState.Site != FailureSite.Parent) // which has been told
                _output.WriteLine($"FAILED {result.FullName}\n{result.Message}\n{result.StackTrace}");
        }
    }
}
