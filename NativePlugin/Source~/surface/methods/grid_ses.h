// SPDX-License-Identifier: MIT
// The voxel method of QuickSES (Martinez, Krone, Baaden 2019), kept as the published baseline: lattice points are
// classified as outside, border or inside (section 2.2), the distance to the nearest outside point is refined (2.3),
// and marching cubes interpolates it (2.4). Here on sparse bricks, and refined at every point.
#pragma once

#include "surface/methods/grid_rows.h"
#include "surface/stages/ball_points.h"

namespace quickses {

inline GridParameters make_grid_parameters(float probe, float spacing, float max_radius) {
  // p and h are decimals that float32 rounds: 1.4 / 0.2 is meant to be 7.
  constexpr double kRounding = 2.5e-7;
  const double ratio = static_cast<double>(probe) / static_cast<double>(spacing);
  if (ratio > kMaxGridReach)
    throw Error(QSES_TOO_FINE, "the grid method takes probe radii of up to 16384 spacings: use a larger spacing");
  GridParameters g;
  g.probe = probe;
  g.spacing = spacing;
  g.max_radius = max_radius;
  g.reach = static_cast<int32_t>(std::ceil(ratio * (1.0 - kRounding)));
  g.max_outside = static_cast<int32_t>(std::floor(ratio * ratio * (1.0 + 2.0 * kRounding)));
  return g;
}

// ---- classes ---------------------------------------------------------------------------------------------------

// The paper tells points in an atom ("inside") and those in an inflated ball only ("border") apart; refined at every
// point, both are treated alike.

// The classes of all bricks, which stay allocated. bricks and atoms must outlive the field.
template <class Executor>
GridField classify_grid_points(Executor &executor, const NeighborGridView &atoms, const GridParameters &parameters,
                               const BrickSet &bricks) {
  Span<uint64_t> outside = executor.template allocate<uint64_t>(size_t(bricks.count) * kLeavesPerBrick);
  find_outside_points(executor, Balls{atoms, parameters.max_radius, 0.f}, bricks, outside.data);
  Span<uint16_t> along_x = executor.template allocate<uint16_t>(bricks.count);
  Span<BrickSide> sides = executor.template allocate<BrickSide>(bricks.count);
  const GridField field{atoms, bricks, outside.data, parameters, along_x.data, sides.data};
  const uint64_t bricks_in_reach = static_cast<uint64_t>(field.bricks_in_reach()), rows = 2 * bricks_in_reach + 1;
  executor.for_each(bricks.count, FindOutsideAlongX{field, along_x.data}, kPlainSteps + 8 * bricks_in_reach);
  constexpr uint64_t kRowSteps = 4;
  const uint64_t most = Executor::kIsCuda ? kThreadSteps / (2 * kRowSteps) : rows * rows;
  for (uint64_t row = 0; row < rows * rows; row += most)
    executor.for_each(bricks.count,
                      FindBrickSides{field, sides.data, {static_cast<int64_t>(row), static_cast<int64_t>(row + most)}},
                      kPlainSteps + kRowSteps * std::min(most, rows * rows));
  return field;
}

// ---- signs -----------------------------------------------------------------------------------------------------

struct IsUndecided {
  GridField field;
  QSES_FN bool operator()(uint32_t brick) const { return field.sides[brick] == BrickSide::kUndecided; }
};

// The signs of a brick, by distances of any reach, or by rows of few words.
struct EvaluateGridSigns {
  GridField field;
  uint32_t first;
  uint64_t *signs;
  int32_t *saved;  // distances, or nullptr

  template <class Team>
  QSES_HOST_DEVICE void operator()(const Team &team, DistanceScratch<kBrickEdge> &scratch, size_t i) const {
    const uint32_t brick = first + static_cast<uint32_t>(i);
    if (is_open(brick))
      bring_distances<kBrickEdge>(field, brick, team, scratch, field.parameters.max_outside,
                                  saved ? saved + i * kBrickPoints : nullptr);
    write_signs(team, brick, [&](int y, int z) {
      uint32_t row = 0;
      for (int x = 0; x < kBrickEdge; ++x) {
        const int32_t d2 = scratch.nearest[x + kBrickEdge * (y + kBrickEdge * z)];
        row |= static_cast<uint32_t>(grid_is_inside(field.parameters, d2)) << x;
      }
      return row;
    });
  }
  template <class Team>
  QSES_HOST_DEVICE void operator()(const Team &team, NearRows &scratch, size_t i) const {
    const uint32_t brick = first + static_cast<uint32_t>(i);
    if (is_open(brick)) {
      const NearCube cube{kBrickEdge, field.parameters.reach};
      find_near_rows(field, brick, cube, team, scratch);
      for (int row = team.rank(); row < kBrickEdge * kBrickEdge; row += team.size())
        scratch.inside[row] =
            inside_of_row(scratch, cube, field.parameters.max_outside, row % kBrickEdge, row / kBrickEdge);
      team.sync();
    }
    write_signs(team, brick, [&](int y, int z) { return scratch.inside[y + kBrickEdge * z]; });
  }

 private:
  QSES_FN bool is_open(uint32_t brick) const {
    if (field.sides[brick] != BrickSide::kUndecided) return false;
    uint64_t all = ~uint64_t(0);
    for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf)
      all &= field.outside[static_cast<size_t>(brick) * kLeavesPerBrick + static_cast<size_t>(leaf)];
    return all != ~uint64_t(0);
  }
  // row_at(y, z): the points inside of a row, as bits, of a brick that is open.
  template <class Team, class RowAt>
  QSES_HOST_DEVICE void write_signs(const Team &team, uint32_t brick, const RowAt &row_at) const {
    const bool open = is_open(brick);
    for (int leaf = team.rank(); leaf < kLeavesPerBrick; leaf += team.size()) {
      uint64_t word = field.sides[brick] == BrickSide::kInside ? ~uint64_t(0) : 0;
      for (int k = 0; k < kLeafEdge * kLeafEdge && open; ++k) {
        const glm::ivec3 p = brick_point(leaf, kLeafEdge * k);
        word |= static_cast<uint64_t>(row_at(p.y, p.z) >> p.x & 15) << (kLeafEdge * k);
      }
      signs[static_cast<size_t>(brick) * kLeavesPerBrick + static_cast<size_t>(leaf)] = word;
    }
    team.sync();
  }
};

// signs[8 * brick + leaf] for the bricks of the slice.
template <class Executor>
void evaluate_grid_signs(Executor &executor, const GridField &field, BrickRange range, uint64_t *signs) {
  if (has_near_rows(field))
    return executor.template for_each_brick<NearRows>(
        range.size(), EvaluateGridSigns{field, range.first, signs, nullptr}, 8,
        kPlainTeamSteps + 2 * NearCube{kBrickEdge, field.parameters.reach}.rows_of_point());
  with_distances<kBrickEdge>(executor, field, range, field.parameters.max_outside, IsUndecided{field},
                             [&](BrickRange some, int32_t *saved, uint64_t steps) {
                               executor.template for_each_brick<DistanceScratch<kBrickEdge>>(
                                   some.size(), EvaluateGridSigns{field, some.first, signs, saved}, 8,
                                   kPlainTeamSteps + steps);
                             });
}

// ---- vertices --------------------------------------------------------------------------------------------------

struct OwnsVertices {
  const BrickTotals *base;
  QSES_FN bool operator()(uint32_t brick) const { return base[brick].vertices != base[brick + 1].vertices; }
};

// Vertices where they belong, in the centred frame, until owners are found.
struct EmitGridVertices {
  static constexpr int kCorners = kBrickEdge + 1;
  GridField field;
  MeshLayout layout;
  uint32_t first;
  MeshView mesh;
  int32_t *saved;  // distances, or nullptr

  // The inner end of an edge that changes sign is one step farther off at most.
  QSES_FN static int32_t limit(const GridParameters &g) { return g.max_outside + 2 * (g.reach + 1) + 1; }

  template <class Team>
  QSES_HOST_DEVICE void operator()(const Team &team, DistanceScratch<kCorners> &scratch, size_t i) const {
    const uint32_t brick = first + static_cast<uint32_t>(i);
    if (!OwnsVertices{layout.base}(brick)) return;
    bring_distances<kCorners>(field, brick, team, scratch, limit(field.parameters),
                              saved ? saved + i * (kCorners * kCorners * kCorners) : nullptr);
    write_vertices(team, brick,
                   [&](const glm::ivec3 &p, bool) { return scratch.nearest[p.x + kCorners * (p.y + kCorners * p.z)]; });
  }
  template <class Team>
  QSES_HOST_DEVICE void operator()(const Team &team, NearRows &scratch, size_t i) const {
    const uint32_t brick = first + static_cast<uint32_t>(i);
    if (!OwnsVertices{layout.base}(brick)) return;
    const NearCube cube{kCorners, field.parameters.reach};
    find_near_rows(field, brick, cube, team, scratch);
    write_vertices(team, brick, [&](const glm::ivec3 &p, bool inside) {
      return nearest_outside(scratch, cube, p, inside ? limit(field.parameters) : field.parameters.max_outside);
    });
  }

 private:
  // distance_at(p, inside): squared, of a point of the brick or next to it.
  template <class Team, class DistanceAt>
  QSES_HOST_DEVICE void write_vertices(const Team &team, uint32_t brick, const DistanceAt &distance_at) const {
    const Lattice &lattice = field.bricks.lattice;
    const glm::ivec3 origin = lattice.first_point(field.bricks.place(brick));
    const uint32_t end = layout.base[brick + 1].vertices;
    for (uint32_t vertex = layout.base[brick].vertices + static_cast<uint32_t>(team.rank()); vertex < end;
         vertex += static_cast<uint32_t>(team.size())) {
      const LatticeEdge edge = edge_of_vertex(layout, brick, vertex);
      const glm::ivec3 at = brick_point(edge.leaf, edge.bit);
      const glm::ivec3 step(edge.axis == 0, edge.axis == 1, edge.axis == 2);
      const bool inside =
          (layout.signs[size_t(brick) * kLeavesPerBrick + static_cast<size_t>(edge.leaf)] >> edge.bit & 1) != 0;
      const float low = grid_value(field.parameters, distance_at(at, inside));
      const float high = grid_value(field.parameters, distance_at(at + step, !inside));
      Vec3<float> p = lattice.position(origin.x + at.x, origin.y + at.y, origin.z + at.z);
      const float along = lattice.spacing * (low / (low - high));
      (edge.axis == 0 ? p.x : edge.axis == 1 ? p.y : p.z) += along;
      store_vec3(mesh.position(vertex), p);
    }
    team.sync();
  }
};

// Vertices of the bricks of the slice, by linear interpolation. Owners and normals are missing yet.
template <class Executor>
void emit_grid_vertices(Executor &executor, const GridField &field, const MeshLayout &layout, BrickRange range,
                        const MeshView &mesh) {
  constexpr int kCorners = EmitGridVertices::kCorners;
  if (has_near_rows(field)) {  // a thread looks for both ends of so many edges at most
    constexpr uint64_t kEdges = kAxes * kBrickPoints / 128;
    return executor.template for_each_brick<NearRows>(
        range.size(), EmitGridVertices{field, layout, range.first, mesh, nullptr}, 8,
        kPlainTeamSteps + 2 * kEdges * NearCube{kCorners, field.parameters.reach}.rows_of_point());
  }
  with_distances<kCorners>(executor, field, range, EmitGridVertices::limit(field.parameters), OwnsVertices{layout.base},
                           [&](BrickRange some, int32_t *saved, uint64_t steps) {
                             executor.template for_each_brick<DistanceScratch<kCorners>>(
                                 some.size(), EmitGridVertices{field, layout, some.first, mesh, saved}, 8,
                                 kPlainTeamSteps + steps);
                           });
}

}  // namespace quickses
