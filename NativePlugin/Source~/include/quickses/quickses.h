/* SPDX-License-Identifier: MIT
 *
 * QuickSES for Unity: molecular surfaces as closed triangle meshes.
 *
 * This header is the manual of the library. It is C99 and needs nothing but <stddef.h>, <stdint.h> and <string.h>.
 * quickses_gpu.h beside it, which is experimental, is for meshes that go from CUDA to a graphics API without leaving
 * the GPU. Documentation~/api.md has an example for each group of functions.
 *
 * In one page
 *   qses_context_options options;            qses_settings settings;            qses_mesh mesh;
 *   qses_context_options_init(&options);     qses_settings_init(&settings);     qses_mesh_init(&mesh);
 *   qses_context *context = NULL;
 *   if (qses_context_create(&options, &context) != QSES_OK) { puts(qses_last_error()); return 1; }
 *   qses_set_atoms(context, xyz, 0, radii, atom_count);
 *   if (qses_compute(context, &settings, &mesh) != QSES_OK) puts(qses_last_error());
 *   ... mesh.positions, mesh.normals, mesh.owners, mesh.indices ...
 *   qses_set_positions(context, next_frame_xyz, 0, atom_count);      (and compute again: memory is reused)
 *   qses_context_destroy(context);
 *
 * Names
 *   qses_<object>_<verb> acts on an object: qses_context_create, qses_structure_open, qses_kept_mesh_pick.
 *   qses_<object>_<noun> tells something about one: qses_backend_info, qses_context_mesh, qses_structure_warning.
 *   qses_<verb>, without an object, acts on a context, its first argument: qses_set_atoms, qses_compute, qses_keep.
 *   qses_<structure>_init prepares a structure. Alone stand qses_version, qses_abi_version and qses_last_error.
 *
 * Units and conventions
 *   Lengths are in angstrom (Å), areas in Å², volumes in Å³, times in milliseconds, memory in bytes.
 *   Positions come in and go out as float32. The accuracy figures of the manual hold for coordinates up to 1000 Å from
 *   the origin; beyond that the rounding of float32 itself adds to them.
 *   Triangles have cross(b - a, c - a) pointing outward in the numbers they are given in: counter-clockwise in a
 *   right-handed frame, and exactly the front face of Unity where the numbers are Unity's. A caller who mirrors an axis
 *   afterwards asks for QSES_WINDING_REVERSED.
 *   Owner atoms are 0-based indices into the array the caller gave to qses_set_atoms.
 *
 * Guarantees
 *   The mesh is a closed, consistently oriented 2-manifold for every input, by construction: no tolerance decides about
 *   it. It has no NaN; every owner index is valid.
 *   The same input, back end and settings give the same bytes, also with a slice size or a memory budget. (The CPU back
 *   end rounds differently on processors without AVX2 and FMA; qses_backend_info names the instruction set in use.)
 *   qses_compute gives the bytes that a job with the same settings ends with. The rounding mode of the calling thread,
 *   and how it treats denormal numbers, change nothing but digits in messages, and are left as they are.
 *
 * Structures
 *   A structure that begins with struct_size is prepared by its qses_..._init before a function gets it. That function
 *   is part of this header, so it writes the size and the defaults of the header that the caller was compiled with, and
 *   the library reads and writes no byte behind that size. So callers and libraries of different releases work together
 *   as long as QSES_ABI_VERSION is the same. Later releases append fields, for which 0 means what was before them:
 *   - a structure shorter than the library's: what it lacks has its default, and is not filled in;
 *   - one that is longer: what the library does not know is left as it is in what it fills in; in options and settings
 *     it must be 0, else INVALID_ARGUMENT: what was asked for there would not be done.
 *   A struct_size that no header can have (below 8, above 4096, no multiple of the structure's alignment) is
 *   INVALID_ARGUMENT.
 *   qses_component and qses_stage_time have no size since they are elements of arrays: they never grow.
 *
 * Errors
 *   Every function that can fail returns a qses_status. qses_last_error() then holds a sentence that names what is
 *   wrong. The comment of a function names every status but OK and INTERNAL_ERROR that it returns. Nothing here prints,
 *   exits, aborts or throws, and no call leaves another CUDA device selected than it found.
 *   After an error the context is still usable, and the last good mesh stays valid. The exception is a fault of the GPU
 *   from which CUDA does not recover within the process (a kernel of this or another library that reads or writes a
 *   wrong address, a failed assertion, an uncorrectable error of its memory ...), or a cudaDeviceReset by other code of
 *   the process. A fault ends all use of CUDA in the process, also by other libraries. From then on all contexts with
 *   CUDA, on any GPU, give DEVICE_ERROR for whatever needs a GPU, with a sentence that says so, until they are
 *   destroyed, which works as usual; their last meshes in host memory stay valid, after a reset on Linux only. New
 *   contexts with CUDA are refused with BACKEND_UNAVAILABLE until the process ends; AUTO takes the CPU. Contexts on the
 *   CPU live on.
 *
 * Threads
 *   A context may be used by one thread at a time, but for qses_poll and qses_cancel, which may be called from any
 *   thread while another one uses the context. Different contexts are independent of each other. Functions without a
 *   context may be called from any thread at any time; kept meshes, structures and trajectories have rules of their
 *   own, below. Calls that compute look at least every 20 ms whether qses_cancel was called, as a rule; on a GPU,
 *   between kernels. A stack of 64 KiB suffices for every call on the CPU. Where the machine refuses threads, a context
 *   makes do with those there are, down to the calling thread. A thread that is in a call must not be ended from
 *   outside (pthread_cancel, TerminateThread): qses_cancel is there for that.
 *   On Linux, threads of the library inherit the processors that the thread is bound to which first computes in a
 *   context, or begins a job there, and are no more than these: let it be one that is not bound. A program of OpenMP
 *   with OMP_PROC_BIND or OMP_PLACES has its main thread bound to one processor. Nor are they more than the processors
 *   that the control groups of the process, as of a container, have time for. qses_context_info tells how many there
 *   are where the context is made. After a fork while nothing of the library ran, the child may make contexts on the
 *   CPU and compute in them, and in those that were made before, with its calling thread alone; contexts that had jobs
 *   (qses_begin) before must be neither used nor destroyed there. Where CUDA was used, no child can use it.
 */
#ifndef QUICKSES_QUICKSES_H
#define QUICKSES_QUICKSES_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#if defined(QSES_STATIC)
#define QSES_API
#elif defined(_WIN32)
#if defined(QSES_BUILDING)
#define QSES_API __declspec(dllexport)
#else
#define QSES_API __declspec(dllimport)
#endif
#else
#define QSES_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Increases whenever a structure or a function below changes in a way that old callers would notice, which appending a
 * field to a structure with a struct_size is not. */
#define QSES_ABI_VERSION 4

typedef enum qses_status {
  QSES_OK = 0,
  QSES_INVALID_ARGUMENT = 1,    /* an argument is wrong; the message names it */
  QSES_OUT_OF_MEMORY = 2,       /* the memory budget, the device or the machine refused memory */
  QSES_BACKEND_UNAVAILABLE = 3, /* the back end asked for can't be used here; the message says why */
  QSES_DEVICE_ERROR = 4,        /* the GPU or its driver reported an error */
  QSES_TOO_FINE = 5,            /* the spacing would need more vertices than 32-bit indices can name, or finer places
                                   than float32 can tell: atoms may lie 2^21 spacings from the middle of them all, and
                                   with GRID the probe's radius may be 16,384 spacings */
  QSES_NO_RESULT = 6,           /* no mesh has been computed or collected yet */
  QSES_INTERNAL_ERROR = 7,      /* a broken invariant of the library: please report it with the input */
  QSES_CANCELLED = 8,           /* qses_cancel was called meanwhile */
  QSES_FILE_ERROR = 9,          /* a file or buffer can't be read, or what is in it can't be used */
  QSES_NO_BOX = 10,             /* no frame of the trajectory has a periodic box, so there is nothing to unwrap */
  QSES_NO_ATOMS = 11,           /* qses_set_atoms has not been called for this context */
  QSES_NOTHING_NEW = 12,        /* qses_collect: no level was finished since the last call. Not an error in itself */
  QSES_BUSY = 13 /* what is there already has to be done first: try again later. Not an error in itself */
} qses_status;

/* 1 (yes) or 0 (no); any other number that is given counts as 1. */
typedef int32_t qses_bool;

typedef enum qses_backend {
  QSES_BACKEND_AUTO = 0, /* CUDA if a usable device is present that has room for a context, else the CPU */
  QSES_BACKEND_CUDA = 1,
  QSES_BACKEND_CPU = 2
} qses_backend;

typedef enum qses_surface {
  QSES_SURFACE_SES = 0,     /* solvent-excluded: what a probe sphere rolling over the atoms can't reach */
  QSES_SURFACE_SAS = 1,     /* solvent-accessible: where the centre of the probe may be */
  QSES_SURFACE_VDW = 2,     /* the union of the atoms themselves */
  QSES_SURFACE_GAUSSIAN = 3 /* where a density of Gaussians has a value, as QuickSurf of VMD defines it: see
                               settings.gaussian_radius_scale */
} qses_surface;

typedef enum qses_method {
  QSES_METHOD_EXACT = 0, /* vertices on the exact surface */
  QSES_METHOD_GRID = 1   /* the voxel method of Martinez, Krone, Baaden 2019 (SES only): the published baseline */
} qses_method;

typedef enum qses_winding {
  QSES_WINDING_OUTWARD = 0, /* cross(b - a, c - a) points out of the molecule */
  QSES_WINDING_REVERSED = 1 /* the opposite, for callers who mirror an axis afterwards */
} qses_winding;

/* How positions and normals of a mesh lie in memory. All else (colours, texture coordinates, owners, patches) has a
 * tightly packed array of its own: it may change where the surface does not. */
typedef enum qses_vertex_layout {
  QSES_VERTICES_SEPARATE = 0,    /* one tightly packed array each */
  QSES_VERTICES_INTERLEAVED = 1, /* behind each other, as a graphics API takes them in one copy: float position[3],
                                    float normal[3]; 24 bytes per vertex */
  QSES_VERTICES_COMPACT = 2      /* float position[3], int8_t normal[4]; 16 bytes per vertex. The components of the
                                    normal are rounded to multiples of 1/127 (SNorm8), which turns it by half a degree
                                    at most; the fourth is 0. Positions are the same as in the other layouts */
} qses_vertex_layout;

/* What kind of surface a vertex lies on (Connolly's three). */
typedef enum qses_patch {
  QSES_PATCH_CONTACT = 0,  /* convex: on one atom */
  QSES_PATCH_TOROIDAL = 1, /* saddle: the probe touches two atoms */
  QSES_PATCH_REENTRANT = 2 /* concave: the probe touches three or more atoms */
} qses_patch;

/* Device memory and CPU or GPU threads that compute surfaces, and the atoms they are computed of. Opaque. */
typedef struct qses_context qses_context;

/* Holds a mesh for longer than the context that computed it would, to be looked at, painted and picked in. Opaque. */
typedef struct qses_kept_mesh qses_kept_mesh;

/* For this header only: what each qses_..._init below begins with, a structure of zeros that knows its size. */
static inline void qses_clear(void *structure, uint32_t struct_size) {
  if (!structure) return;
  memset(structure, 0, struct_size);
  memcpy(structure, &struct_size, sizeof struct_size);
}

/* ---- versions and back ends ------------------------------------------------------------------------------------ */

/* The version of the library, such as "0.1.0". Static storage. */
QSES_API const char *qses_version(void);

/* QSES_ABI_VERSION of the library that is loaded; compare it with the header's before anything else. */
QSES_API uint32_t qses_abi_version(void);

typedef struct qses_backend_description {
  uint32_t struct_size; /* set by qses_backend_description_init */
  qses_bool available;  /* whether qses_context_create with this back end can succeed */
  char device[128];     /* what computes: the GPU's name, or the CPU's instruction set and thread count (one for each of
                           `processors`; from qses_context_info, how many of the context work at a time) */
  char reason[256]; /* if not available: why; with AUTO, why it is not CUDA; if preparing: what is done; else empty */
  uint64_t total_memory; /* bytes of the device, or of the machine; on Linux no more than the control groups of the
                            process may have, as in a container or a batch job */
  uint64_t free_memory;  /* bytes free at the time of the call, of total_memory; if preparing: before that */
  qses_bool preparing; /* whether the first qses_context_create for this GPU is loading the kernels, on another thread.
                          For a GPU newer than this library the driver compiles them then, for up to a minute, once
                          per driver version. 0 from a library that does not know the field */
  uint32_t processors; /* how many the calling thread may run on; on Linux no more than the control groups of the
                          process have time for. 0 from a library that does not know the field */
} qses_backend_description;

/* Empty description with struct_size set. NULL is ignored. */
static inline void qses_backend_description_init(qses_backend_description *description) {
  qses_clear(description, sizeof *description);
}

/* Tells whether a back end can be used here and, if not, why. AUTO describes the one that would be chosen; its reason
 * then says why CUDA was not. The first call for CUDA or AUTO in a process starts CUDA, which takes up to a second;
 * none waits while a GPU is preparing. Errors: INVALID_ARGUMENT (NULL, unknown back end). */
QSES_API qses_status qses_backend_info(qses_backend backend, qses_backend_description *description);

/* How many CUDA devices this library sees; their ordinals are 0 to *count - 1. 0 without CUDA, or where it does not
 * start (qses_backend_info says why). Starts CUDA, as qses_backend_info. Errors: INVALID_ARGUMENT. */
QSES_API qses_status qses_device_count(uint32_t *count);

/* The sentence that belongs to the last call that failed on this thread; "" if none has. Of one with more than 2047
 * bytes there is only so much of the beginning, in whole letters. Valid until the next call into the library from the
 * same thread. Never NULL. */
QSES_API const char *qses_last_error(void);

/* ---- contexts -------------------------------------------------------------------------------------------------- */

typedef struct qses_context_options {
  uint32_t struct_size;   /* set by qses_context_options_init */
  qses_backend backend;   /* default AUTO */
  int32_t device;         /* CUDA device ordinal; default 0 */
  uint32_t threads;       /* CPU threads, of this context's own, at most 4096; 0 (default) = one per hardware thread.
                             Contexts that compute at once do best with a part of the processors each. With CUDA up to
                             8, the caller's among them, copy atoms if there are 16,384 or more; those do not stand
                             back, since the caller waits for them */
  uint64_t memory_budget; /* bytes; 0 (default): what is free at the time (see qses_backend_description.free_memory),
                             on the CPU for the mesh as well. With CUDA it covers everything on the device:
                             where the mesh does not fit, it leaves the device piece by piece. On the CPU it covers
                             the work; the mesh that is handed out comes on top (qses_report.mesh_bytes). The mesh is
                             the same byte for byte; only the time grows. qses_estimate tells what is needed. The
                             first computation takes the budget in one piece, however small the surface */
  qses_bool background;   /* 1: threads of the library that compute stand back behind those of normal priority (Windows:
                             below normal; Linux: 10 nicer, so a busy thread beside them loses a tenth at most); a
                             caller lends its thread as it is. Kernels of the GPU have the lowest priority either way,
                             but for those of coarser levels and those that place vertices of large meshes */
  uint32_t reserved;      /* 0 */
} qses_context_options;

/* The defaults, with struct_size set. NULL is ignored. */
static inline void qses_context_options_init(qses_context_options *options) { qses_clear(options, sizeof *options); }

/* Makes a context. options may be NULL (defaults). On success *context is owned by the caller, who ends it with
 * qses_context_destroy; on failure it is NULL.
 * With CUDA the first one of a process takes as long as CUDA needs to start, up to a second, and for a GPU newer than
 * this library up to a minute more (qses_backend_description.preparing): make it on a thread that may wait. Later ones
 * take milliseconds. From then on, or once CUDA was asked about, the library stays in the process: a host that unloads
 * it gets the same one when it loads it again, since threads of it and of the driver end later than contexts.
 * Errors: INVALID_ARGUMENT, BACKEND_UNAVAILABLE, OUT_OF_MEMORY, DEVICE_ERROR. */
QSES_API qses_status qses_context_create(const qses_context_options *options, qses_context **context);

/* Cancels what still runs and waits for its end, then frees the context and everything it handed out. No other thread
 * may be in a call on the context. NULL is ignored. */
QSES_API void qses_context_destroy(qses_context *context);

/* Which back end the context uses (CUDA or CPU, never AUTO), with the device's name and the memory that was free when
 * it was made. reason says, for a context made with AUTO, why it is not CUDA. Either pointer may be NULL. Errors:
 * INVALID_ARGUMENT. */
QSES_API qses_status qses_context_info(const qses_context *context, qses_backend *backend,
                                       qses_backend_description *description);

/* ---- atoms ----------------------------------------------------------------------------------------------------- */

/* Gives the context its atoms. Everything is copied before the call returns.
 *   positions  count positions of three floats x, y, z in Å, each stride bytes after the one before;
 *              stride 0 means tightly packed (12 bytes); else a multiple of 4, at least 12
 *   radii      count van der Waals radii in Å, above 0 and at most 100
 *   count      number of atoms, at most 2^31 - 1; 0 is allowed and gives an empty mesh
 * Two atoms at the same place count as the larger of them (of equals, as the first), but in the density of GAUSSIAN,
 * which adds up all there are. An atom inside another one owns no vertex.
 * Errors: INVALID_ARGUMENT (NULL, stride, a position that is NaN or infinite or beyond 1e6 Å, a radius out of range:
 * the message names the atom's index), OUT_OF_MEMORY, DEVICE_ERROR. The atoms set before stay in place after an error.
 */
QSES_API qses_status qses_set_atoms(qses_context *context, const float *positions, size_t stride, const float *radii,
                                    size_t count);

/* New positions for the atoms of qses_set_atoms, for instance the next frame of a trajectory; radii stay.
 * count must be the number of atoms. Errors: NO_ATOMS; else as of qses_set_atoms. */
QSES_API qses_status qses_set_positions(qses_context *context, const float *positions, size_t stride, size_t count);

/* The same for atoms that are picked out of a larger array, such as a frame that has solvent too: the new position of
 * atom i is positions[indices[i]].
 *   positions  position_count of them, as in qses_set_atoms; only those that are picked are looked at
 *   indices    count of them, each below position_count; count must be the number of atoms
 * Errors: as of qses_set_positions; INVALID_ARGUMENT also for an index that is out of range. */
QSES_API qses_status qses_set_positions_indexed(qses_context *context, const float *positions, size_t stride,
                                                size_t position_count, const uint32_t *indices, size_t count);

/* ---- appearance --------------------------------------------------------------------------------------------------
 * What vertices take from the atoms that own them. Copied before the calls return. It holds for computations that begin
 * afterwards, until it is set again; a qses_set_atoms that changes the number of atoms brings the defaults back. count
 * must be the number of atoms. Errors of all three: INVALID_ARGUMENT, NO_ATOMS, OUT_OF_MEMORY. */

/* Which atoms are shown: one byte per atom, 0 for hidden; NULL: all are shown (default). The surface is that of all
 * atoms; triangles with a vertex whose owner is hidden are dropped, and vertices that no triangle uses, so the mesh is
 * open along the border of what is hidden. Owners keep the caller's numbers, vertices and triangles their order. Area,
 * volume and components are those of the whole surface. The whole mesh needs memory besides the one handed out. */
QSES_API qses_status qses_set_visible(qses_context *context, const uint8_t *visible, size_t count);

/* Colours per atom, red, green, blue, alpha, 8 bits each, which go to the vertices the atom owns. NULL: none (default).
 * Colours that change while the surface stays need no computation: qses_kept_mesh_paint. */
QSES_API qses_status qses_set_colors(qses_context *context, const uint8_t *rgba, size_t count);

/* Two numbers per atom for the texture coordinates of its vertices (settings.texcoords), for instance values to be
 * coloured by a shader. NULL: 1, 0 (default), which shaders with ambient occlusion in the first one take for none. Not
 * checked. */
QSES_API qses_status qses_set_texcoords(qses_context *context, const float *uv, size_t count);

/* ---- computing ------------------------------------------------------------------------------------------------- */

/* Where a mesh is handed out. */
typedef enum qses_delivery {
  QSES_DELIVERY_HOST = 0,   /* in host memory: qses_mesh has pointers */
  QSES_DELIVERY_DEVICE = 1, /* on the CUDA device (qses_collect_device); nothing is downloaded, and the arrays of
                               qses_mesh are NULL */
  QSES_DELIVERY_BOTH = 2,
  QSES_DELIVERY_NONE = 3 /* nowhere: only the numbers are wanted, and the arrays of qses_mesh are NULL. Of SAS and VDW
                            (method EXACT), area, volume and atom_areas come from the atoms: no mesh is made, unless
                            components are asked for, and vertex_count is 0 */
} qses_delivery;

#define QSES_MAX_LEVELS 8
#define QSES_REMEMBERED_SERIES 512

typedef struct qses_settings {
  uint32_t struct_size; /* set by qses_settings_init */
  qses_surface surface; /* default SES */
  qses_method method;   /* default EXACT */
  float probe_radius; /* Å, 0 to 100; default 1.4 (water). Ignored by VDW and GAUSSIAN. With method EXACT, the SES of a
                         probe below 0.05 Å is computed as the VDW surface, from which it hardly differs */
  float spacing;      /* Å between the points of the lattice on whose edges vertices begin (the paper's "voxel size"):
                         how fine the mesh is. What lies between its points is missing: at 2 Å, an ion that touches
                         nothing may be. 0.001 to 100; default 0.5 */
  uint32_t relaxation_steps; /* default 1, at most 100. EXACT: tangential smoothing, each step projected back onto the
                                exact surface; what is no wider than a few spacings may lose area to it. GRID: Laplacian
                                smoothing as in the paper, which moves off it */
  uint32_t slice_size;   /* 0 (default): work on as much at a time as memory allows. Else at least 8: in slices of at
                            most slice_size³ lattice points; the mesh is the same byte for byte. Smaller slices need
                            less memory with CUDA; on the CPU they change little */
  qses_winding winding;  /* default OUTWARD */
  qses_bool patch_types; /* 1: qses_mesh.patches is filled; default 0. Not with GRID, nor of GAUSSIAN */
  qses_bool measure;     /* 1 (default): qses_report.area and .volume are computed (see qses_measured_by); 0: they are
                            0 */
  uint32_t tag;          /* any number; comes back in qses_mesh.tag and qses_progress.tag */
  uint32_t level_count;  /* of levels, at most QSES_MAX_LEVELS; default 2 */
  float levels[QSES_MAX_LEVELS]; /* Å, each 0.001 to 100; for qses_begin: coarser spacings, falling, each below the one
                                    before. Their surfaces come before that of `spacing`, each a complete closed mesh on
                                    the true surface. Those that are not above `spacing` are left out. Default 2, 1. If
                                    each of the spacings divides the coarsest one without rest, the lattices of all
                                    levels have a point at the origin, else only the finest has. qses_compute
                                    computes no levels, but they decide there too where the lattice lies: with other
                                    levels its mesh differs by what float32 rounds */
  qses_vertex_layout vertex_layout; /* default SEPARATE */
  qses_bool texcoords;              /* 1: vertices have texture coordinates (see qses_set_texcoords, and occlusion
                                       below); default 0 */
  float frame_budget_ms;  /* for qses_begin: 0 (default): all levels one after the other. Above 0, at most 60000: one
                             level only, the finest of them (`spacing` being the last) that is expected to take no
                             longer than this, ms, or the coarsest if none is. Expected is what the last frames of the
                             series (below) say: the time from the start of the work to the mesh in host memory, and
                             what show_ms_per_mb (below) adds. The first frame is the coarsest; what was learnt is
                             forgotten when the number of atoms, surface, method, probe_radius, relaxation_steps,
                             slice_size, creases, hard_edges, occlusion, gaussian_radius_scale, gaussian_isovalue,
                             spacing or levels change within a series. Now and then a frame takes longer, when a finer
                             level is tried: so a surface that became cheaper gets finer again. Which level it was is in
                             qses_mesh.level and .spacing. Like everything that depends on time, the choice of the level
                             is not the same in every run; the mesh of a level is */
  qses_bool components;   /* 1: qses_mesh.components is filled; default 0, which costs nothing */
  uint32_t series;        /* which series of frames a job belongs to: any number; default 0. For callers who let one
                             context compute several molecules in turn: frame_budget_ms learns from each series apart.
                             The QSES_REMEMBERED_SERIES that were used last are remembered; an older one begins anew */
  qses_delivery delivery; /* where the mesh is wanted; default HOST. DEVICE and BOTH need CUDA. A mesh that is wanted on
                             the device does not leave it in pieces where memory is short: that is OUT_OF_MEMORY */
  float show_ms_per_mb;   /* 0 to 60000; default 0: ms that it takes the caller to show 10^6 bytes of the mesh, as
                             qses_report.mesh_bytes counts them (its copies to a graphics API, for instance).
                             frame_budget_ms then covers computing and showing together. May change from frame to frame
                             as it is measured */
  qses_bool pickable;     /* 1: the mesh comes with what makes qses_kept_mesh_pick fast: 1 % more memory, and up to
                             3 % more time on the CPU, 0.04 to 0.2 ms on a GPU; default 0 */
  qses_bool creases;      /* 1: the edges of triangles that cut across a crease, where sheets of the surface meet at an
                             angle, are split on it: sharp rims, a few per cent more triangles, and area along the
                             normals to a thousandth. At `spacing` only, not at the coarser levels. And normals that
                             would point against a triangle of their vertex are turned, also by hard_edges. Default 0.
                             Not with GRID, nor of GAUSSIAN */
  qses_bool hard_edges;   /* 1: a vertex on a crease is there once per side, each time with the normal of that side, so
                             that light breaks where the surface does. The mesh is then closed once vertices at the same
                             place are taken for one. Default 0: one vertex, with the mean normal. GRID knows no
                             creases, so that each is there once. Not of GAUSSIAN */
  qses_bool component_ids; /* 1: qses_mesh.component_ids is filled, and the components; default 0 */
  qses_bool outer_only;    /* 1: the walls of cavities are left out of the mesh, not of area, volume and components,
                              which are filled; the outer surface of what lies within a cavity stays. Default 0 */
  qses_bool atom_areas;    /* 1: qses_mesh.atom_areas is filled; default 0. Of SAS and VDW it costs next to nothing, of
                              SES and GAUSSIAN as much as to measure them. Not with GRID */
  qses_bool occlusion; /* 1: ambient occlusion. Vertices have texture coordinates, and the first number of each is how
                          open the surface is there: the part of the light of an even sky that arrives, from 0
                          (closed in) to 1 (a plain), whatever is farther than 20 Å left aside. The second is 1, so
                          that a shader can tell it from a mesh that has none and reads 0, 0; or that of
                          qses_set_texcoords. What shuts out light are the atoms, hidden ones too. Of an SES with the
                          usual probe it is .04 off in the mean, of SAS and VDW .07, and narrow slits are too
                          bright. Default 0 */
  float gaussian_radius_scale; /* of SURFACE_GAUSSIAN, 0.05 to 10; default 1: the density at a place is the sum of
                                  exp(-d² / 2s²) over the atoms, where d is the distance of the atom's centre and s its
                                  radius times this scale; atoms farther than 4 s add nothing. With a scale
                                  below 0.25 they own no vertices, either, even where they are the nearest. (Radius
                                  scale of QuickSurf, Krone and others 2012; its grid spacing is `spacing`, 1 in VMD) */
  float gaussian_isovalue;     /* the surface is where the density has this value, 0.01 to 1000; default 0.5, as in VMD.
                                  Vertices are at it within a thousandth of the spacing, normals along the density's
                                  exact gradient. No smoothing steps, creases, hard edges or kinds of patch; area and
                                  volume through the normals */
  qses_bool without_owners;    /* 1: a mesh of delivery HOST has no owners: qses_mesh.owners is NULL, and
                                  qses_component_atoms, qses_kept_mesh_paint, _filter and _pick are INVALID_ARGUMENT.
                                  From a GPU a large mesh comes 4 to 7 % sooner. Default 0 */
} qses_settings;

/* The defaults, with struct_size set. NULL is ignored. */
static inline void qses_settings_init(qses_settings *settings) {
  if (!settings) return;
  qses_clear(settings, sizeof *settings);
  settings->probe_radius = 1.4f;
  settings->spacing = 0.5f;
  settings->relaxation_steps = 1;
  settings->measure = 1;
  settings->levels[0] = 2.0f;
  settings->levels[1] = 1.0f;
  settings->level_count = 2;
  settings->gaussian_radius_scale = 1.0f;
  settings->gaussian_isovalue = 0.5f;
}

/* One connected piece of the surface: an outer surface, or the wall of a cavity. An element of an array: it never
 * grows; what else there will be to say comes in arrays beside it. */
typedef struct qses_component {
  uint64_t triangles;
  double area;         /* Å², through the normals as qses_report.area of the SES */
  double volume;       /* Å³, enclosed, through the normals as well; negative for a cavity, whatever the winding */
  qses_bool is_cavity; /* whether its triangles enclose a negative volume, and face where their normals point to: else
                          it is a speck that was turned inside out (settings.relaxation_steps). Only of what encloses
                          next to nothing may `volume` say otherwise */
  float center[3];     /* Å, centre of the volume that its triangles enclose; of its box if that is next to nothing */
  float bounds_min[3]; /* box of its vertices, Å */
  float bounds_max[3];
} qses_component;

/* A view of a mesh in memory of the context: valid until the next qses_compute, qses_collect, qses_collect_device or
 * qses_keep that succeeds on the same context, or qses_context_destroy; also while jobs run. (Page-locked memory with
 * CUDA.) That of a kept mesh is valid until something else is kept there, qses_kept_mesh_clear or
 * qses_kept_mesh_destroy. Nothing here may be written or freed by the caller. */
typedef struct qses_mesh {
  uint32_t struct_size;    /* set by qses_mesh_init */
  uint32_t vertex_count;   /* V */
  uint32_t triangle_count; /* T */
  uint32_t tag;            /* as in the settings */
  const float *positions;  /* V x 3, Å. With settings.delivery DEVICE or NONE all arrays of vertices and indices are
                              NULL */
  const float *normals;   /* V x 3, unit length, outward; on a crease the mean of its sides', or as settings.creases and
                             hard_edges say. COMPACT: NULL, they are behind the positions */
  const uint8_t *colors;  /* V x 4, tightly packed, or NULL if there are none */
  const float *texcoords; /* V x 2, tightly packed, or NULL if not asked for */
  uint32_t vertex_bytes;  /* INTERLEAVED (24) and COMPACT (16), wherever the mesh is: bytes from one vertex to the next
                             in the vertices that positions points to, V * vertex_bytes bytes of memory. SEPARATE: 0,
                             positions and normals are tightly packed. 0 for an empty mesh */
  uint32_t reserved;      /* 0 */
  const uint32_t *owners; /* V, the atom whose van der Waals surface is nearest to the vertex; with GRID, to where it
                             was before it was smoothed. NULL with settings.without_owners */
  const uint8_t *patches; /* V of qses_patch, or NULL */
  const uint32_t *indices; /* T x 3 vertex numbers */
  float bounds_min[3];     /* box of the vertices, Å; all 0 for an empty mesh */
  float bounds_max[3];
  float spacing;                    /* Å, of the level */
  uint32_t level;                   /* 0 is the coarsest */
  uint32_t level_count;             /* levels there are with the settings, of qses_compute one: level_count - 1 is the
                                       finest */
  uint32_t component_count;         /* 0 if not asked for, or if there is no surface */
  const qses_component *components; /* NULL if there are none; in the order of their first vertices. Those of the whole
                                       surface where atoms are hidden. Their areas and volumes add up to those of
                                       qses_report, if that comes from the normals */
  const uint32_t *component_ids;    /* V, the number of the vertex's component, or NULL if not asked for */
  const double *atom_areas; /* atom_count, Å²: how much of the surface belongs to each of the caller's atoms; they add
                               up to qses_report.area. SAS and VDW: exactly, from the atoms. SES and GAUSSIAN: what of
                               each triangle is nearest to the atom, a third for each corner. In host memory with any
                               delivery. Those of the whole surface where atoms are hidden. NULL if not asked for */
  uint64_t atom_count;      /* 0 if atom_areas is NULL */
  const uint32_t *repeated; /* with settings.hard_edges: of the last repeated_count vertices, which vertex each of them
                               stands for on the other side of its crease, in ascending order. With these taken for one
                               the mesh is closed. NULL if there are none */
  uint64_t repeated_count;
  qses_bool has_texcoords; /* whether vertices have texture coordinates, wherever the mesh is; 0 for an empty one */
  uint32_t reserved2;      /* 0 */
} qses_mesh;

/* Empty view with struct_size set. NULL is ignored. */
static inline void qses_mesh_init(qses_mesh *mesh) { qses_clear(mesh, sizeof *mesh); }

/* Computes the surface of the context's atoms and waits for it. settings may be NULL (defaults); mesh may be NULL if
 * only qses_context_report is wanted, or the mesh later from qses_context_mesh.
 * Errors: INVALID_ARGUMENT (settings out of range: the message names the field), NO_ATOMS, TOO_FINE, OUT_OF_MEMORY (the
 * message says how much was needed), DEVICE_ERROR, CANCELLED (by qses_cancel from another thread; not if the mesh was
 * finished by then). */
QSES_API qses_status qses_compute(qses_context *context, const qses_settings *settings, qses_mesh *mesh);

/* Which atoms line each component of a mesh: those that own its vertices. (With qses_structure_description.residues
 * they tell the residues of a cavity.) What is left out of the mesh, hidden or by settings.outer_only, counts for
 * nothing.
 *   mesh    made with settings.component_ids, in host memory
 *   starts  room for component_count + 1 numbers, of which the first becomes 0
 *   atoms   the atoms of component k become atoms[starts[k]] to atoms[starts[k + 1] - 1], rising; NULL: only starts is
 *           written, whose last number tells how much room atoms needs
 *   room    of atoms, in numbers; with NULL it is ignored
 * Errors: INVALID_ARGUMENT (also: no component_ids; no owners; too little room, after which only starts is written),
 * OUT_OF_MEMORY. */
QSES_API qses_status qses_component_atoms(const qses_mesh *mesh, uint32_t *starts, uint32_t *atoms, size_t room);

/* The mesh of the last qses_compute or qses_collect that succeeded. Errors: INVALID_ARGUMENT, NO_RESULT. */
QSES_API qses_status qses_context_mesh(const qses_context *context, qses_mesh *mesh);

#define QSES_MAX_STAGES 16

/* An element of an array: it never grows. */
typedef struct qses_stage_time {
  char name[24];       /* of the file under surface/ that does the work, some with _cpu or _cuda behind it ("exact_ses"
                          stands for the signs of the exact method on either back end): "neighbor_grid",
                          "solvent_features", "bricks", "exact_ses", "grid_ses" or "gaussian_density", "thin_walls",
                          "marching_cubes", "projection", "relaxation", "creases", "measure" or, if components are asked
                          for, "components", "visible_mask", "hard_edges", "appearance" (with settings.occlusion:
                          "occlusion"), "pick_boxes", "mesh_memory" */
  double milliseconds; /* with CUDA: between events on the stream */
} qses_stage_time;

/* Where area and volume come from. */
typedef enum qses_measured_by {
  QSES_MEASURED_BY_NOTHING = 0,   /* not asked for */
  QSES_MEASURED_BY_TRIANGLES = 1, /* sums over flat triangles (method GRID) */
  QSES_MEASURED_BY_NORMALS = 2,   /* triangles bent along the exact normals of their corners: SES and GAUSSIAN. What is
                                       left falls with the square of the spacing, but for creases that triangles cut
                                       across (settings.creases) */
  QSES_MEASURED_BY_ATOMS = 3 /* exact, from what the others leave free of each atom, the same at every spacing: SAS and
                                VDW, and the SES of a probe below 0.05 Å. A molecule that is turned or moved has the
                                same within 1e-6, many small balls on a large one within 2e-5; where balls touch or
                                just close, as in ideal lattices, 2e-4 */
} qses_measured_by;

/* What was done for one mesh. */
typedef struct qses_report {
  uint32_t struct_size; /* set by qses_report_init */
  uint32_t stage_count;
  double area;              /* Å², as measured_by says */
  double volume;            /* Å³, enclosed; cavities count negative */
  double compute_ms;        /* atoms in host memory to mesh in host memory; for a later level: since the one before */
  uint64_t work_bytes_peak; /* most memory in use for the work: on the device with CUDA, else in host memory,
                               without the mesh */
  uint64_t mesh_bytes;      /* memory of the mesh itself, without its components; with settings.delivery NONE 0. On the
                               CPU, and where it leaves a GPU in pieces, owners take theirs without_owners, too */
  uint64_t host_bytes_peak; /* host memory of the context, the mesh included, and what is kept of its meshes */
  uint64_t brick_count;     /* bricks of 8x8x8 lattice points that were evaluated */
  uint64_t slice_count;     /* parts it was made in: of little memory several, and of a large mesh that leaves the GPU
                               while it is made */
  uint32_t hidden_vertices; /* what of the whole surface is left out of the mesh, since its atoms are hidden
                               (qses_set_visible) or it is of a cavity (settings.outer_only); else 0. Vertices are
                               counted before those on edges are repeated (settings.hard_edges) */
  uint32_t hidden_triangles;
  qses_stage_time stages[QSES_MAX_STAGES]; /* stage_count of them, in order; filled if asked for by
                                              qses_set_stage_times */
  uint64_t border_bricks; /* bricks that were added since the surface went on behind the border of those where it was
                             expected: they keep the mesh closed. 0 unless rounding hid a feature of the surface */
  uint64_t unplaced_vertices; /* vertices for which no feature of the surface was found: they stay where their lattice
                                 edge is cut. 0 unless rounding hid a feature of the surface */
  uint64_t attempts;    /* 1; more where memory was refused, and the work was done again in a way that takes less. What
                           sufficed is remembered, so the next frame of as many atoms is made at the first attempt */
  double triangle_area; /* Å² and Å³: sums over the triangles as they are; 0 if no mesh was made, or settings.measure
                           is 0 */
  double triangle_volume;
  qses_measured_by measured_by;
  uint32_t reserved; /* 0 */
} qses_report;

/* Empty report with struct_size set. NULL is ignored. */
static inline void qses_report_init(qses_report *report) { qses_clear(report, sizeof *report); }

/* Report of the mesh that the last qses_compute or qses_collect gave. Errors: INVALID_ARGUMENT, NO_RESULT. */
QSES_API qses_status qses_context_report(const qses_context *context, qses_report *report);

/* What a computation would give and need. */
typedef struct qses_size_estimate {
  uint32_t struct_size; /* set by qses_size_estimate_init */
  qses_bool fits;       /* whether it can be done: within the budget of the context, or else within what is free, on
                           the CPU with the mesh; and by 32-bit numbers of vertices and triangles */
  uint64_t vertices, triangles;
  uint64_t mesh_bytes; /* of the mesh, in host memory; of the whole one if atoms are hidden; 0 with delivery NONE, as
                          are vertices and triangles if no mesh is made */
  uint64_t work_bytes; /* what qses_report.work_bytes_peak would be: on the device with CUDA, else in host memory */
  uint64_t smallest_budget; /* the least qses_context_options.memory_budget that would do, with some reserve; with
                               settings.delivery DEVICE or BOTH also for the mesh, and for those of the context that
                               are held there now: the last one, too, stays until the next is finished */
} qses_size_estimate;

/* Empty estimate with struct_size set. NULL is ignored. */
static inline void qses_size_estimate_init(qses_size_estimate *estimate) { qses_clear(estimate, sizeof *estimate); }

/* Predicts the size of the mesh of settings.spacing (not of coarser levels), and the memory for it, without making it:
 * the features of the atoms are computed, and signs on lattices that are coarse enough to be cheap. All numbers are
 * within 25 % of the truth as a rule, and rarely more than 10 % below. What creases add to flat, regular or isolated
 * atoms is a guess, often too low by half, until the context has made such a surface. Waits for a running job. The last
 * mesh stays valid. settings may be NULL (defaults). Errors: as of qses_compute; also OUT_OF_MEMORY if the budget does
 * not even suffice for the estimate (the message names one that may do). */
QSES_API qses_status qses_estimate(qses_context *context, const qses_settings *settings, qses_size_estimate *estimate);

/* Switches the timing of the single stages on (1) or off (0, the default). With CUDA it costs some tens of microseconds
 * per surface. Waits for a running job. Errors: INVALID_ARGUMENT. */
QSES_API qses_status qses_set_stage_times(qses_context *context, qses_bool enabled);

/* Called from the computing thread during qses_compute and during jobs with the fraction done, rising from 0 to 1; at
 * most a few hundred times. It must not call into the library. NULL (default) switches it off. It is meant for command
 * line programs; games should not hand managed code to it. Waits for a running job. Errors: INVALID_ARGUMENT. */
typedef void (*qses_progress_callback)(void *user_data, double fraction);
QSES_API qses_status qses_set_progress_callback(qses_context *context, qses_progress_callback callback,
                                                void *user_data);

/* ---- jobs: a surface over time ----------------------------------------------------------------------------------- */

/* Starts computing the surface of the context's atoms as they are now, level after level (or one level chosen by
 * settings.frame_budget_ms), and returns at once. Atoms and positions may be set for the next job while this one runs.
 * During a job, a new one replaces it: the coarsest level of the job that runs is still finished and can be collected,
 * then the newest request starts; requests in between are dropped. So frames that come faster than levels never starve
 * the picture. Errors: INVALID_ARGUMENT (settings), NO_ATOMS, OUT_OF_MEMORY (the worker thread). What goes wrong later
 * belongs to the job: see qses_poll. */
QSES_API qses_status qses_begin(qses_context *context, const qses_settings *settings);

typedef enum qses_job_state {
  QSES_JOB_IDLE = 0,      /* none was begun, nor was qses_compute called, which shows as a job does */
  QSES_JOB_RUNNING = 1,   /* or waiting to run */
  QSES_JOB_FINISHED = 2,  /* all levels */
  QSES_JOB_CANCELLED = 3, /* by qses_cancel, before the last level was finished */
  QSES_JOB_FAILED = 4     /* status and message say why; levels finished before can be collected */
} qses_job_state;

typedef struct qses_progress {
  uint32_t struct_size; /* set by qses_progress_init */
  qses_job_state state;
  uint32_t tag;             /* of the settings of the job that runs, or ran last */
  uint32_t tag_requested;   /* of the newest qses_begin or qses_compute */
  uint32_t levels_finished; /* of this job */
  uint32_t level_count;     /* that this job computes: 1 with a frame budget */
  float fraction;           /* of this job's work: from 0 to 1, never falls */
  qses_bool mesh_ready;     /* whether qses_collect would succeed */
  qses_status status;       /* OK unless FAILED; then one that qses_compute returns */
  char message[256];        /* "" unless FAILED */
} qses_progress;

/* Empty progress with struct_size set. NULL is ignored. */
static inline void qses_progress_init(qses_progress *progress) { qses_clear(progress, sizeof *progress); }

/* How the job stands. May be called from any thread at any time before qses_context_destroy. Errors: INVALID_ARGUMENT.
 */
QSES_API qses_status qses_poll(const qses_context *context, qses_progress *progress);

/* The finest level that was finished since the last call. Its memory stays valid until the next qses_collect,
 * qses_collect_device, qses_compute or qses_keep that succeeds, or qses_context_destroy, also while further levels and
 * jobs are computed. Asking often is cheap. Errors: NOTHING_NEW (not an error in itself), INVALID_ARGUMENT. */
QSES_API qses_status qses_collect(qses_context *context, qses_mesh *mesh);

/* A mesh on a CUDA device, made with settings.delivery DEVICE or BOTH. It is finished: who reads it waits for nothing.
 */
typedef struct qses_device_mesh {
  uint32_t struct_size; /* set by qses_device_mesh_init */
  int32_t device;       /* CUDA ordinal */
  void *stream;         /* the cudaStream_t of the context that wrote the mesh */
  qses_mesh mesh;       /* as qses_collect gives it, but all arrays of vertices and triangles (positions, normals,
                           colors, texcoords, owners, patches, indices, component_ids, repeated) are in memory of the
                           device; components and atom_areas, if any, in host memory */
} qses_device_mesh;

/* Empty view with struct_size set, its own and that of its mesh, which both stay as they are. NULL is ignored. */
static inline void qses_device_mesh_init(qses_device_mesh *mesh) {
  if (!mesh) return;
  qses_clear(mesh, sizeof *mesh);
  qses_mesh_init(&mesh->mesh);
}

/* As qses_collect, but the mesh on the device. Where nothing is new it is the mesh of the last qses_compute,
 * qses_collect or qses_collect_device that succeeded: with delivery BOTH, ask for the one and then for the other. Its
 * memory stays valid as long as that of qses_collect. Nothing is copied, and nothing waits for the device.
 * Errors: NO_RESULT (nothing was made yet), INVALID_ARGUMENT (also: the mesh was made for HOST or NONE; what is new can
 * still be collected then). */
QSES_API qses_status qses_collect_device(qses_context *context, qses_device_mesh *mesh);

/* Ends the job that runs as soon as it can (levels finished before stay collectable) and drops the one that waits.
 * Returns at once; from any thread at any time before qses_context_destroy. Also ends a qses_compute or qses_estimate,
 * which then returns CANCELLED. What is finished already is not taken back: then compute returns OK with the mesh, and
 * the job is FINISHED. Errors: INVALID_ARGUMENT. */
QSES_API qses_status qses_cancel(qses_context *context);

/* Waits until no job runs or waits, or until the time is over (negative: without limit). OK either way; *finished,
 * which may be NULL, tells whether no job runs or waits. Errors: INVALID_ARGUMENT (NULL, a time that is no number). */
QSES_API qses_status qses_wait(qses_context *context, double milliseconds, qses_bool *finished);

/* ---- kept meshes -------------------------------------------------------------------------------------------------
 * A mesh that shall be there for longer than until the next one is collected is kept: its memory moves from the context
 * into a kept mesh, without a copy, and the context takes other memory for its next one. Meant to be filled again and
 * again: memory goes back to the context it came from, so that frame after frame allocates nothing. A context holds
 * back a few spare buffers, about as much as it needs for its next meshes; the rest goes back to the machine.
 *
 * Threads: one at a time may change a kept mesh (qses_keep, qses_kept_mesh_download, qses_kept_mesh_clear,
 * qses_kept_mesh_destroy), and then no other may use it; any number may look (the other functions) at a time. All this
 * may go on while the contexts compute, or after their end: a kept mesh outlives its context, without holding the
 * context's threads, work memory or GPU. */

/* Makes an empty one. On success *kept is the caller's, who ends it with qses_kept_mesh_destroy; on failure it is NULL.
 * Errors: INVALID_ARGUMENT, OUT_OF_MEMORY. */
QSES_API qses_status qses_kept_mesh_create(qses_kept_mesh **kept);

/* As qses_kept_mesh_clear; and ends it. NULL is ignored. */
QSES_API void qses_kept_mesh_destroy(qses_kept_mesh *kept);

/* Gives the memory back to the context it came from, or to the machine if that has ended. NULL is ignored. */
QSES_API void qses_kept_mesh_clear(qses_kept_mesh *kept);

/* Moves the mesh of the last qses_compute or qses_collect that succeeded, and its report, out of the context; what kept
 * held before is given back. The context has no mesh then (qses_context_mesh, qses_context_report: NO_RESULT) until the
 * next one. Also while jobs run. Takes some hundred nanoseconds. What it held is still there after an error. With
 * settings.delivery DEVICE or BOTH it keeps the mesh on the device, which counts as the context's until it is given
 * back, for a memory budget too.
 * Errors: INVALID_ARGUMENT (NULL; the mesh was made with settings.delivery NONE, so that there is none), NO_RESULT,
 * OUT_OF_MEMORY. */
QSES_API qses_status qses_keep(qses_context *context, qses_kept_mesh *kept);

/* Copies a mesh that is on the device only (settings.delivery DEVICE) into host memory, and waits for that: from then
 * on it has all that one of delivery BOTH has, the same bytes. Does nothing if it is there already, or empty. Changes
 * the kept mesh. Errors: INVALID_ARGUMENT, NO_RESULT (nothing is kept), OUT_OF_MEMORY, DEVICE_ERROR. */
QSES_API qses_status qses_kept_mesh_download(qses_kept_mesh *kept);

/* A view of the mesh; an empty mesh (vertex_count 0) if nothing is kept. While it is on the device only, counts and
 * bounds are there, but no arrays, and painting, filtering and picking are INVALID_ARGUMENT. Errors: INVALID_ARGUMENT.
 */
QSES_API qses_status qses_kept_mesh_view(const qses_kept_mesh *kept, qses_mesh *mesh);

/* What qses_context_report said about it. Errors: INVALID_ARGUMENT, NO_RESULT (nothing is kept). */
QSES_API qses_status qses_kept_mesh_report(const qses_kept_mesh *kept, qses_report *report);

/* Values of vertices out of those of the atoms that own them: colours, texture coordinates, anything.
 *   per_atom     atom_count values of value_bytes bytes; atom_count must be the number of atoms of the mesh
 *   value_bytes  4, 8, 12 or 16; values are copied as they are
 *   first, count which vertices; first + count at most vertex_count
 *   per_vertex   room for count values: that of vertex `first` comes first
 * Errors: INVALID_ARGUMENT. */
QSES_API qses_status qses_kept_mesh_paint(const qses_kept_mesh *kept, const void *per_atom, size_t value_bytes,
                                          size_t atom_count, uint32_t first, uint32_t count, void *per_vertex);

/* Those of a run of triangles whose three vertices all have owners that are visible, in their order.
 *   visible        one byte per atom, 0 for hidden; atom_count must be the number of atoms of the mesh
 *   first, count   which triangles; first + count at most triangle_count
 *   indices        room for 3 * count vertex numbers; what is behind those that are written may change too
 *   kept_triangles how many were written
 * Errors: INVALID_ARGUMENT. */
QSES_API qses_status qses_kept_mesh_filter(const qses_kept_mesh *kept, const uint8_t *visible, size_t atom_count,
                                           uint32_t first, uint32_t count, uint32_t *indices, uint32_t *kept_triangles);

/* Where a ray meets a mesh. */
typedef struct qses_hit {
  uint32_t struct_size; /* set by qses_hit_init */
  qses_bool found;      /* 0: the ray meets no triangle, and the rest is 0 */
  uint32_t triangle;
  uint32_t vertex;   /* the corner of the triangle that weighs most at the point */
  uint32_t owner;    /* its atom */
  float distance;    /* from the origin, in lengths of the direction; FLT_MAX where it is more */
  float position[3]; /* Å */
  float normal[3];   /* unit length, outward: between those of the corners */
} qses_hit;

/* Empty hit with struct_size set. NULL is ignored. */
static inline void qses_hit_init(qses_hit *hit) { qses_clear(hit, sizeof *hit); }

/* The first triangle that a ray meets, from either side. Borders of triangles count, so that no ray slips through
 * between two of them. With settings.pickable it takes some tens of microseconds, else it looks at all triangles.
 *   origin, direction  Å; direction of any length but 0
 *   visible            NULL, or as of qses_kept_mesh_filter: triangles that are left out there let rays through
 *   atom_count         of visible; with NULL it is ignored
 * Errors: INVALID_ARGUMENT (also: NaN, infinite, a direction of no length). */
QSES_API qses_status qses_kept_mesh_pick(const qses_kept_mesh *kept, const float origin[3], const float direction[3],
                                         const uint8_t *visible, size_t atom_count, qses_hit *hit);

/* ---- structures and trajectories --------------------------------------------------------------------------------- */

/* How many bytes structures and trajectories may take into memory from one file, pipe, device or buffer, unpacked: a
 * gzip file of 3 MB can hold 3 GB, and a device has no end. More is a FILE_ERROR. It holds for the whole process from
 * now on. 0 (default): 4 GiB, but of gzip data at most 100 times its size or 256 MiB, whichever is larger. Any other
 * number holds for all alike. Frames that stay in their file (not gzipped, and not PDB) and plain bytes of a buffer are
 * not counted. What is made of the bytes, atoms above all, takes several times as much again. */
QSES_API void qses_input_set_limit(uint64_t bytes);

/* The atoms of one model of a file, after filters, with radii. Opaque. It never changes: any number of threads may use
 * it at a time. */
typedef struct qses_structure qses_structure;

/* Many frames of the same atoms, read in any order. Opaque. Any number of threads may read it at a time. */
typedef struct qses_trajectory qses_trajectory;

typedef enum qses_structure_format {
  QSES_STRUCTURE_AUTO = 0, /* by the extension of the file's name, else by the content (PDB and mmCIF) */
  QSES_STRUCTURE_PDB = 1,
  QSES_STRUCTURE_MMCIF = 2,
  QSES_STRUCTURE_PQR = 3,  /* with radii of its own */
  QSES_STRUCTURE_XYZR = 4, /* x y z radius per line: no names, no elements */
  QSES_STRUCTURE_GRO = 5   /* GROMACS */
} qses_structure_format;

/* Selections are words, with names of the file behind some of them. Words may be in capitals or not, names are as in
 * the file, and several have blanks or commas between them.
 *   all, none
 *   protein, nucleic, ligand, ions, water (or solvent)
 *       residues: each is of exactly one of these kinds. Of protein and nucleic are modified residues in the chain too;
 *       an ion is one atom of a metal or a halogen; a ligand is whatever is none of the others
 *   backbone, sidechain
 *       of protein and nucleic: N, CA, C, O and their hydrogens, or phosphate and sugar; and the rest
 *   hydrogen, hetero
 *       hydrogen and deuterium; HETATM records
 *   chain A B, resname HEM ATP (or resn), name CA CB, altloc A
 *       chains, residue names, atom names, alternate locations
 *   resid -5-40 52A (or resi)
 *       residue numbers and ranges of them, with insertion codes: 52 is not 52A, 52-53 is both
 *   element C FE
 *       D is deuterium, H is not
 *   index 0-99
 *       places among the atom records of the model, from 0, as file_indices
 *   within 5 of X
 *       atoms at most 5 Å from one of X, centre to centre, those of X too
 *   same residue as X
 *       all atoms of residues that X has an atom of
 *   not X, X and X, X or X, (X)
 *       `not` binds before `and`, and `and` before `or`; X behind `not`, `of` and `as` is the one word, with its names,
 *       or parenthesis that follows
 * Terms in the CID syntax of gemmi, without blanks, may stand wherever X may: "within 5 of (HEM) and not //B". What was
 * CID before there were words still is: a single word names a chain, and a single word in parentheses a residue, if the
 * structure has one of this name ("//all" and "resname ALL" leave no doubt). A word that nobody knows is an error. */

typedef struct qses_structure_options {
  uint32_t struct_size; /* set by qses_structure_options_init */
  qses_structure_format format;
  int32_t model;         /* place of the model in the file, from 1 (default); in PDB files END ends one too */
  qses_bool water;       /* 1 (default): waters are kept; 0: they are left out. XYZR files have no names: with one of
                            these three 0, or a selection, they are INVALID_ARGUMENT */
  qses_bool hetero;      /* the same for HETATM records, which waters mostly are too */
  qses_bool hydrogen;    /* the same for hydrogen and deuterium */
  const char *selection; /* words, such as "protein and not chain B", or CID, such as "//A/10-40": see "selections"
                            above. Of all atoms of the model, those that the filters leave out too. NULL (default) =
                            everything */
  const char *radii;     /* "quickses", "bondi", or the name of a text file with lines `ELEMENT radius` (Å; `*` for all
                            others) and `RESIDUE ATOM radius` (either may be `*`), of which the most specific holds:
                            residue and atom, residue, atom, element, `*`. NULL (default) = those of the file (PQR,
                            XYZR: any others are INVALID_ARGUMENT), else "quickses": O 1.52, C 1.70, N 1.55, H 1.20,
                            S 1.80, P 1.80, others 1.40 Å */
  const char *assembly;  /* PDB and mmCIF: the name of a biological assembly, mostly "1", which is made of copies of the
                            file's chains. The first copy of a chain keeps its name, others have 2, 3 and so on behind
                            it. Atoms, file_indices, file_atom_count and file_elements are then those of the assembly,
                            operation by operation and chain by chain, and fit no trajectory of the file. NULL (default)
                            = the atoms of the file */
  const char *altloc;    /* which alternate locations are taken, with the atoms that have none: "first", in each residue
                            the label met first; "highest", that of the greatest mean occupancy; or a label, such as
                            "B", where a residue has it (a warning tells if none has), else the first. NULL = "first" */
} qses_structure_options;

/* The defaults, with struct_size set. NULL is ignored. */
static inline void qses_structure_options_init(qses_structure_options *options) {
  if (!options) return;
  qses_clear(options, sizeof *options);
  options->model = 1;
  options->water = options->hetero = options->hydrogen = 1;
}

/* Reads a structure from a file, gzipped or not. path is UTF-8. options may be NULL (defaults). On success *structure
 * is the caller's, who ends it with qses_structure_close; on failure it is NULL. Errors: INVALID_ARGUMENT (options; a
 * selection that can't be understood; no such model or assembly), FILE_ERROR (the message names file and line; also
 * more than qses_input_set_limit allows, and if no atom is left, or selected), OUT_OF_MEMORY. */
QSES_API qses_status qses_structure_open(const char *path, const qses_structure_options *options,
                                         qses_structure **structure);

/* The same from size bytes in memory, gzipped or not, which are only read during the call. options->format should name
 * the format; AUTO tells PDB from mmCIF by the content and knows no other. Errors: as of qses_structure_open. */
QSES_API qses_status qses_structure_open_memory(const void *bytes, size_t size, const qses_structure_options *options,
                                                qses_structure **structure);

/* Frees a structure and everything it handed out. NULL is ignored. */
QSES_API void qses_structure_close(qses_structure *structure);

/* A view of a structure; the arrays are the structure's, valid until qses_structure_close. */
typedef struct qses_structure_description {
  uint32_t struct_size; /* set by qses_structure_description_init */
  qses_structure_format format;
  int32_t model;                /* as in the options */
  int32_t model_count;          /* of the file */
  uint32_t atom_count;          /* N, those kept, at least 1; in the order of the file */
  uint32_t file_atom_count;     /* M, atom records of the model in the file */
  const float *positions;       /* N x 3, Å: as qses_set_atoms takes them */
  const float *radii;           /* N, Å */
  const uint32_t *file_indices; /* N, rising, each below M: the atoms' places among the records of the model, before any
                                   filter. qses_set_positions_indexed takes them to pick these atoms out of a frame of a
                                   trajectory that has all M */
  const uint8_t *file_elements; /* M atomic numbers, also of atoms that were left out: for qses_trajectory_unwrap */
  uint32_t warning_count;       /* see qses_structure_warning */
  uint32_t reserved;            /* 0 */
  uint64_t memory;              /* bytes that the structure takes until it is closed */
  const uint32_t *residues; /* N, rising from 0 by 1 at most: which residue an atom is of. Neighbours of the same chain,
                               residue number, insertion code and residue name are of one; in XYZR files each atom
                               is one by itself */
} qses_structure_description;

/* Empty view with struct_size set. NULL is ignored. */
static inline void qses_structure_description_init(qses_structure_description *description) {
  qses_clear(description, sizeof *description);
}

/* Errors: INVALID_ARGUMENT. */
QSES_API qses_status qses_structure_info(const qses_structure *structure, qses_structure_description *description);

/* What the file says about one atom. Strings are never NULL; XYZR files have none, so they are empty there. They are
 * the structure's, valid until qses_structure_close. */
typedef struct qses_atom {
  uint32_t struct_size;     /* set by qses_atom_init */
  int32_t residue_number;   /* also 0 where the file has none, or no number */
  const char *name;         /* such as "CA" */
  const char *residue_name; /* such as "ALA" */
  const char *chain;
  qses_bool is_hetero;   /* a HETATM record */
  qses_bool is_water;    /* its residue is water */
  qses_bool is_hydrogen; /* H or D */
  uint8_t element;       /* atomic number; 0 = unknown; deuterium is 1 */
  char insertion_code;   /* ' ' if there is none */
  uint8_t reserved[2];   /* 0 */
} qses_atom;

/* Empty atom with struct_size set. NULL is ignored. */
static inline void qses_atom_init(qses_atom *atom) { qses_clear(atom, sizeof *atom); }

/* Atom k of the structure, below atom_count. One at a time rather than an array, so that what is known of an atom can
 * grow as other structures do: in an array the library's size of an element would have to be the caller's. Errors:
 * INVALID_ARGUMENT. */
QSES_API qses_status qses_structure_atom(const qses_structure *structure, uint32_t k, qses_atom *atom);

/* Which atoms of the structure a selection names: mask[k] becomes 1 for those, 0 for others, as qses_set_visible takes
 * it.
 *   selection  as in the options, but of the atoms that were kept: what filters left out is not found, and nothing is
 *              near to it. "": everything.
 *              "/2" names a model by the number that the file gives it: of another model it names nothing
 *   mask       room for count bytes
 *   count      must be atom_count
 *   selected   how many atoms are named, maybe none; may be NULL
 * Errors: INVALID_ARGUMENT (a selection that can't be understood; an XYZR file, which has no names; count), after which
 * mask is as it was; OUT_OF_MEMORY. */
QSES_API qses_status qses_structure_select(const qses_structure *structure, const char *selection, uint8_t *mask,
                                           size_t count, uint32_t *selected);

/* How the atoms of a structure are coloured. */
typedef enum qses_color_scheme {
  QSES_COLOR_UNIFORM = 0, /* one colour for all */
  QSES_COLOR_ELEMENT = 1, /* in the colours of Jmol: carbon grey, nitrogen blue, oxygen red, ... */
  QSES_COLOR_CHAIN = 2,   /* a colour per chain, in the order of the file */
  QSES_COLOR_RESIDUE = 3, /* acidic residues red, basic blue, polar green, nonpolar white; purines orange,
                             pyrimidines violet */
  QSES_COLOR_HYDROPHOBICITY =
      4,                  /* Kyte and Doolittle's scale: hydrophilic residues blue, hydrophobic ones orange-red */
  QSES_COLOR_SEQUENCE = 5 /* along each chain from blue (N terminus, 5' end) to red (C terminus, 3' end) */
} qses_color_scheme;

/* A colour for each atom of the structure, red, green, blue, alpha (sRGB, 8 bits each), as qses_set_colors takes them.
 *   uniform_rgba  for UNIFORM, and for atoms of which the scheme tells nothing, such as those of ligands in the schemes
 *                 of residues; its alpha goes along. The other colours are opaque
 *   rgba          room for 4 count bytes
 *   count         must be atom_count
 * Modified residues have the colour of those they were made of. Chains and places in them are those of the model before
 * any filter of qses_structure_options, so that a part has the colours that it has in the whole. Errors:
 * INVALID_ARGUMENT (also: an unknown scheme), after which rgba is as it was; OUT_OF_MEMORY. */
QSES_API qses_status qses_structure_colors(const qses_structure *structure, qses_color_scheme scheme,
                                           const uint8_t uniform_rgba[4], uint8_t *rgba, size_t count);

/* A sentence for the user, such as one about elements that had to be inferred; k is below warning_count. Valid until
 * qses_structure_close. Errors: INVALID_ARGUMENT. */
QSES_API qses_status qses_structure_warning(const qses_structure *structure, uint32_t k, const char **sentence);

typedef enum qses_trajectory_format {
  QSES_TRAJECTORY_AUTO = 0,  /* by the extension of the file's name, else by the content */
  QSES_TRAJECTORY_DCD = 1,   /* CHARMM, NAMD, X-PLOR */
  QSES_TRAJECTORY_XTC = 2,   /* GROMACS; nm become Å */
  QSES_TRAJECTORY_PDB = 3,   /* PDB with several models */
  QSES_TRAJECTORY_TRR = 4,   /* GROMACS, in full precision; nm become Å; frames without positions are left out */
  QSES_TRAJECTORY_NETCDF = 5 /* AMBER, in netCDF's classic format (CDF-1, -2 and -5, not HDF5); also restart files */
} qses_trajectory_format;

/* Opens a trajectory; path is UTF-8. Frames stay in the file and are read when they are asked for (gzipped files
 * and PDB files are taken into memory). A file that ends within a frame, or makes no sense from some frame on, gives
 * the frames before: see qses_trajectory_description.incomplete. On success *trajectory is the caller's, who ends it
 * with qses_trajectory_close; on failure it is NULL. Errors: INVALID_ARGUMENT, FILE_ERROR (no such format, not one
 * whole frame, frames of different numbers of atoms, DCD files of velocities, more in memory than qses_input_set_limit
 * allows), OUT_OF_MEMORY. */
QSES_API qses_status qses_trajectory_open(const char *path, qses_trajectory_format format,
                                          qses_trajectory **trajectory);

/* The same from size bytes in memory, gzipped or not; they are copied. Errors: as of qses_trajectory_open. */
QSES_API qses_status qses_trajectory_open_memory(const void *bytes, size_t size, qses_trajectory_format format,
                                                 qses_trajectory **trajectory);

/* Frees a trajectory and everything it handed out. NULL is ignored. */
QSES_API void qses_trajectory_close(qses_trajectory *trajectory);

typedef struct qses_trajectory_description {
  uint32_t struct_size; /* set by qses_trajectory_description_init */
  qses_trajectory_format format;
  uint64_t frame_count;   /* whole frames, at least 1 */
  uint32_t atom_count;    /* per frame, at least 1; in PDB files all ATOM and HETATM records of a model */
  qses_bool has_box;      /* whether frame 0 has a periodic box */
  qses_bool is_unwrapped; /* 1 after qses_trajectory_unwrap */
  qses_bool incomplete;   /* 1 if the file ends, or stops making sense, before it should; a warning says where */
  uint32_t warning_count; /* see qses_trajectory_warning */
  uint32_t reserved;      /* 0 */
} qses_trajectory_description;

/* Empty description with struct_size set. NULL is ignored. */
static inline void qses_trajectory_description_init(qses_trajectory_description *description) {
  qses_clear(description, sizeof *description);
}

/* Errors: INVALID_ARGUMENT. */
QSES_API qses_status qses_trajectory_info(const qses_trajectory *trajectory, qses_trajectory_description *description);

/* A sentence for the user; k is below warning_count. Valid until qses_trajectory_close. Errors: INVALID_ARGUMENT. */
QSES_API qses_status qses_trajectory_warning(const qses_trajectory *trajectory, uint32_t k, const char **sentence);

/* From now on frames come with every molecule in one piece, around its first atom, instead of torn by the borders of
 * the periodic box. elements are the atomic numbers (0 = unknown) of all count atoms of the trajectory, such as
 * qses_structure_description.file_elements; they are only read during the call. Atoms are bonded if they are in the
 * first frame with a box that can be read. Frames without a box still come as they are, perhaps torn:
 * qses_frame.is_unwrapped tells. No other thread may use the trajectory meanwhile. Errors, after which frames come as
 * before: NO_BOX (no frame has one), INVALID_ARGUMENT (count is not the number of atoms), FILE_ERROR (no frame with a
 * box can be read, or the atoms of the first one lie on top of each other), OUT_OF_MEMORY. */
QSES_API qses_status qses_trajectory_unwrap(qses_trajectory *trajectory, const uint8_t *elements, size_t count);

/* What a file says about one frame, besides positions. */
typedef struct qses_frame {
  uint32_t struct_size; /* set by qses_frame_init */
  qses_bool has_time;
  double time; /* ps; 0 if it is not known */
  qses_bool has_box;
  qses_bool is_unwrapped; /* 1: molecules are in one piece; 0: not asked for, or this frame has no box */
  double box[9];          /* Å; the vectors a, b, c, three numbers each; 0 if there is no box */
} qses_frame;

/* Empty frame with struct_size set. NULL is ignored. */
static inline void qses_frame_init(qses_frame *frame) { qses_clear(frame, sizeof *frame); }

/* Reads frame `index`, counted from 0, into the caller's memory.
 *   positions  room for count positions of three floats x, y, z in Å, each stride bytes after the one before; what lies
 *              between them is not touched
 *   stride     as in qses_set_atoms
 *   count      must be the number of atoms of the trajectory
 *   frame      may be NULL
 * All positions are finite and within 1e6 Å of the origin. May be called from several threads at a time.
 * Errors: INVALID_ARGUMENT (no such frame, stride, count), FILE_ERROR (the frame is damaged; others may be whole),
 * OUT_OF_MEMORY. After an error what positions holds is undefined. */
QSES_API qses_status qses_trajectory_read_frame(const qses_trajectory *trajectory, uint64_t index, float *positions,
                                                size_t stride, size_t count, qses_frame *frame);

#ifdef __cplusplus
}
#endif

#endif
