// SPDX-License-Identifier: MIT
using System;
using System.Collections;
using System.Collections.Generic;
using UnityEngine;

namespace QuickSes.Samples
{
    /// <summary>
    /// Finds out whether meshes can stay on the GPU with this engine, graphics API and machine: moves some atoms, reads the
    /// buffers back that are drawn, compares them with the mesh as the library has it, and shows what came of it. For both
    /// plans of drawing, one after the other.
    /// </summary>
    public sealed class GpuDeliveryCheck : MonoBehaviour
    {
        private const int Atoms = 3000, MovedFrames = 60, RestedFrames = 30;
        private const float Patience = 20; // s

        [SerializeField] private MolecularSurface _surface = null;
        [SerializeField] private Transform _camera = null;

        private readonly List<(string Text, bool IsGood)> _lines = new List<(string, bool)>();
        private Vector3[] _start;
        private Vector3[] _positions;
        private int _shown;
        private bool _isStuck; // nothing more will be shown
        private string _doing = "";
        private SurfaceDelivery _deliveryBefore;
        private GpuMeshPlan _planBefore;

        /// <summary>Whether nothing more will come.</summary>
        public bool IsDone { get; private set; }

        /// <summary>Whether all that was looked at so far was right.</summary>
        public bool IsGood => _lines.TrueForAll(line => line.IsGood);

        /// <summary>What was found, a line each.</summary>
        public string Outcome =>
            string.Join("\n", _lines.ConvertAll(line => (line.IsGood ? "good: " : "BAD: ") + line.Text));

        private static double Now => Time.realtimeSinceStartupAsDouble;

        private void OnEnable()
        {
            _surface.SurfaceUpdated += CountSurface;
            _deliveryBefore = SurfaceScheduler.Delivery;
            _planBefore = SurfaceScheduler.GpuMeshPlan;
            StartCoroutine(Check());
        }

        private void OnDisable()
        {
            _surface.SurfaceUpdated -= CountSurface;
            SurfaceScheduler.Delivery = _deliveryBefore;
            SurfaceScheduler.GpuMeshPlan = _planBefore;
        }

        private void CountSurface(SurfaceLevel level) => ++_shown;

        private IEnumerator Check()
        {
            MakeAtoms(out _start, out float[] radii);
            _positions = (Vector3[])_start.Clone();
            _surface.Coloring = AtomColoring.Vertices;
            _surface.Levels = Array.Empty<float>();
            _surface.SharpCreases = false;
            SurfaceScheduler.Delivery = SurfaceDelivery.Device;
            _surface.SetAtoms(_start, radii);
            yield return Rest();
            foreach (GpuMeshPlan plan in new[] { GpuMeshPlan.SubMeshPerFrame, GpuMeshPlan.WholeBuffers })
            {
                if (!_isStuck)
                    yield return Try(plan);
            }
            _doing = "Please report these lines, and whether the molecule was to be seen all the time.";
            IsDone = true;
        }

        private IEnumerator Try(GpuMeshPlan plan)
        {
            SurfaceScheduler.GpuMeshPlan = plan;
            SurfaceScheduler.Delivery = SurfaceDelivery.Device; // what failed is tried again
            for (int frame = 0; frame < MovedFrames && !_isStuck; ++frame)
                yield return Move(plan, frame);
            if (_isStuck)
                yield break;
            yield return Rest();
            Compare(plan + ", after moving");
            for (int frame = 0; frame < RestedFrames; ++frame)
                yield return null;
            Compare(plan + ", some frames later");
            _surface.SetColors(Array.ConvertAll(_start, place => new Color32((byte)(4 * place.x), 90, 200, 255)));
            yield return Rest();
            Compare(plan + ", in other colours");
        }

        // Until a surface of it is shown, or none will be.
        private IEnumerator Move(GpuMeshPlan plan, int frame)
        {
            _doing = $"{plan}: surface {frame + 1} of {MovedFrames}";
            for (int i = 0; i < _positions.Length; ++i)
                _positions[i] = _start[i] + 0.4f * Mathf.Sin(0.2f * frame + i) * Vector3.up;
            int before = _shown;
            _surface.SetPositions(_positions);
            for (double end = Now + Patience; _shown == before && !HasFailed && Now < end;)
                yield return null;
            if (_shown == before)
                GiveUp($"{_doing} was not shown");
        }

        private IEnumerator Rest()
        {
            for (double end = Now + Patience; _surface.IsBusy && Now < end;)
                yield return null;
            for (int frame = 0; frame < 3; ++frame)
                yield return null;
            if (HasFailed)
                GiveUp("no surface");
        }

        private bool HasFailed => _surface.LastError.Status != QuickSesStatus.Ok;

        private void GiveUp(string what)
        {
            _isStuck = true;
            Note(HasFailed ? $"{what}: {_surface.LastError.Message}" : what, false);
        }

        private void Compare(string when)
        {
            if (_surface.UsedDelivery != SurfaceDelivery.Device)
            {
                Note($"{when}: by host memory, since: {_surface.DeliveryReason}", false);
                return;
            }
            var expected = new Mesh();
            try
            {
                _surface.CopyTo(expected);
                string difference = DifferenceOf(_surface.Mesh, expected);
                Note($"{when}: " + (difference ?? $"{expected.vertexCount} vertices are in the buffers"),
                    difference == null);
            }
            catch (Exception e)
            {
                Note($"{when}: could not be read back: {e.Message}", false);
            }
            Destroy(expected);
        }

        // null: none.
        private static string DifferenceOf(Mesh shown, Mesh expected)
        {
            Vector3[] vertices = expected.vertices, normals = expected.normals;
            Color32[] colors = expected.colors32;
            int[] triangles = expected.triangles;
            var numbers = new float[6 * vertices.Length];
            using (GraphicsBuffer buffer = shown.GetVertexBuffer(0))
                buffer.GetData(numbers, 0, 0, numbers.Length);
            for (int v = 0; v < vertices.Length; ++v)
                for (int k = 0; k < 3; ++k)
                    if (numbers[6 * v + k] != vertices[v][k] || numbers[6 * v + 3 + k] != normals[v][k])
                        return $"vertex {v} of {vertices.Length} is at {numbers[6 * v]}, {numbers[6 * v + 1]}, " +
                            $"{numbers[6 * v + 2]}, not {vertices[v]}";
            var bytes = new byte[4 * colors.Length];
            using (GraphicsBuffer buffer = shown.GetVertexBuffer(1))
                buffer.GetData(bytes, 0, 0, bytes.Length);
            for (int v = 0; v < colors.Length; ++v)
                if (bytes[4 * v] != colors[v].r || bytes[4 * v + 1] != colors[v].g || bytes[4 * v + 2] != colors[v].b)
                    return $"vertex {v} of {colors.Length} has another colour";
            var indices = new int[triangles.Length];
            using (GraphicsBuffer buffer = shown.GetIndexBuffer())
                buffer.GetData(indices, 0, 0, indices.Length);
            for (int i = 0; i < triangles.Length; ++i)
                if (indices[i] != triangles[i])
                    return $"index {i} of {triangles.Length} is {indices[i]}, not {triangles[i]}";
            return null;
        }

        private void Note(string text, bool isGood)
        {
            _lines.Add((text, isGood));
            Debug.Log($"GPU delivery check: {(isGood ? "good" : "BAD")}: {text}");
        }

        // A dense ball of atoms at random, the same in every run.
        private void MakeAtoms(out Vector3[] positions, out float[] radii)
        {
            var random = new System.Random(1);
            float edge = 2.2f * Mathf.Pow(Atoms, 1f / 3);
            positions = new Vector3[Atoms];
            radii = new float[Atoms];
            for (int i = 0; i < Atoms; ++i)
            {
                positions[i] = new Vector3((float)random.NextDouble(), (float)random.NextDouble(),
                    (float)random.NextDouble()) * edge;
                radii[i] = 1.2f + 0.6f * (float)random.NextDouble();
            }
            _camera.position = new Vector3(edge / 2, edge / 2, -2 * edge);
            _camera.rotation = Quaternion.identity;
        }

        private void OnGUI()
        {
            GUILayout.BeginArea(new Rect(12, 12, 900, 400), GUI.skin.box);
            GUILayout.Label($"Unity {Application.unityVersion}, {SystemInfo.graphicsDeviceType}, " +
                $"{SystemInfo.graphicsDeviceName}; computed by {_surface.UsedBackend} {_surface.UsedDevice.Device}");
            foreach ((string text, bool isGood) in _lines)
            {
                GUI.color = isGood ? Color.green : Color.red;
                GUILayout.Label(text);
            }
            GUI.color = Color.white;
            GUILayout.Label(_doing);
            GUILayout.EndArea();
        }
    }
}
