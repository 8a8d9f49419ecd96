// SPDX-License-Identifier: MIT
using NUnit.Framework;
using NUnit.Framework.Interfaces;
using NUnit.Framework.Internal;
using NUnit.Framework.Internal.Builders;
using NUnit.Framework.Internal.Execution;
using System;
using System.Collections;
using System.Collections.Generic;
using System.Linq;
using System.Text.RegularExpressions;
using UnityEngine;
using UnityEngine.TestTools;
using UnityEngine.TestTools.Constraints;
using Is = UnityEngine.TestTools.Constraints.Is;

namespace QuickSes.EngineDouble.Tests
{
    /// <summary>
    /// Tests that should fail do fail: fixtures that only this one runs, and looks at the outcome of.
    /// </summary>
    public sealed class TestToolsTest
    {
        // Of generic fixtures without arguments NUnit finds none by itself.
        [EngineTest]
        private sealed class Cases<T>
        {
            public static readonly List<string> Calls = new List<string>();

            [UnityTest]
            public IEnumerator PassesAfterFrames()
            {
                float before = Time.time;
                yield return null;
                yield return Nested();
                Assert.That(Time.time, Is.GreaterThanOrEqualTo(before + 3e-3f), "three of a millisecond at least");
            }

            [UnityTest]
            public IEnumerator FailsAfterAFrame()
            {
                yield return null;
                Assert.That(Time.time, Is.EqualTo(-1));
            }

            [UnityTest]
            public IEnumerator FailsInNested()
            {
                yield return NestedFailure();
            }

            [UnityTest]
            public IEnumerator FailsByException()
            {
                yield return null;
                throw new InvalidOperationException();
            }

            [UnityTest]
            public IEnumerator TakesValues([Values(1, 2)] int value)
            {
                yield return null;
                Assert.That(value, Is.EqualTo(1));
            }

            [UnityTest]
            public IEnumerator FailsByErrorInAFrame()
            {
                Debug.LogError("error");
                yield return null;
                Calls.Add("not reached");
            }

            [Test]
            public void FailsByError() => Debug.LogError("error");

            [Test]
            public void FailsByWhatDidNotCome() => LogAssert.Expect(LogType.Error, new Regex("^error"));

            [Test]
            public void FailsByAnotherError()
            {
                LogAssert.Expect(LogType.Error, new Regex("^error"));
                Debug.LogError("another");
                Debug.LogError("error");
            }

            [Test]
            public void PassesWithExpectedError()
            {
                LogAssert.Expect(LogType.Error, new Regex("^error"));
                Debug.LogError("error");
            }

            [Test]
            public void PassesWhereErrorsAreIgnored()
            {
                LogAssert.ignoreFailingMessages = true;
                Debug.LogError("error");
            }

            [Test]
            public void FailsByAllocating() =>
                Assert.That(() => { GC.KeepAlive(new int[1]); }, Is.Not.AllocatingGCMemory());

            [Test]
            public void PassesWithoutAllocating() => Assert.That(() => { }, Is.Not.AllocatingGCMemory());

            [Test]
            public void FailsByWrongUpload()
            {
                var mesh = new Mesh { vertices = new Vector3[3], triangles = new[] { 0, 1, 2 } };
                mesh.bounds = new Bounds(Vector3.one * 10, Vector3.one);
                Engine.Frame(0.1);
            }

            private static IEnumerator Nested()
            {
                yield return null;
                yield return null;
            }

            private static IEnumerator NestedFailure()
            {
                yield return null;
                Assert.Fail("nested");
            }
        }

        private static IEnumerable<ITestResult> Leaves(ITestResult result) =>
            result.HasChildren ? result.Children.SelectMany(Leaves) : new[] { result };

        [Test]
        public void OutcomesAreTheRightOnes()
        {
            Cases<int>.Calls.Clear();
            TestSuite suite = new NUnitTestFixtureBuilder().BuildFrom(
                new TypeWrapper(typeof(Cases<int>)), new PreFilterStub());
#pragma warning disable CS0618 // The other overload takes what only NUnit has.
            WorkItem work = WorkItemBuilder.CreateWorkItem(suite, TestFilter.Empty, true);
#pragma warning restore CS0618
            work.InitializeContext(new TestExecutionContext { Dispatcher = new MainThreadWorkItemDispatcher() });
            work.Execute();
            ITestResult[] results = Leaves(work.Result).ToArray();
            Assert.That(results, Has.Length.EqualTo(15), string.Join(", ", results.Select(result => result.Name)));
            foreach (ITestResult result in results)
            {
                bool passes = result.Name.StartsWith("Passes", StringComparison.Ordinal) || result.Name.Contains("(1)");
                Assert.That(result.ResultState.Status, Is.EqualTo(passes ? TestStatus.Passed : TestStatus.Failed),
                    result.Name + ": " + result.Message);
            }

            Assert.That(Cases<int>.Calls, Has.None.EqualTo("not reached"));
        }

        private sealed class PreFilterStub : IPreFilter
        {
            public bool IsMatch(Type type) => true;

            public bool IsMatch(Type type, System.Reflection.MethodInfo method) => true;
        }
    }
}
