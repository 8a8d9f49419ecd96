// SPDX-License-Identifier: MIT
// The enumerations of quickses.h. Names follow the header, so that one manual serves both.
namespace QuickSes
{
    /// <summary>How a call into the native library ended.</summary>
    public enum QuickSesStatus
    {
        /// <summary>Success.</summary>
        Ok = 0,
        /// <summary>An argument is wrong; the message names it.</summary>
        InvalidArgument = 1,
        /// <summary>The memory budget, the device or the machine refused memory.</summary>
        OutOfMemory = 2,
        /// <summary>The back end asked for, or the native library itself, can't be used here.</summary>
        BackendUnavailable = 3,
        /// <summary>The GPU or its driver reported an error; the message says if it ends CUDA for the process.</summary>
        DeviceError = 4,
        /// <summary>
        /// The spacing needs more vertices than 32-bit indices, or finer places than float32, can name.
        /// </summary>
        TooFine = 5,
        /// <summary>No mesh has been computed or collected yet.</summary>
        NoResult = 6,
        /// <summary>A broken invariant of the library: please report it with the input.</summary>
        InternalError = 7,
        /// <summary>Cancelled meanwhile.</summary>
        Cancelled = 8,
        /// <summary>A file or buffer can't be read, or what is in it can't be used.</summary>
        FileError = 9,
        /// <summary>No frame of the trajectory has a periodic box, so there is nothing to unwrap.</summary>
        NoBox = 10,
        /// <summary>The context has no atoms yet.</summary>
        NoAtoms = 11,
        /// <summary>No level was finished since the last time: not an error in itself.</summary>
        NothingNew = 12,
        /// <summary>What is there already has to be done first; try again later: not an error in itself.</summary>
        Busy = 13
    }

    /// <summary>What computes.</summary>
    public enum SurfaceBackend
    {
        /// <summary>CUDA if a usable device is present, else the CPU.</summary>
        Auto = 0,
        /// <summary>An NVIDIA GPU.</summary>
        Cuda = 1,
        /// <summary>The threads of the CPU.</summary>
        Cpu = 2
    }

    /// <summary>Which surface of a molecule.</summary>
    public enum SurfaceKind
    {
        /// <summary>Solvent-excluded: what a probe sphere rolling over the atoms can't reach.</summary>
        Ses = 0,
        /// <summary>Solvent-accessible: where the centre of the probe may be.</summary>
        Sas = 1,
        /// <summary>Van der Waals: the union of the atoms themselves.</summary>
        Vdw = 2,
        /// <summary>
        /// Where a density of Gaussians about the atoms has a value, as QuickSurf of VMD defines it
        /// (<see cref="SurfaceSettings.GaussianRadiusScale"/>).
        /// </summary>
        Gaussian = 3
    }

    /// <summary>How the surface is computed.</summary>
    public enum SurfaceMethod
    {
        /// <summary>Vertices on the exact surface.</summary>
        Exact = 0,
        /// <summary>The voxel method of Martinez, Krone and Baaden 2019 (SES only): the published baseline.</summary>
        Grid = 1
    }

    /// <summary>The order of a triangle's vertices.</summary>
    public enum SurfaceWinding
    {
        /// <summary>
        /// cross(b - a, c - a) points out of the molecule: Unity's front face, in Unity's coordinates.
        /// </summary>
        Outward = 0,
        /// <summary>The opposite, for callers who mirror an axis afterwards.</summary>
        Reversed = 1
    }

    /// <summary>
    /// How positions and normals of a mesh lie in memory. Colours, texture coordinates, owners and patches always have
    /// arrays of their own.
    /// </summary>
    public enum SurfaceVertexLayout
    {
        /// <summary>One tightly packed array each.</summary>
        Separate = 0,
        /// <summary>Behind each other: float position[3], float normal[3]; 24 bytes per vertex.</summary>
        Interleaved = 1,
        /// <summary>
        /// float position[3], sbyte normal[4], in multiples of 1/127 (SNorm8); 16 bytes per vertex.
        /// </summary>
        Compact = 2
    }

    /// <summary>Where a mesh is handed out.</summary>
    public enum MeshDelivery
    {
        /// <summary>In host memory.</summary>
        Host = 0,
        /// <summary>
        /// On the CUDA device (<see cref="SurfaceContext.TryCollectDevice"/>): nothing is downloaded.
        /// </summary>
        Device = 1,
        /// <summary>In both.</summary>
        Both = 2,
        /// <summary>Nowhere: only the numbers are wanted (<see cref="SurfaceReport"/>).</summary>
        None = 3
    }

    /// <summary>Where area and volume come from.</summary>
    public enum SurfaceMeasuredBy
    {
        /// <summary>They were not asked for.</summary>
        Nothing = 0,
        /// <summary>Sums over flat triangles: the grid method.</summary>
        Triangles = 1,
        /// <summary>Triangles bent along the exact normals of their corners: SES and Gaussian.</summary>
        Normals = 2,
        /// <summary>Exact, from what each atom leaves free of the others: SAS and VDW.</summary>
        Atoms = 3
    }

    /// <summary>What kind of surface a vertex lies on (Connolly's three).</summary>
    public enum SurfacePatch : byte
    {
        /// <summary>Convex: on one atom.</summary>
        Contact = 0,
        /// <summary>Saddle: the probe touches two atoms.</summary>
        Toroidal = 1,
        /// <summary>Concave: the probe touches three or more atoms.</summary>
        Reentrant = 2
    }

    /// <summary>How a job stands.</summary>
    public enum SurfaceJobState
    {
        /// <summary>None was begun.</summary>
        Idle = 0,
        /// <summary>Running, or waiting to run.</summary>
        Running = 1,
        /// <summary>All levels are computed.</summary>
        Finished = 2,
        /// <summary>Ended by <see cref="SurfaceContext.Cancel"/>, before the last level was finished.</summary>
        Cancelled = 3,
        /// <summary>Status and message say why; levels finished before can be collected.</summary>
        Failed = 4
    }

    /// <summary>The format of a file of atoms.</summary>
    public enum StructureFormat
    {
        /// <summary>By the extension of the file's name, else by the content (PDB and mmCIF).</summary>
        Auto = 0,
        /// <summary>Protein Data Bank.</summary>
        Pdb = 1,
        /// <summary>Macromolecular crystallographic information file.</summary>
        Mmcif = 2,
        /// <summary>PDB with charges and radii of its own.</summary>
        Pqr = 3,
        /// <summary>x y z radius per line: no names, no elements.</summary>
        Xyzr = 4,
        /// <summary>GROMACS.</summary>
        Gro = 5
    }

    /// <summary>The format of a trajectory.</summary>
    public enum TrajectoryFormat
    {
        /// <summary>By the extension of the file's name, else by the content.</summary>
        Auto = 0,
        /// <summary>CHARMM, NAMD, X-PLOR.</summary>
        Dcd = 1,
        /// <summary>GROMACS; nm become Å.</summary>
        Xtc = 2,
        /// <summary>PDB with several models.</summary>
        Pdb = 3,
        /// <summary>GROMACS, in full precision; nm become Å; frames without positions are left out.</summary>
        Trr = 4,
        /// <summary>AMBER, in netCDF's classic format (CDF-1, -2 and -5, not HDF5); also restart files.</summary>
        Netcdf = 5
    }
}
