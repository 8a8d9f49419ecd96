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
        [NonSerialized] private PreviewLoad _reading; // null: nothing is chosen
        [NonSerialized] private MoleculeSource _previewed; // what _reading is of

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
            _reading?.Dispose();
            _reading = null;
            _previewed = null;
        }

        // Several times per second, while it is open.
        private void Update()
        {
            if (_reading == null || _reading.Preview != null)
                return;
            if (_reading.Tick() && !_reading.Preview.HasPlayableModels)
                _playModels = false;
            Repaint();
        }

        private StructurePreview Preview => _reading?.Preview;

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
            _reading?.Dispose();
            _reading = _source.IsSet ? new PreviewLoad(_source) : null;
            if (_reading == null)
                _playModels = false;
        }

        private void DrawPreview()
        {
            if (_reading == null)
            {
                EditorGUILayout.HelpBox(
                    "Choose a file: PDB, mmCIF, PQR, XYZR or GRO, each also gzipped. It is referred to as an asset " +
                    "if it lies in Assets, relative to StreamingAssets if it lies there, else by its absolute path.",
                    MessageType.Info);
                return;
            }
            if (Preview == null)
            {
                EditorGUI.ProgressBar(EditorGUILayout.GetControlRect(), _reading.Progress, SurfaceStatus.Reading);
                return;
            }
            if (Preview.Error.Length > 0)
            {
                EditorGUILayout.HelpBox(Preview.Error, MessageType.Error);
                return;
            }
            EditorGUILayout.LabelField("Atoms", Preview.Summary);
            foreach (string warning in Preview.Warnings)
                EditorGUILayout.HelpBox(warning, MessageType.Warning);
            if (Preview.HasPlayableModels && _trajectory.Kind == MoleculeSourceKind.None)
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
                bool canCreate = Preview != null && Preview.Error.Length == 0 &&
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
