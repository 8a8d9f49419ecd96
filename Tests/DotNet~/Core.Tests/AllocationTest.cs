// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.IO;
using System.Linq;

namespace QuickSes.Tests
{
    /// <summary>Frames make no garbage on the thread that asks for them.</summary>
    public sealed class AllocationTest
    {
        private sealed class Player : IDisposable
        {
            public readonly SurfaceContext Context;
            public int Collected;
            private readonly float[] _positions;
            private readonly uint[] _indices;
            private readonly byte[] _colors, _visible;
            private readonly Trajectory _trajectory;
            private SurfaceSettings _settings = SurfaceSettings.Default;

            public Player()
            {
                using Structure structure = Meshes.Crambin();
                Context = Meshes.ContextOf(structure);
                Assert.That(Trajectory.TryOpen(File.ReadAllBytes(Repository.CrambinPath), TrajectoryFormat.Pdb,
                    out _trajectory, out _), Is.True);
                _positions = new float[3 * _trajectory.AtomCount];
                _indices = structure.FileIndices.ToArray();
                _colors = new byte[4 * structure.AtomCount];
                _visible = Enumerable.Repeat((byte)1, structure.AtomCount).ToArray();
                _settings.Spacing = 1;
                _settings.VertexLayout = SurfaceVertexLayout.Interleaved;
                _settings.Components = true;
            }

            public void PlayFrame(uint frame)
            {
                if (!_trajectory.TryReadFrame(0, _positions, out _, out _))
                    throw new InvalidOperationException("the frame can't be read");
                _positions[0] += 0.01f * (frame % 7);
                _colors[0] = _visible[0] = (byte)(frame % 2);
                Context.SetColors(_colors);
                Context.SetVisible(_visible);
                if (frame % 2 == 0)
                    Context.SetPositions(_positions);
                else
                    Context.SetPositions(_positions, _indices);
                _settings.Tag = frame;
                Context.Begin(_settings);
                Context.Poll(out SurfaceProgress progress);
                Collect();
                Context.Wait();
                Collect();
                if (progress.TagRequested != frame)
                    throw new InvalidOperationException("the job was not begun");
            }

            private void Collect()
            {
                if (Context.TryCollect(out SurfaceMeshView mesh) && mesh.Vertices.Length > 0 &&
                    mesh.Indices.Length > 0 && mesh.Components.Length > 0)
                    ++Collected;
            }

            public void Dispose()
            {
                Context.Dispose();
                _trajectory.Dispose();
            }
        }

        [Test]
        public void FramesMakeNoGarbage()
        {
            using var player = new Player();
            for (uint frame = 0; frame < 200; ++frame) // the just-in-time compiler, and memory that grows
                player.PlayFrame(frame);
            player.Collected = 0;
            long before = GC.GetAllocatedBytesForCurrentThread();
            for (uint frame = 0; frame < 1000; ++frame)
                player.PlayFrame(frame);
            long allocated = GC.GetAllocatedBytesForCurrentThread() - before;
            Assert.That(player.Collected, Is.GreaterThanOrEqualTo(1000));
            Assert.That(allocated, Is.Zero);
        }

        [Test]
        public void GarbageWouldBeSeen()
        {
            long before = GC.GetAllocatedBytesForCurrentThread();
            GC.KeepAlive(new object());
            Assert.That(GC.GetAllocatedBytesForCurrentThread() - before, Is.Positive);
        }
    }
}
