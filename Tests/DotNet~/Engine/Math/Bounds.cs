// SPDX-License-Identifier: MIT
using System;

namespace UnityEngine
{
    [Serializable]
    public struct Bounds : IEquatable<Bounds>
    {
        private Vector3 _center;
        private Vector3 _extents;

        public Bounds(Vector3 center, Vector3 size)
        {
            _center = center;
            _extents = size * 0.5f;
        }

        public Vector3 center
        {
            readonly get => _center;
            set => _center = value;
        }

        public Vector3 extents
        {
            readonly get => _extents;
            set => _extents = value;
        }

        public Vector3 size
        {
            readonly get => _extents * 2;
            set => _extents = value * 0.5f;
        }

        public Vector3 min
        {
            readonly get => _center - _extents;
            set => SetMinMax(value, max);
        }

        public Vector3 max
        {
            readonly get => _center + _extents;
            set => SetMinMax(min, value);
        }

        public void SetMinMax(Vector3 min, Vector3 max)
        {
            _extents = (max - min) * 0.5f;
            _center = min + _extents;
        }

        public void Encapsulate(Vector3 point) => SetMinMax(Vector3.Min(min, point), Vector3.Max(max, point));

        public void Encapsulate(Bounds bounds) =>
            SetMinMax(Vector3.Min(min, bounds.min), Vector3.Max(max, bounds.max));

        public void Expand(float amount) => size += new Vector3(amount, amount, amount);

        public void Expand(Vector3 amount) => size += amount;

        public readonly bool Contains(Vector3 point) =>
            point.x >= min.x && point.y >= min.y && point.z >= min.z &&
            point.x <= max.x && point.y <= max.y && point.z <= max.z;

        public readonly bool Intersects(Bounds bounds) =>
            min.x <= bounds.max.x && max.x >= bounds.min.x && min.y <= bounds.max.y && max.y >= bounds.min.y &&
            min.z <= bounds.max.z && max.z >= bounds.min.z;

        public readonly bool IntersectRay(Ray ray) => IntersectRay(ray, out _);

        public readonly bool IntersectRay(Ray ray, out float distance)
        {
            float near = float.NegativeInfinity, far = float.PositiveInfinity;
            for (int axis = 0; axis < 3; ++axis)
            {
                float direction = ray.direction[axis], origin = ray.origin[axis];
                float first = (min[axis] - origin) / direction, second = (max[axis] - origin) / direction;
                if (direction == 0 && (origin < min[axis] || origin > max[axis]))
                    first = second = float.PositiveInfinity;
                else if (direction == 0)
                    continue;
                near = Math.Max(near, Math.Min(first, second));
                far = Math.Min(far, Math.Max(first, second));
            }

            distance = near < 0 ? 0 : near;
            bool hit = far >= near && far >= 0 && !float.IsPositiveInfinity(near);
            if (!hit)
                distance = 0;
            return hit;
        }

        public readonly Vector3 ClosestPoint(Vector3 point) => Vector3.Max(min, Vector3.Min(max, point));

        public readonly float SqrDistance(Vector3 point) => (ClosestPoint(point) - point).sqrMagnitude;

        public static bool operator ==(Bounds lhs, Bounds rhs) =>
            lhs._center == rhs._center && lhs._extents == rhs._extents;

        public static bool operator !=(Bounds lhs, Bounds rhs) => !(lhs == rhs);

        public readonly bool Equals(Bounds other) => _center.Equals(other._center) && _extents.Equals(other._extents);

        public override readonly bool Equals(object other) => other is Bounds bounds && Equals(bounds);

        public override readonly int GetHashCode() => HashCode.Combine(_center, _extents);

        public override readonly string ToString() => $"Center: {_center}, Extents: {_extents}";
    }

    public struct Ray
    {
        private Vector3 _direction;

        public Ray(Vector3 origin, Vector3 direction)
        {
            this.origin = origin;
            _direction = direction.normalized;
        }

        public Vector3 origin { get; set; }

        public Vector3 direction
        {
            readonly get => _direction;
            set => _direction = value.normalized;
        }

        public readonly Vector3 GetPoint(float distance) => origin + _direction * distance;

        public override readonly string ToString() => $"Origin: {origin}, Dir: {_direction}";
    }
}
