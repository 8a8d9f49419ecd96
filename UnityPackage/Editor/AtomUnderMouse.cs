// SPDX-License-Identifier: MIT
using UnityEditor;
using UnityEngine;

namespace QuickSes.Editor
{
    /// <summary>Names the atom under the mouse in the Scene view, if the user wants that.</summary>
    internal sealed class AtomUnderMouse
    {
        private bool _isWanted;
        private string _name; // null: there is none
        private Vector3 _point;

        public void DrawToggle(MolecularSurface surface)
        {
            bool wasWanted = _isWanted;
            _isWanted = EditorGUILayout.Toggle(new GUIContent("Name atoms", "Names the atom under the mouse in the " +
                "Scene view. Reads the source once more, and keeps it open meanwhile."), _isWanted);
            if (!wasWanted || _isWanted)
                return;
            _name = null;
            surface.CloseStructure();
            SceneView.RepaintAll();
        }

        /// <summary>The inspector goes, and with it what it keeps open.</summary>
        public void Leave(MolecularSurface surface)
        {
            if (_isWanted && surface != null)
                surface.CloseStructure();
        }

        public void OnSceneGUI(MolecularSurface surface)
        {
            if (!_isWanted)
                return;
            switch (Event.current.type)
            {
                case EventType.MouseMove:
                    Find(surface, HandleUtility.GUIPointToWorldRay(Event.current.mousePosition));
                    HandleUtility.Repaint();
                    break;
                case EventType.Repaint when _name != null:
                    Handles.Label(_point, _name, EditorStyles.helpBox);
                    break;
            }
        }

        private void Find(MolecularSurface surface, Ray ray)
        {
            _name = null;
            if (!surface.TryPick(ray, out int atom, out _point))
                return;
            Structure structure = surface.Structure;
            // The surface shown may be of atoms that there were before.
            bool isNamed = structure != null && atom < structure.AtomCount;
            _name = isNamed ? structure.GetAtom(atom).ToString() : $"atom {atom}";
        }
    }
}
