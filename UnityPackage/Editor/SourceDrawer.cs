// SPDX-License-Identifier: MIT
using UnityEditor;
using UnityEngine;

namespace QuickSes.Editor
{
    /// <summary>
    /// Shows the fields of a source that count, and a button that finds a file. Components read a source anew when it
    /// changed (OnValidate), so nothing needs to be told here.
    /// </summary>
    internal abstract class SourceDrawer : PropertyDrawer
    {
        private const float BrowseWidth = 72;
        private const float HintLines = 3;

        private static float Line => EditorGUIUtility.singleLineHeight;

        private static float Step => Line + EditorGUIUtility.standardVerticalSpacing;

        public override float GetPropertyHeight(SerializedProperty property, GUIContent label)
        {
            SourceFields fields = FieldsOf(property, out string hint);
            float height = Line;
            foreach ((string _, SourceFields field) in SourceForm.Rows)
            {
                if ((fields & field) != 0)
                    height += Step;
            }
            return hint == null ? height : height + HintLines * Line + EditorGUIUtility.standardVerticalSpacing;
        }

        public override void OnGUI(Rect position, SerializedProperty property, GUIContent label)
        {
            TakeDropped(position, property);
            SourceFields fields = FieldsOf(property, out string hint);
            label = EditorGUI.BeginProperty(position, label, property);
            var row = new Rect(position.x, position.y, position.width, Line);
            DrawKind(row, property, label);
            using (new EditorGUI.IndentLevelScope())
            {
                foreach ((string name, SourceFields field) in SourceForm.Rows)
                {
                    if ((fields & field) == 0)
                        continue;
                    row.y += Step;
                    DrawField(row, property.FindPropertyRelative(name));
                }
                if (hint != null)
                {
                    row.y += Step;
                    row.height = HintLines * Line;
                    EditorGUI.HelpBox(EditorGUI.IndentedRect(row), hint, MessageType.Info);
                }
            }
            EditorGUI.EndProperty();
        }

        /// <summary>Which fields count for a source of this kind.</summary>
        protected abstract SourceFields FieldsOf(SerializedProperty property, MoleculeSourceKind kind);

        /// <summary>Asks for a file; false: the user cancelled.</summary>
        protected abstract bool Browse(out ChosenFile chosen);

        private SourceFields FieldsOf(SerializedProperty property, out string hint)
        {
            hint = null;
            SerializedProperty kind = property.FindPropertyRelative("_kind");
            if (kind.hasMultipleDifferentValues)
                return SourceFields.None;
            var value = (MoleculeSourceKind)kind.intValue;
            hint = SourceForm.HintOf(value);
            return FieldsOf(property, value);
        }

        // An asset that is dropped anywhere on a source is its file from then on, whatever kind it had.
        private static void TakeDropped(Rect position, SerializedProperty property)
        {
            Event current = Event.current;
            bool isDropped = current.type == EventType.DragPerform;
            if ((!isDropped && current.type != EventType.DragUpdated) || !GUI.enabled ||
                !position.Contains(current.mousePosition) || DragAndDrop.objectReferences.Length != 1 ||
                !ChosenFile.TryTake(DragAndDrop.objectReferences[0], out ChosenFile chosen))
                return;
            DragAndDrop.visualMode = DragAndDropVisualMode.Link;
            if (isDropped)
            {
                DragAndDrop.AcceptDrag();
                chosen.AssignTo(property);
                property.serializedObject.ApplyModifiedProperties();
                GUI.changed = true;
            }
            current.Use();
        }

        private void DrawKind(Rect row, SerializedProperty property, GUIContent label)
        {
            SerializedProperty kind = property.FindPropertyRelative("_kind");
            var popup = new Rect(row.x, row.y, row.width - BrowseWidth - 4, row.height);
            string tooltip = string.IsNullOrEmpty(label.tooltip) ? kind.tooltip : label.tooltip;
            EditorGUI.PropertyField(popup, kind, new GUIContent(label.text, tooltip));
            var button = new Rect(row.xMax - BrowseWidth, row.y, BrowseWidth, row.height);
            if (!GUI.Button(button, "Browse..."))
                return;
            if (Browse(out ChosenFile chosen))
            {
                chosen.AssignTo(property);
                property.serializedObject.ApplyModifiedProperties();
            }
            GUIUtility.ExitGUI(); // the dialog ran its own events: this one is over
        }

        // A text counts when it is complete, or a file would be looked for at each letter.
        private static void DrawField(Rect row, SerializedProperty field)
        {
            if (field.propertyType == SerializedPropertyType.String)
                EditorGUI.DelayedTextField(row, field, new GUIContent(field.displayName, field.tooltip));
            else
                EditorGUI.PropertyField(row, field);
        }
    }

    /// <summary>Of a structure: with filters, radii and colours.</summary>
    [CustomPropertyDrawer(typeof(MoleculeSource))]
    internal sealed class MoleculeSourceDrawer : SourceDrawer
    {
        protected override bool Browse(out ChosenFile chosen) => ChosenFile.AskForStructure(out chosen);

        protected override SourceFields FieldsOf(SerializedProperty property, MoleculeSourceKind kind)
        {
            SerializedProperty format = property.FindPropertyRelative("_format");
            // Of several objects all fields are shown that may count for one of them.
            return format.hasMultipleDifferentValues
                ? SourceForm.OfStructure(kind, StructureFormat.Pdb, null)
                : SourceForm.OfStructure(kind, (StructureFormat)format.intValue, NameOf(kind, property));
        }

        private static string NameOf(MoleculeSourceKind kind, SerializedProperty property)
        {
            if (kind == MoleculeSourceKind.MoleculeAsset)
            {
                SerializedProperty molecule = property.FindPropertyRelative("_molecule");
                return !molecule.hasMultipleDifferentValues && molecule.objectReferenceValue is MoleculeAsset chosen
                    ? chosen.FileName
                    : null;
            }
            if (kind != MoleculeSourceKind.TextAsset)
            {
                SerializedProperty path = property.FindPropertyRelative("_path");
                return path.hasMultipleDifferentValues ? null : path.stringValue;
            }
            SerializedProperty asset = property.FindPropertyRelative("_asset");
            Object value = asset.hasMultipleDifferentValues ? null : asset.objectReferenceValue;
            return value != null ? value.name : null;
        }
    }

    /// <summary>Of a trajectory.</summary>
    [CustomPropertyDrawer(typeof(TrajectorySource))]
    internal sealed class TrajectorySourceDrawer : SourceDrawer
    {
        protected override bool Browse(out ChosenFile chosen) => ChosenFile.AskForTrajectory(out chosen);

        protected override SourceFields FieldsOf(SerializedProperty property, MoleculeSourceKind kind) =>
            SourceForm.OfTrajectory(kind);
    }
}
