// SPDX-License-Identifier: MIT
// Sharpens a finished mesh: edges that cut across creases get vertices on them, or have an end moved there; then edges
// along creases are split where they leave them. The mesh grows in parts, which are joined at last.
#pragma once

#include "surface/methods/exact_surface.h"
#include "surface/stages/crease_snaps.h"
#include "surface/stages/edge_splits.h"
#include "surface/stages/probe_sheets.h"
#include "surface/stages/sphere_sheets.h"

namespace quickses {

struct PartSizes {
  size_t vertices, triangles;
};

// The mesh while it grows, and how much there is of it.
struct GrowingMesh {
  MeshMemoryView plain;  // the first part
  MeshShape shape;       // of all parts
  MeshParts parts{};
  PartSizes all{};
  uint8_t *is_near = nullptr;  // [triangle]: has to do with creases, of those that are `known`
  size_t known = 0;
};

// Room for work on the mesh: where the mesh is, since most of it is as large.
template <class T, class Work>
Span<T> mesh_room(Work &work, const GrowingMesh &mesh, size_t n) {
  return work.memory.template allocate_where_mesh_is<T>(work.executor, mesh.plain, n);
}

template <class Work>
CreaseMarks marks_room(Work &work, const GrowingMesh &mesh, size_t vertices) {
  return {mesh_room<uint32_t>(work, mesh, vertices).data, mesh_room<uint8_t>(work, mesh, vertices).data};
}

// Where the work is only counted nobody knows how much is near a crease, or split: generously, these parts.
struct ExpectedParts {
  double near, split;
};
template <class Work>
ExpectedParts expected_parts(const Work &work) {
  return work.parameters.is_of_balls() ? ExpectedParts{0.6, 0.3} : ExpectedParts{0.2, 0.1};
}
inline size_t expected_part(size_t n, double part) { return static_cast<size_t>(part * static_cast<double>(n)) + 64; }

// Edges of the listed triangles that may have to be split, in the order of their vertices. Waits.
template <class Work, class Sheets>
size_t list_edges(Work &work, const Sheets &sheets, const SplitRound &round, const GrowingMesh &mesh,
                  Span<const uint32_t> list, uint8_t *chosen, EdgeTable *table) {
  auto &executor = work.executor;
  const size_t vertices = mesh.all.vertices;
  const Span<uint32_t> count = mesh_room<uint32_t>(work, mesh, vertices);
  const Span<uint32_t> starts = mesh_room<uint32_t>(work, mesh, vertices + 1);
  executor.fill(count, 0);
  executor.for_each(list.size, ChooseEdges<Sheets>{mesh.parts, sheets, round, list.data, chosen, count.data});
  executor.exclusive_scan(vertices, LoadCount<uint32_t>{count.data}, starts);
  size_t edges = executor.fetch(starts.data + vertices);
  if (std::decay_t<decltype(executor)>::kCounts) edges = expected_part(vertices, expected_parts(work).split);
  table->starts = starts.data;
  table->firsts = mesh_room<uint32_t>(work, mesh, edges).data;
  table->seconds = mesh_room<uint32_t>(work, mesh, edges).data;
  const Span<uint32_t> unordered = mesh_room<uint32_t>(work, mesh, edges);
  executor.fill(count, 0);
  executor.for_each(list.size, ListEdges{mesh.parts, list.data, chosen, starts.data, count.data, unordered.data});
  executor.for_each(vertices, OrderEdges{unordered.data, *table});
  return edges;
}

// Moves vertices onto creases that are near.
template <class Work>
Snaps snap_vertices(Work &work, const GrowingMesh &mesh, const EdgeTable &table, Span<const CreasePoint> points) {
  auto &executor = work.executor;
  const size_t vertices = mesh.all.vertices;
  const Span<uint32_t> nearest = mesh_room<uint32_t>(work, mesh, vertices),
                       edge = mesh_room<uint32_t>(work, mesh, vertices);
  const Span<uint8_t> refused = mesh_room<uint8_t>(work, mesh, vertices);
  executor.fill(nearest, 0xff);
  executor.fill(edge, 0xff);
  executor.fill(refused, 0);
  const Snaps snaps{nearest.data, edge.data, refused.data};
  const EdgeOfSnap snap{table, points.data, snaps};
  executor.for_each(points.size, FindNearestSnap{snap});
  executor.for_each(points.size, ChooseSnap{snap});
  const Span<uint32_t> touched = mesh_room<uint32_t>(work, mesh, mesh.all.triangles);
  const size_t count = executor.compact(mesh.all.triangles, TouchedBySnap{mesh.parts, edge.data}, touched);
  executor.for_each(count, RefuseSnaps{mesh.parts, work.lattice, touched.data, points.data, snaps, mesh.is_near});
  executor.for_each(points.size, SnapVertices{mesh.parts, work.lattice, table, points.data, snaps});
  return snaps;
}

// Passes in which splits are refused that would fold triangles: what is left of one may fold another.
constexpr int kRefusals = 2;

// One round over the triangles near creases: the mesh grows by a part.
template <class Work, class Sheets>
void split_round(Work &work, const Sheets &sheets, const SplitRound &round, int next_part, GrowingMesh *mesh) {
  auto &executor = work.executor;
  constexpr bool kCounts = std::decay_t<decltype(executor)>::kCounts;
  const Lattice &lattice = work.lattice;
  const PartSizes all = mesh->all;

  const Span<uint32_t> near = mesh_room<uint32_t>(work, *mesh, all.triangles);
  // Of the first part the round before knows what comes into question.
  const Span<uint8_t> is_near = mesh_room<uint8_t>(work, *mesh, all.triangles);
  if (mesh->is_near) executor.for_each(mesh->known, CopyMarks{mesh->is_near, is_near.data});
  executor.for_each(all.triangles, FindNearCrease<Sheets>{mesh->parts, sheets, round.along, mesh->known, is_near.data});
  mesh->is_near = is_near.data;
  mesh->known = all.triangles;
  size_t listed = executor.compact(all.triangles, IsMarked{is_near.data}, near);
  if (kCounts) listed = std::min(all.triangles, expected_part(all.triangles, expected_parts(work).near));
  const Span<const uint32_t> list{near.data, listed};
  const Span<uint8_t> chosen = mesh_room<uint8_t>(work, *mesh, listed);
  EdgeTable table{};
  const size_t edges = list_edges(work, sheets, round, *mesh, list, chosen.data, &table);
  const Span<CreasePoint> points = mesh_room<CreasePoint>(work, *mesh, edges);
  const SolveEdges<Sheets> solve{mesh->parts, sheets, table, round.along, points.data};
  executor.for_each(edges, solve, kCreaseSteps);
  if (round.snap) {
    const Snaps snaps = snap_vertices(work, *mesh, table, Span<const CreasePoint>{points.data, edges});
    executor.for_each(edges, SolveMovedEdges<Sheets>{solve, snaps}, kCreaseSteps);
  }

  const Span<CreasePoint> corners = mesh_room<CreasePoint>(work, *mesh, listed);
  FindSplits find{mesh->parts, table, list.data, chosen.data, points.data, nullptr};
  SolveCorners<Sheets> solve_corners{find, sheets, lattice, corners.data, {}};
  find.corners = corners.data;
  executor.for_each(listed, solve_corners, kCreaseSteps);
  Refusals refusals{};
  for (int pass = 0; pass < kRefusals; ++pass) {
    const Span<uint8_t> refused = mesh_room<uint8_t>(work, *mesh, edges);
    refusals.now = refused.data;
    executor.fill(refused, 0);
    executor.for_each(listed, RefuseSplits<Sheets>{find, sheets, lattice, refusals});
    executor.for_each(edges, DropRefused{refused.data, points.data});
    refusals.before = refused.data;
    solve_corners.refusals = refusals;
    executor.for_each(listed, solve_corners, kCreaseSteps);
  }

  const Span<uint32_t> edge_rank = mesh_room<uint32_t>(work, *mesh, edges + 1),
                       corner_rank = mesh_room<uint32_t>(work, *mesh, listed + 1),
                       before = mesh_room<uint32_t>(work, *mesh, listed + 1);
  executor.exclusive_scan(edges, CountSplit{points.data}, edge_rank);
  executor.exclusive_scan(listed, CountCorner{corners.data}, corner_rank);
  executor.exclusive_scan(listed, CountNewTriangles{find}, before);
  uint32_t n[3] = {0, 0, 0};  // new vertices on edges, and within triangles; new triangles
  const uint32_t *const sources[3] = {edge_rank.data + edges, corner_rank.data + listed, before.data + listed};
  if constexpr (!kCounts) executor.fetch_each(sources, n, 3);
  PartSizes added{size_t(n[0]) + n[1], n[2]};
  if (kCounts)
    added = {expected_part(all.vertices, expected_parts(work).split),
             expected_part(all.triangles, expected_parts(work).split)};
  if (!kCounts) check_mesh_size({all.vertices + added.vertices, all.triangles + added.triangles});

  const MeshArrays arrays(added.vertices, added.triangles, mesh->shape);
  MeshView &part = mesh->parts.part[next_part];
  part = arrays.view(mesh_room<char>(work, *mesh, arrays.bytes()).data);
  add_normals(work.side_normals, &part, added.vertices,
              [&](size_t m) { return mesh_room<glm::vec3>(work, *mesh, m).data; });
  part.first_vertex = static_cast<uint32_t>(all.vertices);
  part.first_triangle = static_cast<uint32_t>(all.triangles);
  mesh->parts.marks[next_part] = marks_room(work, *mesh, added.vertices);
  find.mesh = mesh->parts;
  const uint32_t first_corner = part.first_vertex + n[0];
  executor.for_each(edges, AddVertexOnEdge{{mesh->parts, lattice, points.data, edge_rank.data, part.first_vertex}});
  executor.for_each(listed, AddCorner{{mesh->parts, lattice, corners.data, corner_rank.data, first_corner}});
  executor.for_each(listed, AddTriangles{find, lattice, edge_rank.data, corner_rank.data, part.first_vertex,
                                         first_corner, before.data, part.first_triangle});
  mesh->all = {all.vertices + added.vertices, all.triangles + added.triangles};
}

template <class Work, class Sheets>
void split_rounds(Work &work, const Sheets &sheets, GrowingMesh *mesh) {
  split_round(work, sheets, SplitRound{true, false}, 1, mesh);
  split_round(work, sheets, SplitRound{false, true}, 2, mesh);
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

// The shape of a mesh whose edges are to be split: what else there is to vertices comes when it is finished.
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
  GrowingMesh mesh{plain, plain.shape};
  mesh.all = {plain.vertices, plain.triangles};
  for (int k = 1; k < MeshParts::kMost; ++k)
    mesh.parts.part[k].first_vertex = mesh.parts.part[k].first_triangle = kNoNumber;
  mesh.parts.part[0] = plain.view;
  mesh.parts.marks[0] = marks_room(work, mesh, plain.vertices);
  executor.for_each(plain.vertices, MarkVertices{plain.view, mesh.parts.marks[0]});
  if (!work.parameters.is_of_balls()) {
    split_rounds(work, ProbeSheets{work.features, work.lattice}, &mesh);
  } else {
    const Span<uint32_t> places = executor.template allocate<uint32_t>(work.atoms.count);
    executor.for_each(work.atoms.count, PlaceAtoms{work.atoms.order, places.data});
    const float tolerance = kSheetTolerance + 1.2e-7f * farthest_coordinate(work);
    split_rounds(work, SphereSheets{work.features, places.data, work.lattice, tolerance}, &mesh);
  }
  MeshMemoryView out = work.memory.allocate_mesh(executor, mesh.all.vertices, mesh.all.triangles, work.made_shape,
                                                 work.purpose, work.plan.mesh_in_pieces);
  add_normals(work, &out);
  executor.for_each(mesh.all.vertices, JoinVertex{mesh.parts, out.view});
  executor.for_each(mesh.all.triangles, JoinTriangle{mesh.parts, out.view});
  out.unplaced = plain.unplaced;
  return out;
}

template <class Work>
bool splits_creases(const Work &work) {
  return work.settings.creases != 0 && work.settings.method == QSES_METHOD_EXACT &&
         work.parameters.spacing <= work.settings.spacing;
}

template <class Work>
MeshMemoryView build_creased_surface(Work &work) {
  Work plain = work;
  plain.shape = plain.made_shape = shape_before_splits(work.shape);
  plain.purpose = MeshPurpose::kWork;
  plain.will_be_split = true;
  const MeshMemoryView mesh = build_exact_surface(plain);
  if (mesh.vertices == 0) return mesh;
  work.timer.begin("creases");
  return split_creases(work, mesh);
}

}  // namespace quickses
