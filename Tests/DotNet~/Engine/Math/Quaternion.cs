// SPDX-License-Identifier: MIT
using System;
using System.Globalization;

namespace UnityEngine
{
    [Serializable]
    public struct Quaternion : IEquatable<Quaternion>
    {
        public float x, y, z, w;

        public Quaternion(float x, float y, float z, float w)
        {
            this.x = x;
            this.y = y;
            this.z = z;
            this.w = w;
        }

        public static Quaternion identity => new Quaternion(0, 0, 0, 1);

        public readonly Quaternion normalized => Normalize(this);

        /// <summary>Degrees, applied about z, then x, then y.</summary>
        public Vector3 eulerAngles
        {
            readonly get
            {
                Quaternion q = normalized;
                float sine = 2 * (q.w * q.x - q.y * q.z);
                float pitch, yaw, roll;
                if (Math.Abs(sine) > 0.999999f)
                {
                    pitch = Math.Sign(sine) * Mathf.PI / 2;
                    yaw = (float)Math.Atan2(2 * (q.w * q.y - q.x * q.z), 1 - 2 * (q.y * q.y + q.z * q.z));
                    roll = 0;
                }
                else
                {
                    pitch = (float)Math.Asin(sine);
                    yaw = (float)Math.Atan2(2 * (q.x * q.z + q.w * q.y), 1 - 2 * (q.x * q.x + q.y * q.y));
                    roll = (float)Math.Atan2(2 * (q.x * q.y + q.w * q.z), 1 - 2 * (q.x * q.x + q.z * q.z));
                }

                return new Vector3(Mathf.Repeat(pitch * Mathf.Rad2Deg, 360), Mathf.Repeat(yaw * Mathf.Rad2Deg, 360),
                    Mathf.Repeat(roll * Mathf.Rad2Deg, 360));
            }
            set => this = Euler(value);
        }

        public static Quaternion Euler(float x, float y, float z) =>
            AngleAxis(y, Vector3.up) * AngleAxis(x, Vector3.right) * AngleAxis(z, Vector3.forward);

        public static Quaternion Euler(Vector3 euler) => Euler(euler.x, euler.y, euler.z);

        public static Quaternion AngleAxis(float angle, Vector3 axis)
        {
            axis = axis.normalized;
            float half = angle * Mathf.Deg2Rad / 2, sine = (float)Math.Sin(half);
            return axis.sqrMagnitude == 0
                ? identity
                : new Quaternion(axis.x * sine, axis.y * sine, axis.z * sine, (float)Math.Cos(half));
        }

        public static Quaternion FromToRotation(Vector3 fromDirection, Vector3 toDirection)
        {
            Vector3 from = fromDirection.normalized, to = toDirection.normalized;
            float cosine = Vector3.Dot(from, to);
            if (cosine < -0.999999f)
            {
                Vector3 side = Vector3.Cross(from, Math.Abs(from.x) < 0.8f ? Vector3.right : Vector3.up);
                return AngleAxis(180, side);
            }

            Vector3 axis = Vector3.Cross(from, to);
            return Normalize(new Quaternion(axis.x, axis.y, axis.z, 1 + cosine));
        }

        public static Quaternion LookRotation(Vector3 forward) => LookRotation(forward, Vector3.up);

        public static Quaternion LookRotation(Vector3 forward, Vector3 upwards)
        {
            Vector3 z = forward.normalized;
            if (z.sqrMagnitude == 0)
                return identity;
            Vector3 x = Vector3.Cross(upwards, z).normalized;
            if (x.sqrMagnitude == 0)
                return FromToRotation(Vector3.forward, z);
            Quaternion turn = FromToRotation(Vector3.forward, z);
            float angle = Vector3.Angle(turn * Vector3.right, x);
            float side = Vector3.Dot(Vector3.Cross(turn * Vector3.right, x), z);
            return AngleAxis(side < 0 ? -angle : angle, z) * turn;
        }

        public static Quaternion Inverse(Quaternion rotation)
        {
            float square = Dot(rotation, rotation);
            return new Quaternion(-rotation.x / square, -rotation.y / square, -rotation.z / square,
                rotation.w / square);
        }

        public static float Dot(Quaternion a, Quaternion b) => a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;

        public static float Angle(Quaternion a, Quaternion b) =>
            2 * (float)Math.Acos(Math.Min(Math.Abs(Dot(a, b)), 1)) * Mathf.Rad2Deg;

        public static Quaternion Normalize(Quaternion q)
        {
            float length = (float)Math.Sqrt(Dot(q, q));
            return length < Mathf.Epsilon
                ? identity
                : new Quaternion(q.x / length, q.y / length, q.z / length, q.w / length);
        }

        public static Quaternion Slerp(Quaternion a, Quaternion b, float t)
        {
            t = Mathf.Clamp01(t);
            float cosine = Dot(a, b), sign = cosine < 0 ? -1 : 1;
            double angle = Math.Acos(Math.Min(Math.Abs(cosine), 1));
            double first = angle < 1e-4 ? 1 - t : Math.Sin((1 - t) * angle) / Math.Sin(angle);
            double second = sign * (angle < 1e-4 ? t : Math.Sin(t * angle) / Math.Sin(angle));
            return Normalize(new Quaternion((float)(first * a.x + second * b.x), (float)(first * a.y + second * b.y),
                (float)(first * a.z + second * b.z), (float)(first * a.w + second * b.w)));
        }

        public static Quaternion operator *(Quaternion lhs, Quaternion rhs) => new Quaternion(
            lhs.w * rhs.x + lhs.x * rhs.w + lhs.y * rhs.z - lhs.z * rhs.y,
            lhs.w * rhs.y + lhs.y * rhs.w + lhs.z * rhs.x - lhs.x * rhs.z,
            lhs.w * rhs.z + lhs.z * rhs.w + lhs.x * rhs.y - lhs.y * rhs.x,
            lhs.w * rhs.w - lhs.x * rhs.x - lhs.y * rhs.y - lhs.z * rhs.z);

        public static Vector3 operator *(Quaternion rotation, Vector3 point)
        {
            var axis = new Vector3(rotation.x, rotation.y, rotation.z);
            Vector3 twice = 2 * Vector3.Cross(axis, point);
            return point + rotation.w * twice + Vector3.Cross(axis, twice);
        }

        public static bool operator ==(Quaternion lhs, Quaternion rhs) => Dot(lhs, rhs) > 0.999999f;
        public static bool operator !=(Quaternion lhs, Quaternion rhs) => !(lhs == rhs);

        public readonly bool Equals(Quaternion other) => x == other.x && y == other.y && z == other.z && w == other.w;

        public override readonly bool Equals(object other) => other is Quaternion rotation && Equals(rotation);

        public override readonly int GetHashCode() => HashCode.Combine(x, y, z, w);

        public override readonly string ToString() =>
            string.Format(CultureInfo.InvariantCulture, "({0:F5}, {1:F5}, {2:F5}, {3:F5})", x, y, z, w);
    }
}
