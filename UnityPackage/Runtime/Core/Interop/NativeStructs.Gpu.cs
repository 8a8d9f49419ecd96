// SPDX-License-Identifier: MIT
// The structures and enumerations of quickses_gpu.h, as those of quickses.h are mirrored.
using System.Runtime.InteropServices;

namespace QuickSes.Interop
{
    internal enum GpuGraphics
    {
        Opengl = 1,
        D3d11 = 2
    }

    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct NativeGpuLook
    {
        public uint StructSize;
        public uint Reserved;
        public ulong AtomCount;
        public byte* Colors;
        public float* Texcoords;
        public byte* Visible;
    }

    [StructLayout(LayoutKind.Sequential)]
    internal struct NativeGpuBuffers
    {
        public uint StructSize;
        public GpuGraphics Graphics;
        public ulong Vertices;
        public ulong Colors;
        public ulong Owners;
        public ulong Texcoords;
        public ulong Indices;
        public ulong VertexCapacity;
        public ulong IndexCapacity;
        public uint Generation;
        public int ClearRest;
    }

    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct NativeGpuStatus
    {
        public uint StructSize;
        public QuickSesStatus Status;
        public int Submitted;
        public int Done;
        public uint Waiting;
        public int Stopped;
        public uint Registrations;
        public float EventMs;
        public float CopyMs;
        public fixed byte Message[256];
    }
}
