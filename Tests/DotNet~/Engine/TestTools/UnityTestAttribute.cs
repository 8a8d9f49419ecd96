// SPDX-License-Identifier: MIT
using NUnit.Framework;
using NUnit.Framework.Interfaces;
using NUnit.Framework.Internal;
using NUnit.Framework.Internal.Builders;
using NUnit.Framework.Internal.Commands;
using QuickSes.EngineDouble;
using System;
using System.Collections;
using System.Collections.Generic;

namespace UnityEngine.TestTools
{
    /// <summary>A test that returns IEnumerator; what it yields is run by <see cref="EnumeratorRunner"/>.</summary>
    [AttributeUsage(AttributeTargets.Method)]
    public class UnityTestAttribute : CombiningStrategyAttribute, ISimpleTestBuilder, IImplyFixture, IWrapTestMethod
    {
        // NUnit refuses methods that return something unless a result is expected.
        private sealed class Strategy : ICombiningStrategy
        {
            private readonly CombinatorialStrategy _combinations = new CombinatorialStrategy();

            public IEnumerable<ITestCaseData> GetTestCases(IEnumerable[] sources)
            {
                if (sources.Length == 0)
                    yield break; // The other BuildFrom makes the one test.
                foreach (ITestCaseData data in _combinations.GetTestCases(sources))
                    yield return new TestCaseParameters(data.Arguments) { ExpectedResult = new object() };
            }
        }

        private sealed class Command : TestCommand
        {
            public Command(Test test) : base(test)
            {
            }

            public override TestResult Execute(TestExecutionContext context)
            {
                var routine = (IEnumerator)Test.Method.Invoke(context.TestObject, Test.Arguments);
                EnumeratorRunner.Run(routine);
                if (context.CurrentResult.AssertionResults.Count == 0)
                    context.CurrentResult.SetResult(ResultState.Success);
                return context.CurrentResult;
            }
        }

        public UnityTestAttribute() : base(new Strategy(), new ParameterDataSourceProvider())
        {
        }

        TestMethod ISimpleTestBuilder.BuildFrom(IMethodInfo method, Test suite) =>
            new NUnitTestCaseBuilder().BuildTestMethod(method, suite,
                new TestCaseParameters { ExpectedResult = new object() });

        public TestCommand Wrap(TestCommand command)
        {
            if (command.Test.Method.ReturnType.Type != typeof(IEnumerator))
                throw new InvalidOperationException("Method marked with UnityTest must return IEnumerator.");
            return new Command(command.Test);
        }
    }
}
