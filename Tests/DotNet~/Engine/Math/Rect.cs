// SPDX-License-Identifier: MIT
using System;

namespace UnityEngine
{
    [Serializable]
    public struct Rect
    {
        public Rect(float x, float y, float width, float height)
        {
            this.x = x;
            this.y = y;
            this.width = width;
            this.height = height;
        }

        public float x { get; set; }
        public float y { get; set; }
        public float width { get; set; }
        public float height { get; set; }
        public readonly float xMin => x;
        public readonly float yMin => y;
        public readonly float xMax => x + width;
        public readonly float yMax => y + height;

        public readonly bool Contains(Vector2 point) =>
            point.x >= xMin && point.x < xMax && point.y >= yMin && point.y < yMax;
    }
}
