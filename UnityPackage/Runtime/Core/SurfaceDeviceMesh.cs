// SPDX-License-Identifier: MIT
using QuickSes.Interop;
using System;

namespace QuickSes
{
    /// <summary>
    /// A mesh in memory of a CUDA device, for plug-ins that copy it into graphics buffers. The pointers are CUDA's, valid
    /// until the next mesh is collected or computed. It is finished: what reads it waits for nothing.
    /// </summary>
    public readonly unsafe struct SurfaceDeviceMesh
    {
        private readonly NativeDeviceMesh _native;

        internal SurfaceDeviceMesh(in NativeDeviceMesh native) => _native = native;

        /// <summary>CUDA ordinal of the device.</summary>
        public int Device => _native.Device;

        /// <summary>The cudaStream_t that wrote the mesh.</summary>
        public IntPtr Stream => (IntPtr)_native.Stream;

        /// <summary>How many vertices there are.</summary>
        public int VertexCount => (int)_native.Mesh.VertexCount;

        /// <summary>How many triangles there are.</summary>
        public int TriangleCount => (int)_native.Mesh.TriangleCount;

        /// <summary>Bytes from one vertex to the next if they are interleaved; else 0.</summary>
        public int VertexBytes => (int)_native.Mesh.VertexBytes;

        /// <summary>float[3] per vertex, Å; interleaved: the vertices.</summary>
        public IntPtr Positions => (IntPtr)_native.Mesh.Positions;

        /// <summary>float[3] per vertex, unit length, outward.</summary>
        public IntPtr Normals => (IntPtr)_native.Mesh.Normals;

        /// <summary>byte[4] per vertex, or zero.</summary>
        public IntPtr Colors => (IntPtr)_native.Mesh.Colors;

        /// <summary>float[2] per vertex, or zero.</summary>
        public IntPtr Texcoords => (IntPtr)_native.Mesh.Texcoords;

        /// <summary>uint per vertex: the atom it belongs to.</summary>
        public IntPtr Owners => (IntPtr)_native.Mesh.Owners;

        /// <summary>uint[3] per triangle.</summary>
        public IntPtr Indices => (IntPtr)_native.Mesh.Indices;

        /// <summary>As in the settings.</summary>
        public uint Tag => _native.Mesh.Tag;
    }
}
