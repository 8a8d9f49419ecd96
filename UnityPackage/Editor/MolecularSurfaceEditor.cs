// SPDX-License-Identifier: MIT
using UnityEditor;
using UnityEngine;

namespace QuickSes.Editor
{
    /// <summary>Settings of one or several surfaces, and below them what they show.</summary>
    [CustomEditor(typeof(MolecularSurface))]
    [CanEditMultipleObjects]
    internal sealed class MolecularSurfaceEditor : UnityEditor.Editor
    {
        private readonly AtomUnderMouse _atomUnderMouse = new AtomUnderMouse();
        private bool _isSupported;
        private string _unsupportedReason;
        private bool _wasBusy;

        /// <summary>
        /// Whether the component runs, so that asking it for its surface makes nothing that stays behind.
        /// </summary>
        public static bool IsLive(MolecularSurface surface) =>
            surface != null && surface.isActiveAndEnabled && !EditorUtility.IsPersistent(surface);

        public override void OnInspectorGUI()
        {
            if (!_isSupported)
                DrawUnsupported();
            DrawSettings();
            EditorGUILayout.Space();
            EditorGUILayout.LabelField("Status", EditorStyles.boldLabel);
            if (!IsAnyLive())
            {
                EditorGUILayout.HelpBox("Not active in an open scene or prefab, so there is no surface.",
                    MessageType.Info);
                return;
            }
            if (targets.Length > 1)
                SurfaceStatusPanel.DrawSums(targets);
            else
            {
                DrawStatus((MolecularSurface)target);
                _atomUnderMouse.DrawToggle((MolecularSurface)target);
            }
            DrawButtons();
        }

        // True once more after the end, for the last figures.
        public override bool RequiresConstantRepaint()
        {
            bool isBusy = IsAnyBusy();
            bool repaints = isBusy || _wasBusy;
            _wasBusy = isBusy;
            return repaints;
        }

        // Once for each of the selected surfaces, which is `target` then.
        private void OnSceneGUI()
        {
            if (targets.Length == 1 && IsLive((MolecularSurface)target))
                _atomUnderMouse.OnSceneGUI((MolecularSurface)target);
        }

        private void OnEnable() => _isSupported = MolecularSurface.IsSupported(out _unsupportedReason);

        private void OnDisable() => _atomUnderMouse.Leave((MolecularSurface)target);

        private void DrawUnsupported()
        {
            bool isPlatformSupported = Application.platform == RuntimePlatform.LinuxEditor ||
                Application.platform == RuntimePlatform.WindowsEditor;
            EditorGUILayout.HelpBox(SurfaceStatus.Unsupported(_unsupportedReason, isPlatformSupported),
                MessageType.Error);
            if (GUILayout.Button("Check again"))
                _isSupported = MolecularSurface.IsSupported(out _unsupportedReason);
        }

        // OnValidate of the component begins a computation when something has changed.
        private void DrawSettings()
        {
            serializedObject.Update();
            SerializedProperty kind = serializedObject.FindProperty("_surface");
            SerializedProperty method = serializedObject.FindProperty("_method");
            SerializedProperty property = serializedObject.GetIterator();
            for (bool isFirst = true; property.NextVisible(isFirst); isFirst = false)
            {
                if (property.propertyPath == "m_Script")
                    continue;
                bool isUsed = kind.hasMultipleDifferentValues || method.hasMultipleDifferentValues ||
                    SurfaceForm.IsUsed(
                        property.propertyPath, (SurfaceKind)kind.intValue, (SurfaceMethod)method.intValue);
                string unit = SurfaceForm.UnitOf(property.propertyPath);
                string label = unit == null ? property.displayName : $"{property.displayName} ({unit})";
                using (new EditorGUI.DisabledScope(!isUsed))
                    DrawField(property, new GUIContent(label, property.tooltip));
            }
            serializedObject.ApplyModifiedProperties();
        }

        // A selection counts when it is complete, or each letter of it would be looked at.
        private void DrawField(SerializedProperty property, GUIContent label)
        {
            if (property.propertyPath != "_visible")
            {
                EditorGUILayout.PropertyField(property, label, true);
                return;
            }
            EditorGUILayout.DelayedTextField(property, label);
            var surface = (MolecularSurface)target;
            if (targets.Length == 1 && surface.VisibleSelectionError.Length > 0)
                EditorGUILayout.HelpBox(surface.VisibleSelectionError, MessageType.Error);
        }

        private static void DrawStatus(MolecularSurface surface)
        {
            if (surface.AtomCount == 0 && !surface.Source.IsSet)
                EditorGUILayout.HelpBox("There are no atoms: choose a source above, or call SetAtoms from a script.",
                    MessageType.Info);
            SurfaceStatusPanel.Draw(surface);
        }

        private void DrawButtons()
        {
            using (new EditorGUILayout.HorizontalScope())
            {
                using (new EditorGUI.DisabledScope(!_isSupported))
                {
                    if (GUILayout.Button(new GUIContent("Compute", "Computes the surface again.")))
                        Compute();
                }
                using (new EditorGUI.DisabledScope(!CanAnyReload()))
                {
                    if (GUILayout.Button(new GUIContent("Reload", "Reads the source again.")))
                        Reload();
                }
                using (new EditorGUI.DisabledScope(!IsAnyBusy()))
                {
                    if (GUILayout.Button(new GUIContent("Cancel", "Ends the computation. What is shown stays.")))
                        Cancel();
                }
                using (new EditorGUI.DisabledScope(!_isSupported || targets.Length > 1))
                {
                    if (GUILayout.Button(new GUIContent("Bake to mesh...",
                        "Computes the finest surface and saves a copy of it that needs no component.")))
                    {
                        SurfaceBaker.BakeWithDialog((MolecularSurface)target);
                        GUIUtility.ExitGUI(); // the dialog ran its own events: this one is over
                    }
                    if (GUILayout.Button(new GUIContent("Bake to prefab...",
                        "Saves it with its material as a prefab, which needs no component.")))
                    {
                        PrefabBaker.BakeWithDialog((MolecularSurface)target);
                        GUIUtility.ExitGUI();
                    }
                }
            }
        }

        private void Compute()
        {
            foreach (Object each in targets)
            {
                var surface = (MolecularSurface)each;
                if (!IsLive(surface))
                    continue;
                if (surface.AtomCount == 0 && surface.Source.IsSet)
                    surface.BeginLoadSource();
                else
                    surface.Recompute();
            }
        }

        // What a player brings, it reads again itself.
        private static bool CanReload(MolecularSurface surface) =>
            IsLive(surface) && surface.Source.IsSet && !surface.IsPlayed;

        private void Reload()
        {
            foreach (Object each in targets)
            {
                var surface = (MolecularSurface)each;
                if (CanReload(surface))
                    surface.BeginLoadSource();
            }
        }

        private void Cancel()
        {
            foreach (Object each in targets)
            {
                var surface = (MolecularSurface)each;
                if (!IsLive(surface))
                    continue;
                surface.CancelLoading();
                surface.Cancel();
            }
        }

        private bool IsAnyLive()
        {
            foreach (Object each in targets)
            {
                if (IsLive((MolecularSurface)each))
                    return true;
            }
            return false;
        }

        private bool CanAnyReload()
        {
            foreach (Object each in targets)
            {
                if (CanReload((MolecularSurface)each))
                    return true;
            }
            return false;
        }

        private bool IsAnyBusy()
        {
            foreach (Object each in targets)
            {
                var surface = (MolecularSurface)each;
                if (IsLive(surface) && surface.IsBusy)
                    return true;
            }
            return false;
        }
    }
}
