// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections.Generic;
using System.Diagnostics;
using System.Threading;
using UnityEngine;
using Object = UnityEngine.Object;

namespace QuickSes.Tests
{
    /// <summary>A player whose clock is the test's, and what it told.</summary>
    internal sealed class PlayerFixture : IDisposable
    {
        public readonly GameObject GameObject = new GameObject("molecule");
        public readonly TrajectoryPlayer Player;
        public readonly MolecularSurface Surface;
        public readonly List<int> Shown = new List<int>(10000);
        public readonly List<int> FailedFrames = new List<int>();
        public readonly List<string> Failures = new List<string>();
        public int Loads, Loops, Finishes;

        public PlayerFixture()
        {
            Player = GameObject.AddComponent<TrajectoryPlayer>();
            Surface = GameObject.GetComponent<MolecularSurface>();
            Player.PlayOnEnable = false;
            Player.Pause();
            Player.FrameShown += frame => Shown.Add(frame);
            Player.Loaded += () => ++Loads;
            Player.Looped += () => ++Loops;
            Player.Finished += () => ++Finishes;
            Player.Failed += (frame, error) =>
            {
                FailedFrames.Add(frame);
                Failures.Add(error.Message);
            };
        }

        /// <summary>What the surface was given last, in Unity's space.</summary>
        public Vector3[] Positions => Surface.Positions.ToArray();

        public void UseEnsemble(int frames) =>
            Player.StructureSource.SetAsset(new TextAsset(TestFrames.Pdb(frames)) { name = "ensemble.pdb" });

        public void UseStructure() =>
            Player.StructureSource.SetAsset(new TextAsset(TestFrames.Pdb(1)) { name = "structure.pdb" });

        /// <summary>Loads what is chosen, and waits until the first frame is shown.</summary>
        public void Load()
        {
            Assert.That(Player.Load(), Is.True, Player.LastError.ToString());
            TickUntil(() => Player.ShownFrame >= 0, "a frame is shown");
        }

        public void TickUntil(Func<bool> condition, string what)
        {
            Stopwatch waited = Stopwatch.StartNew();
            while (!condition())
            {
                if (waited.Elapsed.TotalSeconds > SurfaceRig.Patience)
                    Assert.Fail("waited in vain until {0}; {1}", what, Player.LastError);
                Player.Tick(0);
                Thread.Yield();
            }
        }

        public void WaitUntilShown(int frame) => TickUntil(() => Player.ShownFrame == frame, $"frame {frame} is shown");

        /// <summary>Lets time pass, then waits until what is due by then is shown.</summary>
        public void Pass(float seconds)
        {
            Player.Tick(seconds);
            TickUntil(() => !Player.IsWaiting, "the frame is there");
        }

        /// <summary>Plays, without garbage, until so many frames were shown.</summary>
        public void PlayUntilShown(int count)
        {
            long begin = Stopwatch.GetTimestamp();
            while (Shown.Count < count)
            {
                Player.Tick(0.04f);
                Thread.Yield(); // frames are read meanwhile
                if (Stopwatch.GetTimestamp() - begin > SurfaceRig.Patience * Stopwatch.Frequency)
                    throw new TimeoutException("waited in vain until frames are shown");
            }
        }

        public void AssertShows(int frame)
        {
            Assert.That(Player.ShownFrame, Is.EqualTo(frame));
            AssertAt(TestFrames.Frame(frame), 0);
        }

        /// <summary>Atoms are where the file has them, but for the water, and x is negated.</summary>
        public void AssertAt(Vector3[] file, float tolerance)
        {
            Vector3[] shown = Positions;
            Assert.That(shown.Length, Is.EqualTo(TestFrames.WithoutWater.Length));
            for (int i = 0; i < shown.Length; ++i)
            {
                Vector3 expected = file[TestFrames.WithoutWater[i]];
                Assert.That(shown[i].x, Is.EqualTo(-expected.x).Within(tolerance), "x of atom {0}", i);
                Assert.That(shown[i].y, Is.EqualTo(expected.y).Within(tolerance), "y of atom {0}", i);
                Assert.That(shown[i].z, Is.EqualTo(expected.z).Within(tolerance), "z of atom {0}", i);
            }
        }

        public void Dispose() => Object.DestroyImmediate(GameObject);
    }
}
