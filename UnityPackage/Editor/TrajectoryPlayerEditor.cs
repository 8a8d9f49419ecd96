// SPDX-License-Identifier: MIT
using System.Globalization;
using UnityEditor;
using UnityEngine;

namespace QuickSes.Editor
{
    /// <summary>Settings of a player, and below them a slider over the frames and what its files say.</summary>
    [CustomEditor(typeof(TrajectoryPlayer))]
    [CanEditMultipleObjects]
    internal sealed class TrajectoryPlayerEditor : UnityEditor.Editor
    {
        private bool _wasActive;

        public override void OnInspectorGUI()
        {
            serializedObject.Update();
            // The place is the slider below.
            DrawPropertiesExcluding(serializedObject, "m_Script", "_frame");
            serializedObject.ApplyModifiedProperties();
            EditorGUILayout.Space();
            EditorGUILayout.LabelField("Playback", EditorStyles.boldLabel);
            if (targets.Length > 1)
            {
                EditorGUILayout.HelpBox("Select one player to see its frames.", MessageType.Info);
                return;
            }
            var player = (TrajectoryPlayer)target;
            if (!IsLive(player))
            {
                EditorGUILayout.HelpBox("Not active in an open scene or prefab, so nothing is loaded.",
                    MessageType.Info);
                return;
            }
            DrawFrames(player);
            DrawMessages(player);
        }

        // True once more after the end, for the last figures.
        public override bool RequiresConstantRepaint()
        {
            bool isActive = false;
            foreach (Object each in targets)
            {
                var player = (TrajectoryPlayer)each;
                isActive |= IsLive(player) && (player.IsLoading || player.IsPlaying);
            }
            bool repaints = isActive || _wasActive;
            _wasActive = isActive;
            return repaints;
        }

        private static bool IsLive(TrajectoryPlayer player) =>
            player != null && player.isActiveAndEnabled && !EditorUtility.IsPersistent(player);

        private void DrawFrames(TrajectoryPlayer player)
        {
            EditorGUILayout.LabelField("Frames", player.IsReady
                ? SurfaceStatus.Count(player.FrameCount)
                : player.IsLoading ? "Reading..." : "None");
            if (player.IsLoading)
                EditorGUI.ProgressBar(EditorGUILayout.GetControlRect(), player.LoadProgress, "");
            using (new EditorGUI.DisabledScope(!player.IsReady))
            {
                DrawSlider(player);
                if (player.TryGetTime(out double picoseconds))
                    EditorGUILayout.LabelField("Time",
                        picoseconds.ToString("N3", CultureInfo.InvariantCulture) + " ps");
            }
            using (new EditorGUILayout.HorizontalScope())
            {
                using (new EditorGUI.DisabledScope(!Application.IsPlaying(player) || !player.IsReady))
                {
                    var label = player.IsPlaying
                        ? new GUIContent("Pause", "Stays where it is.")
                        : new GUIContent("Play", "Plays from where it is. In play mode only.");
                    if (GUILayout.Button(label))
                        PlayOrPause(player);
                }
                using (new EditorGUI.DisabledScope(!player.IsReady))
                {
                    if (GUILayout.Button(new GUIContent("Stop", "Goes back to the beginning and stays there.")))
                        Stop(player);
                }
                if (GUILayout.Button(new GUIContent("Reload", "Reads the files again.")))
                    player.Load();
            }
        }

        // Edits the serialised place, which the player follows (OnValidate), so that Undo and prefabs know of it. In
        // play mode it moves on by itself and is no matter of Undo.
        private void DrawSlider(TrajectoryPlayer player)
        {
            SerializedProperty frame = serializedObject.FindProperty("_frame");
            float last = Mathf.Max(0, player.FrameCount - 1);
            EditorGUI.BeginChangeCheck();
            Rect row = EditorGUILayout.GetControlRect();
            GUIContent label = EditorGUI.BeginProperty(row, new GUIContent("Frame", frame.tooltip), frame);
            float chosen = EditorGUI.Slider(row, label, (float)player.Frame, 0, last);
            EditorGUI.EndProperty();
            if (!EditorGUI.EndChangeCheck())
                return;
            double place = player.Interpolate ? chosen : System.Math.Round(chosen);
            if (Application.IsPlaying(player))
                player.Frame = place;
            else
                EditPlace((float)place);
        }

        private void Stop(TrajectoryPlayer player)
        {
            if (!Application.IsPlaying(player))
                EditPlace((float)player.Beginning);
            player.Stop();
        }

        private void EditPlace(float place)
        {
            serializedObject.FindProperty("_frame").floatValue = place;
            serializedObject.ApplyModifiedProperties();
        }

        private static void PlayOrPause(TrajectoryPlayer player)
        {
            if (player.IsPlaying)
                player.Pause();
            else
                player.Play();
        }

        private static void DrawMessages(TrajectoryPlayer player)
        {
            if (player.LastError.Status != QuickSesStatus.Ok)
                EditorGUILayout.HelpBox(player.LastError.Message, MessageType.Error);
            Structure structure = player.Structure;
            if (structure == null)
                return;
            EditorGUILayout.LabelField("Atoms", SurfaceStatus.Count(structure.AtomCount));
            for (int k = 0; k < structure.WarningCount; ++k)
                EditorGUILayout.HelpBox(structure.GetWarning(k), MessageType.Warning);
        }
    }
}
