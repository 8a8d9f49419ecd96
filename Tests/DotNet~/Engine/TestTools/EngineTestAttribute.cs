// SPDX-License-Identifier: MIT
using NUnit.Framework;
using NUnit.Framework.Interfaces;
using System;
using System.Collections;
using System.Collections.Generic;
using System.Reflection;
using UnityEngine.TestTools;

namespace QuickSes.EngineDouble
{
    /// <summary>
    /// On an assembly: each of its tests begins with <see cref="Engine.Reset"/>, runs UnitySetUp and UnityTearDown, and
    /// fails by errors in the log that it does not expect, those of taking its scene down included.
    /// </summary>
    [AttributeUsage(AttributeTargets.Assembly | AttributeTargets.Class)]
    public sealed class EngineTestAttribute : Attribute, ITestAction
    {
        private const BindingFlags Instance = BindingFlags.Instance | BindingFlags.Public | BindingFlags.NonPublic;

        public ActionTargets Targets => ActionTargets.Test;

        public void BeforeTest(ITest test)
        {
            Engine.Reset();
            LogScope.Open();
            foreach (MethodInfo method in MethodsWith<UnitySetUpAttribute>(test))
                Run(test, method, false);
        }

        public void AfterTest(ITest test)
        {
            try
            {
                List<MethodInfo> methods = MethodsWith<UnityTearDownAttribute>(test);
                for (int i = methods.Count; i-- > 0;)
                    Run(test, methods[i], true);
                Engine.Reset();
            }
            finally
            {
                LogScope.Close();
            }
        }

        private static void Run(ITest test, MethodInfo method, bool isTearDown) =>
            EnumeratorRunner.Run((IEnumerator)method.Invoke(test.Fixture, null), isTearDown);

        // Those of base classes first.
        private static List<MethodInfo> MethodsWith<T>(ITest test) where T : Attribute
        {
            var methods = new List<MethodInfo>();
            for (Type type = test.Fixture?.GetType(); type != null; type = type.BaseType)
                foreach (MethodInfo method in type.GetMethods(Instance | BindingFlags.DeclaredOnly))
                    if (method.IsDefined(typeof(T), false))
                        methods.Insert(0, method);
            return methods;
        }
    }
}
