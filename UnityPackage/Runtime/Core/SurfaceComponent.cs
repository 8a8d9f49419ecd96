// SPDX-License-Identifier: MIT
using QuickSes.Interop;
using System.Runtime.InteropServices;

namespace QuickSes
{
    /// <summary>One connected piece of the surface: an outer surface, or the wall of a cavity.</summary>
    [StructLayout(LayoutKind.Sequential)] // looked at in native memory: nothing but what is there
    public readonly struct SurfaceComponent
    {
        private readonly NativeComponent _native;

        /// <summary>How many triangles it has.</summary>
        public long Triangles => (long)_native.Triangles;

        /// <summary>Å², sum over its triangles.</summary>
        public double Area => _native.Area;

        /// <summary>Å³, enclosed; negative for a cavity, whatever the winding.</summary>
        public double Volume => _native.Volume;

        /// <summary>Whether it is the wall of a cavity.</summary>
        public bool IsCavity => _native.IsCavity != 0;
    }
}
