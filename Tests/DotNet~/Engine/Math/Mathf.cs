// SPDX-License-Identifier: MIT
using System;

namespace UnityEngine
{
    public struct Mathf
    {
        public const float PI = (float)Math.PI;
        public const float Infinity = float.PositiveInfinity;
        public const float NegativeInfinity = float.NegativeInfinity;
        public const float Deg2Rad = PI * 2 / 360;
        public const float Rad2Deg = 1 / Deg2Rad;
        public static readonly float Epsilon = float.Epsilon;

        public static float Sin(float f) => (float)Math.Sin(f);
        public static float Cos(float f) => (float)Math.Cos(f);
        public static float Tan(float f) => (float)Math.Tan(f);
        public static float Asin(float f) => (float)Math.Asin(f);
        public static float Acos(float f) => (float)Math.Acos(f);
        public static float Atan(float f) => (float)Math.Atan(f);
        public static float Atan2(float y, float x) => (float)Math.Atan2(y, x);
        public static float Sqrt(float f) => (float)Math.Sqrt(f);
        public static float Pow(float f, float p) => (float)Math.Pow(f, p);
        public static float Exp(float power) => (float)Math.Exp(power);
        public static float Log(float f) => (float)Math.Log(f);
        public static float Log(float f, float p) => (float)Math.Log(f, p);
        public static float Log10(float f) => (float)Math.Log10(f);
        public static float Ceil(float f) => (float)Math.Ceiling(f);
        public static float Floor(float f) => (float)Math.Floor(f);
        public static float Round(float f) => (float)Math.Round(f);
        public static int CeilToInt(float f) => (int)Math.Ceiling(f);
        public static int FloorToInt(float f) => (int)Math.Floor(f);
        public static int RoundToInt(float f) => (int)Math.Round(f);
        public static float Sign(float f) => f >= 0 ? 1 : -1;
        public static float Abs(float f) => Math.Abs(f);
        public static int Abs(int value) => Math.Abs(value);

        // A NaN in either place gives the second, as comparisons do.
        public static float Min(float a, float b) => a < b ? a : b;
        public static float Max(float a, float b) => a > b ? a : b;
        public static int Min(int a, int b) => Math.Min(a, b);
        public static int Max(int a, int b) => Math.Max(a, b);

        public static float Clamp(float value, float min, float max) => value < min ? min : value > max ? max : value;
        public static int Clamp(int value, int min, int max) => value < min ? min : value > max ? max : value;
        public static float Clamp01(float value) => Clamp(value, 0, 1);

        public static float Lerp(float a, float b, float t) => a + (b - a) * Clamp01(t);
        public static float LerpUnclamped(float a, float b, float t) => a + (b - a) * t;
        public static float InverseLerp(float a, float b, float value) => a != b ? Clamp01((value - a) / (b - a)) : 0;
        public static float Repeat(float t, float length) => Clamp(t - Floor(t / length) * length, 0, length);

        public static float PingPong(float t, float length)
        {
            t = Repeat(t, length * 2);
            return length - Abs(t - length);
        }

        public static float SmoothStep(float from, float to, float t)
        {
            t = Clamp01(t);
            return Lerp(from, to, t * t * (3 - 2 * t));
        }

        public static float MoveTowards(float current, float target, float maxDelta) =>
            Abs(target - current) <= maxDelta ? target : current + Sign(target - current) * maxDelta;

        public static float DeltaAngle(float current, float target)
        {
            float delta = Repeat(target - current, 360);
            return delta > 180 ? delta - 360 : delta;
        }

        public static bool Approximately(float a, float b) =>
            Abs(b - a) < Max(1e-6f * Max(Abs(a), Abs(b)), Epsilon * 8);

        public static float GammaToLinearSpace(float value) =>
            value <= 0.04045f ? value / 12.92f : Pow((value + 0.055f) / 1.055f, 2.4f);

        public static float LinearToGammaSpace(float value) =>
            value <= 0.0031308f ? value * 12.92f : 1.055f * Pow(value, 1 / 2.4f) - 0.055f;

        public static bool IsPowerOfTwo(int value) => value > 0 && (value & value - 1) == 0;

        public static int NextPowerOfTwo(int value)
        {
            int power = 1;
            while (power < value)
                power *= 2;
            return power;
        }
    }
}
