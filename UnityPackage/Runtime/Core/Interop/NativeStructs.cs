// SPDX-License-Identifier: MIT
// The structures of quickses.h, field for field; Tests/DotNet~ compares sizes and offsets with those of the C compiler.
using System.Runtime.InteropServices;

namespace QuickSes.Interop
{
    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct NativeBackendDescription
    {
        public uint StructSize;
        public int Available;
        public fixed byte Device[128];
        public fixed byte Reason[256];
        public ulong TotalMemory;
        public ulong FreeMemory;
        public int Preparing;
        public uint Processors;
    }

    [StructLayout(LayoutKind.Sequential)]
    internal struct NativeContextOptions
    {
        public uint StructSize;
        public SurfaceBackend Backend;
        public int Device;
        public uint Threads;
        public ulong MemoryBudget;
        public int Background;
        public uint Reserved;
    }

    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct NativeSettings
    {
        public const int MaxLevels = 8;
        public const int RememberedSeries = 512;

        public uint StructSize;
        public SurfaceKind Surface;
        public SurfaceMethod Method;
        public float ProbeRadius;
        public float Spacing;
        public uint RelaxationSteps;
        public uint SliceSize;
        public SurfaceWinding Winding;
        public int PatchTypes;
        public int Measure;
        public uint Tag;
        public uint LevelCount;
        public fixed float Levels[MaxLevels];
        public SurfaceVertexLayout VertexLayout;
        public int Texcoords;
        public float FrameBudgetMs;
        public int Components;
        public uint Series;
        public MeshDelivery Delivery;
        public float ShowMsPerMb;
        public int Pickable;
        public int Creases;
        public int HardEdges;
        public int ComponentIds;
        public int OuterOnly;
        public int AtomAreas;
        public int Occlusion;
        public float GaussianRadiusScale;
        public float GaussianIsovalue;
        public int WithoutOwners;
    }

    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct NativeComponent
    {
        public ulong Triangles;
        public double Area;
        public double Volume;
        public int IsCavity;
        public fixed float Center[3];
        public fixed float BoundsMin[3];
        public fixed float BoundsMax[3];
    }

    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct NativeMesh
    {
        public uint StructSize;
        public uint VertexCount;
        public uint TriangleCount;
        public uint Tag;
        public float* Positions;
        public float* Normals;
        public byte* Colors;
        public float* Texcoords;
        public uint VertexBytes;
        public uint Reserved;
        public uint* Owners;
        public byte* Patches;
        public uint* Indices;
        public fixed float BoundsMin[3];
        public fixed float BoundsMax[3];
        public float Spacing;
        public uint Level;
        public uint LevelCount;
        public uint ComponentCount;
        public NativeComponent* Components;
        public uint* ComponentIds;
        public double* AtomAreas;
        public ulong AtomCount;
        public uint* Repeated;
        public ulong RepeatedCount;
        public int HasTexcoords;
        public uint Reserved2;
    }

    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct NativeDeviceMesh
    {
        public uint StructSize;
        public int Device;
        public void* Stream;
        public NativeMesh Mesh;
    }

    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct NativeStageTime
    {
        public fixed byte Name[24];
        public double Milliseconds;
    }

    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct NativeReport
    {
        public const int MaxStages = 16;
        public const int StageTimeBytes = 32;

        public uint StructSize;
        public uint StageCount;
        public double Area;
        public double Volume;
        public double ComputeMs;
        public ulong WorkBytesPeak;
        public ulong MeshBytes;
        public ulong HostBytesPeak;
        public ulong BrickCount;
        public ulong SliceCount;
        public uint HiddenVertices;
        public uint HiddenTriangles;
        // NativeStageTime[MaxStages]: C# has fixed buffers of numbers only.
        public fixed ulong Stages[MaxStages * StageTimeBytes / sizeof(ulong)];
        public ulong BorderBricks;
        public ulong UnplacedVertices;
        public ulong Attempts;
        public double TriangleArea;
        public double TriangleVolume;
        public SurfaceMeasuredBy MeasuredBy;
        public uint Reserved;
    }

    [StructLayout(LayoutKind.Sequential)]
    internal struct NativeSizeEstimate
    {
        public uint StructSize;
        public int Fits;
        public ulong Vertices;
        public ulong Triangles;
        public ulong MeshBytes;
        public ulong WorkBytes;
        public ulong SmallestBudget;
    }

    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct NativeProgress
    {
        public uint StructSize;
        public SurfaceJobState State;
        public uint Tag;
        public uint TagRequested;
        public uint LevelsFinished;
        public uint LevelCount;
        public float Fraction;
        public int MeshReady;
        public QuickSesStatus Status;
        public fixed byte Message[256];
    }

    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct NativeHit
    {
        public uint StructSize;
        public int Found;
        public uint Triangle;
        public uint Vertex;
        public uint Owner;
        public float Distance;
        public fixed float Position[3];
        public fixed float Normal[3];
    }

    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct NativeStructureOptions
    {
        public uint StructSize;
        public StructureFormat Format;
        public int Model;
        public int Water;
        public int Hetero;
        public int Hydrogen;
        public byte* Selection;
        public byte* Radii;
        public byte* Assembly;
        public byte* Altloc;
    }

    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct NativeAtom
    {
        public uint StructSize;
        public int ResidueNumber;
        public byte* Name;
        public byte* ResidueName;
        public byte* Chain;
        public int IsHetero;
        public int IsWater;
        public int IsHydrogen;
        public byte Element;
        public byte InsertionCode;
        public fixed byte Reserved[2];
    }

    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct NativeStructureDescription
    {
        public uint StructSize;
        public StructureFormat Format;
        public int Model;
        public int ModelCount;
        public uint AtomCount;
        public uint FileAtomCount;
        public float* Positions;
        public float* Radii;
        public uint* FileIndices;
        public byte* FileElements;
        public uint WarningCount;
        public uint Reserved;
        public ulong Memory;
        public uint* Residues;
    }

    [StructLayout(LayoutKind.Sequential)]
    internal struct NativeTrajectoryDescription
    {
        public uint StructSize;
        public TrajectoryFormat Format;
        public ulong FrameCount;
        public uint AtomCount;
        public int HasBox;
        public int IsUnwrapped;
        public int Incomplete;
        public uint WarningCount;
        public uint Reserved;
    }

    [StructLayout(LayoutKind.Sequential)]
    internal unsafe struct NativeFrame
    {
        public uint StructSize;
        public int HasTime;
        public double Time;
        public int HasBox;
        public int IsUnwrapped;
        public fixed double Box[9];
    }
}
