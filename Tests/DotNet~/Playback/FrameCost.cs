// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using QuickSes.Tests;
using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.IO;
using System.Threading;
using UnityEngine;

namespace QuickSes.Playback
{
    /// <summary>
    /// What a surface costs the main thread, in milliseconds per frame, while a game runs at 90 frames a second. The
    /// meshes are the double's, whose copies are plain copies in memory, and whose new buffers are filled: the engine's
    /// own work on the GPU's side comes on top.
    /// </summary>
    internal sealed class FrameCost
    {
        private const int Frames = 300, Repetitions = 20, FewestSurfaces = 6;
        private const double Interval = 1000.0 / 90, Patience = 120000;

        private string _name;
        private readonly MolecularSurface _surface;
        private StandInGpu _gpu;
        private readonly Vector3[] _start;
        private readonly Vector3[] _positions;
        private readonly System.Random _random = new System.Random(1);
        private int _shown;
        private int _fed = -1; // which surface the newest positions were given after

        private FrameCost(string name, MolecularSurface surface, Vector3[] start)
        {
            _name = name;
            _surface = surface;
            _start = start;
            _positions = (Vector3[])start.Clone();
            surface.SurfaceUpdated += level => ++_shown;
        }

        /// <summary>false: the file can't be read; the log says why.</summary>
        /// <param name="file">A structure.</param>
        /// <param name="gpu">
        /// If not null, surfaces stay on its GPU. What it takes to stand for one, by copies on the main thread, is measured
        /// apart.
        /// </param>
        public static bool TryPrint(string file, StandInGpu gpu = null)
        {
            Engine.Reset();
            if (gpu != null)
            {
                GpuDelivery.Library = gpu;
                SurfaceScheduler.Delivery = SurfaceDelivery.Device;
            }
            Engine.ChecksMeshes = false;
            var surface = new GameObject("surface").AddComponent<MolecularSurface>();
            surface.FrameBudget = 0;
            surface.Levels = Array.Empty<float>(); // the finest only
            if (!TryLoad(file, surface, out Vector3[] start))
                return false;
            var cost = new FrameCost(Path.GetFileName(file), surface, start);
            cost.Settle();
            Console.WriteLine($"{cost._name}: {start.Length} atoms, {surface.CurrentLevel.VertexCount} vertices, " +
                $"{surface.CurrentLevel.TriangleCount} triangles, {surface.UsedBackend}; main thread, ms");
            cost._gpu = gpu;
            foreach (AtomColoring coloring in new[] { AtomColoring.Vertices, AtomColoring.Texture })
            {
                surface.Coloring = coloring;
                cost._name = $"{Path.GetFileName(file)}, {coloring}";
                cost.Settle();
                cost.Play();
                cost.ComeToRest();
                cost.Recolour();
            }
            cost.Pick();
            cost.AskForOwners();
            Engine.Quit();
            return true;
        }

        private static bool TryLoad(string file, MolecularSurface surface, out Vector3[] positions)
        {
            positions = null;
            if (!Structure.TryOpen(file, default, out Structure structure, out QuickSesError error))
            {
                Console.Error.WriteLine(error.Message);
                return false;
            }
            using (structure)
            {
                positions = new Vector3[structure.AtomCount];
                UnitySpace.FromFile(structure.Positions, positions);
                surface.SetAtoms(positions, structure.Radii);
            }
            return true;
        }

        // New positions whenever a surface has arrived.
        private void Play()
        {
            int shown = _shown;
            while (_shown < shown + FewestSurfaces)
                PlayFrame(out _);
            shown = _shown;
            var frames = new double[Frames];
            var feeds = new double[Frames];
            var copies = new double[Frames];
            Stopwatch clock = Stopwatch.StartNew();
            long bytes = MeshRecord.AllBytesUploaded, garbage = GC.GetAllocatedBytesForCurrentThread();
            long most = 0, before = bytes;
            for (int k = 0; k < Frames; ++k)
            {
                double copied = CopyMilliseconds;
                frames[k] = PlayFrame(out feeds[k]);
                copies[k] = CopyMilliseconds - copied;
                frames[k] -= copies[k];
                most = Math.Max(most, MeshRecord.AllBytesUploaded - before);
                before = MeshRecord.AllBytesUploaded;
            }
            garbage = GC.GetAllocatedBytesForCurrentThread() - garbage;
            shown = _shown - shown;
            Print("frame, playing", frames);
            Print("  of that SetPositions", feeds);
            if (_gpu != null)
                Print("  not counted: what stands for the GPU", copies);
            Console.WriteLine($"{_name}: {shown} surfaces in {Frames} frames, " +
                $"{(shown > 0 ? clock.Elapsed.TotalMilliseconds / shown : 0):F0} ms each, shown " +
                $"{_surface.CurrentLevel.LatencyMilliseconds:F0} ms after they were computed; MB moved per frame: mean " +
                $"{(before - bytes) / 1e6 / Frames:F2}, most {most / 1e6:F2}; garbage {garbage} bytes");
        }

        private double CopyMilliseconds => _gpu?.Milliseconds ?? 0;

        private double PlayFrame(out double feed)
        {
            bool isFed = _shown != _fed;
            if (isFed)
                for (int i = 0; i < _positions.Length; ++i)
                    _positions[i] = _start[i] + new Vector3((float)_random.NextDouble() * 0.1f, 0, 0);
            _fed = _shown;
            long begin = Stopwatch.GetTimestamp();
            if (isFed)
                _surface.SetPositions(_positions);
            long fed = Stopwatch.GetTimestamp();
            Engine.Frame(Interval / 1000);
            double milliseconds = Milliseconds(begin);
            feed = (fed - begin) * 1000.0 / Stopwatch.Frequency;
            Rest(milliseconds);
            return milliseconds;
        }

        // The surface with creases, which is shown when atoms have not moved for a while, in exact buffers.
        private void ComeToRest()
        {
            var sums = new double[Repetitions];
            var longest = new double[Repetitions];
            for (int k = 0; k < Repetitions; ++k)
            {
                if (k > 0)
                    MoveOnce();
                foreach (double frame in Settle())
                {
                    sums[k] += frame;
                    longest[k] = Math.Max(longest[k], frame);
                }
            }
            Print("coming to rest, in all", sums);
            Print("  its longest frame", longest);
            Console.WriteLine($"{_name}: {_surface.CurrentLevel.VertexCount} vertices, " +
                $"{_surface.CurrentLevel.TriangleCount} triangles, {_surface.Repeated.Length} repeated, computed in " +
                $"{_surface.CurrentLevel.ComputeMilliseconds:F0} ms; {_surface.CurrentLevel.MeshBytes / 1e6:F1} MB");
        }

        private void MoveOnce()
        {
            int shown = _shown;
            while (_shown == shown)
                PlayFrame(out _);
        }

        // One atom after the other, as the mouse moves over them; what it costs in all, and the longest frame of it.
        private void Recolour()
        {
            var colors = new Color32[_start.Length];
            for (int i = 0; i < colors.Length; ++i)
                colors[i] = new Color32((byte)i, (byte)(i >> 8), 90, 255);
            _surface.SetColors(colors);
            Settle();
            var sum = new double[Repetitions];
            var longest = new double[Repetitions];
            var latency = new double[Repetitions];
            long bytes = MeshRecord.AllBytesUploaded;
            for (int k = 0; k < Repetitions; ++k)
            {
                colors[(k + 1) * colors.Length / (Repetitions + 1)] = new Color32(255, 255, (byte)k, 255);
                long begin = Stopwatch.GetTimestamp();
                do
                {
                    long frame = Stopwatch.GetTimestamp();
                    if (frame - begin < Stopwatch.Frequency / 100000)
                        _surface.SetColors(colors);
                    Engine.Frame(Interval / 1000);
                    double milliseconds = Milliseconds(frame);
                    sum[k] += milliseconds;
                    longest[k] = Math.Max(longest[k], milliseconds);
                    latency[k] = Milliseconds(begin);
                    if (_surface.IsBusy)
                        Rest(milliseconds);
                } while (_surface.IsBusy);
            }
            Print("one atom recoloured, in all", sum);
            Print("  its longest frame", longest);
            Print("  until it is shown (not only the main thread)", latency);
            Console.WriteLine($"{_name}: {(MeshRecord.AllBytesUploaded - bytes) / 1e6 / Repetitions:F3} MB moved each");
        }

        private void Pick()
        {
            Bounds bounds = _surface.Mesh.bounds;
            var first = new double[3];
            for (int k = 0; k < first.Length; ++k)
            {
                _surface.SetPositions(_start);
                int shown = _shown;
                while (_shown == shown)
                    RestedFrame();
                Settle();
                first[k] = PickOnce(bounds);
            }
            Print("first pick after a surface", first);
            var later = new double[Frames];
            for (int k = 0; k < later.Length; ++k)
                later[k] = PickOnce(bounds);
            Print("later picks", later);
        }

        private double PickOnce(Bounds bounds)
        {
            var target = bounds.center + Vector3.Scale(bounds.extents, new Vector3(Signed(), Signed(), Signed()) * 0.7f);
            Vector3 from = bounds.center + new Vector3(Signed(), Signed(), Signed()) * (4 * bounds.extents.magnitude);
            long begin = Stopwatch.GetTimestamp();
            _surface.TryPick(new Ray(from, target - from), out _, out _);
            return Milliseconds(begin);
        }

        private void AskForOwners()
        {
            var loops = new double[Repetitions];
            int count = _surface.CurrentLevel.VertexCount;
            long sum = 0;
            for (int k = 0; k < Repetitions; ++k)
            {
                long begin = Stopwatch.GetTimestamp();
                for (int vertex = 0; vertex < count; ++vertex)
                    sum += _surface.OwnerAtomAt(vertex);
                loops[k] = Milliseconds(begin);
            }
            Print($"OwnerAtomAt of all vertices (mean {(double)sum / Math.Max(1, count) / Repetitions:F0})", loops);
        }

        // Until everything is shown, and buffers are those of a surface at rest.
        private List<double> Settle()
        {
            Stopwatch clock = Stopwatch.StartNew();
            var frames = new List<double>();
            do
            {
                if (clock.ElapsedMilliseconds > Patience)
                    throw new InvalidOperationException("still waiting");
                frames.Add(RestedFrame());
            } while (_surface.IsBusy);
            for (int k = 0; k < 40; ++k)
                frames.Add(RestedFrame());
            if (_surface.LastError.Status != QuickSesStatus.Ok)
                throw new InvalidOperationException(_surface.LastError.Message);
            return frames;
        }

        private static double RestedFrame()
        {
            long begin = Stopwatch.GetTimestamp();
            Engine.Frame(Interval / 1000);
            double milliseconds = Milliseconds(begin);
            Rest(milliseconds);
            return milliseconds;
        }

        private static void Rest(double spent) => Thread.Sleep((int)Math.Max(1, Interval - spent));

        private float Signed() => 2 * (float)_random.NextDouble() - 1;

        private static double Milliseconds(long since) =>
            (Stopwatch.GetTimestamp() - since) * 1000.0 / Stopwatch.Frequency;

        private void Print(string what, double[] values)
        {
            Array.Sort(values);
            Console.WriteLine($"{_name}: {what}: median {Quantile(values, 0.5):F3}, p99 {Quantile(values, 0.99):F3}, " +
                $"most {values[values.Length - 1]:F3}");
        }

        private static double Quantile(double[] sorted, double part) =>
            sorted[Math.Min(sorted.Length - 1, (int)(part * sorted.Length))];
    }
}
