// SPDX-License-Identifier: MIT
using System;
using System.Runtime.InteropServices;

namespace QuickSes.Interop
{
    /// <summary>
    /// The functions of quickses.h under their own names. Everything that crosses is blittable, but for the handles,
    /// which the runtime keeps open while a call uses them. Not here: qses_set_progress_callback, since native code
    /// never calls managed code in this package.
    /// </summary>
    internal static unsafe partial class NativeMethods
    {
        /// <summary>QSES_ABI_VERSION of the header these declarations were written after.</summary>
        public const uint AbiVersion = 4;

        public const string Library = "quickses";
        private const CallingConvention Cdecl = CallingConvention.Cdecl;

        // ---- versions and back ends
        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern byte* qses_version();

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern uint qses_abi_version();

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_backend_info(
            SurfaceBackend backend, NativeBackendDescription* description);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern byte* qses_last_error();

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_device_count(uint* count);

        // ---- contexts
        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_context_create(NativeContextOptions* options, IntPtr* context);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern void qses_context_destroy(IntPtr context);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_context_info(
            ContextHandle context, SurfaceBackend* backend, NativeBackendDescription* description);

        // ---- atoms and their appearance
        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_set_atoms(
            ContextHandle context, float* positions, UIntPtr stride, float* radii, UIntPtr count);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_set_positions(
            ContextHandle context, float* positions, UIntPtr stride, UIntPtr count);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_set_positions_indexed(
            ContextHandle context, float* positions, UIntPtr stride, UIntPtr positionCount, uint* indices,
            UIntPtr count);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_set_visible(ContextHandle context, byte* visible, UIntPtr count);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_set_colors(ContextHandle context, byte* rgba, UIntPtr count);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_set_texcoords(ContextHandle context, float* uv, UIntPtr count);

        // ---- computing
        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_compute(
            ContextHandle context, NativeSettings* settings, NativeMesh* mesh);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_context_mesh(ContextHandle context, NativeMesh* mesh);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_context_report(ContextHandle context, NativeReport* report);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_estimate(
            ContextHandle context, NativeSettings* settings, NativeSizeEstimate* estimate);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_set_stage_times(ContextHandle context, int enabled);

        // ---- jobs
        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_begin(ContextHandle context, NativeSettings* settings);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_poll(ContextHandle context, NativeProgress* progress);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_collect(ContextHandle context, NativeMesh* mesh);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_collect_device(ContextHandle context, NativeDeviceMesh* mesh);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_cancel(ContextHandle context);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_wait(ContextHandle context, double milliseconds, int* finished);

        // ---- kept meshes
        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_kept_mesh_create(IntPtr* kept);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern void qses_kept_mesh_destroy(IntPtr kept);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern void qses_kept_mesh_clear(KeptMeshHandle kept);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_keep(ContextHandle context, KeptMeshHandle kept);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_kept_mesh_download(KeptMeshHandle kept);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_kept_mesh_view(KeptMeshHandle kept, NativeMesh* mesh);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_kept_mesh_report(KeptMeshHandle kept, NativeReport* report);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_kept_mesh_paint(
            KeptMeshHandle kept, void* perAtom, UIntPtr valueBytes, UIntPtr atomCount, uint first, uint count,
            void* perVertex);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_component_atoms(
            NativeMesh* mesh, uint* starts, uint* atoms, UIntPtr room);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_kept_mesh_filter(
            KeptMeshHandle kept, byte* visible, UIntPtr atomCount, uint first, uint count, uint* indices,
            uint* keptTriangles);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_kept_mesh_pick(
            KeptMeshHandle kept, float* origin, float* direction, byte* visible, UIntPtr atomCount, NativeHit* hit);

        // ---- structures
        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern void qses_input_set_limit(ulong bytes);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_structure_open(
            byte* path, NativeStructureOptions* options, IntPtr* structure);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_structure_open_memory(
            byte* bytes, UIntPtr size, NativeStructureOptions* options, IntPtr* structure);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern void qses_structure_close(IntPtr structure);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_structure_info(
            StructureHandle structure, NativeStructureDescription* description);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_structure_atom(StructureHandle structure, uint k, NativeAtom* atom);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_structure_select(
            StructureHandle structure, byte* selection, byte* mask, UIntPtr count, uint* selected);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_structure_colors(
            StructureHandle structure, AtomColorScheme scheme, byte* uniformRgba, byte* rgba, UIntPtr count);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_structure_warning(StructureHandle structure, uint k, byte** sentence);

        // ---- trajectories
        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_trajectory_open(
            byte* path, TrajectoryFormat format, IntPtr* trajectory);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_trajectory_open_memory(
            byte* bytes, UIntPtr size, TrajectoryFormat format, IntPtr* trajectory);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern void qses_trajectory_close(IntPtr trajectory);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_trajectory_info(
            TrajectoryHandle trajectory, NativeTrajectoryDescription* description);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_trajectory_warning(
            TrajectoryHandle trajectory, uint k, byte** sentence);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_trajectory_unwrap(
            TrajectoryHandle trajectory, byte* elements, UIntPtr count);

        [DllImport(Library, CallingConvention = Cdecl, ExactSpelling = true)]
        public static extern QuickSesStatus qses_trajectory_read_frame(
            TrajectoryHandle trajectory, ulong index, float* positions, UIntPtr stride, UIntPtr count,
            NativeFrame* frame);
    }
}
