// SPDX-License-Identifier: MIT
namespace UnityEngine
{
    public enum EventType
    {
        MouseDown = 0,
        MouseUp = 1,
        MouseMove = 2,
        MouseDrag = 3,
        KeyDown = 4,
        KeyUp = 5,
        ScrollWheel = 6,
        Repaint = 7,
        Layout = 8,
        Ignore = 11,
        Used = 12
    }

    public sealed class Event
    {
        public static Event current { get; set; }

        public EventType type { get; set; }

        public Vector2 mousePosition { get; set; }

        public Vector2 delta { get; set; }

        public void Use() => type = EventType.Used;
    }
}
