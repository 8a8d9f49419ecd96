// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Reflection;
using System.Threading;
using UnityEngine;

namespace QuickSes.Tests
{
    /// <summary>Threads that read, where nobody waits for them any more.</summary>
    internal sealed class BackgroundThreadTest
    {
        private const int Patience = 150000; // ms
        private const BindingFlags Hidden = BindingFlags.Instance | BindingFlags.Static | BindingFlags.NonPublic;

        /// <summary>One that stays until it is told to leave.</summary>
        private sealed class Waiting : BackgroundThread
        {
            private readonly ManualResetEventSlim _isSentAway = new ManualResetEventSlim();
            private volatile bool _isRunning;

            public Waiting() : base("waits")
            {
                Start();
            }

            public bool IsRunning => _isRunning;

            public override void SendAway() => _isSentAway.Set();

            protected override void Run()
            {
                _isRunning = true;
                _isSentAway.Wait();
                _isRunning = false;
            }
        }

        [Test]
        public void WhenTheDomainEndsAllHaveLeftAndNoMoreBegin()
        {
            var waiting = new[] { new Waiting(), new Waiting() };
            foreach (Waiting each in waiting)
                Assert.That(() => each.IsRunning, Is.True.After(Patience, 1));
            LoadedStructure loaded = Load();
            Structure structure = loaded.Structure;
            bool wasEnding = BackgroundThread.IsDomainEnding;
            try
            {
                BackgroundThread.EndAll();
                foreach (Waiting each in waiting)
                    Assert.That(each.HasLeft && !each.IsRunning, Is.True);
                Assert.That(BackgroundThread.IsDomainEnding, Is.True);
                loaded.DisposeInBackground();
                Assert.That(structure.IsDisposed, Is.True, "at once: a thread could outlive the domain");
            }
            finally
            {
                typeof(BackgroundThread).GetProperty(nameof(BackgroundThread.IsDomainEnding))
                    .GetSetMethod(true).Invoke(null, new object[] { wasEnding });
            }
        }

        [Test]
        public void WhatWasReadAndThenCancelledIsLetGo()
        {
            var rig = new SurfaceRig();
            rig.Surface.Source.SetAsset(new TextAsset(TestFrames.Pdb(1)) { name = "small.pdb" });
            rig.Surface.BeginLoadSource();
            StructureLoad load = AssertReads(typeof(MolecularSurface).GetField("_load", Hidden).GetValue(rig.Surface));
            FieldInfo field = typeof(StructureLoad).GetField("_structures", Hidden);
            Structure structure = ((LoadedStructure[])field.GetValue(load))[0].Structure;
            Assert.That(structure.IsDisposed, Is.False);
            rig.Surface.CancelLoading();
            Assert.That(load.TryTake(out _, out _), Is.False);
            BackgroundThread.SendAllAway(); // which dispose of it
            Assert.That(structure.IsDisposed, Is.True);
            Assert.That(rig.Surface.IsLoading, Is.False);
            rig.Dispose();
        }

        [Test]
        public void WhereNoThreadCanBeStartedThatIsToldAndNothingIsLeftOpen()
        {
            Action<Thread> starter = BackgroundThread.Starter;
            LoadedStructure loaded = Load();
            Structure structure = loaded.Structure;
            var playing = new PlayerFixture();
            try
            {
                playing.UseEnsemble(3);
                Assert.That(playing.Player.Load(), Is.True);
                AssertReads(typeof(TrajectoryPlayer).GetField("_load", Hidden).GetValue(playing.Player));
                BackgroundThread.Starter = thread => throw new OutOfMemoryException("no threads left");
                playing.TickUntil(() => playing.Failures.Count > 0, "it fails");
                Assert.That(playing.Failures, Is.EqualTo(new[] { "trajectory: no threads left" }));
                Assert.That(playing.Player.IsLoading, Is.False);
                Structure played = playing.Player.Structure;
                playing.Player.enabled = false; // which lets go of the structure
                Assert.That(played.IsDisposed);
                loaded.DisposeInBackground();
                Assert.That(structure.IsDisposed);
                playing.Player.enabled = true;
                Assert.That(playing.Player.Load(), Is.True);
                playing.TickUntil(() => playing.Failures.Count > 1, "it fails");
                Assert.That(playing.Failures[1], Is.EqualTo("structure: no threads left"));
            }
            finally
            {
                BackgroundThread.Starter = starter;
                playing.Dispose();
            }
        }

        // Without frames, in which its owner would take what was read.
        private static StructureLoad AssertReads(object load)
        {
            Assert.That(() => ((StructureLoad)load).Tick(), Is.True.After(Patience, 1));
            return (StructureLoad)load;
        }

        private static LoadedStructure Load()
        {
            var source = new MoleculeSource();
            source.SetAsset(new TextAsset(TestFrames.Pdb(1)) { name = "small.pdb" });
            Assert.That(source.TryFind(out MoleculeFile file, out QuickSesError error), Is.True, error.Message);
            var load = new StructureLoad(file, source);
            load.RunHere();
            Assert.That(load.TryTake(out LoadedStructure[] structures, out error), Is.True, error.Message);
            file.Dispose();
            return structures[0];
        }
    }
}
