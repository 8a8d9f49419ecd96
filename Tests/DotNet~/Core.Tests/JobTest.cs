// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.IO;
using System.Linq;
using System.Reflection;
using System.Runtime.CompilerServices;
using System.Runtime.InteropServices;
using System.Threading;

namespace QuickSes.Tests
{
    public sealed class JobTest
    {
        // Long enough for one core (most of a minute) that it never ends before the next statement.
        private static SurfaceSettings LongWork
        {
            get
            {
                SurfaceSettings settings = SurfaceSettings.Default;
                settings.Spacing = 0.04f;
                settings.RelaxationSteps = 100;
                settings.SetLevels(default);
                return settings;
            }
        }

        private static SurfaceContext ContextOfOneCore()
        {
            using Structure structure = Meshes.Crambin();
            return Meshes.ContextOf(structure, new SurfaceContextOptions { Backend = SurfaceBackend.Cpu, Threads = 1 });
        }

        [Test]
        public void LevelsComeCoarseFirstWithTheirFrame()
        {
            using SurfaceContext context = Meshes.CrambinContext();
            context.Poll(out SurfaceProgress progress);
            Assert.That(progress.State, Is.EqualTo(SurfaceJobState.Idle));
            Assert.That(context.TryCollect(out SurfaceMeshView mesh), Is.False);
            Assert.That(mesh.VertexCount, Is.Zero);

            SurfaceSettings settings = SurfaceSettings.Default;
            settings.Tag = 7;
            settings.Spacing = 0.25f;
            settings.SetLevels(new[] { 2f, 1f, 0.5f });
            Assert.That(context.Begin(settings), Is.EqualTo(QuickSesStatus.Ok));
            int lastLevel = -1;
            bool finished;
            do
            {
                finished = context.Wait(1);
                while (context.TryCollect(out mesh))
                {
                    Assert.That(mesh.Tag, Is.EqualTo(7));
                    Assert.That(mesh.LevelCount, Is.EqualTo(4));
                    Assert.That(mesh.Level, Is.GreaterThan(lastLevel));
                    Assert.That(mesh.Spacing,
                        Is.EqualTo(mesh.Level == 3 ? settings.Spacing : settings.GetLevel(mesh.Level)));
                    Assert.That(Meshes.IsClosed(mesh.Indices), Is.True);
                    lastLevel = mesh.Level;
                }
            } while (!finished);
            Assert.That(lastLevel, Is.EqualTo(3));
            context.Poll(out progress);
            Assert.That(progress.State, Is.EqualTo(SurfaceJobState.Finished));
            Assert.That(progress.Fraction, Is.EqualTo(1));
            Assert.That((progress.LevelsFinished, progress.LevelCount), Is.EqualTo((4, 4)));
            Assert.That(progress.IsMeshReady, Is.False, "it was collected");
            Assert.That(progress.Message, Is.Empty);
        }

        [Test]
        public void SeriesOfOneContextKeepWhatTheyLearnt()
        {
            bool[] isFinest;
            int attempts = 0;
            while (!TryLearnLevels(out isFinest))
                Assert.That(++attempts, Is.LessThan(20));
            Assert.That(isFinest, Is.EqualTo(new[] { false, false, true, true, true, true }));
        }

        // Whether each frame was of the finest level, or else of the coarsest. False: the machine stood still in one of the
        // coarsest, so that finer ones seem to cost more than fits.
        private static bool TryLearnLevels(out bool[] isFinest)
        {
            isFinest = new bool[6];
            bool isLearnt = true;
            using Structure structure = Meshes.Crambin();
            using SurfaceContext context = Meshes.ContextOf(structure);
            SurfaceSettings settings = SurfaceSettings.Default;
            settings.FrameBudget = 60000; // everything fits, but for what is not known yet
            for (int frame = 0; frame < isFinest.Length; ++frame)
            {
                int atoms = frame % 2 == 0 ? structure.AtomCount : structure.AtomCount / 2;
                context.SetAtoms(structure.Positions.Slice(0, 3 * atoms), structure.Radii.Slice(0, atoms));
                settings.Series = (uint)(frame % 2);
                Stopwatch clock = Stopwatch.StartNew();
                context.Begin(settings);
                context.Wait();
                bool tookLong = clock.Elapsed.TotalSeconds > 2;
                Assert.That(context.TryCollect(out SurfaceMeshView mesh), Is.True);
                isFinest[frame] = mesh.Level == mesh.LevelCount - 1;
                Assert.That(isFinest[frame] || mesh.Level == 0 || !isLearnt);
                if (mesh.Level == 0 && tookLong)
                    isLearnt = false;
            }
            return isLearnt;
        }

        [Test]
        public void CollectedMeshIsTheComputedOne()
        {
            using SurfaceContext context = Meshes.CrambinContext();
            SurfaceSettings settings = SurfaceSettings.Default;
            context.Begin(settings);
            Assert.That(context.Wait(), Is.True);
            Assert.That(context.TryCollect(out SurfaceMeshView collected), Is.True);
            float[] positions = collected.Positions.ToArray();
            uint[] indices = collected.Indices.ToArray();
            using SurfaceContext other = Meshes.CrambinContext();
            SurfaceMeshView computed = Meshes.Compute(other, settings);
            Assert.That(computed.Indices.SequenceEqual(indices), Is.True);
            Assert.That(computed.Positions.Length, Is.EqualTo(positions.Length));
            for (int i = 0; i < positions.Length; ++i) // levels share an origin, and so round otherwise
                Assert.That(computed.Positions[i], Is.EqualTo(positions[i]).Within(1e-3f));
        }

        [Test]
        public void NewestFrameIsCollectedInTheEnd()
        {
            using SurfaceContext context = Meshes.CrambinContext();
            SurfaceSettings settings = SurfaceSettings.Default;
            uint lastFrame = 0;
            for (uint frame = 1; frame <= 50; ++frame)
            {
                settings.Tag = frame;
                context.Begin(settings);
                if (frame < 50 && context.TryCollect(out SurfaceMeshView early)) // the last one is collected below
                {
                    Assert.That(early.Tag, Is.InRange(lastFrame, frame), "frames never run backwards");
                    lastFrame = early.Tag;
                }
            }
            context.Wait();
            Assert.That(context.TryCollect(out SurfaceMeshView mesh), Is.True);
            Assert.That((mesh.Tag, mesh.Level), Is.EqualTo((50u, mesh.LevelCount - 1)));
            context.Poll(out SurfaceProgress progress);
            Assert.That((progress.Tag, progress.TagRequested), Is.EqualTo((50u, 50u)));
        }

        [Test]
        public void CollectedMeshOutlivesFurtherJobs()
        {
            using SurfaceContext context = Meshes.CrambinContext();
            SurfaceSettings settings = SurfaceSettings.Default;
            context.Begin(settings);
            context.Wait();
            context.TryCollect(out SurfaceMeshView mesh);
            float[] before = mesh.Positions.ToArray();
            settings.ProbeRadius = 3;
            context.Begin(settings);
            context.Wait();
            Assert.That(mesh.IsValid, Is.True);
            Assert.That(mesh.Positions.SequenceEqual(before), Is.True);
            Assert.That(context.TryCollect(out SurfaceMeshView next), Is.True);
            Assert.That(mesh.IsValid, Is.False);
            Assert.That(next.Positions.SequenceEqual(before), Is.False);
        }

        [Test]
        public void CancelledJobLeavesTheContextUsable()
        {
            using SurfaceContext context = ContextOfOneCore();
            context.Begin(LongWork);
            context.Cancel();
            Assert.That(context.Wait(), Is.True);
            context.Poll(out SurfaceProgress progress);
            Assert.That(progress.State, Is.EqualTo(SurfaceJobState.Cancelled));
            Meshes.Compute(context, SurfaceSettings.Default);
        }

        [Test]
        public void FailedJobKeepsTheLastMesh()
        {
            using Structure structure = Meshes.Crambin();
            using var context = new SurfaceContext(new SurfaceContextOptions
            {
                Backend = SurfaceBackend.Cpu, MemoryBudget = 4 << 20, Threads = 2
            });
            context.SetAtoms(structure.Positions, structure.Radii);
            SurfaceSettings settings = SurfaceSettings.Default;
            settings.Spacing = 2;
            SurfaceMeshView mesh = Meshes.Compute(context, settings);
            Assert.That(context.Begin(LongWork), Is.EqualTo(QuickSesStatus.Ok));
            context.Wait();
            context.Poll(out SurfaceProgress progress);
            Assert.That(progress.State, Is.EqualTo(SurfaceJobState.Failed));
            Assert.That(progress.Status, Is.EqualTo(QuickSesStatus.OutOfMemory));
            Assert.That(progress.Message, Does.Contain("budget"));
            Assert.That(context.TryCollect(out _), Is.False);
            Assert.That(mesh.IsValid, Is.True);
            Assert.That(Meshes.IsClosed(mesh.Indices), Is.True);
        }

        [Test]
        public void ThreadsThatComputeStandBackIfAskedTo([Values] bool isBackground)
        {
            if (!RuntimeInformation.IsOSPlatform(OSPlatform.Linux))
                Assert.Ignore("what follows is how Linux tells the priorities of threads");
            Dictionary<string, int> before = NicenessOfThreads();
            int own = before[Process.GetCurrentProcess().Id.ToString()];
            if (own == 19)
                Assert.Ignore("nothing can stand back behind this process");
            using var context = new SurfaceContext(
                new SurfaceContextOptions { Backend = SurfaceBackend.Cpu, Threads = 2, Background = isBackground });
            context.SetAtoms(new float[3], new[] { 1.5f });
            Assert.That(context.Begin(SurfaceSettings.Default), Is.EqualTo(QuickSesStatus.Ok));
            context.Wait();
            Assert.That(NicenessOfThreads().Any(thread => !before.ContainsKey(thread.Key) && thread.Value > own),
                Is.EqualTo(isBackground));
        }

        // By their numbers. One that ends meanwhile has none.
        private static Dictionary<string, int> NicenessOfThreads()
        {
            var found = new Dictionary<string, int>();
            foreach (string folder in Directory.GetDirectories("/proc/self/task"))
            {
                try
                {
                    string stat = File.ReadAllText(Path.Combine(folder, "stat"));
                    string behindName = stat.Substring(stat.LastIndexOf(')') + 2);
                    found.Add(Path.GetFileName(folder), int.Parse(behindName.Split(' ')[16])); // see proc(5)
                }
                catch (IOException)
                {
                }
            }
            return found;
        }

        [Test]
        public void DisposeEndsARunningJob()
        {
            SurfaceContext context = ContextOfOneCore();
            SurfaceMeshView mesh = Meshes.Compute(context, SurfaceSettings.Default);
            context.Begin(LongWork);
            context.Dispose();
            context.Dispose();
            Assert.That(mesh.IsValid, Is.False);
            Assert.That(() => mesh.Positions.Length, Throws.TypeOf<ObjectDisposedException>());
            Assert.That(() => context.Poll(out _), Throws.TypeOf<ObjectDisposedException>());
            Assert.That(() => context.Begin(SurfaceSettings.Default), Throws.TypeOf<ObjectDisposedException>());
            Assert.That(() => context.TryCollect(out _), Throws.TypeOf<ObjectDisposedException>());
            Assert.That(() => context.SetPositions(new float[981]), Throws.TypeOf<ObjectDisposedException>());
            Assert.That(() => context.Cancel(), Throws.TypeOf<ObjectDisposedException>());
        }

        [Test]
        public void DisposeEndsAComputationOnAnotherThread()
        {
            SurfaceContext context = ContextOfOneCore();
            QuickSesStatus status = QuickSesStatus.Ok;
            var thread = new Thread(() => status = context.Compute(LongWork, out _));
            thread.Start();
            SurfaceProgress progress;
            do
                context.Poll(out progress);
            while (progress.State != SurfaceJobState.Running && thread.IsAlive);
            context.Dispose();
            thread.Join();
            Assert.That(status, Is.EqualTo(QuickSesStatus.Cancelled));
        }

        [Test]
        public void AbandonedContextsAreFreedByTheirFinalizers()
        {
            WeakReference handle = OnAnotherThread(Abandon);
            bool isAlive = true;
            for (int i = 0; i < 10 && isAlive; ++i)
            {
                GC.Collect();
                GC.WaitForPendingFinalizers();
                isAlive = OnAnotherThread(() => handle.IsAlive);
            }
            Assert.That(isAlive, Is.False);
        }

        // Mono's collectors take what is left on a stack for a reference, and to ask whether something is alive leaves one.
        private static T OnAnotherThread<T>(Func<T> function)
        {
            T result = default;
            var thread = new Thread(() => result = function());
            thread.Start();
            thread.Join();
            return result;
        }

        // A weak reference that lasts until the finalizer, which frees the native context, is done.
        [MethodImpl(MethodImplOptions.NoInlining)]
        private static WeakReference Abandon()
        {
            SurfaceContext context = ContextOfOneCore();
            context.Begin(LongWork);
            FieldInfo handle = typeof(SurfaceContext).GetField("_handle",
                BindingFlags.Instance | BindingFlags.NonPublic);
            return new WeakReference(handle.GetValue(context), trackResurrection: true);
        }
    }
}
