// SPDX-License-Identifier: MIT
using System;
using UnityEngine;

namespace QuickSes
{
    /// <summary>
    /// Shows the surface of a molecule as an ordinary mesh: coarse at once, then finer, computed in the background on
    /// the GPU or the CPU. Feed it atoms with <see cref="SetAtoms(Vector3[], float[])"/> and, as they move,
    /// <see cref="SetPositions(Vector3[])"/>; or let it read a file (<see cref="Source"/>).
    /// <para>One unit of the transform's space is 1 Å: scale the transform for another size. Numbers are Unity's,
    /// left-handed: who brings coordinates of a file negates x first, or shows the mirror image of a molecule
    /// (<see cref="UnitySpace"/>).</para>
    /// <para>Main thread only. Surfaces are copied into the mesh within the milliseconds per frame of
    /// <see cref="SurfaceScheduler.UploadBudget"/>, without garbage.</para>
    /// </summary>
    [ExecuteAlways]
    [DefaultExecutionOrder(100)] // its LateUpdate comes after those of players and scripts, which may give it atoms there
    [DisallowMultipleComponent]
    [RequireComponent(typeof(MeshFilter), typeof(MeshRenderer))]
    [AddComponentMenu("Molecular/Molecular Surface")]
    public sealed partial class MolecularSurface : MonoBehaviour
    {
        // Who types 0.5 types 0 first, whose surface nobody could wait for.
        private const float MinEditedSpacing = 0.05f;

        [SerializeField] private MoleculeSource _source = new MoleculeSource();

        [Header("Surface")]
        [SerializeField, Tooltip("Solvent-excluded: what a probe rolling over the atoms can't reach. Solvent-" +
            "accessible: where its centre may be. Van der Waals: the atoms themselves. Gaussian: of a density, as QuickSurf.")]
        private SurfaceKind _surface = SurfaceKind.Ses;
        [SerializeField, Min(0), Tooltip("Radius of the probe in Å; 1.4 is water.")]
        private float _probeRadius = 1.4f;
        [SerializeField, Tooltip("Exact: vertices lie on the exact surface. Grid: the voxel method of the QuickSES " +
            "paper, for comparison.")]
        private SurfaceMethod _method = SurfaceMethod.Exact;

        [SerializeField, Range(SurfaceSettings.MinGaussianRadiusScale, SurfaceSettings.MaxGaussianRadiusScale),
            Tooltip("Gaussian: an atom's standard deviation over its radius, as QuickSurf's radius scale.")]
        private float _gaussianRadiusScale = 1;
        [SerializeField, Range(SurfaceSettings.MinGaussianIsovalue, SurfaceSettings.MaxGaussianIsovalue),
            Tooltip("Gaussian: the density on the surface, as QuickSurf's isovalue.")]
        private float _gaussianIsovalue = 0.5f;

        [Header("Quality")]
        [SerializeField, Min(MinEditedSpacing), Tooltip("How fine the mesh is in the end: Å between the points of the " +
            "lattice it is made on. Half of it gives four times the triangles. Not below 0.05 here; scripts may.")]
        private float _spacing = 0.5f;
        [SerializeField, Tooltip("Coarser surfaces (Å) that are shown until the finest is there.")]
        private float[] _levels = { 2, 1 };
        [SerializeField, Min(0), Tooltip("Smoothing steps, up to 100. They make better triangles; vertices stay on the " +
            "exact surface.")]
        private int _relaxationSteps = 1;
        [SerializeField, Tooltip("When atoms rest, triangles of the finest level follow the creases where sheets of the " +
            "surface meet, and light breaks there. Not while atoms move, nor with the grid method or of Gaussian surfaces.")]
        private bool _sharpCreases = true;
        [SerializeField, Tooltip("Less light where the surface is closed in, computed with it, also while atoms move: " +
            "texture coordinate 1, which the package's shaders read.")]
        private bool _ambientOcclusion = true;

        [Header("Playback")]
        [SerializeField, Min(0), Tooltip("Milliseconds per surface while atoms move: the finest level that " +
            "fits is computed. 0: all levels of every frame.")]
        private float _frameBudget = 33;
        [SerializeField, Min(0), Tooltip("Seconds without new positions until the finest level is computed.")]
        private float _restDelay = 0.2f;

        [Header("Look and extras")]
        [SerializeField, Tooltip("Colour of the surface where atoms have none of their own.")]
        private Color32 _baseColor = new Color32(200, 205, 215, 255);
        [SerializeField, Tooltip("Which atoms of a file are shown: words such as within 5 of ligand, or CID such as " +
            "//A/10-40. " +
            "Empty: all. The surface is that of all atoms, cut open where they are hidden.")]
        private string _visible = "";
        [SerializeField, Tooltip("Area and volume of each closed piece and cavity of the surface, not only in all.")]
        private bool _measureComponents;
        [SerializeField, Tooltip("Where the colours of atoms are. Auto: in a texture if the material's shader reads " +
            "it, as the package's does; else in the vertices, which any shader with vertex colours reads.")]
        private AtomColoring _coloring = AtomColoring.Auto;
        [SerializeField, Tooltip("Normals of 4 bytes instead of 12: a sixth less to upload in playback, and directions " +
            "to half a degree.")]
        private bool _compactVertices;
        [SerializeField, Tooltip("What computes. Auto: an NVIDIA GPU if the library was built for it and there is " +
            "one, else the CPU.")]
        private SurfaceBackend _backend = SurfaceBackend.Auto;

        [SerializeField] private SurfaceEvents _events = new SurfaceEvents();

        // Not serialised, so it is gone after a domain reload, like the native memory it stands for.
        [NonSerialized] private SurfaceSession _session;
        [NonSerialized] private bool _isSessionOfPlayMode;
        [NonSerialized] private ShownSurface _shown;
        [NonSerialized] private AtomColorTexture _texture;
        [NonSerialized] private MeshRenderer _renderer;
        [NonSerialized] private bool _isMeshAttached; // to the filter
        private Mesh _replacedMesh; // what the filter had of somebody else's; not in files, but kept over domain reloads
        [NonSerialized] private bool _isScriptFed;
        [NonSerialized] private bool _asksForAtoms;
        [NonSerialized] private bool _isEdited; // in the inspector, by Undo, by a prefab
        [NonSerialized] private SurfaceSettings _editedFrom; // the settings as they changed last
        [NonSerialized] private SurfaceBackend _editedBackend;
        [NonSerialized] private bool _isDestroyed;

        private readonly Listeners<SurfaceLevel> _updated = new Listeners<SurfaceLevel>();
        private readonly Listeners _finished = new Listeners();
        private readonly Listeners<QuickSesError> _failed = new Listeners<QuickSesError>();
        private readonly Listeners _atomsRequested = new Listeners();
        private readonly Listeners _loaded = new Listeners();

        /// <summary>
        /// A surface arrived and is shown, or the one that is shown has come into another <see cref="Mesh"/> or other
        /// buffers. Not for new colours.
        /// </summary>
        public event Action<SurfaceLevel> SurfaceUpdated
        {
            add => _updated.Add(value);
            remove => _updated.Remove(value);
        }

        /// <summary>
        /// The finest surface of the newest atoms is shown, with its creases (<see cref="SharpCreases"/>); nothing is left to
        /// do. After new positions that is not before <see cref="RestDelay"/>.
        /// </summary>
        public event Action RefinementFinished
        {
            add => _finished.Add(value);
            remove => _finished.Remove(value);
        }

        /// <summary>
        /// There is no surface of the newest atoms; the last good one stays. Without listeners it is logged, once until a
        /// surface comes again.
        /// </summary>
        public event Action<QuickSesError> Failed
        {
            add => _failed.Add(value);
            remove => _failed.Remove(value);
        }

        /// <summary>
        /// The component is enabled and has neither atoms nor a source. That is so at first and, in the editor, after
        /// scripts were compiled anew: who feeds it calls SetAtoms again then. Also raised for late listeners.
        /// </summary>
        public event Action AtomsRequested
        {
            add
            {
                _atomsRequested.Add(value);
                _asksForAtoms = true;
                QueueEditorUpdate();
            }
            remove => _atomsRequested.Remove(value);
        }

        /// <summary>The same events as UnityEvents, which can be wired in the inspector.</summary>
        public SurfaceEvents Events => _events;

        /// <summary>
        /// Whether surfaces can be computed here, and if not, why. Never throws, and takes no time.
        /// </summary>
        public static bool IsSupported(out string reason) => SurfaceContext.IsSupported(out reason);

        /// <summary>
        /// The mesh that is shown. The component's: it changes with every surface and goes with the component. To keep it,
        /// use <see cref="CopyTo"/>: a copy of the engine's (Instantiate) may have numbers of atoms instead of colours, has
        /// hidden atoms then, and zeros where the surface is on the GPU. Surfaces too large for one frame
        /// (<see cref="SurfaceScheduler.UploadBudget"/>) are made ready in a second mesh, which takes its place in the
        /// MeshFilter beside the component: who holds the mesh asks for it again in <see cref="SurfaceUpdated"/>. Never
        /// saved with scenes.
        /// </summary>
        public Mesh Mesh => Shown.Mesh;

        /// <summary>What is shown; <see cref="SurfaceLevel.LevelCount"/> 0: nothing yet.</summary>
        public SurfaceLevel CurrentLevel => Session.CurrentLevel;

        /// <summary>
        /// Whether something is being read, computed, uploaded or painted, or will be. Not while the component is disabled.
        /// </summary>
        public bool IsBusy => isActiveAndEnabled && (IsLoading || !Session.IsUpToDate);

        /// <summary>
        /// Whether it is busy because the back end is being started, by another thread. CUDA takes up to a second for
        /// it once per program, and on a GPU newer than the library up to a minute, once per driver version.
        /// </summary>
        public bool IsStarting => isActiveAndEnabled && Session.IsStarting;

        /// <summary>Of the job that runs: from 0 to 1.</summary>
        public float Progress => Session.Progress;

        /// <summary>The back end that computes or computed the surface; Auto: none has.</summary>
        public SurfaceBackend UsedBackend => Session.UsedBackend;

        /// <summary>The device, and for Auto why it is not CUDA. Empty before the first computation.</summary>
        public BackendDescription UsedDevice => Session.UsedDevice;

        /// <summary>
        /// How what is shown came; Auto: nothing is shown. Device: it has not left the GPU, so that the vertices of
        /// <see cref="Mesh"/> are zeros for scripts and Mesh.vertexCount counts unused ones at the end. All else is
        /// as ever: <see cref="TryPick"/>, <see cref="Owners"/> and baking download the surface once, when they first
        /// ask, and wait for that. See <see cref="SurfaceScheduler.Delivery"/>.
        /// </summary>
        public SurfaceDelivery UsedDelivery => !Shown.IsFilled ? SurfaceDelivery.Auto :
            Shown.IsOnGpu ? SurfaceDelivery.Device : SurfaceDelivery.Host;

        /// <summary>Why surfaces come by host memory; "": they stay on the GPU.</summary>
        public string DeliveryReason => Session.DeliveryReason;

        /// <summary>Why there is no surface of the newest atoms; Ok if there is or will be one.</summary>
        public QuickSesError LastError => Session.LastError;

        private SurfaceSession Session
        {
            get
            {
                if (_isDestroyed)
                    throw new MissingReferenceException("This MolecularSurface has been destroyed.");
                if (!HasSession)
                {
                    _shown = new ShownSurface();
                    _session = new SurfaceSession(this);
                    _session.Atoms.SetBaseColor(Number(_baseColor));
                    _isSessionOfPlayMode = IsInPlayMode;
                }
                return _session;
            }
        }

        private bool HasSession => _session != null && !_session.IsDisposed;

        private ShownSurface Shown // comes and goes with the session
        {
            get
            {
                _ = Session;
                return _shown;
            }
        }

        /// <summary>Computes the surface again, for instance after a failure.</summary>
        public void Recompute()
        {
            SurfaceScheduler.PoolOf(_backend).ForgetFailures();
            Changed(SurfaceChange.Shape);
        }

        /// <summary>Ends the computation; what is shown stays until something changes.</summary>
        public void Cancel() => Session.Stop();

        /// <summary>
        /// Computes the finest surface and shows it before it returns. For tools: it blocks for as long as it takes.
        /// </summary>
        /// <returns>False: <see cref="LastError"/> says why.</returns>
        public bool ComputeNow() => ComputeWhile(null);

        /// <summary>The same for tools that show how it goes on.</summary>
        /// <param name="goesOn">If not null: called now and then; false ends it.</param>
        internal bool ComputeWhile(Func<bool> goesOn)
        {
            FollowEditsNow();
            if (!LoadSourceUnlessFed())
                return false;
            if (!Session.Atoms.IsSet)
                throw new InvalidOperationException("There are no atoms: call SetAtoms or choose a source.");
            bool isComputed = Session.ComputeNow(goesOn);
            Session.RaiseEvents();
            return isComputed;
        }

        /// <summary>Whether <see cref="ComputeNow"/> would give what is shown, as far as is known.</summary>
        internal bool IsFinestShown => !_isEdited && !IsLoading && Session.IsFinestShown;

        /// <summary>Whether triangles of what is shown are visible: not all are of hidden atoms.</summary>
        internal bool IsAnyVisible => Shown.IsAnyVisible;

        // Colours, what is hidden, texture coordinates: nothing is computed, and the next frame sees it.
        private void LookChanged() => QueueEditorUpdate();

        private void Changed(SurfaceChange change)
        {
            Session.Change(change, Time.realtimeSinceStartupAsDouble);
            QueueEditorUpdate();
        }

        // In edit mode the engine only calls components when something is redrawn.
        private static void QueueEditorUpdate()
        {
#if UNITY_EDITOR
            if (!Application.isPlaying)
                UnityEditor.EditorApplication.QueuePlayerLoopUpdate();
#endif
        }
    }
}
