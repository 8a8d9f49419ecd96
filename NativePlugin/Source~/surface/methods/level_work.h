// SPDX-License-Identifier: MIT
// The work on one level: what its stages share, and how it is cut into slices.
#pragma once

#include "parallel/error.h"
#include "surface/memory/memory_plan.h"
#include "surface/mesh/mesh_memory.h"
#include "surface/methods/progress.h"
#include "surface/stages/appearance.h"
#include "surface/stages/atom_measures.h"
#include "surface/stages/components.h"
#include "surface/stages/facing_normals.h"
#include "surface/stages/hot_stages.h"
#include "surface/stages/occlusion.h"
#include "surface/stages/packed_normals.h"
#include "surface/stages/side_normals.h"

#include <algorithm>
#include <functional>

namespace quickses {

// Where it will be known how large a mesh is of which that was anticipated. No totals: it is known.
struct UntoldSize {
  const MeshTotals *totals = nullptr;
  const Tally<uint64_t> *bricks = nullptr;  // nullptr: there are most_bricks
  uint64_t most_bricks = 0;
};

// What prepare_frame (pipeline.h) makes for all levels of a frame. Each level has a copy, which enters it, and asks for
// another mesh where that is split at creases (crease_splits.h).
struct PreparedFrame {
  SurfaceParameters parameters{};
  Lattice lattice{};
  glm::vec3 low{0.f}, high{0.f};  // bounds of the atoms' centres, centred frame
  NeighborGridView atoms{};
  FeatureView features{};  // exact method only
  AppearanceView appearance{};
  MeshShape shape{};       // of what is handed out
  MeshShape made_shape{};  // of the whole mesh, before anything is left out of it
  MeshPurpose purpose = MeshPurpose::kDelivered;
  bool side_normals = false;   // whether a later stage asks for MeshView::second_normals
  bool will_be_split = false;  // whether creases of the mesh are split when it is made
  bool is_cut = false;         // whether parts of the whole mesh are left out
  bool hard_edges = false;     // whether a vertex on a crest is delivered once per side
  // Of creases of balls: the caller's number of an atom -> its place in the grid.
  const uint32_t *atom_places = nullptr;
  bool makes_mesh = true;
  AtomMeasures atom_measures{};     // where the surface is that of the balls, and measured
  Span<const double> atom_areas{};  // in host memory; of all levels

  // Turns to the level with this spacing.
  void enter_level(float spacing) {
    parameters.spacing = lattice.spacing = spacing;
    features.parameters = parameters;
    lattice = layout_lattice(lattice, low, high, parameters.max_radius);
  }
};

template <class Executor, class Timer>
struct LevelWork : PreparedFrame {
  Executor &executor;
  Timer &timer;
  MeshMemory<Executor> &memory;
  ComponentFinder &components;
  LearntRooms<Executor> &rooms;
  Progress &progress;
  const TableView &table;
  const qses_settings &settings;
  MemoryPlan plan;
  WorkFacts *facts;
  qses_report *report;
  GrowingBuffer<HostMemory> *area_memory = nullptr;  // of the areas of atoms
  UntoldSize untold{};                               // of the mesh as it is made (closed_layout.h)
  // Called before the host waits for this level: levels under way beside it go out first.
  std::function<void()> hand_out_others = [] {};
  // Called now and then while the back end has enough to do for this level: others may go out.
  std::function<void()> attend_to_others = [] {};

  // Whether the mesh, as it is made, has the vertices and normals that will be delivered: then they are painted before
  // anything waits for what is measured.
  bool paints_early() const { return purpose == MeshPurpose::kDelivered && !side_normals; }
};

// Are creases of the mesh of this level split? Not of coarser ones.
template <class Work>
bool splits_creases(const Work &work) {
  return work.settings.creases != 0 && is_exact(work.settings) && work.parameters.spacing <= work.settings.spacing;
}

// While a mesh is made it has the normals that later stages read, in memory that is given up with the level's: floats
// where the layout has packed ones, and those of the second sheet. allocate(n) returns room for n vectors.
template <class Allocate>
void add_normals(bool side_normals, MeshView *view, size_t vertices, const Allocate &allocate) {
  if (view->packed_normals) view->normals = reinterpret_cast<float *>(allocate(vertices));
  if (side_normals) view->second_normals = reinterpret_cast<float *>(allocate(vertices));
}
template <class Work>
void add_normals(Work &work, bool side_normals, MeshMemoryView *mesh) {
  add_normals(side_normals, &mesh->view, mesh->vertices, [&](size_t n) {
    return work.memory.template allocate_where_mesh_is<glm::vec3>(work.executor, *mesh, n).data;
  });
}
template <class Work>
void add_normals(Work &work, MeshMemoryView *mesh) {
  add_normals(work, work.side_normals, mesh);
}

// Of a Gaussian surface.
template <class Work>
GaussianDensity density_of(const Work &work) {
  return {work.atoms, work.parameters.max_radius, work.settings.gaussian_isovalue,
          1.f / (kGaussianReach * work.settings.gaussian_radius_scale)};
}

// Colours, texture coordinates and packed normals of vertices that have their places, owners and normals.
template <class Work>
void paint(Work &work, const MeshView &mesh, size_t vertices) {
  paint_vertices(work.executor, work.appearance, mesh, vertices);
  pack_normals(work.executor, mesh, vertices);
}
template <class Work>
BrickSet find_occlusion_bricks(const Work &work) {
  return find_occlusion_bricks(work.executor, work.atoms, work.parameters.max_radius, work.lattice, work.low,
                               work.high);
}
template <class Work>
void paint_and_light(Work &work, const MeshMemoryView &mesh) {
  paint(work, mesh.view, mesh.vertices);
  if (!work.settings.occlusion || mesh.vertices == 0) return;
  const auto mark = work.executor.arena().mark();
  const BrickSet bricks = find_occlusion_bricks(work);
  work.facts->occlusion_bricks = bricks.count;
  const auto find = [&](const auto &fill) {
    find_openness(work.executor, bricks, fill, mesh.view, mesh.vertices, !work.appearance.texcoords);
  };
  if (work.settings.surface == QSES_SURFACE_GAUSSIAN)
    find(FillWithDensity{density_of(work)});
  else
    find(FillWithAtoms{work.atoms, work.parameters});
  work.executor.arena().rewind(mark);
}

// What is left to do for a mesh whose vertices have their places, owners, and normals of each side.
template <class Work>
void complete_vertices(Work &work, MeshMemoryView *mesh) {
  share_normals(work.executor, mesh->view, mesh->vertices);
  if (work.side_normals) face_triangles(work.executor, mesh->view, MeshCounts{mesh->vertices, mesh->triangles});
  if (!work.paints_early()) paint_and_light(work, *mesh);
  mesh->view.second_normals = nullptr;
  if (mesh->view.packed_normals) mesh->view.normals = nullptr;
}

// Calls work_on(slice) for runs of so many bricks, and reports progress from `begin` to `end`. The memory that a slice
// takes is given up after it, unless it is the only one. Returns the number of slices.
template <class Work, class WorkOn>
uint64_t for_each_slice(Work &work, uint32_t brick_count, uint32_t bricks_per_slice, double begin, double end,
                        const WorkOn &work_on) {
  const bool single = bricks_per_slice >= brick_count && work.plan.single_slice;
  uint64_t slices = 0;
  for (uint32_t first = 0; first < brick_count; ++slices) {
    const uint32_t last = first + std::min(std::max<uint32_t>(1, bricks_per_slice), brick_count - first);
    const auto mark = work.executor.arena().mark();
    work_on(BrickRange{first, last});
    if (!single) work.executor.arena().rewind(mark);
    first = std::decay_t<decltype(work.executor)>::kCounts ? brick_count : last;  // the first is as large as any
    work.progress.report(begin + (end - begin) * first / brick_count);
  }
  return slices;
}

// Bricks per slice that the caller asked for: at most slice_size cubed lattice points. slice_size 0: all at once, or as
// many as keep the caller informed if progress is asked for.
inline uint32_t asked_slice(const qses_settings &settings, uint32_t brick_count, bool want_progress) {
  uint64_t n = brick_count;
  if (settings.slice_size > 0) {
    const uint64_t edge = settings.slice_size;
    n = std::max<uint64_t>(1, edge > (uint64_t(1) << 20) ? brick_count : edge * edge * edge / kBrickPoints);
  }
  if (want_progress) n = std::min<uint64_t>(n, std::max<uint64_t>(64, brick_count / 32));
  return static_cast<uint32_t>(std::max<uint64_t>(1, std::min<uint64_t>(n, brick_count)));
}

// So many things can be told apart by 32-bit numbers, and one number be left that is none of theirs.
constexpr uint64_t kMostNumbered = 0xfffffffeu;

// Throws if the mesh needs more numbers than 32 bits hold.
inline void check_mesh_size(const MeshCounts &counts) {
  if (counts.vertices > kMostNumbered || counts.triangles > kMostNumbered)
    throw Error(QSES_TOO_FINE, "the spacing is too fine for this structure: the mesh would have " +
                                   std::to_string(counts.vertices) + " vertices and " +
                                   std::to_string(counts.triangles) + " triangles, more than 32-bit indices can name");
}

}  // namespace quickses
