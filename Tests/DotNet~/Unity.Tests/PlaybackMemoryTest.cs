// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System.Diagnostics;
using System.IO;
using System.Text.RegularExpressions;

namespace QuickSes.Tests
{
    /// <summary>
    /// Playing for minutes: 10,000 surfaces of an NMR ensemble (with collections checks 1,000), without garbage on any
    /// thread and without growing memory, managed or native.
    /// </summary>
    internal sealed class PlaybackMemoryTest
    {
#if ENABLE_UNITY_COLLECTIONS_CHECKS
        private const int Surfaces = 1000;
#else
        private const int Surfaces = 10000;
#endif

        private static string Ensemble =>
            Path.Combine(Repository.Root, "Samples~", "TrajectoryPlayback", "2k39_ensemble.pdb.gz.bytes");

        [Test]
        public void FramesFromAPlayerMakeNoGarbage()
        {
            string report = PlayWithoutGarbage("frames", Ensemble, Surfaces.ToString());
            Assert.That(Number(report, "surfaces"), Is.EqualTo(Surfaces));
            Assert.That(Number(report, "live_meshes"), Is.InRange(1, 2), "one, and one for what does not fit into a frame");
            // Surfaces differ in size, some are kept while others are made, and allocators keep some of what they are
            // given back.
            Assert.That(Number(report, "native_heap_growth"), Is.LessThan(4 << 20));
            Assert.That(Number(report, "resident_growth"), Is.LessThan(16 << 20));
        }

        [Test]
        public void ManySurfacesOnFewContextsMakeNoGarbageEither()
        {
            const int Count = 12;
            string report = PlayWithoutGarbage("many", Count.ToString(), "3000");
            Assert.That(Number(report, "surfaces"), Is.GreaterThanOrEqualTo(3000));
            Assert.That(Number(report, "live_meshes"), Is.InRange(Count, 2 * Count));
        }

        private static string PlayWithoutGarbage(string mode, string what, string count)
        {
            string report = Play(mode, what, count);
            Assert.That(Number(report, "allocated_main_thread"), Is.Zero, report);
            Assert.That(Number(report, "allocated_all_threads"), Is.Zero, report);
            return report;
        }

        // In a process of its own: see there.
        private static string Play(string mode, string what, string count)
        {
            string program = typeof(Playback.LongPlay).Assembly.Location;
            var start = new ProcessStartInfo("dotnet") { RedirectStandardOutput = true, RedirectStandardError = true };
            foreach (string argument in new[] { program, NativeLibrarySetup.LibraryPath, mode, what, count })
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
