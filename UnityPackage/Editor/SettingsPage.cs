// SPDX-License-Identifier: MIT
using UnityEditor;
using UnityEngine;

namespace QuickSes.Editor
{
    /// <summary>Edit > Project Settings > QuickSES: makes and edits the asset of <see cref="QuickSesSettings"/>.</summary>
    internal static class SettingsPage
    {
        public const string Path = "Project/QuickSES";
        private const string Folder = "Assets/Resources";
        private const string AssetPath = Folder + "/" + QuickSesSettings.AssetName + ".asset";

        [SettingsProvider]
        private static SettingsProvider Create() => new SettingsProvider(Path, SettingsScope.Project,
            new[] { "molecular", "surface", "contexts", "threads", "memory", "CUDA", "GPU" })
        {
            label = "QuickSES",
            guiHandler = _ => Draw()
        };

        /// <summary>The fields of the settings, which see to it that what is edited holds.</summary>
        public static void Draw(SerializedObject settings)
        {
            settings.Update();
            SerializedProperty property = settings.GetIterator();
            for (bool isFirst = true; property.NextVisible(isFirst); isFirst = false)
            {
                if (property.propertyPath == "m_Script")
                    continue;
                string unit = UnitOf(property.propertyPath);
                string label = unit == null ? property.displayName : $"{property.displayName} ({unit})";
                EditorGUILayout.PropertyField(property, new GUIContent(label, property.tooltip));
            }
            settings.ApplyModifiedProperties();
        }

        private static void Draw()
        {
            QuickSesSettings settings = QuickSesSettings.Find();
            if (settings != null)
            {
                Draw(new SerializedObject(settings));
                EditorGUILayout.Space();
                using (new EditorGUI.DisabledScope(true))
                    EditorGUILayout.ObjectField("Asset", settings, typeof(QuickSesSettings), false);
                return;
            }
            EditorGUILayout.HelpBox($"The defaults hold. Other settings are kept in {AssetPath}, which builds take along.",
                MessageType.Info);
            if (GUILayout.Button("Create settings"))
                CreateAsset();
        }

        private static void CreateAsset()
        {
            if (!AssetDatabase.IsValidFolder(Folder))
                AssetDatabase.CreateFolder("Assets", "Resources");
            AssetDatabase.CreateAsset(ScriptableObject.CreateInstance<QuickSesSettings>(), AssetPath);
            AssetDatabase.SaveAssets();
        }

        private static string UnitOf(string property) =>
            property == "_memoryBudget" ? "MB" : property == "_uploadBudget" ? "ms" : null;
    }

    /// <summary>The same in the inspector of the asset.</summary>
    [CustomEditor(typeof(QuickSesSettings))]
    internal sealed class QuickSesSettingsEditor : UnityEditor.Editor
    {
        public override void OnInspectorGUI() => SettingsPage.Draw(serializedObject);
    }
}
