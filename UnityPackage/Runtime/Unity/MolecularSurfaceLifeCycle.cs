// SPDX-License-Identifier: MIT
// What the engine calls.
using UnityEngine;

namespace QuickSes
{
    public sealed partial class MolecularSurface
    {
        private const string DefaultMaterial = "QuickSes/MolecularSurface"; // below a folder called Resources

        private void OnEnable()
        {
            SurfaceScheduler.Add(Session);
            _asksForAtoms = true;
            GetComponent<MeshFilter>().sharedMesh = Session.Shown.Mesh;
            var meshRenderer = GetComponent<MeshRenderer>();
            if (meshRenderer.sharedMaterial == null)
                meshRenderer.sharedMaterial = Resources.Load<Material>(DefaultMaterial);
            Session.Atoms.SetBaseColor(_baseColor);
            Session.Resume();
            QueueEditorUpdate();
        }

        // The picture stays, as that of other components that are switched off.
        private void OnDisable()
        {
            if (_session != null && !_session.IsDisposed)
                _session.Drop();
        }

        private void OnDestroy()
        {
            _isDestroyed = true;
            _session?.Dispose();
            _session = null;
        }

        // After all Update calls, so that positions set in this frame are on their way in this frame.
        private void LateUpdate()
        {
            if (_asksForAtoms)
            {
                _asksForAtoms = false;
                LoadSourceUnlessFed();
                if (!Session.Atoms.IsSet)
                    _atomsRequested?.Invoke();
            }
            if (_isEdited)
            {
                _isEdited = false;
                FollowEdits();
            }
            SurfaceSession session = Session;
            session.Tick(Time.realtimeSinceStartupAsDouble);
            if (!session.IsSettled)
                QueueEditorUpdate();
            session.RaiseEvents();
        }

        private void OnValidate()
        {
            if (_session == null || _session.IsDisposed)
                return;
            _session.Atoms.SetBaseColor(_baseColor);
            _isEdited = true; // the rest later: files are not read and meshes not set while values are validated
            Changed(SurfaceChange.Shape);
        }

        // The inspector, Undo and changed prefabs write serialised fields, also that of the filter beside this
        // component, whose mesh is in no file.
        private void FollowEdits()
        {
            GetComponent<MeshFilter>().sharedMesh = Session.Shown.Mesh;
            if (_isScriptFed || IsSourceAsLoaded())
                return;
            if (_source.IsSet)
            {
                LoadSource();
                return;
            }
            ClearAtoms();
            _isScriptFed = false;
            _loadedSource = null;
        }

        private bool IsSourceAsLoaded() => _loadedSource == null
            ? !_source.IsSet
            : _source.IsSameAs(_loadedSource) && _source.ColorScheme == _loadedSource.ColorScheme &&
              _baseColor.Equals(_loadedBaseColor);

#if UNITY_EDITOR
        private const string DemoMolecule = "887aaba082b543e99d77084bbddee6c8"; // GUID of Defaults/1crn.pdb.bytes

        // A component that is added shows something at once.
        private void Reset()
        {
            string path = UnityEditor.AssetDatabase.GUIDToAssetPath(DemoMolecule);
            _source.SetAsset(UnityEditor.AssetDatabase.LoadAssetAtPath<TextAsset>(path));
        }
#endif
    }
}
