// SPDX-License-Identifier: MIT
// The whole order on one page: atoms -> neighbour grid -> solvent features, once for all levels; then for each level
// bricks -> signs -> marching cubes -> projection -> relaxation (methods/), measures, components, what is shown, boxes
// for picking. Run on a CountingExecutor, it tells what memory that takes.
#pragma once

#include "surface/levels.h"
#include "surface/methods/crease_splits.h"
#include "surface/methods/exact_surface.h"
#include "surface/methods/gaussian_surface.h"
#include "surface/methods/grid_surface.h"
#include "surface/methods/hard_edges.h"
#include "surface/methods/size_check.h"
#include "surface/methods/visible_mask.h"
#include "surface/stages/atom_measures.h"
#include "surface/stages/atoms.h"
#include "surface/stages/measure.h"
#include "surface/stages/owner_areas.h"
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
  p.depth = s.surface == QSES_SURFACE_SES ? p.probe : 0.f;
  p.spacing = s.spacing;
  if (s.surface == QSES_SURFACE_GAUSSIAN) {
    p.probe = 0.f;
    p.scale = kGaussianReach * s.gaussian_radius_scale;
  }
  p.max_radius = p.scale * in.atoms.bounds.radii.largest + p.probe;
  return p;
}

// Whether the surface is the boundary of the balls, which the atoms measure.
inline bool is_of_balls(const FrameInput &in) { return is_exact(in.settings) && parameters_of(in).is_of_balls(); }

// Where area and volume come from.
inline qses_measured_by measured_by(const FrameInput &in) {
  const qses_settings &s = in.settings;
  if (!s.measure) return QSES_MEASURED_BY_NOTHING;
  if (s.method == QSES_METHOD_GRID) return QSES_MEASURED_BY_TRIANGLES;
  return is_of_balls(in) ? QSES_MEASURED_BY_ATOMS : QSES_MEASURED_BY_NORMALS;
}

// Whether vertices where sheets of the surface meet keep the normals of both.
inline bool needs_side_normals(const FrameInput &in) {
  return is_exact(in.settings) && (in.settings.creases || in.settings.hard_edges);
}

// Whether there is something to be made at each level, or only numbers of the atoms.
inline bool makes_mesh(const FrameInput &in) {
  const qses_settings &s = in.settings;
  return s.delivery != QSES_DELIVERY_NONE || wants_components(s) || !is_of_balls(in);
}

// Something the host has per atom, where the back end reads it.
template <class Executor, class T>
const T *bring(Executor &executor, const T *host, size_t n) {
  if (n == 0 || !Executor::kIsCuda) return n ? host : nullptr;
  Span<T> copy = executor.template allocate<T>(n);
  executor.upload(copy.data, host, n);
  return copy.data;
}

// Areas of all atoms on the host, by whoever fills them in where the back end can.
template <class Work, class Fill>
Span<const double> bring_areas(Work &work, const Fill &fill) {
  auto &executor = work.executor;
  using Executor = std::remove_reference_t<decltype(executor)>;
  const size_t n = work.atoms.count;
  const auto mark = executor.arena().mark();
  double *on_host = nullptr;
  if (!Executor::kCounts) on_host = static_cast<double *>(work.area_memory->reserve(n * sizeof(double)));
  double *const areas = Executor::kIsCuda ? executor.template allocate<double>(n).data : on_host;
  fill(areas);
  if (Executor::kIsCuda) {
    executor.download(on_host, areas, n);
    executor.wait();
  }
  executor.arena().rewind(mark);
  return {on_host, n};
}

// Area and volume from the atoms, and what each of them has.
template <class Work>
void measure_by_atoms(Work &work, const SolventFeatures &features) {
  work.timer.begin("measure");
  const auto measure_into = [&](double *areas) {
    work.atom_measures = measure_atoms(work.executor, work.atoms, features, areas);
  };
  if (work.settings.atom_areas)
    work.atom_areas = bring_areas(work, measure_into);
  else
    measure_into(nullptr);
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
  work.makes_mesh = makes_mesh(in);
  const bool is_delivered = in.settings.delivery != QSES_DELIVERY_NONE;
  work.is_cut = is_delivered && (!look.visible.empty() || in.settings.outer_only);
  work.hard_edges = is_delivered && in.settings.hard_edges && is_exact(in.settings);
  work.purpose = is_delivered && !work.is_cut && !work.hard_edges ? MeshPurpose::kDelivered : MeshPurpose::kWork;
  work.made_shape = work.shape;
  work.made_shape.component_ids |= in.settings.outer_only && is_delivered;
  work.lattice = center_lattice(set.bounds, frame_spacing(levels_of(in.settings)));
  work.low = to_glm(work.lattice.from_caller(&set.bounds.low.x));
  work.high = to_glm(work.lattice.from_caller(&set.bounds.high.x));
  work.side_normals = needs_side_normals(in);
  work.appearance = {bring(executor, look.visible.data(), look.visible.size()),
                     bring(executor, look.colors.data(), look.colors.size()),
                     bring(executor, look.texcoords.data(), look.texcoords.size()), set.count};
  // Gaussians reach far: in smaller cells there are fewer atoms that they do not reach. They know no large atoms, since
  // each point is the nearest atom's, be it beyond its own reach.
  const bool is_gaussian = in.settings.surface == QSES_SURFACE_GAUSSIAN;
  const ItemRadii radii = is_gaussian
                              ? ItemRadii{work.parameters.max_radius, 0}
                              : ItemRadii{set.bounds.radii.usual + work.parameters.probe, set.bounds.radii.large};
  const CellLayout cells = layout_cells(
      work.low, work.high, std::max(is_gaussian ? radii.in_cells / 3.f : radii.in_cells, kSmallestCell), radii);
  work.atoms = build_neighbor_grid(executor, "crowded cell of atoms", set.count, cells, [&] {
    return CenteredAtomAt{executor.lend(set.atoms), work.lattice.center_x, work.lattice.center_y,
                          work.lattice.center_z,    work.parameters.scale, work.parameters.probe};
  });
  executor.end_lending();
  if (is_gaussian) return;
  remove_contained_atoms(executor, work.atoms, work.parameters.max_radius);
  if (in.settings.method != QSES_METHOD_EXACT) return;
  const SolventFeatures features = list_features(work);
  if (work.parameters.is_of_balls() && (in.settings.measure || in.settings.atom_areas))
    measure_by_atoms(work, features);
  if (!work.makes_mesh) return;
  work.features = arrange_features(work, features);
  if (in.settings.creases && !work.parameters.is_of_balls()) sum_arcs(work);
}

// What is shown of the mesh of all atoms.
template <class Work>
MeshMemoryView cut_surface(Work &work, const MeshMemoryView &whole) {
  ShownParts shown{work.appearance.visible, nullptr};
  if (work.settings.outer_only) {
    const Span<const uint8_t> outer = work.components.outer(whole.components);
    shown.components = bring(work.executor, outer.data, outer.size);
  }
  MeshMemoryView mesh = drop_hidden(work, whole, shown, work.hard_edges ? MeshPurpose::kWork : MeshPurpose::kDelivered);
  mesh.components = whole.components;
  mesh.bounds = find_bounds(work.executor, mesh.view, MeshCounts{mesh.vertices, mesh.triangles});
  return mesh;
}

template <class Work>
void begin_appearance(Work &work) {
  work.timer.begin(work.settings.occlusion ? "occlusion" : "appearance");
}

// The mesh of all atoms. Of a short frame like the one before, all of it is asked for and nothing is waited for.
template <class Work>
MeshMemoryView begin_level(Work &work) {
  if (!work.makes_mesh) return {};
  return work.settings.surface == QSES_SURFACE_GAUSSIAN ? build_gaussian_surface(work)
         : work.settings.method == QSES_METHOD_GRID     ? build_grid_surface(work)
         : splits_creases(work)                         ? build_creased_surface(work)
                                                        : build_exact_surface(work);
}

// Sums of the mesh. Of one that is painted and complete nothing is left but to bring it to where it is wanted: on a GPU
// its sums are on their way as well, and that is all that is waited for.
template <class Work, class Load>
Measures sum_up(Work &work, const Load &load, MeshMemoryView *mesh) {
  using Executor = std::decay_t<decltype(work.executor)>;
  if constexpr (Executor::kIsCuda && !Executor::kCounts) {
    const bool is_complete = work.paints_early() && !work.settings.atom_areas && !work.shape.boxes &&
                             work.report->measured_by != QSES_MEASURED_BY_ATOMS;
    if (is_complete && send_sums(work.executor, load, &mesh->coming)) return {};
  }
  return sum_mesh(work.executor, load, &work.report->unplaced_vertices);
}

// It is measured; then what is shown of it, with hard edges if they are asked for.
template <class Work>
MeshMemoryView measure_and_cut(Work &work, MeshMemoryView mesh) {
  auto &executor = work.executor;
  const MeshCounts counts{mesh.vertices, mesh.triangles};
  if (work.paints_early() && !mesh.is_brought) {
    begin_appearance(work);
    paint_and_light(work, mesh);
    work.memory.bring_vertices(executor, mesh);
  }
  Measures measures{};
  if (wants_components(work.settings)) {
    work.timer.begin("components");
    // Along the normals also of balls, whose atoms know area and volume better, but not of each component.
    const bool bent = work.settings.method != QSES_METHOD_GRID;
    const MeshComponents components = work.components.find(executor, mesh, work.parameters.spacing, bent,
                                                           &work.report->unplaced_vertices, work.progress.stop_flag());
    mesh.components = components.list;
    measures = components.total;
  } else {
    work.timer.begin("measure");
    const double middle[3] = {work.lattice.center_x, work.lattice.center_y, work.lattice.center_z};
    const bool bent = work.report->measured_by == QSES_MEASURED_BY_NORMALS;
    measures = work.settings.measure
                   ? sum_up(work, measured_sums(mesh.view, counts, bent, middle, mesh.unplaced), &mesh)
                   : sum_up(work, bound_sums(mesh.view, counts, mesh.unplaced), &mesh);
  }
  mesh.bounds = measures.bounds;
  if (work.settings.measure) note_measures(measures.sums, work.report);
  if (work.settings.atom_areas && !(is_exact(work.settings) && work.parameters.is_of_balls()))
    work.atom_areas = bring_areas(work, [&](double *areas) {
      measure_owners(executor, mesh.view, mesh.triangles, work.parameters.spacing, work.atoms.count, areas);
    });
  if (work.is_cut && mesh.vertices > 0) {
    work.timer.begin("visible_mask");
    mesh = cut_surface(work, mesh);
  }
  if (work.hard_edges && mesh.vertices > 0) {
    work.timer.begin("hard_edges");
    mesh = harden_edges(work, mesh);
  }
  return mesh;
}

// What is left to do for it: the mesh of the level, in memory of the arena and of the pools.
template <class Work>
MeshMemoryView end_level(Work &work, MeshMemoryView mesh) {
  settle_mesh(work, &mesh);
  if (work.makes_mesh) mesh = measure_and_cut(work, mesh);
  if (work.settings.delivery != QSES_DELIVERY_NONE) {
    begin_appearance(work);
    complete_vertices(work, &mesh);
  }
  if (work.shape.boxes) {
    work.timer.begin("pick_boxes");
    fill_pick_boxes(work.executor, mesh.view, mesh.triangles);
  }
  if (work.report->measured_by == QSES_MEASURED_BY_ATOMS) {
    work.report->area = work.atom_measures.area;
    work.report->volume = work.atom_measures.volume;
  }
  mesh.atom_areas = work.atom_areas;
  return mesh;
}

}  // namespace quickses
