// SPDX-License-Identifier: MIT
using System;
using System.Globalization;

namespace UnityEngine
{
    /// <summary>mRC is row R, column C; vectors are columns.</summary>
    [Serializable]
    public struct Matrix4x4
    {
        public float m00, m10, m20, m30, m01, m11, m21, m31, m02, m12, m22, m32, m03, m13, m23, m33;

        public Matrix4x4(Vector4 column0, Vector4 column1, Vector4 column2, Vector4 column3)
        {
            (m00, m10, m20, m30) = (column0.x, column0.y, column0.z, column0.w);
            (m01, m11, m21, m31) = (column1.x, column1.y, column1.z, column1.w);
            (m02, m12, m22, m32) = (column2.x, column2.y, column2.z, column2.w);
            (m03, m13, m23, m33) = (column3.x, column3.y, column3.z, column3.w);
        }

        public static Matrix4x4 identity => Scale(Vector3.one);

        public readonly Matrix4x4 inverse => Invert(this);

        public readonly float determinant
        {
            get
            {
                double value = 0;
                for (int column = 0; column < 4; ++column)
                    value += this[0, column] * Cofactor(0, column);
                return (float)value;
            }
        }

        public readonly Vector3 lossyScale
        {
            get
            {
                Vector3 x = GetColumn(0), y = GetColumn(1), z = GetColumn(2);
                float sign = Vector3.Dot(Vector3.Cross(x, y), z) < 0 ? -1 : 1;
                return new Vector3(sign * x.magnitude, y.magnitude, z.magnitude);
            }
        }

        public readonly Vector3 GetPosition() => GetColumn(3);

        public float this[int row, int column]
        {
            readonly get => this[row + 4 * column];
            set => this[row + 4 * column] = value;
        }

        public unsafe float this[int index]
        {
            readonly get
            {
                RequireIndex(index);
                fixed (float* first = &m00)
                    return first[index];
            }
            set
            {
                RequireIndex(index);
                fixed (float* first = &m00)
                    first[index] = value;
            }
        }

        public readonly Vector4 GetColumn(int index) =>
            new Vector4(this[0, index], this[1, index], this[2, index], this[3, index]);

        public readonly Vector4 GetRow(int index) =>
            new Vector4(this[index, 0], this[index, 1], this[index, 2], this[index, 3]);

        public readonly Vector3 MultiplyPoint3x4(Vector3 point) =>
            MultiplyVector(point) + new Vector3(m03, m13, m23);

        public readonly Vector3 MultiplyVector(Vector3 vector) => new Vector3(
            m00 * vector.x + m01 * vector.y + m02 * vector.z,
            m10 * vector.x + m11 * vector.y + m12 * vector.z,
            m20 * vector.x + m21 * vector.y + m22 * vector.z);

        public static Matrix4x4 Scale(Vector3 vector) =>
            new Matrix4x4 { m00 = vector.x, m11 = vector.y, m22 = vector.z, m33 = 1 };

        public static Matrix4x4 TRS(Vector3 pos, Quaternion q, Vector3 s) => new Matrix4x4(
            q * Vector3.right * s.x, q * Vector3.up * s.y, q * Vector3.forward * s.z,
            new Vector4(pos.x, pos.y, pos.z, 1));

        public static Vector4 operator *(Matrix4x4 lhs, Vector4 vector) => new Vector4(
            Vector4.Dot(lhs.GetRow(0), vector), Vector4.Dot(lhs.GetRow(1), vector),
            Vector4.Dot(lhs.GetRow(2), vector), Vector4.Dot(lhs.GetRow(3), vector));

        public static Matrix4x4 operator *(Matrix4x4 lhs, Matrix4x4 rhs) => new Matrix4x4(
            lhs * rhs.GetColumn(0), lhs * rhs.GetColumn(1), lhs * rhs.GetColumn(2), lhs * rhs.GetColumn(3));

        public override readonly string ToString() =>
            string.Format(CultureInfo.InvariantCulture, "{0}\n{1}\n{2}\n{3}", GetRow(0), GetRow(1), GetRow(2),
                GetRow(3));

        // A matrix that can't be inverted gives zero, as in the engine.
        private static Matrix4x4 Invert(in Matrix4x4 matrix)
        {
            Matrix4x4 result = default;
            float determinant = matrix.determinant;
            if (determinant == 0)
                return result;
            for (int row = 0; row < 4; ++row)
                for (int column = 0; column < 4; ++column)
                    result[column, row] = (float)(matrix.Cofactor(row, column) / determinant);
            return result;
        }

        private readonly double Cofactor(int row, int column)
        {
            double Entry(in Matrix4x4 m, int i, int j) => m[i + (i < row ? 0 : 1), j + (j < column ? 0 : 1)];
            double minor = 0;
            for (int j = 0; j < 3; ++j)
                minor += Entry(this, 0, j) * (Entry(this, 1, (j + 1) % 3) * Entry(this, 2, (j + 2) % 3) -
                    Entry(this, 1, (j + 2) % 3) * Entry(this, 2, (j + 1) % 3));
            return (row + column) % 2 == 0 ? minor : -minor;
        }

        private static void RequireIndex(int index)
        {
            if ((uint)index >= 16)
                throw new IndexOutOfRangeException("Invalid matrix index!");
        }
    }
}
