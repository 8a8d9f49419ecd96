// SPDX-License-Identifier: MIT
// What is computed. Setting anything to another value begins a new computation.
using System;
using System.Collections.Generic;
using UnityEngine;

namespace QuickSes
{
    public sealed partial class MolecularSurface
    {
        /// <summary>Which surface; default: solvent-excluded.</summary>
        public SurfaceKind Surface
        {
            get => _surface;
            set => Set(ref _surface, value);
        }

        /// <summary>How the solvent-excluded surface is computed; default: exactly.</summary>
        public SurfaceMethod Method
        {
            get => _method;
            set => Set(ref _method, value);
        }

        /// <summary>Å, 0 to 100; default 1.4, water.</summary>
        public float ProbeRadius
        {
            get => _probeRadius;
            set => Set(ref _probeRadius, value);
        }

        /// <summary>Å between lattice points of the finest level, 0.001 to 100; default 0.5.</summary>
        public float Spacing
        {
            get => _spacing;
            set => Set(ref _spacing, value);
        }

        /// <summary>Smoothing steps, 0 to 100; default 1.</summary>
        public int RelaxationSteps
        {
            get => _relaxationSteps;
            set => Set(ref _relaxationSteps, value);
        }

        /// <summary>
        /// Spacings of coarser levels, Å, in any order, at most <see cref="SurfaceSettings.MaxLevels"/>; those not
        /// above <see cref="Spacing"/> are left out. Default 2, 1. A copy.
        /// </summary>
        public float[] Levels
        {
            get => (float[])_levels.Clone();
            set
            {
                if (value == null)
                    throw new ArgumentNullException(nameof(value));
                if (value.AsSpan().SequenceEqual(_levels))
                    return;
                _levels = (float[])value.Clone();
                Changed(SurfaceChange.Shape);
            }
        }

        /// <summary>
        /// Milliseconds per surface while atoms move, 0 to 60000; default 33: the finest level that fits, judging by
        /// the last frames. 0: all levels of every frame.
        /// </summary>
        public float FrameBudget
        {
            get => _frameBudget;
            set => _frameBudget = value;
        }

        /// <summary>Seconds without new positions until the finest level is computed; default 0.2.</summary>
        public float RestDelay
        {
            get => _restDelay;
            set => _restDelay = value;
        }

        /// <summary>Whether <see cref="Components"/> is filled; default no.</summary>
        public bool MeasureComponents
        {
            get => _measureComponents;
            set => Set(ref _measureComponents, value);
        }

        /// <summary>
        /// Whether the mesh's buffers only grow; default no. Then <see cref="UnityEngine.Mesh.vertexCount"/> counts
        /// unused vertices at the end as well.
        /// </summary>
        public bool PadBuffers
        {
            get => _padBuffers;
            set => _padBuffers = value;
        }

        /// <summary>What computes; default: the GPU if there is a suitable one, else the CPU.</summary>
        public SurfaceBackend Backend
        {
            get => _backend;
            set => Set(ref _backend, value);
        }

        /// <summary>Colour of the surface where atoms have none of their own.</summary>
        public Color32 BaseColor
        {
            get => _baseColor;
            set
            {
                _baseColor = value;
                if (Session.Atoms.SetBaseColor(Number(value)))
                    Changed(SurfaceChange.Appearance);
            }
        }

        private void Set<T>(ref T field, T value) where T : struct
        {
            if (EqualityComparer<T>.Default.Equals(field, value))
                return;
            field = value;
            Changed(SurfaceChange.Shape);
        }
    }
}
