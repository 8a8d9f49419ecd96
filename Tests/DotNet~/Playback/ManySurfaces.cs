// SPDX-License-Identifier: MIT
using QuickSes.EngineDouble;
using QuickSes.Tests;
using System;
using UnityEngine;

namespace QuickSes.Playback
{
    /// <summary>Surfaces that move in every frame and share fewer contexts, and what that takes.</summary>
    internal static class ManySurfaces
    {
        private const int FewestAtoms = 40, MostAtoms = 150, Frames = 8;

        /// <summary>Prints what <see cref="Measurement"/> prints.</summary>
        public static void Run(int surfaceCount, int count)
        {
            Engine.Reset();
            var surfaces = new MolecularSurface[surfaceCount];
            var positions = new Vector3[surfaceCount][][];
            int shown = 0, frame = 0;
            for (int k = 0; k < surfaceCount; ++k)
            {
                int atoms = FewestAtoms + (MostAtoms - FewestAtoms) * k / Math.Max(1, surfaceCount - 1);
                TestMolecules.Blob(atoms, k, out Vector3[] start, out float[] radii);
                positions[k] = new Vector3[Frames][];
                for (int i = 0; i < Frames; ++i)
                    positions[k][i] = TestMolecules.Moved(start, i);
                surfaces[k] = new GameObject("surface " + k).AddComponent<MolecularSurface>();
                surfaces[k].SurfaceUpdated += level => ++shown;
                surfaces[k].Failed += error => throw new InvalidOperationException(error.Message);
                surfaces[k].SetAtoms(start, radii);
            }
            Action step = () =>
            {
                ++frame;
                for (int k = 0; k < surfaces.Length; ++k)
                    surfaces[k].SetPositions(positions[k][frame % Frames]);
                Engine.Frame(1 / 60.0);
            };
            Measurement.Print(count, step, () => shown);
            Engine.Quit();
        }
    }
}
