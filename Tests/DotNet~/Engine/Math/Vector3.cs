// SPDX-License-Identifier: MIT
using System;
using System.Globalization;

namespace UnityEngine
{
    [Serializable]
    public struct Vector3 : IEquatable<Vector3>
    {
        public float x, y, z;

        public Vector3(float x, float y, float z)
        {
            this.x = x;
            this.y = y;
            this.z = z;
        }

        public Vector3(float x, float y) : this(x, y, 0)
        {
        }

        public static Vector3 zero => default;
        public static Vector3 one => new Vector3(1, 1, 1);
        public static Vector3 right => new Vector3(1, 0, 0);
        public static Vector3 left => new Vector3(-1, 0, 0);
        public static Vector3 up => new Vector3(0, 1, 0);
        public static Vector3 down => new Vector3(0, -1, 0);
        public static Vector3 forward => new Vector3(0, 0, 1);
        public static Vector3 back => new Vector3(0, 0, -1);

        public static Vector3 positiveInfinity =>
            new Vector3(float.PositiveInfinity, float.PositiveInfinity, float.PositiveInfinity);

        public static Vector3 negativeInfinity =>
            new Vector3(float.NegativeInfinity, float.NegativeInfinity, float.NegativeInfinity);

        public readonly float sqrMagnitude => x * x + y * y + z * z;
        public readonly float magnitude => (float)Math.Sqrt(sqrMagnitude);
        public readonly Vector3 normalized => Normalize(this);

        public float this[int index]
        {
            readonly get => index switch
            {
                0 => x, 1 => y, 2 => z, _ => throw new IndexOutOfRangeException("Invalid Vector3 index!")
            };
            set
            {
                switch (index)
                {
                    case 0: x = value; break;
                    case 1: y = value; break;
                    case 2: z = value; break;
                    default: throw new IndexOutOfRangeException("Invalid Vector3 index!");
                }
            }
        }

        public void Set(float newX, float newY, float newZ) => this = new Vector3(newX, newY, newZ);

        public void Normalize() => this = Normalize(this);

        public static Vector3 Normalize(Vector3 value)
        {
            float length = value.magnitude;
            return length > 1e-5f ? value / length : zero;
        }

        public static float Dot(Vector3 lhs, Vector3 rhs) => lhs.x * rhs.x + lhs.y * rhs.y + lhs.z * rhs.z;

        public static Vector3 Cross(Vector3 lhs, Vector3 rhs) => new Vector3(
            lhs.y * rhs.z - lhs.z * rhs.y, lhs.z * rhs.x - lhs.x * rhs.z, lhs.x * rhs.y - lhs.y * rhs.x);

        public static float Distance(Vector3 a, Vector3 b) => (a - b).magnitude;

        public static float Magnitude(Vector3 vector) => vector.magnitude;

        public static float SqrMagnitude(Vector3 vector) => vector.sqrMagnitude;

        public static float Angle(Vector3 from, Vector3 to)
        {
            float scale = (float)Math.Sqrt(from.sqrMagnitude * to.sqrMagnitude);
            return scale < 1e-15f ? 0 : (float)Math.Acos(Mathf.Clamp(Dot(from, to) / scale, -1, 1)) * Mathf.Rad2Deg;
        }

        public static Vector3 Lerp(Vector3 a, Vector3 b, float t) => LerpUnclamped(a, b, Mathf.Clamp01(t));

        public static Vector3 LerpUnclamped(Vector3 a, Vector3 b, float t) => a + (b - a) * t;

        public static Vector3 Scale(Vector3 a, Vector3 b) => new Vector3(a.x * b.x, a.y * b.y, a.z * b.z);

        public void Scale(Vector3 scale) => this = Scale(this, scale);

        public static Vector3 Project(Vector3 vector, Vector3 onNormal)
        {
            float square = onNormal.sqrMagnitude;
            return square < Mathf.Epsilon ? zero : onNormal * (Dot(vector, onNormal) / square);
        }

        public static Vector3 ClampMagnitude(Vector3 vector, float maxLength) =>
            vector.sqrMagnitude > maxLength * maxLength ? vector.normalized * maxLength : vector;

        public static Vector3 MoveTowards(Vector3 current, Vector3 target, float maxDistanceDelta)
        {
            Vector3 way = target - current;
            return way.magnitude <= maxDistanceDelta ? target : current + way.normalized * maxDistanceDelta;
        }

        public static Vector3 Min(Vector3 lhs, Vector3 rhs) =>
            new Vector3(Mathf.Min(lhs.x, rhs.x), Mathf.Min(lhs.y, rhs.y), Mathf.Min(lhs.z, rhs.z));

        public static Vector3 Max(Vector3 lhs, Vector3 rhs) =>
            new Vector3(Mathf.Max(lhs.x, rhs.x), Mathf.Max(lhs.y, rhs.y), Mathf.Max(lhs.z, rhs.z));

        public static Vector3 operator +(Vector3 a, Vector3 b) => new Vector3(a.x + b.x, a.y + b.y, a.z + b.z);
        public static Vector3 operator -(Vector3 a, Vector3 b) => new Vector3(a.x - b.x, a.y - b.y, a.z - b.z);
        public static Vector3 operator -(Vector3 a) => new Vector3(-a.x, -a.y, -a.z);
        public static Vector3 operator *(Vector3 a, float d) => new Vector3(a.x * d, a.y * d, a.z * d);
        public static Vector3 operator *(float d, Vector3 a) => a * d;
        public static Vector3 operator /(Vector3 a, float d) => new Vector3(a.x / d, a.y / d, a.z / d);

        // Nearly equal is equal to the operators, not to Equals.
        public static bool operator ==(Vector3 lhs, Vector3 rhs) => (lhs - rhs).sqrMagnitude < 9.99999944e-11f;
        public static bool operator !=(Vector3 lhs, Vector3 rhs) => !(lhs == rhs);

        public readonly bool Equals(Vector3 other) => x == other.x && y == other.y && z == other.z;

        public override readonly bool Equals(object other) => other is Vector3 vector && Equals(vector);

        public override readonly int GetHashCode() => HashCode.Combine(x, y, z);

        public override readonly string ToString() => ToString("F2");

        public readonly string ToString(string format)
        {
            CultureInfo culture = CultureInfo.InvariantCulture;
            return $"({x.ToString(format, culture)}, {y.ToString(format, culture)}, {z.ToString(format, culture)})";
        }
    }
}
