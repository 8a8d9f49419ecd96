// SPDX-License-Identifier: MIT
// What is computed. Setting anything to another value begins a new computation; what is out of its range throws
// ArgumentOutOfRangeException and leaves all as it was.
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
            set => Set(ref _surface, Known(value, value <= SurfaceKind.Gaussian && value >= 0));
        }

        /// <summary>How the solvent-excluded surface is computed; default: exactly.</summary>
        public SurfaceMethod Method
        {
            get => _method;
            set => Set(ref _method, Known(value, value <= SurfaceMethod.Grid && value >= 0));
        }

        /// <summary>Å, 0 to 100; default 1.4, water. Not used by Vdw and Gaussian.</summary>
        public float ProbeRadius
        {
            get => _probeRadius;
            set => Set(ref _probeRadius, InRange(value, 0, SurfaceSettings.MaxProbeRadius, "Å"));
        }

        /// <summary>
        /// Of <see cref="SurfaceKind.Gaussian"/>, 0.05 to 10: an atom's standard deviation over its radius; default 1.
        /// </summary>
        public float GaussianRadiusScale
        {
            get => _gaussianRadiusScale;
            set => Set(ref _gaussianRadiusScale, InRange(value, SurfaceSettings.MinGaussianRadiusScale,
                SurfaceSettings.MaxGaussianRadiusScale, "of the radius"));
        }

        /// <summary>Of <see cref="SurfaceKind.Gaussian"/>, 0.01 to 1000: the density on the surface; default 0.5.</summary>
        public float GaussianIsovalue
        {
            get => _gaussianIsovalue;
            set => Set(ref _gaussianIsovalue,
                InRange(value, SurfaceSettings.MinGaussianIsovalue, SurfaceSettings.MaxGaussianIsovalue, "of density"));
        }

        /// <summary>Å between lattice points of the finest level, 0.001 to 100; default 0.5.</summary>
        public float Spacing
        {
            get => _spacing;
            set => Set(ref _spacing, Spaced(value));
        }

        /// <summary>Smoothing steps, 0 to 100; default 1. Not used by Gaussian.</summary>
        public int RelaxationSteps
        {
            get => _relaxationSteps;
            set => Set(ref _relaxationSteps, (int)InRange(value, 0, SurfaceSettings.MaxRelaxationSteps, "steps"));
        }

        /// <summary>
        /// Whether, when atoms rest, triangles of the finest level follow the creases where sheets of the surface meet,
        /// with vertices for each side, so that light breaks there (<see cref="SurfaceSettings.Creases"/>,
        /// <see cref="SurfaceSettings.HardEdges"/>); default yes. New atoms and settings count as rest, new positions
        /// do not until <see cref="RestDelay"/> is over. Which vertex each of the others stands for: <see
        /// cref="Repeated"/>. Not with the grid method, nor of Gaussian surfaces.
        /// </summary>
        public bool SharpCreases
        {
            get => _sharpCreases;
            set => Set(ref _sharpCreases, value);
        }

        /// <summary>
        /// Whether less light reaches where the surface is closed in (<see cref="SurfaceSettings.Occlusion"/>), with atoms
        /// that move as with those that rest; default yes. Vertices have it as texture coordinate 1: x from 0 (closed in) to
        /// 1 (open), y is 1. The package's shaders read it (Ambient Occlusion, _OcclusionStrength), and none for a mesh
        /// without. Texture coordinates of atoms (<see cref="SetTexcoords(ReadOnlySpan{Vector2})"/>) take its place.
        /// </summary>
        public bool AmbientOcclusion
        {
            get => _ambientOcclusion;
            set => Set(ref _ambientOcclusion, value);
        }

        /// <summary>
        /// Spacings of coarser levels, 0.001 to 100 Å, in any order, at most <see cref="SurfaceSettings.MaxLevels"/>; those not
        /// above <see cref="Spacing"/> are left out. Default 2, 1. A copy.
        /// </summary>
        public float[] Levels
        {
            get => (float[])_levels.Clone();
            set
            {
                if (value == null)
                    throw new ArgumentNullException(nameof(value));
                if (value.Length > SurfaceSettings.MaxLevels)
                    throw new ArgumentOutOfRangeException(nameof(value), value.Length,
                        $"at most {SurfaceSettings.MaxLevels} levels are possible");
                foreach (float spacing in value)
                    Spaced(spacing);
                if (value.AsSpan().SequenceEqual(_levels))
                    return;
                _levels = (float[])value.Clone();
                ShapeSettingChanged();
            }
        }

        /// <summary>
        /// Milliseconds per surface while atoms move, 0 to 60000; default 33: the finest level that fits, judging by
        /// the last frames. 0: all levels of every frame.
        /// </summary>
        public float FrameBudget
        {
            get => _frameBudget;
            set => _frameBudget = InRange(value, 0, SurfaceSettings.MaxFrameBudget, "ms");
        }

        /// <summary>
        /// Seconds without new positions until the finest level is computed, 0 or more; default 0.2. Infinite: never.
        /// </summary>
        public float RestDelay
        {
            get => _restDelay;
            set
            {
                _restDelay = InRange(value, 0, float.PositiveInfinity, "s");
                QueueEditorUpdate(); // what was left coarse may become finer
            }
        }

        /// <summary>Whether <see cref="Components"/> is filled; default no.</summary>
        public bool MeasureComponents
        {
            get => _measureComponents;
            set => Set(ref _measureComponents, value);
        }

        /// <summary>
        /// Where colours of atoms are: default <see cref="AtomColoring.Auto"/>. Changing it computes nothing.
        /// </summary>
        public AtomColoring Coloring
        {
            get => _coloring;
            set
            {
                _coloring = Known(value, value <= AtomColoring.Texture && value >= 0);
                LookChanged();
            }
        }

        /// <summary>
        /// Whether normals have 4 bytes (SNorm8) instead of 12: 20 bytes per vertex instead of 28. Default no: indices are
        /// half of what is uploaded, so it saves a sixth, and smooth highlights show the rounding (half a degree).
        /// </summary>
        public bool CompactVertices
        {
            get => _compactVertices;
            set => Set(ref _compactVertices, value);
        }

        /// <summary>What computes; default: the GPU if there is a suitable one, else the CPU.</summary>
        public SurfaceBackend Backend
        {
            get => _backend;
            set => Set(ref _backend, Known(value, value <= SurfaceBackend.Cpu && value >= 0));
        }

        /// <summary>Colour of the surface where atoms have none of their own.</summary>
        public Color32 BaseColor
        {
            get => _baseColor;
            set
            {
                _baseColor = value;
                if (!HasSession)
                    return;
                _session.Atoms.SetBaseColor(Number(value));
                LookChanged();
            }
        }

        private static float Spaced(float value) =>
            InRange(value, SurfaceSettings.MinSpacing, SurfaceSettings.MaxSpacing, "Å");

        // NaN is in no range.
        private static float InRange(float value, float min, float max, string unit) => value >= min && value <= max
            ? value
            : throw new ArgumentOutOfRangeException(nameof(value), value, float.IsInfinity(max)
                ? FormattableString.Invariant($"must be {min} {unit} or more")
                : FormattableString.Invariant($"must be {min} to {max} {unit}"));

        private static T Known<T>(T value, bool isKnown) where T : struct => isKnown
            ? value
            : throw new ArgumentOutOfRangeException(nameof(value), value, $"there is no such {typeof(T).Name}");

        // What the inspector takes, animations write, and files may hold.
        private void LimitSettings()
        {
            _probeRadius = Limited(_probeRadius, 0, SurfaceSettings.MaxProbeRadius);
            _gaussianRadiusScale = Limited(_gaussianRadiusScale, SurfaceSettings.MinGaussianRadiusScale,
                SurfaceSettings.MaxGaussianRadiusScale);
            _gaussianIsovalue = Limited(
                _gaussianIsovalue, SurfaceSettings.MinGaussianIsovalue, SurfaceSettings.MaxGaussianIsovalue);
            _spacing = Limited(_spacing, SurfaceSettings.MinSpacing, SurfaceSettings.MaxSpacing);
            if (_levels.Length > SurfaceSettings.MaxLevels)
                Array.Resize(ref _levels, SurfaceSettings.MaxLevels);
            for (int i = 0; i < _levels.Length; ++i)
                _levels[i] = Limited(_levels[i], SurfaceSettings.MinSpacing, SurfaceSettings.MaxSpacing);
            _relaxationSteps = Math.Min(Math.Max(_relaxationSteps, 0), SurfaceSettings.MaxRelaxationSteps);
            _frameBudget = Limited(_frameBudget, 0, SurfaceSettings.MaxFrameBudget);
            _restDelay = Limited(_restDelay, 0, float.PositiveInfinity);
        }

        private static float Limited(float value, float min, float max) => value >= min ? Math.Min(value, max) : min;

        private void Set<T>(ref T field, T value) where T : struct
        {
            if (EqualityComparer<T>.Default.Equals(field, value))
                return;
            field = value;
            ShapeSettingChanged();
        }

        // What has no session yet, such as a prefab, which never gets one, will begin with the settings as they are then.
        private void ShapeSettingChanged()
        {
            if (!HasSession)
                return;
            NoteSettings();
            Changed(SurfaceChange.Shape);
        }

        // The inspector does not say what was edited, so the next edit is measured by these. Whether they are others than
        // those before.
        private bool NoteSettings()
        {
            SurfaceSettings settings = ((ISurfaceHost)this).MakeSettings(out ReadOnlySpan<float> levels);
            settings.SetLevels(levels.Slice(0, Math.Min(levels.Length, SurfaceSettings.MaxLevels))); // files may have more
            bool areSame = _backend == _editedBackend && SurfaceSettings.AreSame(settings, _editedFrom);
            _editedFrom = settings;
            _editedBackend = _backend;
            return !areSame;
        }
    }
}
