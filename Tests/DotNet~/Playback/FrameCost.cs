// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using System;
using System.Diagnostics;
using System.IO;
using System.Threading;
using UnityEngine;

namespace QuickSes.Playback
{
    /// <summary>
    /// What a frame costs the main thread: feeding positions, and taking a surface into the mesh. The mesh is the
    /// double's, whose copies are plain copies in memory: the engine's own work on the GPU's side comes on top.
    /// </summary>
    internal static class FrameCost
    {
        private const int Surfaces = 30;

        /// <summary>false: the file can't be read; the log says why.</summary>
        public static bool TryPrint(string file) => TryPrint(file, false) && TryPrint(file, true);

        private static bool TryPrint(string file, bool padBuffers)
        {
            Engine.Reset();
            Engine.ChecksMeshes = false;
            var surface = new GameObject("surface").AddComponent<MolecularSurface>();
            surface.FrameBudget = 0;
            surface.Levels = Array.Empty<float>(); // the finest only
            surface.PadBuffers = padBuffers;
            surface.Source.SetFile(file);
            if (!surface.LoadSource())
            {
                Console.Error.WriteLine(surface.LastError.Message);
                return false;
            }
            var positions = new Vector3[surface.AtomCount];
            var start = new Vector3[surface.AtomCount];
            using (Structure structure = Open(surface))
                UnitySpace.FromFile(structure.Positions, start);
            bool hasArrived = false;
            surface.SurfaceUpdated += level => hasArrived = true;
            var feed = new double[Surfaces];
            var begin = new double[Surfaces];
            var arrival = new double[Surfaces];
            var upload = new double[Surfaces];
            var random = new System.Random(1);
            for (int k = -3; k < Surfaces; ++k)
            {
                for (int i = 0; i < positions.Length; ++i)
                    positions[i] = start[i] + new Vector3((float)random.NextDouble() * 0.1f, 0, 0);
                hasArrived = false;
                long t0 = Stopwatch.GetTimestamp();
                surface.SetPositions(positions);
                long t1 = Stopwatch.GetTimestamp();
                Engine.Frame(1 / 60.0);
                long t2 = Stopwatch.GetTimestamp(), t3 = t2;
                while (!hasArrived)
                {
                    Thread.Sleep(1);
                    t3 = Stopwatch.GetTimestamp();
                    Engine.Frame(1 / 60.0);
                }
                long t4 = Stopwatch.GetTimestamp();
                if (k < 0)
                    continue;
                feed[k] = Milliseconds(t0, t1);
                begin[k] = Milliseconds(t1, t2);
                arrival[k] = Milliseconds(t3, t4);
                upload[k] = surface.CurrentLevel.UploadMilliseconds;
            }
            Console.WriteLine($"{Path.GetFileName(file)}: {positions.Length} atoms, " +
                $"{surface.CurrentLevel.VertexCount} vertices, buffers {(padBuffers ? "padded" : "exact")}, " +
                $"{surface.UsedBackend}: median/max ms of {Surfaces}: SetPositions {Summary(feed)}, " +
                $"frame that begins {Summary(begin)}, frame that shows {Summary(arrival)}, " +
                $"of that upload {Summary(upload)}");
            Engine.Quit();
            return true;
        }

        private static Structure Open(MolecularSurface surface) =>
            surface.Source.TryOpen(out Structure structure, out QuickSesError error)
                ? structure
                : throw new InvalidOperationException(error.Message);

        private static double Milliseconds(long from, long to) => (to - from) * 1000.0 / Stopwatch.Frequency;

        private static string Summary(double[] values)
        {
            Array.Sort(values);
            return $"{values[values.Length / 2]:F3}/{values[values.Length - 1]:F3}";
        }
    }
}
