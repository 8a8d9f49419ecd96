// SPDX-License-Identifier: MIT
using System;
using System.Globalization;

namespace UnityEngine
{
    [Serializable]
    public struct Vector4 : IEquatable<Vector4>
    {
        public float x, y, z, w;

        public Vector4(float x, float y, float z, float w)
        {
            this.x = x;
            this.y = y;
            this.z = z;
            this.w = w;
        }

        public Vector4(float x, float y, float z) : this(x, y, z, 0)
        {
        }

        public Vector4(float x, float y) : this(x, y, 0, 0)
        {
        }

        public static Vector4 zero => default;
        public static Vector4 one => new Vector4(1, 1, 1, 1);

        public readonly float sqrMagnitude => Dot(this, this);
        public readonly float magnitude => (float)Math.Sqrt(sqrMagnitude);
        public readonly Vector4 normalized => magnitude > 1e-5f ? this / magnitude : zero;

        public float this[int index]
        {
            readonly get => index switch
            {
                0 => x, 1 => y, 2 => z, 3 => w, _ => throw new IndexOutOfRangeException("Invalid Vector4 index!")
            };
            set
            {
                switch (index)
                {
                    case 0: x = value; break;
                    case 1: y = value; break;
                    case 2: z = value; break;
                    case 3: w = value; break;
                    default: throw new IndexOutOfRangeException("Invalid Vector4 index!");
                }
            }
        }

        public void Set(float newX, float newY, float newZ, float newW) => this = new Vector4(newX, newY, newZ, newW);

        public static float Dot(Vector4 a, Vector4 b) => a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;

        public static Vector4 Lerp(Vector4 a, Vector4 b, float t) => a + (b - a) * Mathf.Clamp01(t);

        public static Vector4 operator +(Vector4 a, Vector4 b) =>
            new Vector4(a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w);

        public static Vector4 operator -(Vector4 a, Vector4 b) =>
            new Vector4(a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w);

        public static Vector4 operator -(Vector4 a) => new Vector4(-a.x, -a.y, -a.z, -a.w);
        public static Vector4 operator *(Vector4 a, float d) => new Vector4(a.x * d, a.y * d, a.z * d, a.w * d);
        public static Vector4 operator *(float d, Vector4 a) => a * d;
        public static Vector4 operator /(Vector4 a, float d) => new Vector4(a.x / d, a.y / d, a.z / d, a.w / d);

        // Nearly equal is equal to the operators, not to Equals.
        public static bool operator ==(Vector4 lhs, Vector4 rhs) => (lhs - rhs).sqrMagnitude < 9.99999944e-11f;
        public static bool operator !=(Vector4 lhs, Vector4 rhs) => !(lhs == rhs);

        public static implicit operator Vector4(Vector3 v) => new Vector4(v.x, v.y, v.z, 0);
        public static implicit operator Vector3(Vector4 v) => new Vector3(v.x, v.y, v.z);
        public static implicit operator Vector4(Vector2 v) => new Vector4(v.x, v.y, 0, 0);
        public static implicit operator Vector2(Vector4 v) => new Vector2(v.x, v.y);

        public readonly bool Equals(Vector4 other) => x == other.x && y == other.y && z == other.z && w == other.w;

        public override readonly bool Equals(object other) => other is Vector4 vector && Equals(vector);

        public override readonly int GetHashCode() => HashCode.Combine(x, y, z, w);

        public override readonly string ToString() =>
            string.Format(CultureInfo.InvariantCulture, "({0:F2}, {1:F2}, {2:F2}, {3:F2})", x, y, z, w);
    }
}
