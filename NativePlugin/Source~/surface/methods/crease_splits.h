// SPDX-License-Identifier: MIT
// Sharpens a finished mesh: edges that cut across creases get vertices on them, or have an end moved there, then edges
// along creases are split where they leave them, and triangles over corners get a vertex in the corner. The mesh grows
// in parts, which are joined at last.
#pragma once

#include "surface/methods/exact_surface.h"
#include "surface/stages/edge_splits.h"
#include "surface/stages/probe_sheets.h"

namespace quickses {

// Splits are not known before they are made: of memory for this part of the vertices and triangles is thought.
constexpr double kExpectedSplits = 0.25, kExpectedNear = 0.6;

inline size_t expected_part(size_t n, double part) { return static_cast<size_t>(part * static_cast<double>(n)) + 64; }

template <class Executor>
CreaseMarks allocate_marks(Executor &executor, size_t vertices) {
  return {executor.template allocate<uint32_t>(vertices).data, executor.template allocate<uint8_t>(vertices).data};
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

#ifdef CREASE_DEBUG
  std::fprintf(stderr, "round along %d: ", round.along);
#endif
  // What is allocated here goes, but for the part that is added: that comes first.
  // Sizes of the new part are only known at the end; the work arrays lie before it.
  Span<uint32_t> list = executor.template allocate<uint32_t>(all->triangles);
  size_t listed = executor.compact(all->triangles, NearCrease<Sheets>{*mesh, sheets, round.along}, list);
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

  Span<CreasePoint> corners = executor.template allocate<CreasePoint>(listed);
  const FindSplits find{*mesh, table, list.data, chosen.data, points.data, corners.data};
  const SolveCorners<Sheets> solve_corners{{*mesh, table, list.data, chosen.data, points.data, nullptr}, sheets, lattice,
                                           corners.data};
  {
    Span<uint8_t> refused = executor.template allocate<uint8_t>(edges);
    for (int pass = 0; pass < KNOB(9, 2.f); ++pass) {
      executor.for_each(listed, solve_corners, steps);
      executor.fill(refused, 0);
      executor.for_each(listed, RefuseSplits<Sheets>{find, sheets, lattice, refused.data});
      executor.for_each(edges, DropRefused{refused.data, points.data});
    }
  }
  executor.for_each(listed, solve_corners, steps);
#ifdef CREASE_DEBUG
  if constexpr (!kCounts && !Executor::kIsCuda) {
    size_t c[3] = {0, 0, 0}, near_end = 0, cc = 0;
    for (size_t k = 0; k < edges; ++k) {
      ++c[points[k].kind];
      if (points[k].kind && !is_split(points[k])) ++near_end;
    }
      for (size_t k = 0; k < listed; ++k) cc += corners[k].kind != 0;
    std::fprintf(stderr, "listed %zu edges %zu none %zu crossed %zu along %zu near end %zu corners %zu\n", listed, edges, c[0], c[1], c[2],
                 near_end, cc);
    for (int k = 0; k < 16; ++k) std::fprintf(stderr, "%ld ", gWhy[k]), gWhy[k] = 0;
    std::fprintf(stderr, "\n");
  }
#endif
  Span<uint32_t> edge_rank = executor.template allocate<uint32_t>(edges + 1),
                 corner_rank = executor.template allocate<uint32_t>(listed + 1),
                 before = executor.template allocate<uint32_t>(listed + 1);
  executor.exclusive_scan(edges, CountSplit{points.data}, edge_rank);
  executor.exclusive_scan(listed, CountCorner{corners.data}, corner_rank);
  executor.exclusive_scan(listed, CountNewTriangles{find}, before);
  uint32_t n[3] = {0, 0, 0};  // of edges, triangles, corners
  const uint32_t *const sources[3] = {edge_rank.data + edges, before.data + listed, corner_rank.data + listed};
  if constexpr (!kCounts) executor.fetch_each(sources, n, 3);
  const uint32_t first_vertex = static_cast<uint32_t>(all->vertices),
                 first_triangle = static_cast<uint32_t>(all->triangles);
  PartSizes added{size_t(n[0]) + n[2], n[1]};
  if (kCounts) added = {expected_part(all->vertices, kExpectedSplits), expected_part(all->triangles, kExpectedSplits)};
  check_mesh_size({all->vertices + added.vertices, all->triangles + added.triangles});

  const MeshArrays arrays(added.vertices, added.triangles, shape);
  MeshView part = arrays.view(executor.template allocate<char>(arrays.bytes()).data);
  add_normals(work, &part, added.vertices, [&](size_t count) { return executor.template allocate<glm::vec3>(count).data; });
  part.first_vertex = first_vertex;
  part.first_triangle = first_triangle;
  mesh->part[next_part] = part;
  mesh->marks[next_part] = allocate_marks(executor, added.vertices);
  FindSplits grown = find;
  grown.mesh = *mesh;
  executor.for_each(edges, AddVertex{*mesh, lattice, points.data, edge_rank.data, first_vertex, true});
  executor.for_each(listed, AddVertex{*mesh, lattice, corners.data, corner_rank.data, first_vertex + n[0], false});
  executor.for_each(listed, AddTriangles{grown, lattice, edge_rank.data, corner_rank.data, first_vertex,
                                         first_vertex + n[0], before.data, first_triangle});
  all->vertices += added.vertices;
  all->triangles += added.triangles;
}

template <class Work>
bool splits_creases(const Work &work) {
  return work.settings.creases != 0 && work.settings.method == QSES_METHOD_EXACT && !work.plan.mesh_in_pieces;
}

// The shape of a mesh whose edges are to be split: what else there is to vertices comes when it is finished.
inline MeshShape shape_before_splits(const MeshShape &wanted) {
  MeshShape shape;
  shape.patches = wanted.patches;
  shape.reversed = wanted.reversed;
  return shape;
}

template <class Work, class Sheets>
void split_rounds(Work &work, const Sheets &sheets, const MeshShape &shape, MeshParts *mesh, PartSizes *all) {
#ifdef CREASE_DEBUG
  const char *how = std::getenv("HOW") ? std::getenv("HOW") : "sa";
  int next = 1;
  for (const char *c = how; *c; ++c)
    split_round(work, sheets, SplitRound{*c == 's', *c == 'a'}, next++, shape, mesh, all);
#else
  split_round(work, sheets, SplitRound{true, false}, 1, shape, mesh, all);
  split_round(work, sheets, SplitRound{false, true}, 2, shape, mesh, all);
#endif
}

// How far from the origin of the caller's coordinates the atoms are.
template <class Work>
float farthest_coordinate(const Work &work) {
  const double centers[3] = {work.lattice.center_x, work.lattice.center_y, work.lattice.center_z};
  double far = 0;
  for (int d = 0; d < 3; ++d)
    far = std::max(far, std::abs(centers[d]) + static_cast<double>(std::max(std::abs(work.low[d]), std::abs(work.high[d]))));
  return static_cast<float>(far);
}

// The mesh `plain`, of that shape, with sharp creases. Waits.
template <class Work>
MeshMemoryView split_creases(Work &work, const MeshMemoryView &plain) {
  auto &executor = work.executor;
  const MeshShape shape = shape_before_splits(work.shape);
  MeshParts mesh{};
  for (int k = 1; k < MeshParts::kMost; ++k) mesh.part[k].first_vertex = mesh.part[k].first_triangle = kNoNumber;
  mesh.part[0] = plain.view;
  PartSizes all{plain.vertices, plain.triangles};
  mesh.marks[0] = allocate_marks(executor, plain.vertices);
  executor.for_each(plain.vertices, MarkVertices{plain.view, mesh.marks[0]});
  if (work.parameters.depth > 0.f) {
    split_rounds(work, ProbeSheets{work.features, work.lattice}, shape, &mesh, &all);
  } else {
    Span<uint32_t> places = executor.template allocate<uint32_t>(work.atoms.count);
    executor.for_each(work.atoms.count, PlaceAtoms{work.atoms.order, places.data});
    split_rounds(work,
                 SphereSheets{work.atoms, places.data, work.lattice, work.parameters.max_radius,
                              kSheetTolerance + 4e-7f * farthest_coordinate(work)},
                 shape, &mesh, &all);
  }
  MeshMemoryView out = work.memory.allocate_mesh(executor, all.vertices, all.triangles, work.shape, work.purpose,
                                                 work.plan.mesh_in_pieces);
  add_normals(work, &out);
  executor.for_each(all.vertices, JoinVertex{mesh, out.view});
  executor.for_each(all.triangles, JoinTriangle{mesh, out.view});
  out.unplaced = plain.unplaced;
  return out;
}

template <class Work>
MeshMemoryView build_creased_surface(Work &work) {
  Work plain = work;
  plain.shape = shape_before_splits(work.shape);
  plain.purpose = MeshPurpose::kWork;
  const MeshMemoryView mesh = build_exact_surface(plain);
  if (mesh.vertices == 0) return mesh;
  work.timer.begin("creases");
  return split_creases(work, mesh);
}

}  // namespace quickses
