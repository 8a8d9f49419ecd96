// SPDX-License-Identifier: MIT
using UnityEditor;
using UnityEngine;

namespace QuickSes.Editor
{
    /// <summary>Draws what a surface shows, what it took, and what computes it.</summary>
    internal static class SurfaceStatusPanel
    {
        private static readonly BackendInquiry s_cuda = new BackendInquiry(SurfaceBackend.Cuda);
        private static string s_startNote; // null: none

        public static void Draw(MolecularSurface surface)
        {
            SurfaceLevel shown = surface.CurrentLevel;
            bool hasFailed = surface.LastError.Status != QuickSesStatus.Ok;
            bool hasAtoms = surface.AtomCount > 0;
            string state = surface.IsLoading ? SurfaceStatus.Reading : SurfaceStatus.State(hasAtoms, surface.IsBusy, surface.IsStarting, surface.Progress, shown,
                hasFailed);
            if (surface.IsBusy)
                EditorGUI.ProgressBar(EditorGUILayout.GetControlRect(),
                    surface.IsLoading ? surface.LoadProgress : surface.Progress, state);
            else
                Row("State", state);
            // Other threads start it: all events of a frame must see the same controls.
            if (Event.current.type == EventType.Layout)
                s_startNote = StartNoteOf(surface);
            if (s_startNote != null)
                EditorGUILayout.HelpBox(s_startNote, MessageType.Info);
            if (hasFailed)
                EditorGUILayout.HelpBox(surface.LastError.Message, MessageType.Error);
            Row("Atoms", SurfaceStatus.Count(surface.AtomCount));
            if (shown.LevelCount > 0)
                DrawShown(surface, shown);
            DrawBackend(surface);
        }

        /// <summary>Sums over several surfaces.</summary>
        public static void DrawSums(Object[] surfaces)
        {
            int busy = 0, count = 0;
            long atoms = 0, vertices = 0, triangles = 0;
            ulong meshBytes = 0;
            foreach (Object target in surfaces)
            {
                var surface = (MolecularSurface)target;
                if (!MolecularSurfaceEditor.IsLive(surface))
                    continue;
                SurfaceLevel shown = surface.CurrentLevel;
                ++count;
                busy += surface.IsBusy ? 1 : 0;
                atoms += surface.AtomCount;
                vertices += shown.VertexCount;
                triangles += shown.TriangleCount;
                meshBytes += shown.MeshBytes;
            }
            Row("Surfaces", $"{SurfaceStatus.Count(count)}, {SurfaceStatus.Count(busy)} computing");
            Row("Atoms", SurfaceStatus.Count(atoms));
            Row("Vertices", SurfaceStatus.Count(vertices));
            Row("Triangles", SurfaceStatus.Count(triangles));
            Row("Mesh memory", SurfaceStatus.Bytes(meshBytes));
        }

        private static void DrawShown(MolecularSurface surface, in SurfaceLevel shown)
        {
            Row("Level", SurfaceStatus.Level(shown.Level, shown.LevelCount, shown.Spacing));
            Row("Vertices", SurfaceStatus.Count(shown.VertexCount));
            Row("Triangles", SurfaceStatus.Count(shown.TriangleCount));
            Row("Compute time", SurfaceStatus.Milliseconds(shown.ComputeMilliseconds));
            Row("Upload time", SurfaceStatus.Milliseconds(shown.UploadMilliseconds));
            string place = surface.UsedBackend == SurfaceBackend.Cuda ? " (GPU)" : "";
            Row("Delivery", SurfaceStatus.Delivery(surface.UsedDelivery));
            string note = SurfaceStatus.WhyNotOnGpu(SurfaceScheduler.Delivery, surface.DeliveryReason);
            if (note != null)
                EditorGUILayout.HelpBox(note, MessageType.Info);
            Row("Work memory", SurfaceStatus.Bytes(shown.WorkBytes) + place);
            Row("Mesh memory", SurfaceStatus.Bytes(shown.MeshBytes));
            Row("Host memory", SurfaceStatus.Bytes(shown.HostBytes));
            Row("Area", SurfaceStatus.Measure(surface.Area, "Å²"));
            Row("Volume", SurfaceStatus.Measure(surface.Volume, "Å³"));
            if (surface.MeasureComponents && surface.Components.Length > 0)
                Row("Components", SurfaceStatus.Components(surface.Components));
        }

        // The driver may compile for a minute, which the user should know.
        private static string StartNoteOf(MolecularSurface surface)
        {
            if (!surface.IsStarting || surface.Backend == SurfaceBackend.Cpu)
                return null;
            s_cuda.Ask();
            return s_cuda.TryGetAnswer(out BackendDescription cuda) && cuda.IsPreparing
                ? SurfaceStatus.Preparing(cuda.Device, cuda.Reason) : null;
        }

        private static void DrawBackend(MolecularSurface surface)
        {
            if (surface.UsedBackend == SurfaceBackend.Auto)
                return;
            BackendDescription device = surface.UsedDevice;
            Row("Computed by", SurfaceStatus.Backend(surface.UsedBackend, device.Device));
            string note = SurfaceStatus.WhyNotCuda(surface.UsedBackend, device.Reason);
            if (note != null)
                EditorGUILayout.HelpBox(note, MessageType.Info);
        }

        private static void Row(string label, string text) => EditorGUILayout.LabelField(label, text);
    }
}
