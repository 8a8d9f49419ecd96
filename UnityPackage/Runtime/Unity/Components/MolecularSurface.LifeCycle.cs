// SPDX-License-Identifier: MIT
// What the engine calls.
using UnityEngine;
#if UNITY_EDITOR
using UnityEditor;
using UnityEngine.Rendering;
#endif

namespace QuickSes
{
    public sealed partial class MolecularSurface
    {
        private const string DefaultMaterial = "QuickSes/MolecularSurface"; // below a folder called Resources

        // The filter of a copy has the mesh of the original, also where the copy is not enabled.
        private void Awake()
        {
            Mesh mesh = GetComponent<MeshFilter>().sharedMesh;
            if (SurfaceMesh.IsMade(mesh))
                AttachMesh();
        }

        private void OnEnable()
        {
            _asksForAtoms = true;
            LeaveEditMode();
            AttachMeshUnlessBaked();
            var meshRenderer = GetComponent<MeshRenderer>();
            if (meshRenderer.sharedMaterial == null)
                meshRenderer.sharedMaterial = Resources.Load<Material>(DefaultMaterial);
            NoteSettings();
            Shown.ForgiveGpu();
            Session.Resume();
            QueueEditorUpdate();
        }

        // Where play mode begins without a reload of domain and scene, the component is as it was in edit mode: what came
        // there would be told to nobody here.
        private void LeaveEditMode()
        {
            if (!HasSession || _isSessionOfPlayMode == IsInPlayMode)
                return;
            LoseStructure();
            _session.Dispose();
            _session = null;
            _isScriptFed = false;
            _loadedSource = null;
            _loggedFailure = default;
        }

        private bool IsInPlayMode => this != null && Application.IsPlaying(this); // false in an open prefab

        // The picture stays, as that of other components that are switched off, also where it is somebody else's.
        private void OnDisable()
        {
            CloseStructure();
            SuspendLoading();
            if (!HasSession)
                return;
            _session.Drop();
            FollowFilter();
        }

        private void OnDestroy()
        {
            _isDestroyed = true;
            GiveMeshBack();
            LoseStructure();
            CancelLoading();
            _session?.Dispose();
            _session = null;
        }

        // After all Update calls, so that positions set in this frame are on their way in this frame. Each step may call
        // handlers, which may do anything.
        private void LateUpdate()
        {
            FollowEditsNow();
            if (IsAlive && _asksForAtoms)
            {
                _asksForAtoms = false;
                BeginLoadSourceUnlessFed();
                if (IsAlive && !Session.Atoms.IsSet && !_source.IsSet)
                    RequestAtoms();
            }
            if (IsAlive)
                TickLoading();
            if (!IsAlive)
                return;
            SurfaceSession session = Session;
            FollowFilter();
            session.Tick(Time.realtimeSinceStartupAsDouble);
            if (session.IsWaiting)
                QueueEditorUpdate();
            session.RaiseEvents();
        }

        private void RequestAtoms()
        {
            _atomsRequested.Tell(this);
            if (IsAlive && !Session.Atoms.IsSet)
                WiredListeners.Tell(_events.AtomsRequested, this);
        }

        private void AttachMesh()
        {
            var filter = GetComponent<MeshFilter>();
            Mesh present = filter.sharedMesh;
            if (present != null && !SurfaceMesh.IsMade(present))
                _replacedMesh = present;
            filter.sharedMesh = Shown.Mesh;
            _isMeshAttached = true;
        }

        // The component was removed, or Undo took it back: the own mesh goes with it.
        private void GiveMeshBack()
        {
            if (_session != null && _replacedMesh != null && ShowsOwnMesh)
                GetComponent<MeshFilter>().sharedMesh = _replacedMesh;
        }

        // A mesh of somebody else's, such as a baked one, stays until there is a surface to show in its place: where
        // there is no library there never is.
        private void AttachMeshUnlessBaked()
        {
            Mesh mesh = GetComponent<MeshFilter>().sharedMesh;
            _isMeshAttached = false;
            if (mesh == null || SurfaceMesh.IsMade(mesh) || Session.CurrentLevel.LevelCount > 0)
                AttachMesh();
        }

        private bool IsAlive => !_isDestroyed && isActiveAndEnabled;

        private void OnValidate()
        {
            FollowSettings();
            if (HasSession)
                _isEdited = true; // the rest later: files are not read and meshes not set while values are validated
        }

        // The engine calls it after an animation, or its preview in the Editor, wrote serialised fields.
        private void OnDidApplyAnimationProperties() => FollowSettings();

        private void FollowSettings()
        {
            LimitSettings();
            if (!HasSession)
                return;
            _session.Atoms.SetBaseColor(Number(_baseColor));
            if (NoteSettings())
                Changed(SurfaceChange.Shape);
            QueueEditorUpdate();
        }

        /// <summary>The source may be another one: it was left to a player, or its asset was imported anew.</summary>
        internal void FollowSourceSoon()
        {
            _isEdited = true;
            QueueEditorUpdate();
        }

        /// <summary>What was edited since the last frame counts from now on.</summary>
        internal void FollowEditsNow()
        {
            if (!_isEdited)
                return;
            _isEdited = false;
            FollowEdits();
        }

        // The inspector, Undo and changed prefabs write serialised fields, also that of the filter beside this
        // component, whose mesh is in no file.
        private void FollowEdits()
        {
            AttachMeshUnlessBaked();
            if (VisibleSelection != (_followedVisible ?? ""))
                FollowVisible();
            if (_isScriptFed && !IsPlayed)
                return;
            var player = GetComponent<TrajectoryPlayer>();
            if ((player != null && player.FollowSurfaceSource()) || IsPlayed)
                return;
            if (_source.IsSet)
            {
                FollowSource();
            }
            else if (_loadedSource != null)
            {
                CancelLoading();
                Clear();
                _loadedSource = null;
                _asksForAtoms = true;
            }
        }

#if UNITY_EDITOR
        private const string DemoMolecule = "887aaba082b543e99d77084bbddee6c8"; // GUID of Defaults/1crn.pdb.bytes

        // A component that is added shows something at once, unless it was added for a script that feeds it, which is
        // there a moment later only.
        private void Reset()
        {
            var meshRenderer = GetComponent<MeshRenderer>();
            if (IsDefault(meshRenderer.sharedMaterial))
            {
                Undo.RecordObject(meshRenderer, "Add Component"); // a step with what calls it
                meshRenderer.sharedMaterial = Resources.Load<Material>(DefaultMaterial);
                PrefabUtility.RecordPrefabInstancePropertyModifications(meshRenderer);
            }
            EditorApplication.delayCall += ShowDemoUnlessFed;
        }

        /// <summary>Of a surface that was just added, and is to stay without atoms.</summary>
        internal void ForgoDemo() => EditorApplication.delayCall -= ShowDemoUnlessFed;

        private void ShowDemoUnlessFed()
        {
            if (this == null || _isScriptFed || _source.IsSet || _atomsRequested.IsAny || IsPlayed ||
                GetComponent<TrajectoryPlayer>() != null)
                return;
            _source.SetAsset(AssetDatabase.LoadAssetAtPath<TextAsset>(AssetDatabase.GUIDToAssetPath(DemoMolecule)));
            EditorUtility.SetDirty(this);
            PrefabUtility.RecordPrefabInstancePropertyModifications(this);
            FollowSourceSoon();
        }

        // What the Editor gives new renderers, which shows no colours of vertices.
        private static bool IsDefault(Material material)
        {
            RenderPipelineAsset pipeline = GraphicsSettings.currentRenderPipeline;
            return material == null || (pipeline != null && material == pipeline.defaultMaterial) ||
                AssetDatabase.GetAssetPath(material) == "Resources/unity_builtin_extra";
        }
#endif
    }
}
