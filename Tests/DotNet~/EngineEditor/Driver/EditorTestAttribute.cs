// SPDX-License-Identifier: MIT
using NUnit.Framework;
using NUnit.Framework.Interfaces;
using System;

namespace QuickSes.EngineDouble
{
    /// <summary>
    /// On an assembly: each of its tests begins in edit mode with an empty project, and fails by errors in the log that it
    /// does not expect.
    /// </summary>
    [AttributeUsage(AttributeTargets.Assembly | AttributeTargets.Class)]
    public sealed class EditorTestAttribute : Attribute, ITestAction
    {
        public ActionTargets Targets => ActionTargets.Test;

        public void BeforeTest(ITest test)
        {
            EditorDriver.Begin();
            LogScope.Open();
        }

        public void AfterTest(ITest test)
        {
            try
            {
                EditorDriver.End();
            }
            finally
            {
                LogScope.Close();
            }
        }
    }
}
