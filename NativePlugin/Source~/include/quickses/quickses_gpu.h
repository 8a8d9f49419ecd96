/* SPDX-License-Identifier: MIT
 *
 * QuickSES for Unity: meshes that never leave the GPU, from CUDA into the vertex and index buffers of a graphics API.
 *
 * EXPERIMENTAL. What is declared here may change in any release: compare QSES_GPU_ABI_VERSION with
 * qses_gpu_abi_version(). What quickses.h says of units, structures, errors and threads holds here too.
 *
 * In one page
 *   the thread that uses the context, whenever a mesh is there
 *     settings.delivery = QSES_DELIVERY_DEVICE; ... qses_collect(context, &mesh); qses_keep(context, kept);
 *     qses_gpu_target_submit(target, kept, &buffers, NULL);         (draw mesh.vertex_count, mesh.triangle_count)
 *   the same thread, once per frame, when all surfaces have been submitted and before anything is drawn
 *     int32_t event;
 *     if (qses_gpu_next_event(&event) == QSES_OK && event) GL.IssuePluginEvent(qses_gpu_event_function(), event);
 *   the thread that draws
 *     calls the function: it maps the buffers of all targets in one call, copies, and unmaps them.
 *
 * Who waits for whom
 *   A mesh that was collected is finished. Mapping makes CUDA wait for what was drawn before, unmapping makes what is
 *   drawn later wait for the copies: both on the GPU. No thread waits for it, nor for another thread, but for the
 *   microseconds of a lock. Memory that is being copied is not written to: the context takes other memory, and what
 *   writes there later waits on the GPU for the copies.
 *
 * When it can't be done
 *   Every failure is a status of the target (qses_gpu_target_status) with a sentence. The mesh is still kept:
 *   qses_kept_mesh_download brings it to host memory, from where it is shown as any other. What the buffers hold then
 *   is undefined.
 *
 * Graphics APIs
 *   OpenGL on Linux and Windows; Direct3D 11 on Windows, which nobody has run yet on a GPU: its order of calls is
 *   tested against stand-ins. Vulkan and Direct3D 12 would need memory that both sides import:
 *   Documentation~/gpu-delivery.md.
 */
#ifndef QUICKSES_QUICKSES_GPU_H
#define QUICKSES_QUICKSES_GPU_H

#include "quickses/quickses.h"

#ifdef __cplusplus
extern "C" {
#endif

#define QSES_GPU_ABI_VERSION 1

/* After so long without an event, meshes that wait for one are given up (qses_gpu_status.stopped). */
#define QSES_GPU_PATIENCE_MS 500

/* Of one target, how many meshes may wait for their events. */
#define QSES_GPU_MAX_WAITING 2

typedef enum qses_graphics {
  QSES_GRAPHICS_OPENGL = 1, /* buffers are names of OpenGL, of the context that is current when the event runs */
  QSES_GRAPHICS_D3D11 = 2   /* buffers are ID3D11Buffer pointers of usage DEFAULT, not shared (Windows) */
} qses_graphics;

/* The buffers of one surface, and what CUDA knows of them. Opaque. */
typedef struct qses_gpu_target qses_gpu_target;

/* QSES_GPU_ABI_VERSION of the library that is loaded. */
QSES_API uint32_t qses_gpu_abi_version(void);

/* Whether this library and the driver that is installed can write into buffers of a graphics API; whether the GPU that
 * draws is the one that computes, only the first event can tell. Errors: BACKEND_UNAVAILABLE (the message says why),
 * INVALID_ARGUMENT. */
QSES_API qses_status qses_gpu_check_graphics(qses_graphics graphics);

/* Makes a target without buffers. On success *target is the caller's, who ends it with qses_gpu_target_destroy; on
 * failure it is NULL. Errors: INVALID_ARGUMENT, BACKEND_UNAVAILABLE (the library has no CUDA), OUT_OF_MEMORY. */
QSES_API qses_status qses_gpu_target_create(qses_gpu_target **target);

/* Ends it: meshes that wait are let go. CUDA lets go of the buffers with the next event, so issue one before they are
 * deleted. NULL is ignored. */
QSES_API void qses_gpu_target_destroy(qses_gpu_target *target);

/* What vertices take from the atoms that own them, and which are shown: as the functions of the same names take them
 * (qses_set_colors ...). Any array may be NULL. */
typedef struct qses_gpu_look {
  uint32_t struct_size; /* set by qses_gpu_look_init */
  uint32_t reserved;    /* 0 */
  uint64_t atom_count;
  const uint8_t *colors;  /* atom_count x 4, red, green, blue, alpha; NULL: the mesh's own, or white if it has none */
  const float *texcoords; /* atom_count x 2; NULL: the mesh's own */
  const uint8_t *visible; /* atom_count; triangles with a vertex whose owner has 0 here become points, three times the
                             same vertex, so that the number of indices stays; NULL: all are shown */
} qses_gpu_look;

/* Empty look with struct_size set. NULL is ignored. */
static inline void qses_gpu_look_init(qses_gpu_look *look) { qses_clear(look, sizeof *look); }

/* Copies a look, which holds for meshes that are submitted from now on; NULL: none. To show another one of the mesh
 * that is shown, submit that again: nothing is computed. Errors: INVALID_ARGUMENT, OUT_OF_MEMORY. */
QSES_API qses_status qses_gpu_target_set_look(qses_gpu_target *target, const qses_gpu_look *look);

/* Where a mesh goes. Buffers that are 0 are not written. */
typedef struct qses_gpu_buffers {
  uint32_t struct_size;     /* set by qses_gpu_buffers_init */
  qses_graphics graphics;   /* default OPENGL */
  uint64_t vertices;        /* positions and normals: INTERLEAVED or COMPACT, as the mesh has them. Never 0 */
  uint64_t colors;          /* 4 bytes per vertex */
  uint64_t owners;          /* uint32_t per vertex: the atom it belongs to */
  uint64_t texcoords;       /* 2 floats per vertex */
  uint64_t indices;         /* uint32_t, 3 per triangle. Never 0 */
  uint64_t vertex_capacity; /* vertices for which each buffer of the first four has room */
  uint64_t index_capacity;  /* indices */
  uint32_t generation;  /* another number whenever one of the buffers was made anew: names and addresses come again, and
                           CUDA would go on writing into the memory of the old one */
  qses_bool clear_rest; /* 1: indices behind those of the mesh become 0, up to index_capacity, so that all of the buffer
                           can be drawn; default 0 */
} qses_gpu_buffers;

/* The defaults, with struct_size set. NULL is ignored. */
static inline void qses_gpu_buffers_init(qses_gpu_buffers *buffers) {
  if (!buffers) return;
  qses_clear(buffers, sizeof *buffers);
  buffers->graphics = QSES_GRAPHICS_OPENGL;
}

/* Puts a mesh on its way into buffers. It is there once the next event has run: draw its counts from that frame on. Its
 * memory on the device stays until then, whatever becomes of kept and of the context.
 *   kept    made with settings.delivery DEVICE or BOTH and vertex_layout INTERLEAVED or COMPACT
 *   event   may be NULL; gets the number of that event
 * Errors: INVALID_ARGUMENT (NULL; layout; buffers too small; a look of another number of atoms), NO_RESULT (what is
 * kept is not on a device), BACKEND_UNAVAILABLE (as of qses_gpu_check_graphics), OUT_OF_MEMORY, BUSY (as many meshes as
 * may wait do so already, or events have stopped: qses_gpu_status.stopped; try again later). */
QSES_API qses_status qses_gpu_target_submit(qses_gpu_target *target, const qses_kept_mesh *kept,
                                            const qses_gpu_buffers *buffers, int32_t *event);

typedef struct qses_gpu_status {
  uint32_t struct_size; /* set by qses_gpu_status_init */
  qses_status status;   /* of the last event that had a mesh for this target; OK if there was none */
  int32_t submitted;    /* number of the event that the newest mesh waits for or has had; 0: none */
  int32_t done;         /* number of the last event that had a mesh for this target; 0: none */
  uint32_t waiting;  /* meshes that wait for their event, and one that an event is at work on: 0 as soon as `done` and
                        `status` are of the newest */
  qses_bool stopped; /* 1: meshes have waited for an event longer than QSES_GPU_PATIENCE_MS, as they do while a window
                        is minimised, and were let go. 0 again once an event runs; qses_gpu_next_event gives some to
                        try with */
  uint32_t registrations; /* buffers that were made known to CUDA so far */
  float event_ms; /* of the thread that drew: how long it was in the last event, which may have had other targets too */
  float copy_ms;  /* of the GPU: the copies of the event before that one, those of other targets too; 0: not known */
  char message[256]; /* "" if status is OK */
} qses_gpu_status;

/* Empty status with struct_size set. NULL is ignored. */
static inline void qses_gpu_status_init(qses_gpu_status *status) { qses_clear(status, sizeof *status); }

/* How a target stands. From any thread before qses_gpu_target_destroy. Errors: INVALID_ARGUMENT. */
QSES_API qses_status qses_gpu_target_status(const qses_gpu_target *target, qses_gpu_status *status);

/* The number of the event that is to be issued now; 0: there is nothing to do. What is submitted later belongs to a
 * later event. Targets share events: one per frame suffices for all surfaces of a process. Errors: INVALID_ARGUMENT. */
QSES_API qses_status qses_gpu_next_event(int32_t *event);

/* What runs an event on the thread that draws, where the graphics API's context is current: it does what was submitted
 * for this event and those before it (of each target, only the newest mesh). Has the form of Unity's
 * UnityRenderingEvent. It returns nothing, throws nothing and does not wait for the GPU, but where a look is of more
 * atoms than any before. */
typedef void (*qses_gpu_event)(int32_t event);
QSES_API qses_gpu_event qses_gpu_event_function(void);

#ifdef __cplusplus
}
#endif

#endif
