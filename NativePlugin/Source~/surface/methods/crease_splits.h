// SPDX-License-Identifier: MIT
// Sharpens a finished mesh: edges that cut across creases get vertices on them, or have an end moved there; then edges
// along creases are split where they leave them. The mesh grows into room that was left behind it.
#pragma once

#include "parallel/two_step_pass.h"
#include "surface/methods/crease_merges.h"
#include "surface/stages/crease_snaps.h"
#include "surface/stages/edge_splits.h"
#include "surface/stages/probe_sheets.h"
#include "surface/stages/sphere_sheets.h"

namespace quickses {

// Of so many triangles, those that a round is expected to look at.
template <class Work>
size_t expected_near(const Work &work, int round, size_t triangles) {
  const double near = expected_splits(work).near_part(round) * static_cast<double>(triangles);
  return std::min(triangles, static_cast<size_t>(near) + 64);
}

// The mesh, of which there is room for so many vertices and triangles, with marks for as many.
template <class Sheets, class Work>
GrowingMesh begin_to_grow(Work &work, const MeshMemoryView &whole, size_t vertex_room, size_t triangle_room) {
  GrowingMesh mesh{whole, {whole.view, nullptr, nullptr, nullptr}, vertex_room, triangle_room};
  if (Sheets::kHasCorners) mesh.view.second_owners = mesh_room<uint32_t>(work, mesh, vertex_room).data;
  mesh.view.crease_marks = mesh_room<uint8_t>(work, mesh, vertex_room).data;
  mesh.view.near_marks = mesh_room<uint8_t>(work, mesh, triangle_room).data;
  return mesh;
}

// Room for so many more. Where there is not enough behind the mesh it goes elsewhere.
template <class Sheets, class Work>
void make_room(Work &work, size_t vertices, size_t triangles, GrowingMesh *mesh) {
  auto &executor = work.executor;
  const size_t v = mesh->whole.vertices, t = mesh->whole.triangles;
  FoundSplits &found = work.facts->found;
  if (!std::decay_t<decltype(executor)>::kCounts) {
    check_mesh_size({v + vertices, t + triangles});
    const SurfaceSize &before = work.facts->size;
    const double v_part = static_cast<double>(v + vertices) / before.vertices,
                 t_part = static_cast<double>(t + triangles) / before.triangles;
    found.added = std::max(v_part, t_part) - 1;
  }
  if (v + vertices <= mesh->vertex_room && t + triangles <= mesh->triangle_room) return;
  found.lacked_room = true;
  const size_t vertex_room = v + vertices + v / 8, triangle_room = t + triangles + t / 8;
  MeshMemoryView larger = work.memory.allocate_mesh(executor, vertex_room, triangle_room, mesh->whole.shape,
                                                    MeshPurpose::kWork, work.plan.mesh_in_pieces);
  add_normals(work, &larger);
  larger.vertices = v;
  larger.triangles = t;
  larger.unplaced = mesh->whole.unplaced;
  const CreasedMesh from = mesh->view;
  *mesh = begin_to_grow<Sheets>(work, larger, vertex_room, triangle_room);
  executor.for_each(std::max(v, t), GrowMesh{from, mesh->view, v, t});
}

// Calls f(near by, i), which may gather what is near a place if the sheets need it.
struct NothingNearBy {};
template <class F>
struct WithNothingNearBy {
  F f;
  QSES_FN void operator()(size_t i) const {
    NothingNearBy nothing;
    f(nothing, i);
  }
};
template <class Sheets, class Executor, class F>
void for_each_edge(Executor &executor, size_t n, const F &f) {
  if constexpr (Sheets::kGathers)
    Backend<Executor>::for_each_gathering(executor, n, f);
  else
    executor.for_each(n, WithNothingNearBy<F>{f}, kCreaseSteps);
}

// What a round leaves to the host.
struct RoundCounts {
  uint32_t triangles, vertices;  // new ones
  uint64_t old_near;             // triangles of before that the next round looks at
};

// One round over triangles near creases: the mesh grows by a part. The list becomes that of the next round. Waits once.
template <class Work, class Sheets>
void split_round(Work &work, const Sheets &sheets, SplitRound round, GrowingMesh *mesh, NearTriangles *list,
                 size_t *listed) {
  auto &executor = work.executor;
  constexpr bool kCounts = std::decay_t<decltype(executor)>::kCounts;
  const Lattice &lattice = sheets.lattice;
  const bool is_last = round == SplitRound::kLast;
  const size_t n = *listed, most_edges = n + n / 2;  // each is an edge of two triangles of the list
  const auto room = [&](auto kind, size_t m) { return mesh_room<decltype(kind)>(work, *mesh, m); };

  const Span<uint8_t> chosen = room(uint8_t{}, n);
  const Span<uint32_t> starts = room(uint32_t{}, n + 1), heads = room(uint32_t{}, mesh->whole.vertices);
  executor.fill(heads, 0xff);
  executor.for_each(n, ChooseEdges<Sheets>{mesh->view, sheets, round, *list, chosen.data});
  executor.exclusive_scan(n, CountChosen{chosen.data}, starts);
  const CreaseEdges edges{starts.data,
                          static_cast<uint32_t>(n),
                          room(uint32_t{}, most_edges).data,
                          room(uint32_t{}, most_edges).data,
                          heads.data,
                          room(uint32_t{}, most_edges).data,
                          room(CreasePoint{}, most_edges).data,
                          room(uint8_t{}, most_edges).data,
                          room(uint8_t{}, most_edges).data};
  executor.for_each(n, ListEdges{mesh->view, *list, chosen.data, edges});
  Snaps snaps{nullptr, edges};
  if (!is_last) {
    const Span<uint64_t> nearest = room(uint64_t{}, mesh->whole.vertices);
    executor.fill(nearest, 0xff);
    snaps.nearest = nearest.data;
  }
  SolveEdges<Sheets> solve{mesh->view, sheets, round, edges, snaps, false};
  for_each_edge<Sheets>(executor, most_edges, solve);
  if (!is_last) {
    executor.for_each(mesh->whole.triangles, RefuseSnaps{mesh->view, lattice, snaps});
    executor.for_each(most_edges, SnapVertices{mesh->view, lattice, snaps});
    solve.ends_were_moved = true;
    for_each_edge<Sheets>(executor, most_edges, solve);
  }

  const Span<uint32_t> edges_of = room(uint32_t{}, 3 * n);
  CreasePoint *const corners = Sheets::kHasCorners ? room(CreasePoint{}, n).data : nullptr;
  constexpr uint64_t kSteps = Sheets::kHasCorners ? kCreaseSteps : kPlainSteps;
  FindSplits find{mesh->view, *list, edges, chosen.data, edges_of.data, corners, 1};
  for_each_in_two_steps(executor, n, RefuseSplits<Sheets>{find, sheets}, kSteps);
  while (++find.pass <= kRefusals) executor.for_each(n, RefuseSplits<Sheets>{find, sheets}, kSteps);
  find.pass = 0;

  // Behind the sums the number of old triangles for the next round, so that both come to the host together.
  const Span<uint64_t> counts_of = room(uint64_t{}, n), before = room(uint64_t{}, n + 2);
  const Span<uint32_t> old_near = room(uint32_t{}, is_last ? 0 : mesh->whole.triangles);
  executor.for_each(n, CountNew<Sheets>{find, sheets, counts_of.data}, kSteps);
  executor.exclusive_scan(n, LoadCount<uint64_t>{counts_of.data}, Span<uint64_t>{before.data, n + 1});
  if (is_last)
    executor.fill(Span<uint64_t>{before.data + n + 1, 1}, 0);
  else
    executor.compact(mesh->whole.triangles, IsMarked{mesh->view.near_marks}, old_near, before.data + n + 1);
  RoundCounts counts = executor.fetch(reinterpret_cast<const RoundCounts *>(before.data + n));
  size_t vertices = counts.vertices, triangles = counts.triangles;
  if (kCounts) {
    vertices = mesh->vertex_room - mesh->whole.vertices;
    triangles = mesh->triangle_room - mesh->whole.triangles;
  }
  make_room<Sheets>(work, vertices, triangles, mesh);
  find.mesh = mesh->view;
  const uint32_t first_vertex = static_cast<uint32_t>(mesh->whole.vertices),
                 first_triangle = static_cast<uint32_t>(mesh->whole.triangles);
  uint32_t *const vertex_of = edges.nexts;  // which nobody follows any more
  executor.for_each(n, AddVertices{find, lattice, before.data, first_vertex, vertex_of});
  executor.for_each(n, AddTriangles{find, lattice, before.data, first_vertex, first_triangle, vertex_of});
  mesh->whole.vertices += vertices;
  mesh->whole.triangles += triangles;
  *list = {old_near.data, static_cast<uint32_t>(counts.old_near), first_triangle};
  *listed = kCounts ? expected_near(work, 2, mesh->whole.triangles) : static_cast<size_t>(counts.old_near) + triangles;
}

// The mesh, with room behind it, with sharp creases. Waits.
template <class Work, class Sheets>
GrowingMesh split_at(Work &work, const Sheets &sheets, const MeshMemoryView &plain, size_t vertex_room,
                     size_t triangle_room) {
  auto &executor = work.executor;
  GrowingMesh mesh = begin_to_grow<Sheets>(work, plain, vertex_room, triangle_room);
  const size_t triangles = plain.triangles;
  executor.for_each(plain.vertices, MarkVertices{mesh.view});
  if constexpr (Sheets::kHasCorners) {
    executor.for_each(triangles, FindSecondOwners{mesh.view, sheets});
    executor.for_each(plain.vertices, MarkCircleVertices{mesh.view, sheets});
  }
  executor.for_each(triangles, MarkNearTriangles<Sheets>{mesh.view, sheets});
  const Span<uint32_t> near = mesh_room<uint32_t>(work, mesh, triangles);
  size_t listed = executor.compact(triangles, IsMarked{mesh.view.near_marks}, near);
  if (std::decay_t<decltype(executor)>::kCounts)
    listed = expected_near(work, 1, triangles);
  else
    work.facts->found.near = exponent_of_part(static_cast<double>(listed) / static_cast<double>(triangles));
  NearTriangles list{near.data, static_cast<uint32_t>(listed), 0};
  split_round(work, sheets, SplitRound::kFirst, &mesh, &list, &listed);
  split_round(work, sheets, SplitRound::kLast, &mesh, &list, &listed);
  return mesh;
}

// How far from the origin of the caller's coordinates the atoms are.
template <class Work>
float farthest_coordinate(const Work &work) {
  const double centers[3] = {work.lattice.center_x, work.lattice.center_y, work.lattice.center_z};
  double far = 0;
  for (int d = 0; d < 3; ++d) {
    const float half = std::max(std::abs(work.low[d]), std::abs(work.high[d]));
    far = std::max(far, std::abs(centers[d]) + static_cast<double>(half));
  }
  return static_cast<float>(far);
}

// The shape of a mesh whose edges are to be split: what else there is to vertices comes when it is finished, and it is
// turned then, so that the winding does not matter to where it is split.
inline MeshShape shape_before_splits(const MeshShape &wanted) {
  MeshShape shape;
  shape.patches = wanted.patches;
  return shape;
}

template <class Work>
GrowingMesh split_creases(Work &work, const MeshMemoryView &plain, size_t vertex_room, size_t triangle_room) {
  if (!work.parameters.is_of_balls())
    return split_at(work, ProbeSheets{work.features, work.lattice}, plain, vertex_room, triangle_room);
  const float tolerance = kSheetTolerance + 1.2e-7f * farthest_coordinate(work);
  return split_at(work, SphereSheets{work.features, work.atom_places, work.lattice, tolerance}, plain, vertex_room,
                  triangle_room);
}

struct PlaceAtoms {
  const uint32_t *order;
  uint32_t *places;
  QSES_HOST_DEVICE void operator()(size_t i) const { places[order[i]] = static_cast<uint32_t>(i); }
};

template <class Work>
MeshMemoryView build_creased_surface(Work &work) {
  Work plain = work;
  plain.shape = plain.made_shape = shape_before_splits(work.shape);
  plain.purpose = MeshPurpose::kWork;
  plain.will_be_split = true;
  if (work.parameters.is_of_balls()) {
    const Span<uint32_t> places = work.executor.template allocate<uint32_t>(work.atoms.count);
    work.executor.for_each(work.atoms.count, PlaceAtoms{work.atoms.order, places.data});
    plain.atom_places = places.data;
  }
  MeshMemoryView mesh = build_exact_surface(plain);
  wait_for_size(plain, &mesh);
  if (mesh.vertices == 0) return mesh;
  work.timer.begin("creases");
  const GrowingMesh sharp =
      split_creases(plain, mesh, with_spare_room(plain, mesh.vertices), with_spare_room(plain, mesh.triangles));
  const size_t vertices = sharp.whole.vertices, triangles = sharp.whole.triangles;
  size_t merged = 0;
  const KeptParts kept = merge_at_creases(work, sharp, &merged);
  MeshMemoryView out = work.memory.allocate_mesh(work.executor, vertices - merged, triangles - 2 * merged,
                                                 work.made_shape, work.purpose, work.plan.mesh_in_pieces);
  add_normals(work, &out);
  keep_parts(work.executor, sharp.whole.view, vertices, triangles, kept, out.view);
  out.unplaced = mesh.unplaced;
  return out;
}

}  // namespace quickses
