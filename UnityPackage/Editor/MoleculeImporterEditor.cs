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
        private const long MostReadUnasked = 16 << 20; // bytes: some 0.5 s

        private StructurePreview _preview;
        private MoleculeAsset _previewed;

        public override bool showImportedObject => false; // it has nothing else to show

        protected override bool needsApplyRevert => false; // there are no settings

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
            if (_previewed != asset && (asset.Size <= MostReadUnasked || GUILayout.Button("Read")))
            {
                _previewed = asset;
                _preview = StructurePreview.Read(SourceOf(asset, false));
            }
            if (_previewed != asset)
                return;
            if (_preview.Error.Length > 0)
            {
                EditorGUILayout.HelpBox(_preview.Error, MessageType.Error);
                return;
            }
            EditorGUILayout.LabelField("Atoms", _preview.Summary);
            foreach (string warning in _preview.Warnings)
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
