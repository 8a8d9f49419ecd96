// SPDX-License-Identifier: MIT
// The voxel method of QuickSES (Martinez, Krone, Baaden 2019), kept as the published baseline: lattice points are
// classified as outside, border or inside (section 2.2), the distance to the nearest outside point is refined (2.3),
// and marching cubes interpolates it (2.4). Here on sparse bricks, and refined at every point.
#pragma once

#include "parallel/atomics.h"
#include "surface/methods/grid_distance.h"

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

// ---- bricks ----------------------------------------------------------------------------------------------------

// Bricks that hold a lattice point of an inflated ball, grown by one spacing: the field is positive everywhere else.
struct BallBricks {
  NeighborGridView atoms;
  Lattice lattice;
  QSES_FN size_t size() const { return atoms.count; }
  template <class Visit>
  QSES_FN void visit(size_t i, const Visit &visit_brick) const {
    const Sphere atom = atoms.items[i];
    visit_bricks_of_shell(lattice, atom.center, 0.f, atom.radius, visit_brick);
  }
  QSES_FN double fewest(size_t i) const {
    const float radius = atoms.items[i].radius;
    return atoms.items[i].center.x >= 0.5f * kFarAway ? 0.0 : fewest_bricks_of_ball(lattice, radius);
  }
};

template <class Executor>
BrickSet find_grid_bricks(Executor &executor, const NeighborGridView &atoms, const GridParameters &parameters,
                          const Lattice &lattice, uint64_t *listed = nullptr) {
  const double reach = static_cast<double>(parameters.max_radius) / static_cast<double>(lattice.brick_size());
  if (atoms.count > 0 && 4.0 / 3.0 * 3.14159265358979 * reach * reach * reach > static_cast<double>(kMaxBricks))
    throw Error(QSES_TOO_FINE,
                "the largest inflated atom alone needs more bricks of the SES grid than 32-bit numbers can name: use a "
                "larger spacing");
  return collect_bricks(executor, BallBricks{atoms, lattice}, lattice, listed);
}

// ---- classes ---------------------------------------------------------------------------------------------------

// The paper's text has the conditions of "inside" and "border" the other way round; its sentences about them agree with
// these. (Its program starts "inside" one spacing deeper, which changes no vertex.)
enum class GridClass : uint8_t {
  kOutside,  // in no inflated ball: the probe's centre may be here
  kBorder,   // in an inflated ball, but in no atom
  kInside    // within the van der Waals radius of an atom
};

struct ClassifyScratch {
  static constexpr int kListed = 128, kBlock = 64;
  Sphere listed[kListed];
  uint32_t count;
  float beyond_ball[kBrickPoints];  // smallest |x - c|² - R², x fastest; >= 0 outside
  float beyond_atom[kBrickPoints];  // smallest |x - c|² - r²
};

// Writes the outside bits of a brick and, if asked for, its inside bits.
struct ClassifyBrick {
  NeighborGridView atoms;
  BrickSet bricks;
  GridParameters parameters;
  uint64_t *outside;  // [brick][leaf]
  uint64_t *inside;   // [brick][leaf], or nullptr

  template <class Team>
  QSES_HOST_DEVICE void operator()(const Team &team, ClassifyScratch &scratch, size_t brick) const {
    const Lattice &lattice = bricks.lattice;
    const glm::ivec3 first = lattice.first_point(lattice.brick_at(bricks.linear[brick]));
    const Vec3<float> low = lattice.position(first.x, first.y, first.z);
    const Vec3<float> high = lattice.position(first.x + 7, first.y + 7, first.z + 7);
    const float slack = 1e-4f + 1e-3f * lattice.spacing, reach = parameters.max_radius + slack;
    const Vec3<float> margin(reach, reach, reach);
    const CellBox box = cells_around(atoms.cells, low - margin, high + margin);
    for (int i = team.rank(); i < kBrickPoints; i += team.size())
      scratch.beyond_ball[i] = scratch.beyond_atom[i] = kFarAway;
    if (team.rank() == 0) scratch.count = 0;
    team.sync();
    for (int z = box.z0; z <= box.z1; ++z)
      for (int y = box.y0; y <= box.y1; ++y) {
        const ItemRun run = atoms.run(box.x0, box.x1, y, z);
        for (uint32_t begin = run.begin; begin < run.end; begin += ClassifyScratch::kBlock) {
          const uint32_t end = run.end - begin < ClassifyScratch::kBlock ? run.end : begin + ClassifyScratch::kBlock;
          list(team, scratch, begin, end, low, high, slack);
          team.sync();
          const uint32_t count = scratch.count;
          team.sync();
          if (count > ClassifyScratch::kListed - ClassifyScratch::kBlock) apply(team, scratch, count, first);
        }
      }
    apply(team, scratch, scratch.count, first);
    for (int leaf = team.rank(); leaf < kLeavesPerBrick; leaf += team.size()) {
      uint64_t out = 0, in = 0;
      for (int bit = 0; bit < 64; ++bit) {
        const int i = point_of(leaf, bit);
        out |= static_cast<uint64_t>(scratch.beyond_ball[i] < 0.f ? 0 : 1) << bit;
        in |= static_cast<uint64_t>(scratch.beyond_atom[i] < 0.f ? 1 : 0) << bit;
      }
      outside[brick * kLeavesPerBrick + static_cast<size_t>(leaf)] = out;
      if (inside) inside[brick * kLeavesPerBrick + static_cast<size_t>(leaf)] = in;
    }
    team.sync();
  }

 private:
  QSES_FN static int point_of(int leaf, int bit) {
    const int x = (leaf & 1) * kLeafEdge + (bit & 3), y = (leaf >> 1 & 1) * kLeafEdge + (bit >> 2 & 3);
    return x + kBrickEdge * (y + kBrickEdge * ((leaf >> 2) * kLeafEdge + (bit >> 4)));
  }

  // Lists the atoms begin ... end - 1 whose balls touch the box of the brick's lattice points. In any order: the minima
  // below do not depend on it.
  template <class Team>
  QSES_HOST_DEVICE void list(const Team &team, ClassifyScratch &scratch, uint32_t begin, uint32_t end,
                             const Vec3<float> &low, const Vec3<float> &high, float slack) const {
    for (uint32_t k = begin + static_cast<uint32_t>(team.rank()); k < end; k += static_cast<uint32_t>(team.size())) {
      const Sphere s = atoms.items[k];
      const float dx = maximum(0.f, maximum(low.x - s.center.x, s.center.x - high.x));
      const float dy = maximum(0.f, maximum(low.y - s.center.y, s.center.y - high.y));
      const float dz = maximum(0.f, maximum(low.z - s.center.z, s.center.z - high.z));
      const float r = s.radius + slack;
      if (dx * dx + dy * dy + dz * dz <= r * r) scratch.listed[atomic_add(&scratch.count, uint32_t(1))] = s;
    }
  }

  // Takes the listed atoms into account and empties the list.
  template <class Team>
  QSES_HOST_DEVICE void apply(const Team &team, ClassifyScratch &scratch, uint32_t count,
                              const glm::ivec3 &first) const {
    const float h = bricks.lattice.spacing;
    const RowShare share = row_share<kBrickEdge>(team);
    for (int row = share.first_row; row < kBrickEdge * kBrickEdge; row += share.row_step) {
      const float py = static_cast<float>(first.y + row % kBrickEdge) * h;
      const float pz = static_cast<float>(first.z + row / kBrickEdge) * h;
      float *ball = scratch.beyond_ball + row * kBrickEdge, *atom = scratch.beyond_atom + row * kBrickEdge;
      for (uint32_t k = 0; k < count; ++k) {
        const Sphere s = scratch.listed[k];
        const float dy = py - s.center.y, dz = pz - s.center.z, across2 = dy * dy + dz * dz;
        const float r = maximum(0.f, s.radius - parameters.probe), ball2 = s.radius * s.radius, atom2 = r * r;
        if (across2 >= ball2) continue;
        for (int x = share.first_x; x < kBrickEdge; x += share.x_step) {
          const float dx = static_cast<float>(first.x + x) * h - s.center.x, d2 = dx * dx + across2;
          ball[x] = minimum(ball[x], d2 - ball2);
          atom[x] = minimum(atom[x], d2 - atom2);
        }
      }
    }
    team.sync();
    if (team.rank() == 0) scratch.count = 0;
    team.sync();
  }
};

// The classes of all bricks, which stay allocated. bricks and atoms must outlive the field.
template <class Executor>
GridField classify_grid_points(Executor &executor, const NeighborGridView &atoms, const GridParameters &parameters,
                               const BrickSet &bricks) {
  Span<uint64_t> outside = executor.template allocate<uint64_t>(size_t(bricks.count) * kLeavesPerBrick);
  executor.template for_each_brick<ClassifyScratch>(bricks.count,
                                                    ClassifyBrick{atoms, bricks, parameters, outside.data, nullptr});
  Span<uint16_t> along_x = executor.template allocate<uint16_t>(bricks.count);
  Span<BrickSide> sides = executor.template allocate<BrickSide>(bricks.count);
  const GridField field{atoms, bricks, outside.data, parameters, along_x.data, sides.data};
  executor.for_each(bricks.count, FindOutsideAlongX{field, along_x.data});
  executor.for_each(bricks.count, FindBrickSides{field, sides.data});
  return field;
}

// ---- signs -----------------------------------------------------------------------------------------------------

struct EvaluateGridSigns {
  GridField field;
  uint32_t first;
  uint64_t *signs;
  template <class Team>
  QSES_HOST_DEVICE void operator()(const Team &team, DistanceScratch<kBrickEdge> &scratch, size_t i) const {
    const uint32_t brick = first + static_cast<uint32_t>(i);
    uint64_t *words = signs + static_cast<size_t>(brick) * kLeavesPerBrick;
    const BrickSide side = field.sides[brick];
    const bool open = side == BrickSide::kUndecided && !is_all_outside(brick);
    if (open) find_distances<kBrickEdge>(field, brick, team, scratch, field.parameters.max_outside);
    for (int leaf = team.rank(); leaf < kLeavesPerBrick; leaf += team.size()) {
      uint64_t word = side == BrickSide::kInside ? ~uint64_t(0) : 0;
      for (int bit = 0; bit < 64 && open; ++bit) {
        const int x = (leaf & 1) * kLeafEdge + (bit & 3), y = (leaf >> 1 & 1) * kLeafEdge + (bit >> 2 & 3);
        const int z = (leaf >> 2) * kLeafEdge + (bit >> 4);
        const int32_t d2 = scratch.nearest[x + kBrickEdge * (y + kBrickEdge * z)];
        word |= static_cast<uint64_t>(grid_is_inside(field.parameters, d2) ? 1 : 0) << bit;
      }
      words[leaf] = word;
    }
    team.sync();
  }

 private:
  QSES_FN bool is_all_outside(uint32_t brick) const {
    uint64_t all = ~uint64_t(0);
    for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf)
      all &= field.outside[static_cast<size_t>(brick) * kLeavesPerBrick + static_cast<size_t>(leaf)];
    return all == ~uint64_t(0);
  }
};

// signs[8 * brick + leaf] for the bricks of the slice.
template <class Executor>
void evaluate_grid_signs(Executor &executor, const GridField &field, BrickRange range, uint64_t *signs) {
  executor.template for_each_brick<DistanceScratch<kBrickEdge>>(range.size(),
                                                                EvaluateGridSigns{field, range.first, signs});
}

// ---- vertices --------------------------------------------------------------------------------------------------

// Place in the grid of the atom whose van der Waals surface is nearest, among those whose inflated surface is at most
// `margin` away; of several, the one with the smallest number.
QSES_FN uint32_t nearest_grid_atom(const GridField &f, const Vec3<float> &x, float margin) {
  const float reach = f.parameters.max_radius + margin;
  const Vec3<float> r(reach, reach, reach);
  const CellBox box = cells_around(f.atoms.cells, x - r, x + r);
  uint32_t best = 0;
  float depth = -2.f * kFarAway;
  for (int z = box.z0; z <= box.z1; ++z)
    for (int y = box.y0; y <= box.y1; ++y) {
      const ItemRun run = f.atoms.run(box.x0, box.x1, y, z);
      for (uint32_t k = run.begin; k < run.end; ++k) {
        const float d = ball_depth(f.atoms.items[k], x);
        if (d > depth || (d == depth && f.atoms.order[k] < f.atoms.order[best])) {
          depth = d;
          best = k;
        }
      }
    }
  return best;
}

struct EmitGridVertices {
  static constexpr int kCorners = kBrickEdge + 1;
  GridField field;
  MeshLayout layout;
  uint32_t first;
  MeshView mesh;

  template <class Team>
  QSES_HOST_DEVICE void operator()(const Team &team, DistanceScratch<kCorners> &scratch, size_t i) const {
    const uint32_t brick = first + static_cast<uint32_t>(i);
    if (layout.vertex_base[brick] == layout.vertex_base[brick + 1]) return;
    // The inner end of an edge that changes sign is one step farther off at most.
    const int32_t limit = field.parameters.max_outside + 2 * (field.parameters.reach + 1) + 1;
    find_distances<kCorners>(field, brick, team, scratch, limit);
    const Lattice &lattice = field.bricks.lattice;
    const glm::ivec3 origin = lattice.first_point(lattice.brick_at(field.bricks.linear[brick]));
    for (int k = team.rank(); k < kAxes * kBrickPoints; k += team.size()) {
      const int axis = k / kBrickPoints, leaf = k / 64 % kLeavesPerBrick, bit = k % 64;
      const size_t word = (static_cast<size_t>(brick) * kLeavesPerBrick + static_cast<size_t>(leaf)) * kAxes +
                          static_cast<size_t>(axis);
      if (!(layout.crossing[word] >> bit & 1)) continue;
      const int x = (leaf & 1) * kLeafEdge + (bit & 3), y = (leaf >> 1 & 1) * kLeafEdge + (bit >> 2 & 3);
      const int z = (leaf >> 2) * kLeafEdge + (bit >> 4);
      const int corner = x + kCorners * (y + kCorners * z);
      const int step = axis == 0 ? 1 : axis == 1 ? kCorners : kCorners * kCorners;
      const float low = grid_value(field.parameters, scratch.nearest[corner]);
      const float high = grid_value(field.parameters, scratch.nearest[corner + step]);
      Vec3<float> p = lattice.position(origin.x + x, origin.y + y, origin.z + z);
      const float along = lattice.spacing * (low / (low - high));
      (axis == 0 ? p.x : axis == 1 ? p.y : p.z) += along;
      write_vertex(vertex_number(layout, static_cast<int>(brick), leaf, axis, bit), p);
    }
    team.sync();
  }

 private:
  QSES_FN void write_vertex(uint32_t vertex, const Vec3<float> &p) const {
    const glm::vec3 position = field.bricks.lattice.to_caller(p);
    // The inner end of the edge is in an inflated ball, and at most a spacing away.
    const uint32_t atom = nearest_grid_atom(field, p, 1.01f * field.parameters.spacing + 1e-4f);
    const Vec3<float> normal = sphere_normal(field.atoms.items[atom], p);
    store_vec3(mesh.position(vertex), Vec3<float>(position));
    store_vec3(mesh.normal(vertex), normal);
    mesh.owner(vertex) = field.atoms.order[atom];
  }
};

// Vertices of the bricks of the slice, by linear interpolation, with their owners. The normals written are those of the
// owners' spheres: compute_normals (relaxation.h) replaces them where the triangles define one.
template <class Executor>
void emit_grid_vertices(Executor &executor, const GridField &field, const MeshLayout &layout, BrickRange range,
                        const MeshView &mesh) {
  executor.template for_each_brick<DistanceScratch<EmitGridVertices::kCorners>>(
      range.size(), EmitGridVertices{field, layout, range.first, mesh});
}

}  // namespace quickses
