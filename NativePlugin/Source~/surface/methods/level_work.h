// SPDX-License-Identifier: MIT
// What the stages of one computation share.
#pragma once

#include "parallel/error.h"
#include "surface/memory/work_facts.h"
#include "surface/mesh/mesh_memory.h"
#include "surface/methods/progress.h"
#include "surface/stages/appearance.h"
#include "surface/stages/hot_stages.h"
#include "surface/stages/measure.h"

#include <algorithm>

namespace quickses {

template <class Executor, class Timer>
struct Run {
  Executor &executor;
  Timer &timer;
  MeshMemory<Executor> &memory;
  Progress &progress;
  TableView table;
  const qses_settings &settings;
  SurfaceParameters parameters;
  Lattice lattice;
  glm::vec3 low, high;  // bounds of the atoms' centres, centred frame
  NeighborGridView atoms;
  FeatureView features;  // exact method only
  AppearanceView appearance;
  MeshShape shape;
  MeshPurpose purpose;
  bool frugal;  // memory is short
  qses_report *report;
  WorkFacts *facts;
};

// Slices are not cut smaller than this when memory is refused.
constexpr uint32_t kLeastSlice = 16;
// With room for the work on so many bricks at a time, slices cost next to nothing.
constexpr uint32_t kRoomySlice = 4096;

// How bricks are worked on: all in one slice, whose memory is kept; or in slices of at most so many, which shrink where
// memory is refused, and give up what they took.
struct Slicing {
  bool together;
  uint32_t bricks;
};

// Calls work(slice) for all bricks and reports progress from `begin` to `end`. Returns the number of slices.
template <class R, class Work>
uint64_t for_each_slice(R &run, uint32_t brick_count, Slicing slicing, double begin, double end, const Work &work) {
  const bool one = slicing.together;
  uint32_t bricks_per_slice = std::max<uint32_t>(1, slicing.bricks);
  uint64_t slices = 0;
  for (uint32_t first = 0; first < brick_count; ++slices) {
    uint32_t last = one ? brick_count : first + std::min(bricks_per_slice, brick_count - first);
    const auto mark = run.executor.arena().mark();
    for (;;) {
      try {
        work(BrickRange{first, last});
        break;
      } catch (const MemoryRefused &) {
        if (one || last - first <= kLeastSlice) throw;
        run.executor.arena().rewind(mark);
        bricks_per_slice = std::max(kLeastSlice, (last - first) / 2);
        last = first + bricks_per_slice;
      }
    }
    if (!one) run.executor.arena().rewind(mark);
    first = last;
    run.progress.report(begin + (end - begin) * first / brick_count);
  }
  return slices;
}

// Bricks per slice from the settings: at most slice_size cubed lattice points. slice_size 0: all at once, or as many
// as keep the caller informed if progress is asked for.
inline uint32_t bricks_per_slice(const qses_settings &settings, uint32_t brick_count, bool want_progress) {
  uint64_t n = brick_count;
  if (settings.slice_size > 0) {
    const uint64_t edge = settings.slice_size;
    n = std::max<uint64_t>(1, edge > (uint64_t(1) << 20) ? brick_count : edge * edge * edge / kBrickPoints);
  }
  if (want_progress) n = std::min<uint64_t>(n, std::max<uint64_t>(64, brick_count / 32));
  return static_cast<uint32_t>(std::max<uint64_t>(1, std::min<uint64_t>(n, brick_count)));
}

// Throws if the mesh needs more numbers than 32 bits hold.
inline void check_mesh_size(const MeshCounts &counts) {
  constexpr uint64_t kMost = 0xffffffffu;
  if (counts.vertices >= kMost || counts.triangles >= kMost)
    throw Error(QSES_TOO_FINE, "the spacing is too fine for this structure: the mesh would have " +
                                   std::to_string(counts.vertices) + " vertices and " +
                                   std::to_string(counts.triangles) + " triangles, more than 32-bit indices can name");
}

}  // namespace quickses
