// SPDX-License-Identifier: MIT
using System;
using UnityEngine;

namespace QuickSes
{
    /// <summary>
    /// A surface and those atoms of a trajectory's structure that it is of, from when they are read until the player
    /// lets go of them. Main thread only.
    /// </summary>
    internal sealed class PlayedAtoms : IDisposable
    {
        private readonly LoadedStructure _loaded;
        private readonly MoleculeSource _surfaceSource;
        private readonly Action _onAsked;

        /// <param name="surface">
        /// Which gets the atoms, now and whenever it asks. It may be destroyed at any time, also before.
        /// </param>
        /// <param name="loaded">Taken over.</param>
        /// <param name="surfaceSource">The surface's source, as it was read; null: they are of another one.</param>
        /// <param name="onAsked">The surface asked, and got the atoms where the structure has them.</param>
        public PlayedAtoms(
            MolecularSurface surface, LoadedStructure loaded, MoleculeSource surfaceSource, Action onAsked)
        {
            Surface = surface;
            _loaded = loaded;
            _surfaceSource = surfaceSource;
            _onAsked = onAsked;
            SendAtoms();
            Surface.AtomsRequested += Answer;
        }

        public MolecularSurface Surface { get; }

        public Structure Structure => _loaded.Structure;

        public int Count => _loaded.Positions.Length;

        /// <summary>Whether the surface has these atoms, or is gone.</summary>
        public bool IsInPlace => Surface == null || Surface.AtomCount == Count;

        /// <summary>N positions; the atoms come first if somebody else gave the surface others.</summary>
        public void SendPositions(ReadOnlySpan<Vector3> positions)
        {
            if (!IsInPlace)
                SendAtoms();
            if (Surface != null)
                Surface.SetPositions(positions);
        }

        public void SendColors(AtomColorScheme colorScheme)
        {
            _loaded.Color(colorScheme);
            if (!IsInPlace)
                SendAtoms();
            else if (Surface != null)
                Surface.ColorAtomsOf(_loaded);
        }

        public void Dispose()
        {
            Surface.AtomsRequested -= Answer;
            Surface.GiveBackStructure(Structure, _surfaceSource);
            _loaded.DisposeInBackground();
        }

        private void SendAtoms()
        {
            if (Surface != null)
                Surface.SetAtomsOf(_loaded);
        }

        private void Answer()
        {
            SendAtoms();
            _onAsked();
        }
    }
}
