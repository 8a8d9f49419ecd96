// SPDX-License-Identifier: MIT
namespace UnityEngine
{
    public struct Plane
    {
        public Plane(Vector3 inNormal, Vector3 inPoint)
        {
            normal = Vector3.Normalize(inNormal);
            distance = -Vector3.Dot(normal, inPoint);
        }

        public Plane(Vector3 inNormal, float d)
        {
            normal = Vector3.Normalize(inNormal);
            distance = d;
        }

        public Vector3 normal { get; set; }

        public float distance { get; set; }

        public readonly Plane flipped => new Plane(-normal, -distance);

        public readonly float GetDistanceToPoint(Vector3 point) => Vector3.Dot(normal, point) + distance;

        public readonly bool GetSide(Vector3 point) => GetDistanceToPoint(point) > 0;
    }
}
