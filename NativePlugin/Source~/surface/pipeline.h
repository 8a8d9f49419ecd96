// SPDX-License-Identifier: MIT
// The whole order on one page: atoms -> neighbour grid -> solvent features, once for all levels; then for each level
// bricks -> signs -> marching cubes -> projection -> relaxation (methods/), measures, components, visible atoms, boxes
// for picking. Run on a CountingExecutor, it tells what memory that takes.
#pragma once

#include "surface/levels.h"
#include "surface/methods/exact_surface.h"
#include "surface/methods/grid_surface.h"
#include "surface/methods/hard_edges.h"
#include "surface/methods/size_check.h"
#include "surface/methods/visible_mask.h"
#include "surface/stages/atoms.h"
#include "surface/stages/measure.h"
#include "surface/stages/pick_boxes.h"

namespace quickses {

// Below this probe radius the solvent-excluded surface is the van der Waals surface within rounding.
constexpr float kSmallestProbe = 0.05f;

// Cells of the neighbour grid are at least this large, in Å, however small the atoms: their number must stay countable.
constexpr float kSmallestCell = 1.f;

// What a frame is made of, on the host.
struct FrameInput {
  const AtomSet &atoms;
  const Appearance &appearance;
  const qses_settings &settings;
};

inline SurfaceParameters parameters_of(const FrameInput &in) {
  const qses_settings &s = in.settings;
  const bool vdw = s.surface == QSES_SURFACE_VDW ||
                   (s.surface == QSES_SURFACE_SES && s.method == QSES_METHOD_EXACT && s.probe_radius < kSmallestProbe);
  SurfaceParameters p{};
  p.probe = vdw ? 0.f : s.probe_radius;
  p.depth = s.surface == QSES_SURFACE_SES && !vdw ? p.probe : 0.f;
  p.spacing = s.spacing;
  p.max_radius = in.atoms.bounds.max_radius + p.probe;
  return p;
}

// Something the host has per atom, where the back end reads it.
template <class Executor, class T>
const T *bring(Executor &executor, const T *host, size_t n) {
  if (n == 0 || !Executor::kIsCuda) return n ? host : nullptr;
  Span<T> copy = executor.template allocate<T>(n);
  executor.upload(copy.data, host, n);
  return copy.data;
}

// What all levels of a frame share. It fills in the work: atoms, features, appearance, and where they are.
template <class Work>
void prepare_frame(Work &work, const FrameInput &in) {
  auto &executor = work.executor;
  const AtomSet &set = in.atoms;
  const Appearance &look = in.appearance;
  work.timer.begin("neighbor_grid");
  work.facts->atoms = set.count;
  work.parameters = parameters_of(in);
  work.shape = shape_of(in.settings, !look.colors.empty());
  work.hard_edges = in.settings.hard_edges && in.settings.method == QSES_METHOD_EXACT;
  work.purpose = look.visible.empty() && !work.hard_edges ? MeshPurpose::kDelivered : MeshPurpose::kWork;
  work.lattice = center_lattice(set.bounds, frame_spacing(levels_of(in.settings)));
  work.low = to_centered(work.lattice, set.bounds.low);
  work.high = to_centered(work.lattice, set.bounds.high);
  work.side_normals = in.settings.method == QSES_METHOD_EXACT && (in.settings.creases || in.settings.hard_edges);
  work.appearance = {bring(executor, look.visible.data(), look.visible.size()),
                     bring(executor, look.colors.data(), look.colors.size()),
                     bring(executor, look.texcoords.data(), look.texcoords.size())};
  const CellLayout cells = layout_cells(work.low, work.high, std::max(work.parameters.max_radius, kSmallestCell));
  work.atoms = build_neighbor_grid(executor, set.count, cells, [&] {
    Span<Sphere> centered = executor.template allocate<Sphere>(set.count);
    const Sphere *const given = bring(executor, set.atoms, set.count);
    executor.for_each(set.count, CenterAtoms{given, work.lattice.center_x, work.lattice.center_y, work.lattice.center_z,
                                             work.parameters.probe, centered.data});
    return centered;
  });
  remove_contained_atoms(executor, work.atoms, work.parameters.max_radius);
  if (in.settings.method == QSES_METHOD_EXACT) work.features = find_features(work);
}

// The work turns to the level with this spacing.
template <class Work>
void enter_level(Work &work, float spacing) {
  work.parameters.spacing = work.lattice.spacing = spacing;
  work.features.parameters = work.parameters;
  work.lattice = layout_lattice(work.lattice, work.low, work.high, work.parameters.max_radius);
}

// The mesh of all atoms, measured; then of those that are visible, and with hard edges.
template <class Work>
MeshMemoryView build_surface(Work &work) {
  auto &executor = work.executor;
  MeshMemoryView mesh = work.settings.method == QSES_METHOD_GRID ? build_grid_surface(work) : build_exact_surface(work);
  work.timer.begin("measure");
  const MeshCounts counts{mesh.vertices, mesh.triangles};
  if (work.settings.measure) {
    const Measures m = measure(executor, mesh.view, counts, mesh.unplaced, &work.report->unplaced_vertices);
    work.report->area = m.area;
    work.report->volume = m.volume;
    mesh.bounds = m.bounds;
  } else {
    mesh.bounds = find_bounds(executor, mesh.view, counts, mesh.unplaced, &work.report->unplaced_vertices);
  }
  if (work.settings.components) {
    work.timer.begin("components");
    mesh.components = work.components.find(executor, mesh, work.parameters.spacing);
  }
  if (work.appearance.visible && mesh.vertices > 0) {
    work.timer.begin("visible_mask");
    const Span<const qses_component> components = mesh.components;
    mesh = drop_hidden(work, mesh, work.hard_edges ? MeshPurpose::kWork : MeshPurpose::kDelivered);
    mesh.components = components;
    mesh.bounds = find_bounds(executor, mesh.view, MeshCounts{mesh.vertices, mesh.triangles});
  }
  if (work.hard_edges && mesh.vertices > 0) {
    work.timer.begin("hard_edges");
    mesh = harden_edges(work, mesh);
  }
  return mesh;
}

// The mesh of the level, in memory of the arena and of the slots.
template <class Work>
MeshMemoryView build_level(Work &work) {
  MeshMemoryView mesh = build_surface(work);
  work.timer.begin("appearance");
  complete_vertices(work, &mesh);
  if (work.shape.boxes) {
    work.timer.begin("pick_boxes");
    fill_pick_boxes(work.executor, mesh.view, mesh.triangles);
  }
  return mesh;
}

}  // namespace quickses
