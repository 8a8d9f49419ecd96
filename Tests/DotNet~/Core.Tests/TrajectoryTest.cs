// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Globalization;
using System.IO;
using System.Linq;
using System.Text;

namespace QuickSes.Tests
{
    public sealed class TrajectoryTest
    {
        private const int FrameCount = 3, AtomCount = 4;

        // Thousandths of Å, as exact in PDB columns as in float32's nearest.
        private static float[] Frame(int k) =>
            Enumerable.Range(0, 3 * AtomCount).Select(i => (float)((1000 * k + 137 * i) / 1000m)).ToArray();

        private static byte[] Ensemble(string before = "", int shortFrame = -1)
        {
            var text = new StringBuilder(before);
            for (int k = 0; k < FrameCount; ++k)
            {
                text.Append($"MODEL     {k + 1,4}\n");
                float[] p = Frame(k);
                for (int i = 0; i < (k == shortFrame ? AtomCount - 1 : AtomCount); ++i)
                    text.Append(string.Format(CultureInfo.InvariantCulture,
                        "ATOM  {0,5}  CA  GLY A{1,4}    {2,8:F3}{3,8:F3}{4,8:F3}  1.00  0.00           C  \n",
                        i + 1, i + 1,
                        p[3 * i], p[3 * i + 1], p[3 * i + 2]));
                text.Append("ENDMDL\n");
            }
            return Encoding.ASCII.GetBytes(text.Append("END\n").ToString());
        }

        private static Trajectory Open(byte[] bytes)
        {
            Assert.That(
                Trajectory.TryOpen(bytes, TrajectoryFormat.Pdb, out Trajectory trajectory, out QuickSesError error),
                Is.True, error.ToString());
            return trajectory;
        }

        [Test]
        public void FramesComeInAnyOrder()
        {
            using Trajectory trajectory = Open(Ensemble());
            Assert.That((trajectory.FrameCount, trajectory.AtomCount, trajectory.Format),
                Is.EqualTo(((long)FrameCount, AtomCount, TrajectoryFormat.Pdb)));
            Assert.That(trajectory.HasBox || trajectory.IsIncomplete || trajectory.IsUnwrapped, Is.False);
            var positions = new float[3 * AtomCount];
            foreach (int k in new[] { 2, 0, 1, 2 })
            {
                Assert.That(trajectory.TryReadFrame(k, positions, out TrajectoryFrame frame, out QuickSesError error),
                    Is.True, error.ToString());
                Assert.That(positions, Is.EqualTo(Frame(k)));
                Assert.That(frame.HasBox, Is.False);
                Assert.That(frame.GetBoxVector(2), Is.EqualTo((0.0, 0.0, 0.0)));
            }
        }

        [Test]
        public void FileAndMemoryAreTheSame()
        {
            using var folder = new TemporaryFolder();
            File.WriteAllBytes(folder.File("ensemble.pdb"), Ensemble());
            Assert.That(Trajectory.TryOpen(folder.File("ensemble.pdb"), TrajectoryFormat.Auto,
                out Trajectory trajectory, out _), Is.True);
            using (trajectory)
            {
                var positions = new float[3 * AtomCount];
                Assert.That(trajectory.TryReadFrame(1, positions, out _, out _), Is.True);
                Assert.That(positions, Is.EqualTo(Frame(1)));
            }
        }

        [Test]
        public void BoxIsThatOfTheFile()
        {
            using Trajectory trajectory = Open(
                Ensemble("CRYST1   20.000   30.000   40.000  90.00  90.00  90.00 P 1           1\n"));
            Assert.That(trajectory.HasBox, Is.True);
            var positions = new float[3 * AtomCount];
            Assert.That(trajectory.TryReadFrame(1, positions, out TrajectoryFrame frame, out _), Is.True);
            Assert.That(frame.HasBox, Is.True);
            double[] edges = { 20, 30, 40 };
            for (int k = 0; k < 3; ++k)
            {
                (double x, double y, double z) = frame.GetBoxVector(k);
                Assert.That(new[] { x, y, z }[k], Is.EqualTo(edges[k]).Within(1e-6));
                Assert.That(Math.Abs(x) + Math.Abs(y) + Math.Abs(z), Is.EqualTo(edges[k]).Within(1e-6));
            }
            foreach (int none in new[] { -1, 3 })
                Assert.Throws<ArgumentOutOfRangeException>(() => frame.GetBoxVector(none));
            Assert.That(trajectory.TryUnwrap(Enumerable.Repeat((byte)6, AtomCount).ToArray(), out QuickSesError error),
                Is.True, error.ToString());
            Assert.That(trajectory.IsUnwrapped, Is.True);
        }

        [Test]
        public void NothingToUnwrapIsTold()
        {
            using Trajectory trajectory = Open(Ensemble());
            Assert.That(trajectory.TryUnwrap(new byte[AtomCount], out QuickSesError error), Is.False);
            Assert.That(error.Status, Is.EqualTo(QuickSesStatus.NoBox));
            Assert.That(error.Message, Is.Not.Empty);
            Assert.That(trajectory.IsUnwrapped, Is.False);
            Assert.That(() => trajectory.TryUnwrap(new byte[1], out _), Throws.ArgumentException);
        }

        [Test]
        public void FramesBeforeAFaultAreGiven()
        {
            byte[] whole = Ensemble();
            using Trajectory trajectory = Open(whole.AsSpan(0, whole.Length - 150).ToArray());
            Assert.That(trajectory.IsIncomplete, Is.True);
            Assert.That(trajectory.FrameCount, Is.EqualTo(2));
            Assert.That(trajectory.WarningCount, Is.Positive);
            Assert.That(trajectory.GetWarning(0), Is.Not.Empty);
            Assert.That(Assert.Throws<QuickSesException>(() => trajectory.GetWarning(trajectory.WarningCount)).Status,
                Is.EqualTo(QuickSesStatus.InvalidArgument));
        }

        [Test]
        public void FaultsAreNamed()
        {
            Assert.That(Trajectory.TryOpen("/no/such.dcd", TrajectoryFormat.Auto, out Trajectory trajectory,
                out QuickSesError error), Is.False);
            Assert.That(trajectory, Is.Null);
            Assert.That(error.Status, Is.EqualTo(QuickSesStatus.FileError));
            Assert.That(error.Message, Does.Contain("/no/such.dcd"));
            Assert.That(Trajectory.TryOpen(ReadOnlySpan<byte>.Empty, TrajectoryFormat.Dcd, out _, out error), Is.False);
            Assert.That(error.Status, Is.EqualTo(QuickSesStatus.FileError));

            Assert.That(Trajectory.TryOpen(Ensemble(shortFrame: 1), TrajectoryFormat.Pdb, out _, out error), Is.False);
            Assert.That(error.Status, Is.EqualTo(QuickSesStatus.FileError));
            Assert.That(error.Message, Does.Contain("frame 1 has 3 atoms"));

            trajectory = Open(Ensemble());
            var positions = new float[3 * AtomCount];
            Assert.That(() => trajectory.TryReadFrame(FrameCount, positions, out _, out _),
                Throws.TypeOf<ArgumentOutOfRangeException>());
            Assert.That(() => trajectory.TryReadFrame(-1, positions, out _, out _),
                Throws.TypeOf<ArgumentOutOfRangeException>());
            Assert.That(() => trajectory.TryReadFrame(0, new float[3], out _, out _), Throws.ArgumentException);
            trajectory.Dispose();
            Assert.That(() => trajectory.TryReadFrame(0, positions, out _, out _),
                Throws.TypeOf<ObjectDisposedException>());
        }
    }
}
