// SPDX-License-Identifier: MIT
using UnityEngine;

namespace QuickSes.Samples
{
    /// <summary>
    /// A panel to play a trajectory with, and the name of the atom under the mouse. The work is done by the components
    /// it talks to: <see cref="TrajectoryPlayer"/> reads frames, <see cref="MolecularSurface"/> shows their surfaces.
    /// </summary>
    public sealed class TrajectoryPlaybackUI : MonoBehaviour
    {
        private const float LabelWidth = 110;

        private static readonly Rect s_panel = new Rect(12, 12, 330, 370);
        private static readonly float[] s_spacings = { 2, 1, 0.5f };
        private static readonly string[] s_spacingNames = { "2 Å", "1 Å", "0.5 Å" };
        private static readonly string[] s_schemeNames =
            { "Uniform", "Element", "Chain", "Residue", "Hydrophobic", "Sequence" }; // order of AtomColorScheme

        [SerializeField] private MolecularSurface _surface = null;
        [SerializeField] private TrajectoryPlayer _player = null;
        [SerializeField] private OrbitCamera _orbit = null;

        private Camera _camera;
        private string _problem = "";
        private bool _isInView;

        private void OnEnable()
        {
            _camera = _orbit.GetComponent<Camera>();
            _surface.SurfaceUpdated += OnSurfaceUpdated;
            _surface.Failed += OnFailed;
            _player.Failed += OnFrameFailed;
            if (!MolecularSurface.IsSupported(out string reason))
                _problem = reason;
        }

        private void OnDisable()
        {
            _surface.SurfaceUpdated -= OnSurfaceUpdated;
            _surface.Failed -= OnFailed;
            _player.Failed -= OnFrameFailed;
        }

        private void OnSurfaceUpdated(SurfaceLevel level)
        {
            _problem = "";
            if (_isInView || level.VertexCount == 0)
                return;
            Bounds bounds = _surface.Mesh.bounds;
            Transform space = _surface.transform;
            float radius = space.TransformVector(bounds.extents).magnitude;
            _orbit.LookAt(space.TransformPoint(bounds.center), radius);
            _isInView = true;
        }

        private void OnFailed(QuickSesError error) => _problem = error.Message;

        private void OnFrameFailed(int frame, QuickSesError error) => _problem = error.Message;

        private void OnGUI()
        {
            // Readable on screens with many pixels as well.
            float scale = Mathf.Max(1, Screen.height / 900f);
            GUI.matrix = Matrix4x4.Scale(new Vector3(scale, scale, 1));
            GUILayout.BeginArea(s_panel, GUI.skin.box);
            DrawPlayback();
            GUILayout.Space(8);
            DrawSurface();
            GUILayout.Space(8);
            DrawFigures();
            GUILayout.EndArea();

            Event input = Event.current;
            if (s_panel.Contains(input.mousePosition))
                return;
            if (input.type == EventType.Repaint)
                DrawAtomUnderMouse(input.mousePosition, scale);
            else
                _orbit.Handle(input);
        }

        private void DrawPlayback()
        {
            GUILayout.BeginHorizontal();
            if (GUILayout.Button(_player.IsPlaying ? "Pause" : "Play", GUILayout.Width(LabelWidth)))
            {
                if (_player.IsPlaying)
                    _player.Pause();
                else
                    _player.Play();
            }
            _player.Interpolate = GUILayout.Toggle(_player.Interpolate, "Interpolate");
            GUILayout.EndHorizontal();

            float frame = (float)_player.Frame;
            float last = Mathf.Max(1, _player.FrameCount - 1);
            float wanted = Slider($"Model {_player.ShownFrame + 1} of {_player.FrameCount}", frame, 0, last);
            if (wanted != frame)
                _player.Frame = wanted;
            _player.FramesPerSecond =
                Slider($"{_player.FramesPerSecond:0} frames / s", _player.FramesPerSecond, 1, 60);
        }

        private void DrawSurface()
        {
            GUILayout.Label("Finest spacing of the mesh");
            int chosen = System.Array.IndexOf(s_spacings, _surface.Spacing);
            int spacing = GUILayout.Toolbar(chosen, s_spacingNames);
            if (spacing != chosen)
                _surface.Spacing = s_spacings[spacing];
            _surface.ProbeRadius = Slider($"Probe {_surface.ProbeRadius:0.00} Å", _surface.ProbeRadius, 0.5f, 3);

            GUILayout.Label("Colours");
            int scheme = (int)_player.ColorScheme;
            int wanted = GUILayout.SelectionGrid(scheme, s_schemeNames, 3);
            if (wanted != scheme)
                _player.ColorScheme = (AtomColorScheme)wanted;
        }

        private void DrawFigures()
        {
            SurfaceLevel shown = _surface.CurrentLevel;
            GUILayout.Label($"{_surface.AtomCount:N0} atoms on {_surface.UsedBackend}, {shown.Spacing:0.##} Å now");
            GUILayout.Label($"{shown.VertexCount:N0} vertices, {shown.TriangleCount:N0} triangles");
            GUILayout.Label($"{shown.ComputeMilliseconds:0.0} ms to compute, " +
                $"{shown.UploadMilliseconds:0.00} ms of the main thread");
            GUILayout.Label($"{_surface.Area:N0} Å², {_surface.Volume:N0} Å³");
#if ENABLE_INPUT_SYSTEM && !ENABLE_LEGACY_INPUT_MANAGER
            GUILayout.Label("No mouse events here: in the Player settings, set Active Input Handling to Both.");
#endif
            GUILayout.Label(_player.IsLoading ? $"Reading, {100 * _player.LoadProgress:0} %" : _problem);
        }

        private void DrawAtomUnderMouse(Vector2 mouse, float scale)
        {
            // The GUI counts from the top of the screen, the camera from its bottom.
            var pixel = new Vector3(mouse.x * scale, Screen.height - mouse.y * scale, 0);
            if (_player.Structure == null ||
                !_surface.TryPick(_camera.ScreenPointToRay(pixel), out int index, out Vector3 _) ||
                index >= _player.Structure.AtomCount) // the surface shown may be of what was loaded before
                return;
            GUI.Box(new Rect(mouse.x + 16, mouse.y, 200, 24), _player.Structure.GetAtom(index).ToString());
        }

        private static float Slider(string label, float value, float least, float most)
        {
            GUILayout.BeginHorizontal();
            GUILayout.Label(label, GUILayout.Width(LabelWidth));
            value = GUILayout.HorizontalSlider(value, least, most);
            GUILayout.EndHorizontal();
            return value;
        }
    }
}
