// SPDX-License-Identifier: MIT
using QuickSes.Interop;
using System;

namespace QuickSes
{
    /// <summary>What was done for one mesh.</summary>
    public readonly struct SurfaceReport
    {
        internal SurfaceReport(in NativeReport native)
        {
            _native = native;
        }

        private readonly NativeReport _native;

        /// <summary>
        /// Å²; 0 if not asked for (<see cref="SurfaceSettings.Measure"/>). Those of single atoms are in
        /// <see cref="SurfaceMeshView.AtomAreas"/>.
        /// </summary>
        public double Area => _native.Area;

        /// <summary>Å³, enclosed; cavities count negative.</summary>
        public double Volume => _native.Volume;

        /// <summary>Where <see cref="Area"/> and <see cref="Volume"/> come from.</summary>
        public SurfaceMeasuredBy MeasuredBy => _native.MeasuredBy;

        /// <summary>Å², sum over the triangles as they are; 0 if no mesh was made.</summary>
        public double TriangleArea => _native.TriangleArea;

        /// <summary>Å³, within the triangles as they are; 0 if no mesh was made.</summary>
        public double TriangleVolume => _native.TriangleVolume;

        /// <summary>Milliseconds from atoms to mesh in host memory; for a later level: since the one before.</summary>
        public double ComputeMilliseconds => _native.ComputeMs;

        /// <summary>
        /// Most bytes in use for the work, without the mesh: on the device with CUDA, else in host memory.
        /// </summary>
        public ulong WorkBytesPeak => _native.WorkBytesPeak;

        /// <summary>Bytes of the mesh, without its components; 0 with <see cref="MeshDelivery.None"/>.</summary>
        public ulong MeshBytes => _native.MeshBytes;

        /// <summary>Bytes of host memory of the context, the mesh included.</summary>
        public ulong HostBytesPeak => _native.HostBytesPeak;

        /// <summary>Bricks of 8x8x8 lattice points that were evaluated.</summary>
        public ulong BrickCount => _native.BrickCount;

        /// <summary>Parts the surface was made in: of little memory several, and of a large mesh that leaves the GPU
        /// while it is made.</summary>
        public ulong SliceCount => _native.SliceCount;

        /// <summary>
        /// Vertices that are left out of the mesh: their atoms are hidden, or they are of a cavity
        /// (<see cref="SurfaceSettings.OuterOnly"/>). Counted before vertices on edges are repeated.
        /// </summary>
        public uint HiddenVertices => _native.HiddenVertices;

        /// <summary>Triangles that are left out for the same reasons.</summary>
        public uint HiddenTriangles => _native.HiddenTriangles;

        /// <summary>
        /// Bricks that were added since the surface went on behind the border of those where it was expected: they keep
        /// the mesh closed. 0 unless rounding hid a feature of the surface.
        /// </summary>
        public ulong BorderBricks => _native.BorderBricks;

        /// <summary>
        /// Vertices for which no feature of the surface was found: they stay where their lattice edge is cut. 0 unless
        /// rounding hid a feature of the surface.
        /// </summary>
        public ulong UnplacedVertices => _native.UnplacedVertices;

        /// <summary>
        /// How often the work was begun: more than once only where memory was refused, and it was done again in a way
        /// that takes less.
        /// </summary>
        public ulong Attempts => _native.Attempts;

        /// <summary>How many stages were timed; 0 unless <see cref="SurfaceContext.EnableStageTimes"/>.</summary>
        public int StageCount => (int)_native.StageCount;

        /// <summary>
        /// Name and milliseconds of stage k, from 0 to <see cref="StageCount"/> - 1. Makes a new string.
        /// </summary>
        public unsafe (string Name, double Milliseconds) GetStage(int k)
        {
            if ((uint)k >= _native.StageCount)
                throw new ArgumentOutOfRangeException(nameof(k), k, $"there are {_native.StageCount} stages");
            fixed (ulong* stages = _native.Stages)
            {
                NativeStageTime* stage = (NativeStageTime*)stages + k;
                return (NativeText.Read(stage->Name), stage->Milliseconds);
            }
        }
    }
}
