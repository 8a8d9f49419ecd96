// SPDX-License-Identifier: MIT
using System;
using System.Globalization;
using System.Runtime.InteropServices;

namespace UnityEngine
{
    [Serializable]
    public struct Color : IEquatable<Color>
    {
        public float r, g, b, a;

        public Color(float r, float g, float b, float a)
        {
            this.r = r;
            this.g = g;
            this.b = b;
            this.a = a;
        }

        public Color(float r, float g, float b) : this(r, g, b, 1)
        {
        }

        public static Color white => new Color(1, 1, 1);
        public static Color black => new Color(0, 0, 0);
        public static Color red => new Color(1, 0, 0);
        public static Color green => new Color(0, 1, 0);
        public static Color blue => new Color(0, 0, 1);
        public static Color cyan => new Color(0, 1, 1);
        public static Color magenta => new Color(1, 0, 1);
        public static Color yellow => new Color(1, 235f / 255, 4f / 255);
        public static Color gray => new Color(0.5f, 0.5f, 0.5f);
        public static Color grey => gray;
        public static Color clear => default;

        public readonly Color linear => new Color(Mathf.GammaToLinearSpace(r), Mathf.GammaToLinearSpace(g),
            Mathf.GammaToLinearSpace(b), a);

        public readonly Color gamma => new Color(Mathf.LinearToGammaSpace(r), Mathf.LinearToGammaSpace(g),
            Mathf.LinearToGammaSpace(b), a);

        public static Color Lerp(Color a, Color b, float t) => a + (b - a) * Mathf.Clamp01(t);

        public static Color HSVToRGB(float H, float S, float V)
        {
            float Channel(float shift)
            {
                float k = Mathf.Repeat(shift + 6 * H, 6);
                return V - V * S * Mathf.Clamp01(Math.Min(k, 4 - k));
            }

            return new Color(Channel(5), Channel(3), Channel(1));
        }

        public static Color operator +(Color a, Color b) => new Color(a.r + b.r, a.g + b.g, a.b + b.b, a.a + b.a);
        public static Color operator -(Color a, Color b) => new Color(a.r - b.r, a.g - b.g, a.b - b.b, a.a - b.a);
        public static Color operator *(Color a, Color b) => new Color(a.r * b.r, a.g * b.g, a.b * b.b, a.a * b.a);
        public static Color operator *(Color a, float b) => new Color(a.r * b, a.g * b, a.b * b, a.a * b);
        public static Color operator *(float b, Color a) => a * b;
        public static Color operator /(Color a, float b) => new Color(a.r / b, a.g / b, a.b / b, a.a / b);
        public static bool operator ==(Color lhs, Color rhs) => (Vector4)lhs == (Vector4)rhs;
        public static bool operator !=(Color lhs, Color rhs) => !(lhs == rhs);
        public static implicit operator Vector4(Color c) => new Vector4(c.r, c.g, c.b, c.a);
        public static implicit operator Color(Vector4 v) => new Color(v.x, v.y, v.z, v.w);

        public readonly bool Equals(Color other) => r == other.r && g == other.g && b == other.b && a == other.a;

        public override readonly bool Equals(object other) => other is Color color && Equals(color);

        public override readonly int GetHashCode() => HashCode.Combine(r, g, b, a);

        public override readonly string ToString() =>
            string.Format(CultureInfo.InvariantCulture, "RGBA({0:F3}, {1:F3}, {2:F3}, {3:F3})", r, g, b, a);
    }

    [Serializable]
    [StructLayout(LayoutKind.Sequential)]
    public struct Color32
    {
        public byte r, g, b, a;

        public Color32(byte r, byte g, byte b, byte a)
        {
            this.r = r;
            this.g = g;
            this.b = b;
            this.a = a;
        }

        public static Color32 Lerp(Color32 a, Color32 b, float t) => Color.Lerp(a, b, t);

        public static implicit operator Color32(Color c) => new Color32(Byte(c.r), Byte(c.g), Byte(c.b), Byte(c.a));

        public static implicit operator Color(Color32 c) =>
            new Color(c.r / 255f, c.g / 255f, c.b / 255f, c.a / 255f);

        public override readonly string ToString() =>
            string.Format(CultureInfo.InvariantCulture, "RGBA({0}, {1}, {2}, {3})", r, g, b, a);

        private static byte Byte(float value) => (byte)Math.Round(Mathf.Clamp01(value) * 255);
    }
}
