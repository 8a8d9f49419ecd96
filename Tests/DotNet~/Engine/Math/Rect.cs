// SPDX-License-Identifier: MIT
using System;

namespace UnityEngine
{
    [Serializable]
    public struct Rect : IEquatable<Rect>
    {
        public Rect(float x, float y, float width, float height)
        {
            this.x = x;
            this.y = y;
            this.width = width;
            this.height = height;
        }

        public Rect(Vector2 position, Vector2 size) : this(position.x, position.y, size.x, size.y)
        {
        }

        public static Rect zero => default;

        public float x { get; set; }
        public float y { get; set; }
        public float width { get; set; }
        public float height { get; set; }
        public readonly float xMin => x;
        public readonly float yMin => y;
        public readonly float xMax => x + width;
        public readonly float yMax => y + height;
        public readonly Vector2 position => new Vector2(x, y);
        public readonly Vector2 size => new Vector2(width, height);
        public readonly Vector2 center => new Vector2(x + width / 2, y + height / 2);

        public readonly bool Contains(Vector2 point) =>
            point.x >= xMin && point.x < xMax && point.y >= yMin && point.y < yMax;

        public static bool operator ==(Rect lhs, Rect rhs) => lhs.Equals(rhs);
        public static bool operator !=(Rect lhs, Rect rhs) => !lhs.Equals(rhs);

        public readonly bool Equals(Rect other) =>
            x == other.x && y == other.y && width == other.width && height == other.height;

        public override readonly bool Equals(object other) => other is Rect rect && Equals(rect);

        public override readonly int GetHashCode() => HashCode.Combine(x, y, width, height);
    }
}
