// SPDX-License-Identifier: MIT
// Sharpens a finished mesh: edges that cut across creases get vertices on them, or have an end moved there, then edges
// along creases are split where they leave them, and triangles over corners get a vertex in the corner. The mesh grows
// in parts, which are joined at last.
#pragma once

#include "surface/methods/level_work.h"
#include "surface/methods/visible_mask.h"
#include "surface/stages/edge_splits.h"

namespace quickses {

// Splits are not known before they are made: of memory for this part of the vertices and triangles is thought.
constexpr double kExpectedSplits = 0.25, kExpectedNear = 0.6;

inline size_t expected_part(size_t n, double part) { return static_cast<size_t>(part * static_cast<double>(n)) + 64; }

template <class Executor>
CreaseMarks allocate_marks(Executor &executor, size_t vertices) {
  return {executor.template allocate<float>(3 * vertices).data, executor.template allocate<uint8_t>(vertices).data};
}

struct PartSizes {
  size_t vertices, triangles;
};

// One round over the triangles near creases. `all`: of the mesh so far; it grows.
template <class Work, class Sheets>
void split_round(Work &work, const Sheets &sheets, const SplitRound &round, int next_part, const MeshShape &shape,
                 MeshParts *mesh, PartSizes *all) {
  auto &executor = work.executor;
  using Executor = std::remove_reference_t<decltype(executor)>;
  constexpr bool kCounts = Executor::kCounts;
  const Lattice &lattice = work.lattice;
  const size_t vertices = all->vertices;
  const uint64_t steps = std::min<uint64_t>(NearSpheres::kMostMet, work.atoms.count) + kPlainSteps;

  // What is allocated here goes, but for the part that is added: that comes first.
  // Sizes of the new part are only known at the end; the work arrays lie before it.
  Span<uint32_t> list = executor.template allocate<uint32_t>(all->triangles);
  size_t listed = executor.compact(all->triangles, NearCrease<Sheets>{*mesh, round.along}, list);
  if (kCounts) listed = std::min(all->triangles, expected_part(all->triangles, kExpectedNear));
  Span<uint8_t> chosen = executor.template allocate<uint8_t>(listed);
  Span<uint32_t> count = executor.template allocate<uint32_t>(vertices);
  Span<uint32_t> starts = executor.template allocate<uint32_t>(vertices + 1);
  executor.fill(count, 0);
  executor.for_each(listed, ChooseEdges<Sheets>{*mesh, sheets, round, list.data, chosen.data, count.data});
  executor.exclusive_scan(vertices, LoadCount<uint32_t>{count.data}, starts);
  size_t edges = executor.fetch(starts.data + vertices);
  if (kCounts) edges = expected_part(vertices, kExpectedSplits);
  Span<uint32_t> seconds = executor.template allocate<uint32_t>(edges), firsts = executor.template allocate<uint32_t>(edges),
                 unordered = executor.template allocate<uint32_t>(edges);
  const EdgeTable table{starts.data, seconds.data, firsts.data};
  executor.fill(count, 0);
  executor.for_each(listed, ListEdges{*mesh, list.data, chosen.data, starts.data, count.data, unordered.data});
  executor.for_each(vertices, OrderEdges{unordered.data, table});
  Span<CreasePoint> points = executor.template allocate<CreasePoint>(edges);
  const SolveEdges<Sheets> solve{*mesh, sheets, table, round.along, points.data};
  executor.for_each(edges, solve, steps);

  if (round.snap) {
    const auto mark = executor.arena().mark();
    const Snaps snaps{executor.template allocate<uint32_t>(vertices).data,
                      executor.template allocate<uint32_t>(vertices).data};
    executor.fill(Span<uint32_t>{snaps.nearest, vertices}, 0xff);
    executor.fill(Span<uint32_t>{snaps.edge, vertices}, 0xff);
    executor.for_each(edges, FindNearestSnap{{table, points.data, snaps}});
    executor.for_each(edges, ChooseSnap{{table, points.data, snaps}});
    Span<uint8_t> refused = executor.template allocate<uint8_t>(vertices);
    executor.fill(refused, 0);
    Span<uint32_t> touched = executor.template allocate<uint32_t>(all->triangles);
    const size_t touched_count = executor.compact(all->triangles, TouchedBySnap{*mesh, snaps.edge}, touched);
    const RefuseSnaps refuse{*mesh, lattice, touched.data, points.data, snaps.edge, refused.data};
    executor.for_each(touched_count, refuse);
    executor.for_each(edges, SnapVertices{*mesh, lattice, table, points.data, snaps.edge, refused.data});
    executor.arena().rewind(mark);
    executor.for_each(edges, solve, steps);
  }

  Span<CreasePoint> corners{};
  if (round.along) {
    corners = executor.template allocate<CreasePoint>(listed);
    executor.for_each(listed, SolveCorners<Sheets>{*mesh, sheets, list.data, corners.data}, steps);
  }
  const FindSplits find{*mesh, table, list.data, chosen.data, points.data, corners.data};
  if (round.along) {
    Span<uint8_t> refused = executor.template allocate<uint8_t>(edges);
    for (int pass = 0; pass < 2; ++pass) {
      executor.fill(refused, 0);
      executor.for_each(listed, RefuseSplits{find, lattice, refused.data});
      executor.for_each(edges, DropRefused{refused.data, points.data});
    }
  }
  Span<uint32_t> edge_rank = executor.template allocate<uint32_t>(edges + 1),
                 corner_rank = executor.template allocate<uint32_t>(listed + 1),
                 before = executor.template allocate<uint32_t>(listed + 1);
  executor.exclusive_scan(edges, CountSplit{points.data}, edge_rank);
  if (round.along) executor.exclusive_scan(listed, CountCorner{corners.data}, corner_rank);
  executor.exclusive_scan(listed, CountNewTriangles{find}, before);
  uint32_t n[3] = {0, 0, 0};
  const uint32_t *const sources[3] = {edge_rank.data + edges, before.data + listed, corner_rank.data + listed};
  if constexpr (!kCounts) executor.fetch_each(sources, n, round.along ? 3 : 2);
  const uint32_t first_vertex = static_cast<uint32_t>(all->vertices),
                 first_triangle = static_cast<uint32_t>(all->triangles);
  PartSizes added{size_t(n[0]) + n[2], n[1]};
  if (kCounts) added = {expected_part(all->vertices, kExpectedSplits), expected_part(all->triangles, kExpectedSplits)};
  check_mesh_size({all->vertices + added.vertices, all->triangles + added.triangles});

  const MeshArrays arrays(added.vertices, added.triangles, shape);
  MeshView part = arrays.view(executor.template allocate<char>(arrays.bytes()).data);
  part.first_vertex = first_vertex;
  part.first_triangle = first_triangle;
  mesh->part[next_part] = part;
  mesh->marks[next_part] = allocate_marks(executor, added.vertices);
  FindSplits grown = find;
  grown.mesh = *mesh;
  executor.for_each(edges, AddVertex{*mesh, lattice, points.data, edge_rank.data, first_vertex, true});
  if (round.along)
    executor.for_each(listed, AddVertex{*mesh, lattice, corners.data, corner_rank.data, first_vertex + n[0], false});
  executor.for_each(listed, AddTriangles{grown, lattice, edge_rank.data, corner_rank.data, first_vertex,
                                         first_vertex + n[0], before.data, first_triangle});
  all->vertices += added.vertices;
  all->triangles += added.triangles;
}

template <class Work>
bool splits_creases(const Work &work) {
  return work.settings.creases != 0 && work.parameters.depth == 0.f && !work.plan.mesh_in_pieces;
}

// Shape of a mesh whose edges are to be split: the rest of the attributes come when it is finished.
inline MeshShape shape_before_splits(const MeshShape &wanted) {
  MeshShape shape;
  shape.patches = wanted.patches;
  shape.reversed = wanted.reversed;
  return shape;
}

// The mesh `plain`, of that shape, with sharp creases. Waits.
template <class Work>
MeshMemoryView split_creases(Work &work, const MeshMemoryView &plain) {
  auto &executor = work.executor;
  const MeshShape shape = shape_before_splits(work.shape);
  MeshParts mesh{};
  for (int k = 1; k < kMostParts; ++k) mesh.part[k].first_vertex = mesh.part[k].first_triangle = kNoNumber;
  mesh.part[0] = plain.view;
  PartSizes all{plain.vertices, plain.triangles};
  mesh.marks[0] = allocate_marks(executor, plain.vertices);
  executor.fill(Span<uint8_t>{mesh.marks[0].on_crease, plain.vertices}, 0);

  Span<uint32_t> places = executor.template allocate<uint32_t>(work.atoms.count);
  executor.for_each(work.atoms.count, PlaceAtoms{work.atoms.order, places.data});
  float far = 0.f;
  for (int d = 0; d < 3; ++d) far = std::max({far, std::abs(work.low[d]), std::abs(work.high[d])});
  const double center[3] = {work.lattice.center_x, work.lattice.center_y, work.lattice.center_z};
  for (double c : center) far += static_cast<float>(std::abs(c));
  const SphereSheets sheets{work.atoms, places.data, work.lattice, work.parameters.max_radius,
                            kSheetTolerance + 4e-7f * far};
  split_round(work, sheets, SplitRound{true, false}, 1, shape, &mesh, &all);
  split_round(work, sheets, SplitRound{false, true}, 2, shape, &mesh, &all);

  MeshMemoryView out = work.memory.allocate_mesh(executor, all.vertices, all.triangles, work.shape, work.purpose,
                                                 work.plan.mesh_in_pieces);
  add_normals(work, &out);
  executor.for_each(all.vertices, JoinVertex{mesh, out.view});
  executor.for_each(all.triangles, JoinTriangle{mesh, out.view});
  complete_vertices(executor, work.appearance, out.view, out.vertices);
  if (out.view.packed_normals) out.view.normals = nullptr;
  out.unplaced = plain.unplaced;
  return out;
}

}  // namespace quickses
