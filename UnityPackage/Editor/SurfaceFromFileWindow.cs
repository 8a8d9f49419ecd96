// SPDX-License-Identifier: MIT
using System;
using UnityEditor;
using UnityEngine;

namespace QuickSes.Editor
{
    /// <summary>Asks which atoms of which file, shows how many that are, and makes a surface of them.</summary>
    internal sealed class SurfaceFromFileWindow : EditorWindow
    {
        // Serialised, so that a reload of scripts leaves the window as it was.
        [SerializeField] private MoleculeSource _source = new MoleculeSource();
        [SerializeField] private TrajectorySource _trajectory = new TrajectorySource();
        [SerializeField] private bool _playModels;
        [SerializeField] private GameObject _parent;
        [SerializeField] private Vector2 _scroll;

        [NonSerialized] private SerializedObject _serialized;
        [NonSerialized] private StructurePreview _preview;
        [NonSerialized] private MoleculeSource _previewed; // what _preview is of

        public static void Open(GameObject parent)
        {
            var window = GetWindow<SurfaceFromFileWindow>(true, "Surface from file");
            window.minSize = new Vector2(420, 380);
            window._parent = parent;
            window.Show();
        }

        private void OnEnable() => _serialized = new SerializedObject(this);

        private void OnDisable()
        {
            _serialized?.Dispose();
            _serialized = null;
        }

        private void OnGUI()
        {
            _serialized.Update();
            _scroll = EditorGUILayout.BeginScrollView(_scroll);
            EditorGUILayout.PropertyField(_serialized.FindProperty(nameof(_source)), new GUIContent("Structure"));
            EditorGUILayout.Space();
            EditorGUILayout.PropertyField(_serialized.FindProperty(nameof(_trajectory)),
                new GUIContent("Trajectory", "Optional: frames of the same atoms, for a Trajectory Player."));
            _serialized.ApplyModifiedPropertiesWithoutUndo();
            EditorGUILayout.Space();
            UpdatePreview();
            DrawPreview();
            EditorGUILayout.EndScrollView();
            DrawButtons();
        }

        private void UpdatePreview()
        {
            if (_previewed != null && _previewed.IsSameAs(_source))
                return;
            _previewed = _source.Copy();
            _preview = _source.IsSet ? StructurePreview.Read(_source) : null;
            if (_preview == null || !_preview.HasPlayableModels)
                _playModels = false;
        }

        private void DrawPreview()
        {
            if (_preview == null)
            {
                EditorGUILayout.HelpBox(
                    "Choose a file: PDB, mmCIF, PQR, XYZR or GRO, each also gzipped. It is referred to as an asset " +
                    "if it lies in Assets, relative to StreamingAssets if it lies there, else by its absolute path.",
                    MessageType.Info);
                return;
            }
            if (_preview.Error.Length > 0)
            {
                EditorGUILayout.HelpBox(_preview.Error, MessageType.Error);
                return;
            }
            EditorGUILayout.LabelField("Atoms", _preview.Summary);
            foreach (string warning in _preview.Warnings)
                EditorGUILayout.HelpBox(warning, MessageType.Warning);
            if (_preview.HasPlayableModels && _trajectory.Kind == MoleculeSourceKind.None)
                _playModels = EditorGUILayout.Toggle(
                    new GUIContent("Play the models", "Adds a Trajectory Player that shows one model after the other."),
                    _playModels);
        }

        private void DrawButtons()
        {
            using (new EditorGUILayout.HorizontalScope())
            {
                var label = new GUIContent("Parent", "Where in the scene; none: at its root.");
                _parent = (GameObject)EditorGUILayout.ObjectField(label, _parent, typeof(GameObject), true);
                if (_parent != null && EditorUtility.IsPersistent(_parent))
                    _parent = null; // an asset can't be one
                bool canCreate = _preview != null && _preview.Error.Length == 0 &&
                    (_trajectory.Kind == MoleculeSourceKind.None || _trajectory.IsSet);
                using (new EditorGUI.DisabledScope(!canCreate))
                {
                    if (GUILayout.Button("Create", GUILayout.Width(90)))
                    {
                        Create();
                        Close();
                        GUIUtility.ExitGUI();
                    }
                }
            }
        }

        private void Create()
        {
            if (_trajectory.IsSet || _playModels)
                SurfaceCreator.Create(_source, _trajectory, _parent);
            else
                SurfaceCreator.Create(_source, _parent);
        }
    }
}
