// SPDX-License-Identifier: MIT
using System.Collections.Generic;
using UnityEditor;
using UnityEngine;
using UnityEngine.SceneManagement;

namespace QuickSes.Editor
{
    /// <summary>
    /// Molecule assets that are dropped into the Scene view or the Hierarchy become surfaces; a structure together with
    /// a trajectory becomes one with a player.
    /// </summary>
    internal static class MoleculeDrop
    {
#if UNITY_6000_3_OR_NEWER // objects have an EntityId; from 6000.5 on the other handlers don't compile
        [InitializeOnLoadMethod]
        private static void Register()
        {
            DragAndDrop.AddDropHandlerV2((DragAndDrop.SceneDropHandler)DropIntoScene);
            DragAndDrop.AddDropHandlerV2((DragAndDrop.HierarchyDropHandlerV2)DropIntoHierarchy);
        }

        private static DragAndDropVisualMode DropIntoHierarchy(EntityId target, HierarchyDropFlags dropMode,
            Transform parentForDraggedObjects, bool perform) =>
            DropIntoHierarchy(EditorUtility.EntityIdToObject(target), target.ToString(), dropMode,
                parentForDraggedObjects, perform);
#else
        [InitializeOnLoadMethod]
        private static void Register()
        {
            DragAndDrop.AddDropHandler((DragAndDrop.SceneDropHandler)DropIntoScene);
            DragAndDrop.AddDropHandler((DragAndDrop.HierarchyDropHandler)DropIntoHierarchy);
        }

        private static DragAndDropVisualMode DropIntoHierarchy(int target, HierarchyDropFlags dropMode,
            Transform parentForDraggedObjects, bool perform) =>
            DropIntoHierarchy(EditorUtility.InstanceIDToObject(target), target.ToString(), dropMode,
                parentForDraggedObjects, perform);
#endif

        private static DragAndDropVisualMode DropIntoScene(Object dropUpon, Vector3 worldPosition,
            Vector2 viewportPosition, Transform parentForDraggedObjects, bool perform)
        {
            DragAndDropVisualMode mode =
                Drop(ParentOf(parentForDraggedObjects), default, perform, out List<GameObject> made);
            foreach (GameObject each in made)
                each.transform.position = worldPosition;
            return mode;
        }

        private static DragAndDropVisualMode DropIntoHierarchy(Object target, string targetId,
            HierarchyDropFlags dropMode, Transform parentForDraggedObjects, bool perform)
        {
            FindPlace(target as GameObject, targetId, dropMode, parentForDraggedObjects, out GameObject parent,
                out Scene scene);
            return Drop(parent, scene, perform, out _);
        }

        /// <summary>Where in the Hierarchy what is dropped goes.</summary>
        /// <param name="target">What the mouse is upon, or one of the two it is between; null: it is a scene.</param>
        /// <param name="targetId">That of the object, or else the handle of the scene, as text.</param>
        /// <param name="parent">null: it gets none.</param>
        /// <param name="scene">Of what has no parent; not valid: that of the stage.</param>
        internal static void FindPlace(GameObject target, string targetId, HierarchyDropFlags dropMode,
            Transform parentForDraggedObjects, out GameObject parent, out Scene scene)
        {
            const HierarchyDropFlags beside = HierarchyDropFlags.DropBetween | HierarchyDropFlags.DropAbove;
            scene = target != null ? target.scene : FindScene(targetId);
            parent = parentForDraggedObjects != null ? parentForDraggedObjects.gameObject
                : target == null || (dropMode & beside) == 0 ? target
                : ParentOf(target.transform.parent);
        }

        // Handles became identifiers, which convert to numbers otherwise in each version of the Editor: their texts are
        // the same.
        private static Scene FindScene(string handle)
        {
            for (int k = 0; k < SceneManager.sceneCount; ++k)
            {
                Scene each = SceneManager.GetSceneAt(k);
                if (each.handle.ToString() == handle)
                    return each;
            }
            return default;
        }

        private static GameObject ParentOf(Transform parent) => parent != null ? parent.gameObject : null;

        // None: other handlers are asked.
        private static DragAndDropVisualMode Drop(GameObject parent, Scene scene, bool perform,
            out List<GameObject> made)
        {
            made = new List<GameObject>();
            var structures = new List<MoleculeAsset>();
            var trajectories = new List<MoleculeAsset>();
            foreach (Object dragged in DragAndDrop.objectReferences)
            {
                if (!(dragged is MoleculeAsset molecule))
                    return DragAndDropVisualMode.None;
                (MoleculeFiles.IsTrajectory(molecule.FileName) ? trajectories : structures).Add(molecule);
            }
            bool isPlayed = structures.Count == 1 && trajectories.Count == 1;
            if (structures.Count == 0 || (trajectories.Count > 0 && !isPlayed))
                return structures.Count + trajectories.Count == 0
                    ? DragAndDropVisualMode.None
                    : DragAndDropVisualMode.Rejected;
            if (!perform)
                return DragAndDropVisualMode.Copy;
            foreach (MoleculeAsset each in structures)
            {
                var source = new MoleculeSource();
                source.SetAsset(each);
                if (!isPlayed)
                {
                    made.Add(SurfaceCreator.Create(source, parent, scene).gameObject);
                    continue;
                }
                var trajectory = new TrajectorySource();
                trajectory.SetAsset(trajectories[0]);
                made.Add(SurfaceCreator.Create(source, trajectory, parent, scene).gameObject);
            }
            DragAndDrop.AcceptDrag();
            return DragAndDropVisualMode.Copy;
        }
    }
}
