// SPDX-License-Identifier: MIT
using NUnit.Framework;
using System;
using System.Collections;
using System.Collections.Generic;
using System.Diagnostics;
using UnityEngine;
using Object = UnityEngine.Object;

namespace QuickSes.Tests
{
    /// <summary>A surface in the scene, and what it has told.</summary>
    internal sealed class SurfaceRig : IDisposable
    {
        public const double Patience = 150; // s

        public readonly GameObject GameObject;
        public readonly MolecularSurface Surface;
        public readonly List<SurfaceLevel> Levels = new List<SurfaceLevel>();
        public readonly List<QuickSesError> Failures = new List<QuickSesError>();
        public int Finished;
        public int Requests;

        public SurfaceRig(string name = "surface", Transform parent = null)
        {
            Assert.That(MolecularSurface.IsSupported(out string reason), reason);
            GameObject = new GameObject(name);
            GameObject.transform.SetParent(parent, false);
            Surface = GameObject.AddComponent<MolecularSurface>();
            Surface.SurfaceUpdated += level => Levels.Add(level);
            Surface.Failed += error => Failures.Add(error);
            Surface.RefinementFinished += () => ++Finished;
            Surface.AtomsRequested += () => ++Requests;
        }

        public static SurfaceRig WithBlob(int atoms, int seed)
        {
            var rig = new SurfaceRig();
            TestMolecules.Blob(atoms, seed, out Vector3[] positions, out float[] radii);
            rig.Surface.SetAtoms(positions, radii);
            return rig;
        }

        /// <summary>Frames until nothing is left to do.</summary>
        public IEnumerator Settle() => Until(() => !Surface.IsBusy);

        public static IEnumerator Until(Func<bool> condition)
        {
            Stopwatch clock = Stopwatch.StartNew();
            do
            {
                Assert.That(clock.Elapsed.TotalSeconds, Is.LessThan(Patience), "still waiting");
                yield return null;
            } while (!condition());
        }

        public static IEnumerator Frames(int count)
        {
            for (int i = 0; i < count; ++i)
                yield return null;
        }

        public void Dispose()
        {
            if (GameObject != null)
                Object.DestroyImmediate(GameObject);
        }
    }
}
