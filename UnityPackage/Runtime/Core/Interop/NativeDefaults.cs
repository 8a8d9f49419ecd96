// SPDX-License-Identifier: MIT
namespace QuickSes.Interop
{
    /// <summary>
    /// What the qses_..._init functions of the header write: sizes as these declarations have them, and defaults. The
    /// functions are compiled into C callers, so they are written once more here; Tests/DotNet~ compares all bytes.
    /// </summary>
    internal static unsafe class NativeDefaults
    {
        public static NativeBackendDescription BackendDescription() =>
            new NativeBackendDescription { StructSize = (uint)sizeof(NativeBackendDescription) };

        public static NativeContextOptions ContextOptions() =>
            new NativeContextOptions { StructSize = (uint)sizeof(NativeContextOptions) };

        public static NativeSettings Settings()
        {
            var settings = new NativeSettings
            {
                StructSize = (uint)sizeof(NativeSettings),
                ProbeRadius = 1.4f,
                Spacing = 0.5f,
                RelaxationSteps = 1,
                Measure = 1,
                LevelCount = 2,
                GaussianRadiusScale = 1,
                GaussianIsovalue = 0.5f
            };
            settings.Levels[0] = 2;
            settings.Levels[1] = 1;
            return settings;
        }

        public static NativeMesh Mesh() => new NativeMesh { StructSize = (uint)sizeof(NativeMesh) };

        public static NativeDeviceMesh DeviceMesh() =>
            new NativeDeviceMesh { StructSize = (uint)sizeof(NativeDeviceMesh), Mesh = Mesh() };

        public static NativeReport Report() => new NativeReport { StructSize = (uint)sizeof(NativeReport) };

        public static NativeSizeEstimate SizeEstimate() =>
            new NativeSizeEstimate { StructSize = (uint)sizeof(NativeSizeEstimate) };

        public static NativeProgress Progress() => new NativeProgress { StructSize = (uint)sizeof(NativeProgress) };

        public static NativeHit Hit() => new NativeHit { StructSize = (uint)sizeof(NativeHit) };

        public static NativeStructureOptions StructureOptions() => new NativeStructureOptions
        {
            StructSize = (uint)sizeof(NativeStructureOptions), Model = 1, Water = 1, Hetero = 1, Hydrogen = 1
        };

        public static NativeStructureDescription StructureDescription() =>
            new NativeStructureDescription { StructSize = (uint)sizeof(NativeStructureDescription) };

        public static NativeAtom Atom() => new NativeAtom { StructSize = (uint)sizeof(NativeAtom) };

        public static NativeTrajectoryDescription TrajectoryDescription() =>
            new NativeTrajectoryDescription { StructSize = (uint)sizeof(NativeTrajectoryDescription) };

        public static NativeGpuLook GpuLook() => new NativeGpuLook { StructSize = (uint)sizeof(NativeGpuLook) };

        public static NativeGpuBuffers GpuBuffers() => new NativeGpuBuffers
        {
            StructSize = (uint)sizeof(NativeGpuBuffers), Graphics = GpuGraphics.Opengl
        };

        public static NativeGpuStatus GpuStatus() => new NativeGpuStatus { StructSize = (uint)sizeof(NativeGpuStatus) };

        public static NativeFrame Frame() => new NativeFrame { StructSize = (uint)sizeof(NativeFrame) };
    }
}
