// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System.Text.RegularExpressions;

namespace UnityEngine.TestTools
{
    public static class LogAssert
    {
        public static bool ignoreFailingMessages
        {
            get => LogScope.Current.IgnoresFailures;
            set => LogScope.Current.IgnoresFailures = value;
        }

        public static void Expect(LogType type, Regex message) => LogScope.Current.Expect(type, null, message);
    }
}
