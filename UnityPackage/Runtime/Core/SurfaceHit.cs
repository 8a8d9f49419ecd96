// SPDX-License-Identifier: MIT
using QuickSes.Interop;

namespace QuickSes
{
    /// <summary>Where a ray meets a mesh: see <see cref="KeptMesh.TryPick"/>.</summary>
    public readonly unsafe struct SurfaceHit
    {
        internal SurfaceHit(in NativeHit native) => _native = native;

        private readonly NativeHit _native;

        /// <summary>The number of the triangle.</summary>
        public int Triangle => (int)_native.Triangle;

        /// <summary>The corner of the triangle that weighs most at the point.</summary>
        public int Vertex => (int)_native.Vertex;

        /// <summary>The atom of that corner.</summary>
        public int Owner => (int)_native.Owner;

        /// <summary>From the origin, in lengths of the direction; float.MaxValue where it is more.</summary>
        public float Distance => _native.Distance;

        /// <summary>Å, in the coordinates the atoms were given in.</summary>
        public (float X, float Y, float Z) Position =>
            (_native.Position[0], _native.Position[1], _native.Position[2]);

        /// <summary>Of unit length, outward: between those of the corners.</summary>
        public (float X, float Y, float Z) Normal => (_native.Normal[0], _native.Normal[1], _native.Normal[2]);
    }
}
