// SPDX-License-Identifier: MIT
using QuickSes.Interop;
using System.Runtime.InteropServices;

namespace QuickSes
{
    /// <summary>One connected piece of the surface: an outer surface, or the wall of a cavity.</summary>
    [StructLayout(LayoutKind.Sequential)] // looked at in native memory: nothing but what is there
    public readonly unsafe struct SurfaceComponent
    {
        private readonly NativeComponent _native;

        /// <summary>How many triangles it has.</summary>
        public long Triangles => (long)_native.Triangles;

        /// <summary>Å², along the normals, as <see cref="SurfaceReport.Area"/> of the SES.</summary>
        public double Area => _native.Area;

        /// <summary>Å³, enclosed; negative for a cavity, whatever the winding.</summary>
        public double Volume => _native.Volume;

        /// <summary>Whether it is the wall of a cavity.</summary>
        public bool IsCavity => _native.IsCavity != 0;

        /// <summary>
        /// Å, centre of the volume that its triangles enclose; of its box if that is next to nothing.
        /// </summary>
        public (float X, float Y, float Z) Center => (_native.Center[0], _native.Center[1], _native.Center[2]);

        /// <summary>Box of its vertices, Å.</summary>
        public (float X, float Y, float Z) BoundsMin =>
            (_native.BoundsMin[0], _native.BoundsMin[1], _native.BoundsMin[2]);

        /// <summary>The other corner of the box.</summary>
        public (float X, float Y, float Z) BoundsMax =>
            (_native.BoundsMax[0], _native.BoundsMax[1], _native.BoundsMax[2]);
    }
}
