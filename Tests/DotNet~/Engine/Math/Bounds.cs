// SPDX-License-Identifier: MIT
using System;

namespace UnityEngine
{
    [Serializable]
    public struct Bounds
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

        public override readonly string ToString() => $"Origin: {origin}, Dir: {_direction}";
    }
}
