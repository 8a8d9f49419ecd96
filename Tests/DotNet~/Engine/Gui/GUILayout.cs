// SPDX-License-Identifier: MIT
using System;

namespace UnityEngine
{
    public sealed class GUILayoutOption
    {
    }

    public class GUIStyle
    {
        public int fontSize { get; set; }

        public bool wordWrap { get; set; }

        public static implicit operator GUIStyle(string str) => new GUIStyle();
    }

    public class GUIContent
    {
        public static GUIContent none = new GUIContent("");

        public GUIContent(string text) : this(text, "")
        {
        }

        public GUIContent(string text, string tooltip)
        {
            this.text = text;
            this.tooltip = tooltip;
        }

        public string text { get; set; }

        public string tooltip { get; set; }
    }

    public sealed class GUISkin : ScriptableObject
    {
        public GUIStyle box { get; set; } = new GUIStyle();

        public GUIStyle label { get; set; } = new GUIStyle();

        public GUIStyle button { get; set; } = new GUIStyle();
    }

    /// <summary>Controls that nobody uses: they return what they are given.</summary>
    public class GUI
    {
        private static GUISkin s_skin;

        public static bool enabled { get; set; } = true;

        public static bool changed { get; set; }

        public static int depth { get; set; }

        public static Color color { get; set; } = Color.white;

        public static Matrix4x4 matrix { get; set; } = Matrix4x4.identity;

        public static GUISkin skin
        {
            get => s_skin != null ? s_skin : s_skin = ScriptableObject.CreateInstance<GUISkin>();
            set => s_skin = value;
        }

        public static void Label(Rect position, string text)
        {
        }

        public static void Box(Rect position, string text)
        {
        }

        public static bool Button(Rect position, string text) => false;

        public static bool Toggle(Rect position, bool value, string text) => value;

        public static float HorizontalSlider(Rect position, float value, float leftValue, float rightValue) => value;
    }

    /// <summary>Controls that nobody uses: they return what they are given.</summary>
    public class GUILayout
    {
        private static readonly GUILayoutOption s_option = new GUILayoutOption();

        public static GUILayoutOption Width(float width) => s_option;

        public static GUILayoutOption Height(float height) => s_option;

        public static GUILayoutOption MinWidth(float minWidth) => s_option;

        public static GUILayoutOption MaxWidth(float maxWidth) => s_option;

        public static GUILayoutOption ExpandWidth(bool expand) => s_option;

        public static void BeginArea(Rect screenRect)
        {
        }

        public static void BeginArea(Rect screenRect, GUIStyle style)
        {
        }

        public static void EndArea()
        {
        }

        public static void BeginHorizontal(params GUILayoutOption[] options)
        {
        }

        public static void EndHorizontal()
        {
        }

        public static void BeginVertical(params GUILayoutOption[] options)
        {
        }

        public static void BeginVertical(GUIStyle style, params GUILayoutOption[] options)
        {
        }

        public static void EndVertical()
        {
        }

        public static void Space(float pixels)
        {
        }

        public static void FlexibleSpace()
        {
        }

        public static void Label(string text, params GUILayoutOption[] options)
        {
        }

        public static void Label(string text, GUIStyle style, params GUILayoutOption[] options)
        {
        }

        public static void Box(string text, params GUILayoutOption[] options)
        {
        }

        public static bool Button(string text, params GUILayoutOption[] options) => false;

        public static bool RepeatButton(string text, params GUILayoutOption[] options) => false;

        public static bool Toggle(bool value, string text, params GUILayoutOption[] options) => value;

        public static int Toolbar(int selected, string[] texts, params GUILayoutOption[] options) => selected;

        public static int SelectionGrid(int selected, string[] texts, int xCount, params GUILayoutOption[] options) =>
            selected;

        public static string TextField(string text, params GUILayoutOption[] options) => text;

        public static float HorizontalSlider(float value, float leftValue, float rightValue,
            params GUILayoutOption[] options) => value;

        public class HorizontalScope : IDisposable
        {
            public HorizontalScope(params GUILayoutOption[] options)
            {
            }

            public void Dispose()
            {
            }
        }

        public class AreaScope : IDisposable
        {
            public AreaScope(Rect screenRect)
            {
            }

            public void Dispose()
            {
            }
        }
    }
}
