// SPDX-License-Identifier: MIT
using NUnit.Framework;
using QuickSes.Editor;
using System.Collections.Generic;
using UnityEngine;

namespace QuickSes.Tests
{
    /// <summary>GameObjects of a test, destroyed after it.</summary>
    internal sealed class CreatedSurfaces
    {
        private readonly List<GameObject> _made = new List<GameObject>();

        public T Keep<T>(T component) where T : Component
        {
            _made.Add(component.gameObject);
            return component;
        }

        /// <summary>One of two atoms, computed.</summary>
        public MolecularSurface MakeComputed()
        {
            MolecularSurface surface = Keep(SurfaceCreator.CreateEmpty(null));
            GiveAtoms(surface);
            Assert.That(surface.ComputeNow(), Is.True, surface.LastError.Message);
            return surface;
        }

        /// <summary>Two atoms that overlap.</summary>
        public static void GiveAtoms(MolecularSurface surface) =>
            surface.SetAtoms(new[] { Vector3.zero, new Vector3(1.5f, 0, 0) }, new[] { 1.7f, 1.5f });

        public void Destroy()
        {
            foreach (GameObject made in _made)
            {
                if (made != null)
                    Object.DestroyImmediate(made);
            }
            _made.Clear();
        }
    }
}
