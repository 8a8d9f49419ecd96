// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;

namespace UnityEngine
{
    /// <summary>Moved on by the driver, once per frame.</summary>
    public class Time
    {
        private static double s_time;
        private static float s_deltaTime, s_unscaledDeltaTime;

        public static int frameCount { get; private set; }

        public static float time => (float)realtimeSinceStartupAsDouble;

        public static float deltaTime
        {
            get
            {
                EngineThread.Require("get_deltaTime");
                return s_deltaTime;
            }
        }

        public static float unscaledDeltaTime
        {
            get
            {
                EngineThread.Require("get_unscaledDeltaTime");
                return s_unscaledDeltaTime;
            }
        }

        public static float maximumDeltaTime { get; set; } = 1f / 3;

        public static float timeScale { get; set; } = 1;

        /// <summary>Time of the driver's frames, unlike in the engine: a test decides how long a frame takes.</summary>
        public static double realtimeSinceStartupAsDouble
        {
            get
            {
                EngineThread.Require("get_realtimeSinceStartup");
                return s_time;
            }
        }

        internal static void Reset()
        {
            s_time = 0;
            s_deltaTime = s_unscaledDeltaTime = 0;
            timeScale = 1;
        }

        internal static void Advance(double seconds)
        {
            s_unscaledDeltaTime = (float)seconds;
            s_deltaTime = System.Math.Min(s_unscaledDeltaTime, maximumDeltaTime) * timeScale;
            s_time += seconds;
            ++frameCount;
        }
    }
}
