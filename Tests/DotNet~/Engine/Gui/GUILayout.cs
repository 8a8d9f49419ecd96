// SPDX-License-Identifier: MIT
using System.Collections.Generic;

namespace UnityEngine
{
    public sealed class GUILayoutOption
    {
    }

    public class GUIStyle
    {
    }

    public sealed class GUISkin : ScriptableObject
    {
        public GUIStyle box { get; set; } = new GUIStyle();
    }

    /// <summary>Controls that nobody uses: they return what they are given.</summary>
    public class GUI
    {
        private static GUISkin s_skin;

        public static Color color { get; set; } = Color.white;

        public static Matrix4x4 matrix { get; set; } = Matrix4x4.identity;

        public static GUISkin skin
        {
            get => s_skin != null ? s_skin : s_skin = ScriptableObject.CreateInstance<GUISkin>();
            set => s_skin = value;
        }

        public static void Box(Rect position, string text)
        {
        }
    }

    /// <summary>Controls that nobody uses: they return what they are given.</summary>
    public class GUILayout
    {
        private static readonly GUILayoutOption s_option = new GUILayoutOption();

        /// <summary>Of the last event, in order.</summary>
        internal static readonly List<string> Labels = new List<string>();

        public static GUILayoutOption Width(float width) => s_option;

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

        public static void Space(float pixels)
        {
        }

        public static void Label(string text, params GUILayoutOption[] options) => Labels.Add(text);

        public static bool Button(string text, params GUILayoutOption[] options) => false;

        public static bool Toggle(bool value, string text, params GUILayoutOption[] options) => value;

        public static int Toolbar(int selected, string[] texts, params GUILayoutOption[] options) => selected;

        public static int SelectionGrid(int selected, string[] texts, int xCount, params GUILayoutOption[] options) =>
            selected;

        public static float HorizontalSlider(float value, float leftValue, float rightValue,
            params GUILayoutOption[] options) => value;
    }
}
