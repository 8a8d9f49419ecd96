// SPDX-License-Identifier: MIT
using System;

namespace QuickSes
{
    /// <summary>
    /// The settings that change a surface, as they were at one time: the inspector does not say what was edited.
    /// </summary>
    internal readonly struct SurfaceShapeSettings : IEquatable<SurfaceShapeSettings>
    {
        private readonly SurfaceKind _surface;
        private readonly SurfaceMethod _method;
        private readonly float _probeRadius;
        private readonly float _gaussianRadiusScale;
        private readonly float _gaussianIsovalue;
        private readonly float _spacing;
        private readonly float[] _levels;
        private readonly int _relaxationSteps;
        private readonly bool _sharpCreases;
        private readonly bool _ambientOcclusion;
        private readonly bool _measureComponents;
        private readonly bool _compactVertices;
        private readonly SurfaceBackend _backend;

        public SurfaceShapeSettings(SurfaceKind surface, SurfaceMethod method, float probeRadius,
            float gaussianRadiusScale, float gaussianIsovalue, float spacing, float[] levels, int relaxationSteps, bool sharpCreases, bool ambientOcclusion, bool measureComponents,
            bool compactVertices, SurfaceBackend backend)
        {
            _surface = surface;
            _method = method;
            _probeRadius = probeRadius;
            _gaussianRadiusScale = gaussianRadiusScale;
            _gaussianIsovalue = gaussianIsovalue;
            _spacing = spacing;
            _levels = (float[])levels.Clone();
            _relaxationSteps = relaxationSteps;
            _sharpCreases = sharpCreases;
            _ambientOcclusion = ambientOcclusion;
            _measureComponents = measureComponents;
            _compactVertices = compactVertices;
            _backend = backend;
        }

        public bool Equals(SurfaceShapeSettings other) => _surface == other._surface && _method == other._method &&
            _probeRadius.Equals(other._probeRadius) && _gaussianRadiusScale.Equals(other._gaussianRadiusScale) &&
            _gaussianIsovalue.Equals(other._gaussianIsovalue) && _spacing.Equals(other._spacing) &&
            _relaxationSteps == other._relaxationSteps && _sharpCreases == other._sharpCreases &&
            _ambientOcclusion == other._ambientOcclusion && _measureComponents == other._measureComponents && _compactVertices == other._compactVertices &&
            _backend == other._backend && _levels.AsSpan().SequenceEqual(other._levels);

        public override bool Equals(object other) => other is SurfaceShapeSettings settings && Equals(settings);

        public override int GetHashCode() => HashCode.Combine(_surface, _probeRadius, _spacing);
    }
}
