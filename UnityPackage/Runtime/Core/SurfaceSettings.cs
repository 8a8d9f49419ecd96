// SPDX-License-Identifier: MIT
using QuickSes.Interop;
using System;

namespace QuickSes
{
    /// <summary>
    /// What is computed. Begin with <see cref="Default"/>; <c>default(SurfaceSettings)</c> is refused. Ranges are
    /// checked when a computation starts.
    /// </summary>
    public struct SurfaceSettings
    {
        /// <summary>The most coarser levels there can be.</summary>
        public const int MaxLevels = NativeSettings.MaxLevels;

        /// <summary>How many <see cref="Series"/> a context remembers.</summary>
        public const int RememberedSeries = NativeSettings.RememberedSeries;

        /// <summary>The largest <see cref="ProbeRadius"/>, Å; the smallest is 0.</summary>
        public const float MaxProbeRadius = 100;

        /// <summary>The smallest <see cref="Spacing"/>, Å, also of levels.</summary>
        public const float MinSpacing = 0.001f;

        /// <summary>The largest <see cref="Spacing"/>, Å, also of levels.</summary>
        public const float MaxSpacing = 100;

        /// <summary>The most <see cref="RelaxationSteps"/>.</summary>
        public const int MaxRelaxationSteps = 100;

        /// <summary>The largest <see cref="FrameBudget"/>, ms.</summary>
        public const float MaxFrameBudget = 60000;

        /// <summary>The smallest <see cref="GaussianRadiusScale"/>.</summary>
        public const float MinGaussianRadiusScale = 0.05f;

        /// <summary>The largest <see cref="GaussianRadiusScale"/>.</summary>
        public const float MaxGaussianRadiusScale = 10;

        /// <summary>The smallest <see cref="GaussianIsovalue"/>.</summary>
        public const float MinGaussianIsovalue = 0.01f;

        /// <summary>The largest <see cref="GaussianIsovalue"/>.</summary>
        public const float MaxGaussianIsovalue = 1000;

        internal NativeSettings Native;

        /// <summary>
        /// The native library's defaults: the solvent-excluded surface of a probe of 1.4 Å at a spacing of 0.5 Å, after
        /// levels of 2 and 1 Å.
        /// </summary>
        public static SurfaceSettings Default => new SurfaceSettings { Native = NativeDefaults.Settings() };

        /// <summary>Which surface.</summary>
        public SurfaceKind Surface { get => Native.Surface; set => Native.Surface = value; }

        /// <summary>How it is computed.</summary>
        public SurfaceMethod Method { get => Native.Method; set => Native.Method = value; }

        /// <summary>Å, 0 to 100; 1.4 is water. Below 0.05 the SES is the VDW surface. Ignored by VDW and Gaussian.</summary>
        public float ProbeRadius { get => Native.ProbeRadius; set => Native.ProbeRadius = value; }

        /// <summary>Å between lattice points, 0.001 to 100: how fine the mesh is.</summary>
        public float Spacing { get => Native.Spacing; set => Native.Spacing = value; }

        /// <summary>Smoothing steps, at most 100. With the exact method vertices stay on the exact surface.</summary>
        public uint RelaxationSteps { get => Native.RelaxationSteps; set => Native.RelaxationSteps = value; }

        /// <summary>
        /// Work in slices of at most this many lattice points cubed (at least 8); 0: as large as memory allows. The
        /// mesh is the same byte for byte.
        /// </summary>
        public uint SliceSize { get => Native.SliceSize; set => Native.SliceSize = value; }

        /// <summary>The order of a triangle's vertices.</summary>
        public SurfaceWinding Winding { get => Native.Winding; set => Native.Winding = value; }

        /// <summary>
        /// Whether <see cref="SurfaceMeshView.Patches"/> is filled. Not with the grid method, nor of Gaussian surfaces.
        /// </summary>
        public bool PatchTypes { get => Native.PatchTypes != 0; set => Native.PatchTypes = value ? 1 : 0; }

        /// <summary>Whether area and volume are computed: see <see cref="SurfaceReport.MeasuredBy"/>.</summary>
        public bool Measure { get => Native.Measure != 0; set => Native.Measure = value ? 1 : 0; }

        /// <summary>Any number; it comes back in <see cref="SurfaceMeshView.Tag"/>.</summary>
        public uint Tag { get => Native.Tag; set => Native.Tag = value; }

        /// <summary>How the vertices lie in memory.</summary>
        public SurfaceVertexLayout VertexLayout { get => Native.VertexLayout; set => Native.VertexLayout = value; }

        /// <summary>
        /// Whether vertices have texture coordinates: see <see cref="SurfaceContext.SetTexcoords"/> and
        /// <see cref="Occlusion"/>.
        /// </summary>
        public bool Texcoords { get => Native.Texcoords != 0; set => Native.Texcoords = value ? 1 : 0; }

        /// <summary>
        /// Milliseconds, for <see cref="SurfaceContext.Begin"/>: 0: all levels one after the other. Above 0, at most
        /// 60000: only the finest level that is expected to take no longer than this, judging by the last frames of the
        /// same <see cref="Series"/>.
        /// </summary>
        public float FrameBudget { get => Native.FrameBudgetMs; set => Native.FrameBudgetMs = value; }

        /// <summary>Whether <see cref="SurfaceMeshView.Components"/> is filled; off costs nothing.</summary>
        public bool Components { get => Native.Components != 0; set => Native.Components = value ? 1 : 0; }

        /// <summary>
        /// Whether <see cref="SurfaceMeshView.ComponentIds"/> is filled, and <see cref="SurfaceMeshView.Components"/>.
        /// </summary>
        public bool ComponentIds { get => Native.ComponentIds != 0; set => Native.ComponentIds = value ? 1 : 0; }

        /// <summary>
        /// Whether the walls of cavities are left out of the mesh; not of area, volume and
        /// <see cref="SurfaceMeshView.Components"/>, which are filled.
        /// </summary>
        public bool OuterOnly { get => Native.OuterOnly != 0; set => Native.OuterOnly = value ? 1 : 0; }

        /// <summary>
        /// Any number: which series of frames a job belongs to, where one context computes several molecules in turn.
        /// <see cref="FrameBudget"/> learns from each series apart; the context remembers the
        /// <see cref="RememberedSeries"/> that were used last.
        /// </summary>
        public uint Series { get => Native.Series; set => Native.Series = value; }

        /// <summary>
        /// Where the mesh is wanted. Device and Both need CUDA. Arrays of a mesh that is not wanted on the host are empty
        /// in <see cref="SurfaceMeshView"/>; numbers are there always. With None, area, volume and areas of atoms of SAS
        /// and VDW are computed without a mesh.
        /// </summary>
        public MeshDelivery Delivery { get => Native.Delivery; set => Native.Delivery = value; }

        /// <summary>
        /// Milliseconds, 0 to 60000, that it takes the caller to show 10^6 bytes of the mesh; 0 by default.
        /// <see cref="FrameBudget"/> then covers computing and showing together.
        /// </summary>
        public float ShowMillisecondsPerMegabyte { get => Native.ShowMsPerMb; set => Native.ShowMsPerMb = value; }

        /// <summary>
        /// Whether the mesh comes with what makes <see cref="KeptMesh.TryPick"/> fast: 1 % more memory, up to 3 % more time.
        /// </summary>
        public bool Pickable { get => Native.Pickable != 0; set => Native.Pickable = value ? 1 : 0; }

        /// <summary>
        /// Whether edges of triangles that cut across a crease are split on it: sharp rims, some more triangles. Not with
        /// the grid method, nor of Gaussian surfaces.
        /// </summary>
        public bool Creases { get => Native.Creases != 0; set => Native.Creases = value ? 1 : 0; }

        /// <summary>
        /// Whether a vertex on a crease is there once per side, each time with the normal of that side; with
        /// <see cref="SurfaceMeshView.Repeated"/> taken for one the mesh is closed. The grid method knows no
        /// creases, so that each is there once; not of Gaussian surfaces.
        /// </summary>
        public bool HardEdges { get => Native.HardEdges != 0; set => Native.HardEdges = value ? 1 : 0; }

        /// <summary>
        /// Whether <see cref="SurfaceMeshView.AtomAreas"/> is filled: of SAS and VDW that costs next to nothing. Not
        /// with the grid method.
        /// </summary>
        public bool AtomAreas { get => Native.AtomAreas != 0; set => Native.AtomAreas = value ? 1 : 0; }

        /// <summary>
        /// Ambient occlusion: vertices have texture coordinates, of which the first number is the part of an even sky's
        /// light that arrives there, from 0 (closed in) to 1 (open); what is farther than 20 Å does not count.
        /// </summary>
        public bool Occlusion { get => Native.Occlusion != 0; set => Native.Occlusion = value ? 1 : 0; }

        /// <summary>
        /// Of <see cref="SurfaceKind.Gaussian"/>, 0.05 to 10: an atom's standard deviation over its radius, as the radius scale
        /// of VMD's QuickSurf. No creases, hard edges or kinds of patch there.
        /// </summary>
        public float GaussianRadiusScale
        {
            get => Native.GaussianRadiusScale;
            set => Native.GaussianRadiusScale = value;
        }

        /// <summary>Of <see cref="SurfaceKind.Gaussian"/>, 0.01 to 1000: the density on the surface.</summary>
        public float GaussianIsovalue { get => Native.GaussianIsovalue; set => Native.GaussianIsovalue = value; }

        /// <summary>
        /// Whether a mesh of <see cref="MeshDelivery.Host"/> goes out without <see cref="SurfaceMeshView.Owners"/>, which
        /// are empty then: large meshes come sooner from a GPU. Atoms of components, and painting, filtering and picking
        /// of a <see cref="KeptMesh"/>, need them.
        /// </summary>
        public bool WithoutOwners { get => Native.WithoutOwners != 0; set => Native.WithoutOwners = value ? 1 : 0; }

        /// <summary>How many coarser levels come before <see cref="Spacing"/> in a job.</summary>
        public int LevelCount => (int)Native.LevelCount;

        /// <summary>The spacing of coarser level k, Å; k from 0 to <see cref="LevelCount"/> - 1.</summary>
        public unsafe float GetLevel(int k)
        {
            if ((uint)k >= Native.LevelCount)
                throw new ArgumentOutOfRangeException(nameof(k), k, $"there are {Native.LevelCount} levels");
            return Native.Levels[k];
        }

        /// <summary>
        /// Sets the spacings, Å, of the coarser levels of a job: each 0.001 to 100, falling, at most
        /// <see cref="MaxLevels"/>; those not above <see cref="Spacing"/> are left out. Empty: only
        /// <see cref="Spacing"/>.
        /// </summary>
        public unsafe void SetLevels(ReadOnlySpan<float> spacings)
        {
            if (spacings.Length > MaxLevels)
                throw new ArgumentException($"{spacings.Length} levels, but at most {MaxLevels} are possible",
                    nameof(spacings));
            for (int k = 0; k < spacings.Length; ++k)
                Native.Levels[k] = spacings[k];
            Native.LevelCount = (uint)spacings.Length;
        }

        /// <summary>Byte for byte: all members have four, so there is nothing between them.</summary>
        internal static unsafe bool AreSame(SurfaceSettings one, SurfaceSettings other) =>
            new ReadOnlySpan<byte>(&one, sizeof(SurfaceSettings)).SequenceEqual(
                new ReadOnlySpan<byte>(&other, sizeof(SurfaceSettings)));

        internal void ThrowIfUninitialised()
        {
            if (Native.StructSize == 0)
                throw new ArgumentException("is empty: begin with SurfaceSettings.Default", "settings");
        }
    }
}
