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

    public enum KeyCode
    {
        None = 0,
        Tab = 9,
        Return = 13,
        Escape = 27,
        Space = 32,
        UpArrow = 273,
        DownArrow = 274,
        RightArrow = 275,
        LeftArrow = 276
    }

    public sealed class Event
    {
        public static Event current { get; set; }

        public EventType type { get; set; }

        public KeyCode keyCode { get; set; }

        public int button { get; set; }

        public int clickCount { get; set; }

        public bool alt { get; set; }

        public bool control { get; set; }

        public bool shift { get; set; }

        public Vector2 mousePosition { get; set; }

        public Vector2 delta { get; set; }

        public EventType rawType => type;

        public void Use() => type = EventType.Used;
    }
}
