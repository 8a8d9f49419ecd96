// SPDX-License-Identifier: MIT
using System;
using System.Globalization;

namespace UnityEngine
{
    [Serializable]
    public struct Vector2 : IEquatable<Vector2>
    {
        public float x, y;

        public Vector2(float x, float y)
        {
            this.x = x;
            this.y = y;
        }

        public readonly bool Equals(Vector2 other) => x == other.x && y == other.y;

        public override readonly bool Equals(object other) => other is Vector2 vector && Equals(vector);

        public override readonly int GetHashCode() => HashCode.Combine(x, y);

        public override readonly string ToString() => ToString("F2");

        public readonly string ToString(string format) =>
            $"({x.ToString(format, CultureInfo.InvariantCulture)}, {y.ToString(format, CultureInfo.InvariantCulture)})";
    }
}
