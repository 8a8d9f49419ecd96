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

        public readonly Vector3 center => _center;

        public readonly Vector3 extents => _extents;

        public readonly Vector3 size => _extents * 2;

        public readonly Vector3 min => _center - _extents;

        public readonly Vector3 max => _center + _extents;

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
        public Ray(Vector3 origin, Vector3 direction)
        {
            this.origin = origin;
            this.direction = direction.normalized;
        }

        public Vector3 origin { get; }

        public Vector3 direction { get; }
    }
}
