// SPDX-License-Identifier: MIT
using UnityEditor;
using UnityEditor.AssetImporters;
using UnityEngine;

namespace QuickSes.Editor
{
    /// <summary>Tells what is in a molecule asset, and makes a surface of it.</summary>
    [CustomEditor(typeof(MoleculeImporter))]
    internal sealed class MoleculeImporterEditor : ScriptedImporterEditor
    {
        private PreviewLoad _reading;
        private MoleculeAsset _previewed; // what _reading is of

        public override bool showImportedObject => false; // it has nothing else to show

        protected override bool needsApplyRevert => false; // there are no settings

        public override void OnDisable()
        {
            _reading?.Dispose();
            _reading = null;
            _previewed = null;
            base.OnDisable();
        }

        public override bool RequiresConstantRepaint() => _reading != null && _reading.Preview == null;

        public override void OnInspectorGUI()
        {
            var asset = assetTarget as MoleculeAsset;
            if (asset == null)
            {
                EditorGUILayout.HelpBox("Not imported.", MessageType.Info);
                return;
            }
            EditorGUILayout.LabelField("File", asset.FileName);
            EditorGUILayout.LabelField("Size", SurfaceStatus.Bytes((ulong)asset.Size));
            if (MoleculeFiles.IsTrajectory(asset.FileName))
            {
                EditorGUILayout.HelpBox("Frames, for the Trajectory Source of a Trajectory Player. Drag it into the " +
                    "scene together with its structure to get both.", MessageType.Info);
                return;
            }
            DrawStructure(asset);
        }

        private void DrawStructure(MoleculeAsset asset)
        {
            if (_previewed != asset)
            {
                _reading?.Dispose();
                _reading = new PreviewLoad(SourceOf(asset, false));
                _previewed = asset;
            }
            if (Event.current.type == EventType.Layout) // all events of a frame must see the same controls
                _reading.Tick();
            if (_reading.Preview == null)
            {
                EditorGUI.ProgressBar(EditorGUILayout.GetControlRect(), _reading.Progress, SurfaceStatus.Reading);
                return;
            }
            StructurePreview preview = _reading.Preview;
            if (preview.Error.Length > 0)
            {
                EditorGUILayout.HelpBox(preview.Error, MessageType.Error);
                return;
            }
            EditorGUILayout.LabelField("Atoms", preview.Summary);
            foreach (string warning in preview.Warnings)
                EditorGUILayout.HelpBox(warning, MessageType.Warning);
            if (GUILayout.Button(new GUIContent("Create surface", "In the open scene, with the filters' defaults.")))
                SurfaceCreator.Create(SourceOf(asset, true), null);
        }

        private static MoleculeSource SourceOf(MoleculeAsset asset, bool skipWater)
        {
            var source = new MoleculeSource { SkipWater = skipWater };
            source.SetAsset(asset);
            return source;
        }
    }
}
