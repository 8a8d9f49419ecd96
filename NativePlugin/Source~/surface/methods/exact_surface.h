// SPDX-License-Identifier: MIT
// The exact method from the neighbour grid to the mesh: features, bricks, signs, counts, vertices, triangles.
#pragma once

#include "surface/methods/ball_edges.h"
#include "surface/methods/closed_layout.h"
#include "surface/methods/exact_slabs.h"
#include "surface/stages/relaxation.h"
#include "surface/stages/thin_walls.h"

namespace quickses {

// Caps and arcs of the atoms.
template <class Work>
SolventFeatures list_features(Work &work) {
  using Executor = std::remove_reference_t<decltype(work.executor)>;
  work.timer.begin("solvent_features");
  SolventFeatures found;
  Backend<Executor>::find_solvent_features(work.executor, work.atoms, work.parameters, work.plan, work.rooms, &found);
  constexpr uint64_t kMostArcs = 0x7fffffffu;  // their numbers are signed (NearestArc): -1 is none
  if (found.caps.size > kMostNumbered || found.arcs.size > kMostArcs)
    throw Error(
        QSES_OUT_OF_MEMORY,
        "the inflated atoms have more circles with each other than 32-bit numbers can name: use a smaller probe, "
        "smaller radii or fewer atoms");
  work.facts->caps = found.caps.size;
  work.facts->arcs = found.arcs.size;
  work.facts->knows_arcs = true;
  return found;
}

// The arcs in a grid of their own.
template <class Work>
FeatureView arrange_features(Work &work, const SolventFeatures &found) {
  auto &executor = work.executor;
  work.timer.begin("solvent_features");
  FeatureView f{};
  f.atoms = work.atoms;
  f.cap_ranges = found.cap_ranges.data;
  f.caps = found.caps.data;
  f.exposed = found.exposed.data;
  f.most_caps = found.most_caps;
  f.parameters = work.parameters;
  f.max_arc_bound = work.parameters.max_arc_bound() + 1e-3f;
  const size_t n = found.arcs.size;
  if (n > 0) {
    const glm::vec3 reach(work.parameters.max_radius);
    const CellLayout cells = layout_cells(work.low - reach, work.high + reach, kArcCellEdge);
    // Where memory is short they change places in the end, when the work on the grid is given up.
    const bool changes_places = work.plan.low_memory || executor.arena().has_budget();
    const auto allocate_sorted = [&] { return executor.template allocate<Arc>(n).data; };
    const BringArc at_once{found.arcs.data, changes_places ? nullptr : allocate_sorted()};
    f.arc_bounds = build_neighbor_grid(
        executor, "crowded cell of arcs", n, cells,
        [&] {
          return ArcBoundAt{found.arcs.data, found.arc_count};
        },
        at_once);
    f.arcs = at_once.sorted;
    if (changes_places) {
      const auto mark = executor.arena().mark();
      const BringArc later{found.arcs.data, allocate_sorted()};
      executor.for_each(n, GatherArcs{later, found.arc_count, f.arc_bounds.order});
      executor.for_each(n, CopyArcs{later.sorted, found.arcs.data});
      executor.arena().rewind(mark);
      f.arcs = found.arcs.data;
    }
  }
  return f;
}

// Bricks per slice: those that are asked for, or, by a plan with several slices, as many as fit into what is left. What
// they take is counted: work_on(counting executor, slice). A bit is kept back, since bricks differ.
template <class Work, class WorkOn>
uint32_t slice_of(Work &work, uint32_t brick_count, const WorkOn &work_on) {
  const uint32_t asked = asked_slice(work.settings, brick_count, work.progress.wanted());
  if (work.plan.single_slice || brick_count == 0) return asked;
  const uint32_t sample = std::min<uint32_t>(brick_count, kRoomySlice);
  auto counted = counting(work.executor, *work.facts);
  work_on(counted, BrickRange{0, sample});
  const uint64_t per_brick = counted.arena().peak() / sample + 1;
  return std::min(asked, work.plan.slice(work.executor.arena().available() / 8 * 7 / per_brick, brick_count));
}

template <class Work>
uint32_t sign_slice(Work &work, const BrickSet &bricks) {
  using B = Backend<std::remove_reference_t<decltype(work.executor)>>;
  return slice_of(work, bricks.count, [&](auto &counted, BrickRange slice) {
    typename B::Candidates own{};
    B::evaluate_signs(counted, {work.features, bricks, slice, work.rooms, own}, nullptr);
  });
}

// Marks what signs miss of walls thinner than the spacing. All marks are found before the first becomes a sign, so that
// neither slices nor threads matter. shared: candidates of all bricks, if they are gathered.
template <class Work>
void mend_thin_walls(Work &work, const BrickSet &bricks,
                     Candidates<std::remove_reference_t<decltype(work.executor)>> *shared, uint64_t *signs) {
  auto &executor = work.executor;
  using B = Backend<std::remove_reference_t<decltype(executor)>>;
  work.timer.begin("thin_walls");
  const auto mark = executor.arena().mark();
  // The GPU reads all signs of a slice before it marks: those of the only one may be marked where they are.
  const bool in_place = std::remove_reference_t<decltype(executor)>::kIsCuda && shared;
  const size_t leaves = size_t(bricks.count) * kLeavesPerBrick;
  const Span<uint64_t> marks =
      in_place ? Span<uint64_t>{signs, leaves} : executor.template allocate_zeros<uint64_t>(leaves);
  const auto mark_slice = [&](auto &any_executor, BrickRange slice) {
    typename B::Candidates own{};
    B::mark_thin_walls(any_executor, {work.features, bricks, slice, work.rooms, shared ? *shared : own}, signs,
                       marks.data);
  };
  const uint32_t slice_size = shared ? bricks.count : slice_of(work, bricks.count, mark_slice);
  for_each_slice(work, bricks.count, slice_size, 0.4, 0.45, [&](BrickRange slice) { mark_slice(executor, slice); });
  if (!in_place) executor.for_each(leaves, AddMarks{marks.data, signs});
  executor.arena().rewind(mark);
}

// The part of a mesh that a slice of bricks owns, in memory of the device.
struct MeshPart {
  MeshView view;
  size_t vertices, triangles;
};
template <class Work, class Executor>
MeshPart open_part(const Work &work, Executor &executor, const SliceSizes &sizes) {
  MeshShape shape = work.shape;
  shape.boxes = shape.colors = shape.texcoords = shape.component_ids = false;
  MeshPart part{{}, sizes.vertices, sizes.triangles};
  const MeshArrays arrays(part.vertices, part.triangles, shape);
  part.view = arrays.view(executor.template allocate<char>(arrays.bytes()).data);
  add_normals(work.side_normals, &part.view, part.vertices,
              [&](size_t n) { return executor.template allocate<glm::vec3>(n).data; });
  part.view.first_vertex = sizes.first_vertex;
  part.view.first_triangle = sizes.first_triangle;
  return part;
}

// All from the features to the mesh, whose size may be left to be told (settle_mesh). Signs of all bricks first, slice
// by slice: numbers are global before anything is emitted.
template <class Work>
MeshMemoryView build_exact_surface(Work &work) {
  auto &executor = work.executor;
  using Executor = std::remove_reference_t<decltype(executor)>;
  using B = Backend<Executor>;
  const FeatureView &features = work.features;
  work.memory.forget_spills();
  work.timer.begin("bricks");
  BrickSet bricks = find_bricks(executor, features, work.lattice, &work.facts->brick_visits);
  note_bricks(work, bricks);
  work.progress.report(0.1);
  if constexpr (Executor::kIsCuda && !Executor::kCounts) {
    const Slabs slabs = slabs_of(work, bricks);
    if (slabs.count > 0) return build_in_slabs(work, bricks, slabs);
  }

  // What signs and vertices share, if all bricks are worked on at once; gathered again for each of several slices.
  Candidates<Executor> shared{};
  bool share = false;
  const bool holds = work.will_be_split && work.parameters.is_of_balls();
  Span<uint64_t> channels{};
  MeshLayout layout{};
  const MeshCounts counts = lay_out_closed_mesh(work, &bricks, &layout, [&](const BrickSet &set, uint64_t *signs) {
    work.timer.begin("exact_ses");
    const uint32_t slice_size = sign_slice(work, set);
    share = slice_size >= set.count && work.plan.single_slice;
    shared = {};
    if (share) B::gather_candidates(executor, {features, set, {0, set.count}, work.rooms, shared}, signs);
    if (holds) channels = executor.template allocate<uint64_t>(size_t(set.count) * kLeavesPerBrick);
    const auto mark = executor.arena().mark();
    for_each_slice(work, set.count, slice_size, 0.1, 0.45, [&](BrickRange slice) {
      Candidates<Executor> own{};
      B::evaluate_signs(executor, {features, set, slice, work.rooms, share ? shared : own}, signs);
    });
    if (holds) open_thin_channels(work, set, signs, channels);
    if (work.parameters.has_thin_walls()) mend_thin_walls(work, set, share ? &shared : nullptr, signs);
    executor.arena().rewind(mark);
  });

  executor.send_counts();
  MeshMemoryView mesh = begin_mesh(work, counts);
  const auto end_of_mesh = executor.arena().mark();
  VertexStarts starts{work.settings.relaxation_steps > 0, nullptr, work.table.ring, &layout.totals->unplaced};
  // In a short frame triangles and vertices may be made side by side; but for stages, whose times are to be told apart.
  const bool together = share && !mesh.in_pieces && executor.runs_ahead() && !work.timer.is_enabled();
  const auto note_triangles = [&] { work.memory.note_triangles(executor); };  // they may go out meanwhile
  const auto emit_triangles_first = [&] {
    const auto emit_run = [&](BrickRange run) {
      if (run.size() > 0) B::emit_triangles(executor, bricks, layout, run, work.table, mesh.view);
    };
    uint32_t early = 0;
    if constexpr (Executor::kIsCuda && !Executor::kCounts)
      if (layout.early_triangles > 0 && work.memory.may_send_triangles(mesh, work.purpose)) {
        early = static_cast<uint32_t>(early_bricks(bricks.count));
        emit_run({0, early});
        work.memory.bring_early_triangles(executor, mesh, static_cast<size_t>(layout.early_triangles));
      }
    emit_run({early, bricks.count});
    note_triangles();
  };
  if (!mesh.in_pieces && !together) emit_triangles_first();
  const auto emit_slice = [&](auto &any_executor, BrickRange slice, bool with_triangles) {
    Candidates<Executor> own{};
    MeshPart part{mesh.view, 0, 0};
    const SliceSizes sizes = slice_sizes(any_executor, bricks, layout, slice);
    if (mesh.in_pieces) part = open_part(work, any_executor, sizes);
    const typename B::Slice slice_work{features, bricks, slice, work.rooms, share ? shared : own};
    const VertexWork vertices{layout, sizes, starts, part.view};
    if (with_triangles && together) {
      B::emit_mesh(any_executor, slice_work, vertices, work.table, note_triangles, emit_triangles_first);
      return part;
    }
    B::emit_vertices(any_executor, slice_work, vertices);
    if (with_triangles && mesh.in_pieces) B::emit_triangles(any_executor, bricks, layout, slice, work.table, part.view);
    return part;
  };
  const auto emit = [&](double begin, double end, bool with_triangles) {
    const uint32_t slice_size = slice_of(
        work, bricks.count, [&](auto &counted, BrickRange slice) { emit_slice(counted, slice, with_triangles); });
    work.report->slice_count = for_each_slice(work, bricks.count, slice_size, begin, end, [&](BrickRange slice) {
      const MeshPart part = emit_slice(executor, slice, with_triangles);
      if (mesh.in_pieces)
        work.memory.save(executor, mesh, part.view, part.vertices, with_triangles ? part.triangles : 0);
    });
  };
  // For how much it is, a short frame waits when all of it is under way. A long one waits again and again while its
  // vertices are made; so it does that before, and its triangles go out meanwhile.
  work.untold = {layout.totals, bricks.found, bricks.count};
  work.timer.begin("projection");
  if (!executor.runs_ahead()) wait_for_size(work, &mesh);
  emit(0.45, 0.8, true);
  if (work.settings.relaxation_steps > 1 || holds) wait_for_size(work, &mesh);
  work.progress.report(0.85);

  // Steps 2 and on: tangential, each projected again.
  work.timer.begin("relaxation");
  if (work.settings.relaxation_steps > 1) {
    Span<RingSum> sums = work.memory.template allocate_where_mesh_is<RingSum>(executor, mesh, mesh.vertices);
    Span<glm::vec3> moved = work.memory.template allocate_where_mesh_is<glm::vec3>(executor, mesh, mesh.vertices);
    for (uint32_t step = 1; step < work.settings.relaxation_steps; ++step) {
      tangential_starts(executor, bricks, layout, mesh.view, MeshCounts{mesh.vertices, mesh.triangles}, sums,
                        moved.data);
      starts.moved = moved.data;
      executor.turn_counts_to(work.parameters.spacing, step);  // of a kind each
      executor.fill(Span<uint32_t>{starts.unplaced, 1}, 0);
      const double share_of_time = 0.15 / work.settings.relaxation_steps;
      emit(0.85 + share_of_time * (step - 1), 0.85 + share_of_time * step, false);
      executor.keep_pace();
    }
    executor.turn_counts_to(work.parameters.spacing);
  }
  if (holds && mesh.vertices > 0) hold_to_edges(work, bricks, layout, channels.data, mesh);
  executor.arena().rewind(end_of_mesh);
  mesh.unplaced = starts.unplaced;
  return mesh;
}

}  // namespace quickses
