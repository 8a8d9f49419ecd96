// SPDX-License-Identifier: MIT
using System;
using UnityEngine;
using UnityEngine.Events;

namespace QuickSes
{
    /// <summary>
    /// The events of a <see cref="MolecularSurface"/> for those who wire in the inspector; each comes right after the C#
    /// event of the same name. Serialised with the component. Main thread only.
    /// </summary>
    [Serializable]
    public sealed class SurfaceEvents
    {
        [SerializeField, Tooltip("The atoms of the source are there.")]
        private UnityEvent _loaded = new UnityEvent();
        [SerializeField, Tooltip("A surface arrived and is shown.")]
        private UnityEvent _surfaceUpdated = new UnityEvent();
        [SerializeField, Tooltip("The finest surface of the newest atoms is shown.")]
        private UnityEvent _refinementFinished = new UnityEvent();
        [SerializeField, Tooltip("There is no surface of the newest atoms; the text says why. If nothing is wired here, and no " +
            "script listens, it is logged.")]
        private UnityEvent<string> _failed = new UnityEvent<string>();
        [SerializeField, Tooltip("The component is enabled and has neither atoms nor a source.")]
        private UnityEvent _atomsRequested = new UnityEvent();

        /// <summary>See <see cref="MolecularSurface.Loaded"/>.</summary>
        public UnityEvent Loaded => _loaded;

        /// <summary>See <see cref="MolecularSurface.SurfaceUpdated"/>.</summary>
        public UnityEvent SurfaceUpdated => _surfaceUpdated;

        /// <summary>See <see cref="MolecularSurface.RefinementFinished"/>.</summary>
        public UnityEvent RefinementFinished => _refinementFinished;

        /// <summary>
        /// See <see cref="MolecularSurface.Failed"/>; with the sentence. What is wired in the inspector and is called
        /// now (not Off, nor Runtime Only in edit mode) counts as a listener, so that nothing is logged; AddListener does
        /// not.
        /// </summary>
        public UnityEvent<string> Failed => _failed;

        /// <summary>
        /// See <see cref="MolecularSurface.AtomsRequested"/>; not raised again for listeners that come later.
        /// </summary>
        public UnityEvent AtomsRequested => _atomsRequested;
    }
}
