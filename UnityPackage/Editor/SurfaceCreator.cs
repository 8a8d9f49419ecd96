// SPDX-License-Identifier: MIT
using System;
using UnityEditor;
using UnityEditor.SceneManagement;
using UnityEngine;
using UnityEngine.SceneManagement;

namespace QuickSes.Editor
{
    /// <summary>
    /// Makes GameObjects with surfaces in the open scene or prefab stage, each as one step of Undo, and selects them.
    /// </summary>
    public static class SurfaceCreator
    {
        /// <summary>A surface without atoms, for scripts to feed.</summary>
        /// <param name="parent">May be null.</param>
        public static MolecularSurface CreateEmpty(GameObject parent)
        {
            MolecularSurface surface = Make(MoleculeNames.ObjectNameOf(null), parent, default);
            Finish(surface.gameObject);
            return surface;
        }

        /// <summary>A surface that reads its atoms itself. The file need not be there.</summary>
        /// <param name="source">Is copied.</param>
        /// <param name="parent">May be null.</param>
        public static MolecularSurface Create(MoleculeSource source, GameObject parent) =>
            Create(source, parent, default);

        /// <summary>The same in a scene, if there is no parent; one that is not valid: that of the stage.</summary>
        internal static MolecularSurface Create(MoleculeSource source, GameObject parent, Scene scene)
        {
            if (source == null)
                throw new ArgumentNullException(nameof(source));
            MolecularSurface surface = Make(NameOf(source), parent, scene);
            surface.Source.CopyFrom(source);
            Finish(surface.gameObject);
            return surface;
        }

        /// <summary>A surface whose atoms and frames a <see cref="TrajectoryPlayer"/> reads.</summary>
        /// <param name="structure">Is copied.</param>
        /// <param name="trajectory">Is copied. Of kind None: the models of the structure's own PDB file.</param>
        /// <param name="parent">May be null.</param>
        public static TrajectoryPlayer Create(MoleculeSource structure, TrajectorySource trajectory, GameObject parent) =>
            Create(structure, trajectory, parent, default);

        /// <summary>The same in a scene, if there is no parent; one that is not valid: that of the stage.</summary>
        internal static TrajectoryPlayer Create(MoleculeSource structure, TrajectorySource trajectory, GameObject parent,
            Scene scene)
        {
            if (structure == null)
                throw new ArgumentNullException(nameof(structure));
            if (trajectory == null)
                throw new ArgumentNullException(nameof(trajectory));
            GameObject made = Make(NameOf(structure), parent, scene).gameObject;
            made.SetActive(false); // so that the player is enabled when it has its sources
            var player = made.AddComponent<TrajectoryPlayer>();
            player.StructureSource.CopyFrom(structure);
            player.TrajectorySource.CopyFrom(trajectory);
            made.SetActive(true);
            Finish(made);
            return player;
        }

        private static MolecularSurface Make(string name, GameObject parent, Scene scene)
        {
            var made = new GameObject(name);
            GameObjectUtility.SetParentAndAlign(made, parent);
            if (parent == null && scene.IsValid() && !EditorSceneManager.IsPreviewScene(scene))
                SceneManager.MoveGameObjectToScene(made, scene);
            else if (parent == null)
                StageUtility.PlaceGameObjectInCurrentStage(made); // below the root of an open prefab
            GameObjectUtility.EnsureUniqueNameForSibling(made);
            var surface = made.AddComponent<MolecularSurface>();
            surface.ForgoDemo();
            return surface;
        }

        private static void Finish(GameObject made)
        {
            Undo.RegisterCreatedObjectUndo(made, "Create " + made.name);
            Selection.activeGameObject = made;
        }

        private static string NameOf(MoleculeSource source) => MoleculeNames.ObjectNameOf(
            source.Kind == MoleculeSourceKind.TextAsset && source.Asset != null ? source.Asset.name
            : source.Kind == MoleculeSourceKind.MoleculeAsset && source.Molecule != null ? source.Molecule.FileName
            : source.Path);
    }
}
