// SPDX-License-Identifier: MIT
using NUnit.Framework;
using NUnit.Framework.Interfaces;
using System;

namespace QuickSes.EngineDouble
{
    /// <summary>
    /// On an assembly: each of its tests begins with <see cref="Engine.Reset"/>, and fails by errors in the log that it
    /// does not expect, those of taking its scene down included.
    /// </summary>
    [AttributeUsage(AttributeTargets.Assembly | AttributeTargets.Class)]
    public class EngineTestAttribute : Attribute, ITestAction
    {
        public ActionTargets Targets => ActionTargets.Test;

        public void BeforeTest(ITest test)
        {
            Begin();
            LogScope.Open();
        }

        public void AfterTest(ITest test)
        {
            try
            {
                End();
            }
            finally
            {
                LogScope.Close();
            }
        }

        protected virtual void Begin() => Engine.Reset();

        protected virtual void End() => Engine.Reset();
    }
}
