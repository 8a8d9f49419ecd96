// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;

namespace UnityEngine
{
    /// <summary>Moved on by the driver, once per frame.</summary>
    public class Time
    {
        private static double s_time, s_unscaledTime;
        private static float s_deltaTime, s_unscaledDeltaTime;
        private static int s_frameCount;

        public static float timeScale { get; set; } = 1;

        public static float time => (float)timeAsDouble;

        public static double timeAsDouble
        {
            get
            {
                EngineThread.Require("get_time");
                return s_time;
            }
        }

        public static float unscaledTime => (float)unscaledTimeAsDouble;

        public static double unscaledTimeAsDouble
        {
            get
            {
                EngineThread.Require("get_unscaledTime");
                return s_unscaledTime;
            }
        }

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

        public static float smoothDeltaTime => deltaTime;

        public static float fixedDeltaTime { get; set; } = 0.02f;

        public static float maximumDeltaTime { get; set; } = 1f / 3;

        public static float timeSinceLevelLoad => time;

        public static float realtimeSinceStartup => (float)realtimeSinceStartupAsDouble;

        /// <summary>Time of the driver's frames, unlike in the engine: a test decides how long a frame takes.</summary>
        public static double realtimeSinceStartupAsDouble
        {
            get
            {
                EngineThread.Require("get_realtimeSinceStartup");
                return s_unscaledTime;
            }
        }

        public static int frameCount
        {
            get
            {
                EngineThread.Require("get_frameCount");
                return s_frameCount;
            }
        }

        internal static void Reset()
        {
            s_time = s_unscaledTime = 0;
            s_deltaTime = s_unscaledDeltaTime = 0;
            s_frameCount = 0;
            timeScale = 1;
        }

        internal static void Advance(double seconds)
        {
            ++s_frameCount;
            s_unscaledDeltaTime = (float)seconds;
            s_deltaTime = (float)seconds * timeScale;
            s_unscaledTime += seconds;
            s_time += seconds * timeScale;
        }
    }
}
