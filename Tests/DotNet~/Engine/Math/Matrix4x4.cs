// SPDX-License-Identifier: MIT
using Numbers = System.Numerics;

namespace UnityEngine
{
    public struct Matrix4x4
    {
        // Of .NET, for row vectors: transposed, so that products are the other way round.
        private Numbers.Matrix4x4 _rows;

        private Matrix4x4(Numbers.Matrix4x4 rows) => _rows = rows;

        public static Matrix4x4 identity => new Matrix4x4(Numbers.Matrix4x4.Identity);

        /// <summary>Of a matrix that can't be inverted: zero, as in the engine.</summary>
        public readonly Matrix4x4 inverse =>
            Numbers.Matrix4x4.Invert(_rows, out Numbers.Matrix4x4 inverse) ? new Matrix4x4(inverse) : default;

        public readonly Vector3 lossyScale
        {
            get
            {
                Vector3 x = MultiplyVector(Vector3.right), y = MultiplyVector(Vector3.up);
                Vector3 z = MultiplyVector(Vector3.forward);
                float sign = Vector3.Dot(Vector3.Cross(x, y), z) < 0 ? -1 : 1;
                return new Vector3(sign * x.magnitude, y.magnitude, z.magnitude);
            }
        }

        public readonly Vector3 GetPosition() => MultiplyPoint3x4(Vector3.zero);

        public readonly Vector3 MultiplyPoint3x4(Vector3 point) =>
            From(Numbers.Vector3.Transform(To(point), _rows));

        public readonly Vector3 MultiplyVector(Vector3 vector) =>
            From(Numbers.Vector3.TransformNormal(To(vector), _rows));

        public static Matrix4x4 Scale(Vector3 vector) => new Matrix4x4(Numbers.Matrix4x4.CreateScale(To(vector)));

        public static Matrix4x4 TRS(Vector3 pos, Quaternion q, Vector3 s) => new Matrix4x4(
            Numbers.Matrix4x4.CreateScale(To(s)) *
            Numbers.Matrix4x4.CreateFromQuaternion(new Numbers.Quaternion(q.x, q.y, q.z, q.w)) *
            Numbers.Matrix4x4.CreateTranslation(To(pos)));

        public static Matrix4x4 operator *(Matrix4x4 lhs, Matrix4x4 rhs) => new Matrix4x4(rhs._rows * lhs._rows);

        private static Numbers.Vector3 To(Vector3 v) => new Numbers.Vector3(v.x, v.y, v.z);

        private static Vector3 From(Numbers.Vector3 v) => new Vector3(v.X, v.Y, v.Z);
    }
}
