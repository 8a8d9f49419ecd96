// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Diagnostics;
using System.IO;
using System.Text.RegularExpressions;
using QuickSes.EngineDouble;
using UnityEngine;

namespace QuickSes.Tests
{
    /// <summary>
    /// Playing for minutes: 10,000 surfaces of an NMR ensemble, without garbage on any thread and without growing
    /// memory, managed or native.
    /// </summary>
    internal sealed class PlaybackMemoryTest
    {
        private const int Surfaces = 10000;

        private static string Ensemble =>
            Path.Combine(Repository.Root, "Samples~", "TrajectoryPlayback", "2k39_ensemble.pdb.gz.bytes");

        [Test]
        public void TenThousandFramesFromAPlayerMakeNoGarbage()
        {
            string report = Play(Ensemble, Surfaces);
            Assert.That(Number(report, "surfaces"), Is.EqualTo(Surfaces));
            Assert.That(Number(report, "allocated_main_thread"), Is.EqualTo(0));
            Assert.That(Number(report, "allocated_all_threads"), Is.EqualTo(0));
            Assert.That(Number(report, "live_meshes"), Is.EqualTo(1));
            // Surfaces differ in size, and allocators keep some of what they are given back.
            Assert.That(Number(report, "native_heap_growth"), Is.LessThan(2 << 20));
            Assert.That(Number(report, "resident_growth"), Is.LessThan(16 << 20));
        }

        [Test]
        public void ManySurfacesOnFewContextsMakeNoGarbageEither()
        {
            const int Count = 12;
            var surfaces = new MolecularSurface[Count];
            var positions = new Vector3[Count][][];
            int updates = 0;
            for (int k = 0; k < Count; ++k)
            {
                TestMolecules.Blob(40 + 10 * k, k, out Vector3[] start, out float[] radii);
                positions[k] = new Vector3[8][];
                for (int frame = 0; frame < positions[k].Length; ++frame)
                    positions[k][frame] = TestMolecules.Moved(start, frame);
                surfaces[k] = new GameObject("surface " + k).AddComponent<MolecularSurface>();
                surfaces[k].SetAtoms(start, radii);
                surfaces[k].SurfaceUpdated += level => ++updates;
            }
            int frames = 0;
            Action step = () =>
            {
                ++frames;
                for (int k = 0; k < Count; ++k)
                    surfaces[k].SetPositions(positions[k][frames % positions[k].Length]);
                Engine.Frame(1 / 60.0);
            };
            while (updates < 1000)
                step();
            long allocated = GC.GetAllocatedBytesForCurrentThread();
            while (updates < 3000)
                step();
            Assert.That(GC.GetAllocatedBytesForCurrentThread() - allocated, Is.EqualTo(0));
        }

        // In a process of its own: see there.
        private static string Play(string file, int count)
        {
            string program = typeof(Playback.LongPlay).Assembly.Location;
            var start = new ProcessStartInfo("dotnet") { RedirectStandardOutput = true, RedirectStandardError = true };
            foreach (string argument in new[]
                { program, NativeLibrarySetup.LibraryPath, "frames", file, count.ToString() })
                start.ArgumentList.Add(argument);
            using (Process process = Process.Start(start))
            {
                var errors = process.StandardError.ReadToEndAsync();
                string output = process.StandardOutput.ReadToEnd();
                process.WaitForExit();
                Assert.That(process.ExitCode, Is.EqualTo(0), errors.Result);
                return output;
            }
        }

        private static long Number(string report, string name)
        {
            Match match = Regex.Match(report, $"(?m)^{name} (-?\\d+)$");
            Assert.That(match.Success, report);
            return long.Parse(match.Groups[1].Value);
        }
    }
}
