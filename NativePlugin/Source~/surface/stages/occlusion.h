// SPDX-License-Identifier: MIT
// Ambient occlusion: how much of an even sky a vertex sees, if what is beyond 20 Å does not count. Balls about the
// atoms, or what a Gaussian surface encloses, fill a lattice of 1 Å. From nodes 2 Å apart around them, rays look in 48
// directions which of them are free. A node keeps two moments of that, from which follows the light on a plane with any
// normal (the first two orders of the cosine lobe's spherical harmonics: Ramamoorthi and Hanrahan 2001); vertices take
// it from the eight nodes around them.
#pragma once

#include "parallel/atomics.h"
#include "surface/mesh/mesh_view.h"
#include "surface/stages/ball_points.h"
#include "surface/stages/hot_stages.h"
#include "surface/stages/sky_directions.h"

namespace quickses {

constexpr int kNodeEdge = 4;  // nodes along a brick: every other point
constexpr int kBrickNodes = kNodeEdge * kNodeEdge * kNodeEdge;

// The balls are larger than the atoms, since between atoms the surface lies above them.
constexpr float kFilledGap = 0.2f;
// Vertices look from so far above the surface, beyond the steps of the lattice.
constexpr float kLookout = 1.f;
// All nodes around a lookout are within so many points of a ball of the neighbour grid, along each axis.
constexpr float kNodeReach = 3.f;

struct OpennessField {
  BrickSet bricks;
  // [brick][word]: bits of the points in no ball. A word has every other point along each axis, so that the nodes are
  // the points of word 0: word x & 1, ..., and bit x >> 1, ... of the point, counted from the brick's first.
  uint64_t *outside;
  Openness *nodes;  // [brick][node]
  int32_t *behind;  // [brick][k]: the next brick along the axes of k's bits; -1: there is none

  QSES_FN int find(const glm::ivec3 &brick) const { return bricks.find(brick - bricks.lattice.first_brick); }
};

// Takes the points of balls out of those outside: a thread, or several, for each of the planes that may cut one.
struct FillBalls {
  Balls balls;
  OpennessField field;
  uint32_t first;  // item of the grid
  int planes, shares;

  QSES_HOST_DEVICE void operator()(size_t i) const {
    const int share = static_cast<int>(i % static_cast<size_t>(shares));
    i /= static_cast<size_t>(shares);
    const size_t count = static_cast<size_t>(planes);
    const Sphere atom = balls.atoms.items[first + i / count];
    const float r = balls.radius(atom.radius) / kOcclusionPoint;
    if (is_removed(atom) || r <= 0.f) return;
    const Vec3<float> c = Vec3<float>(atom.center) * (1.f / kOcclusionPoint);
    const int z = static_cast<int>(ceilf(c.z - r)) + static_cast<int>(i % count);
    const float dz = static_cast<float>(z) - c.z, rest = r * r - dz * dz;
    if (rest <= 0.f) return;
    for (int y = static_cast<int>(ceilf(c.y - r)) + share; static_cast<float>(y) <= c.y + r; y += shares) {
      const float dy = static_cast<float>(y) - c.y;
      for (int x = static_cast<int>(ceilf(c.x - r)); static_cast<float>(x) <= c.x + r; ++x) {
        const float dx = static_cast<float>(x) - c.x;
        if (dx * dx + dy * dy < rest) fill(x, y, z);
      }
    }
  }

 private:
  QSES_FN void fill(int x, int y, int z) const {
    const int brick = field.find(glm::ivec3(x >> 3, y >> 3, z >> 3));
    if (brick < 0) return;  // none: the bricks hold all balls
    const int word = (x & 1) | (y & 1) << 1 | (z & 1) << 2;
    const uint64_t bit = uint64_t(1) << leaf_bit(x >> 1 & 3, y >> 1 & 3, z >> 1 & 3);
    atomic_and(field.outside + static_cast<size_t>(brick) * kLeavesPerBrick + static_cast<size_t>(word), ~bit);
  }
};

// A place among the nodes along one axis: the node before it, and how far behind.
struct NodeStep {
  int node;
  float along;
  QSES_FN explicit NodeStep(float place) {
    const float p = place * (0.5f / kOcclusionPoint);
    node = static_cast<int>(p);
    node -= p < static_cast<float>(node) ? 1 : 0;
    along = p - static_cast<float>(node);
  }
  QSES_FN int brick() const { return node >> 2; }
  // Of the node itself and the next: where in its brick it is, and what it weighs.
  QSES_FN int in_brick(int next) const { return (node + next) & 3; }
  QSES_FN float weight(int next) const { return next ? along : 1.f - along; }
};

// The cell between eight nodes that a vertex looks from.
struct Lookout {
  NodeStep x, y, z;
  QSES_FN explicit Lookout(const Vec3<float> &p) : x(p.x), y(p.y), z(p.z) {}
  QSES_FN glm::ivec3 brick() const { return glm::ivec3(x.brick(), y.brick(), z.brick()); }
  // Along the axes of these bits, the nodes behind the cell are in another brick.
  QSES_FN int crossed() const {
    return (x.in_brick(1) == 0 ? 1 : 0) | (y.in_brick(1) == 0 ? 2 : 0) | (z.in_brick(1) == 0 ? 4 : 0);
  }
};

struct SkyScratch {
  uint64_t outside[SkyBricks::kCount][kLeavesPerBrick];
  uint64_t seen[kBrickNodes];  // by direction, the nodes from which it is free; on the CPU then by node
};

// Rays of all nodes of a brick at a time: a word is what a step meets.
struct OpenNodes {
  OpennessField field;
  SkyDirections sky;

  template <class Team>
  QSES_HOST_DEVICE void operator()(const Team &team, SkyScratch &scratch, size_t i) const {
    const glm::ivec3 place = field.bricks.place(i);
    for (int k = team.rank(); k < 8; k += team.size())
      field.behind[8 * i + static_cast<size_t>(k)] = field.bricks.find(place + glm::ivec3(k & 1, k >> 1 & 1, k >> 2));
    const uint64_t free_nodes = field.outside[i * kLeavesPerBrick];
    if (free_nodes != 0) look_around(team, scratch, place, free_nodes);
    for (int node = team.rank(); node < kBrickNodes; node += team.size())
      field.nodes[i * kBrickNodes + static_cast<size_t>(node)] =
          free_nodes >> node & 1 ? sum_up(scratch, node) : Openness{{0.f, 0.f, 0.f, kFilled}};
    team.sync();
  }

 private:
#if defined(__CUDA_ARCH__)
  template <class Team>
  QSES_HOST_DEVICE void look_around(const Team &team, SkyScratch &scratch, const glm::ivec3 &place,
                                    uint64_t free_nodes) const {
    for (int k = team.rank(); k < SkyBricks::kCount; k += team.size()) bring_points(scratch, place, k);
    team.sync();
    for (int d = team.rank(); d < SkyDirections::kCount; d += team.size()) {
      uint64_t seen = free_nodes;
      for_sky_steps(sky.direction[d], [&](const SkyStep &step) { return (seen &= outside_at(scratch, step)) != 0; });
      scratch.seen[d] = seen;
    }
    team.sync();
  }
  QSES_FN Openness sum_up(const SkyScratch &scratch, int node) const {
    Openness sum = {};
    for (int d = 0; d < SkyDirections::kCount; ++d) {
      const float seen = scratch.seen[d] >> node & 1 ? 1.f : 0.f;
      for (int axis = 0; axis < kAxes; ++axis) sum.value[axis] += seen * sky.direction[d][axis];
      sum.value[3] += seen;
    }
    return mean_of(sum);
  }
#else
  template <class Team>
  QSES_HOST_DEVICE void look_around(const Team &, SkyScratch &scratch, const glm::ivec3 &place,
                                    uint64_t free_nodes) const {
    const SkyTable &table = SkyTable::get();
    for (int k = 0; k < table.brick_count; ++k) bring_points(scratch, place, table.bricks[k]);
    for (int d = 0; d < kBrickNodes; ++d) {
      uint64_t seen = d < SkyDirections::kCount ? free_nodes : 0;
      for (int k = 0; k < table.step_count && seen; ++k) seen &= outside_at(scratch, table.steps[d][k]);
      scratch.seen[d] = seen;
    }
    transpose_bits(scratch.seen);
  }
  QSES_FN Openness sum_up(const SkyScratch &scratch, int node) const {
    const SkyTable &table = SkyTable::get();
    OpennessSum sum;
    uint64_t seen = scratch.seen[node];
    for (const Openness(&of_four)[1 << SkyTable::kFour] : table.sums) {
      sum.add(of_four[seen & ((1 << SkyTable::kFour) - 1)]);
      seen >>= SkyTable::kFour;
    }
    return mean_of(sum.total());
  }
#endif

  QSES_FN static Openness mean_of(const Openness &sum) {
    constexpr float kPart = 1.f / static_cast<float>(SkyDirections::kCount);
    return {{2.f * kPart * sum.value[0], 2.f * kPart * sum.value[1], 2.f * kPart * sum.value[2], kPart * sum.part()}};
  }

  // Those of a brick around the one at place.
  QSES_FN void bring_points(SkyScratch &scratch, const glm::ivec3 &place, int k) const {
    const int brick = field.bricks.find(place + SkyBricks::step(k));
    for (int word = 0; word < kLeavesPerBrick; ++word)
      scratch.outside[k][word] =
          brick < 0 ? ~uint64_t(0) : field.outside[static_cast<size_t>(brick) * kLeavesPerBrick + size_t(word)];
  }

  // The outside bits of the points a step from each of the brick's nodes.
  QSES_FN static uint64_t outside_at(const SkyScratch &scratch, const SkyStep &step) {
    constexpr int kEdge = SkyBricks::kEdge;
    const int word = step.word, rx = step.x, ry = step.y, rz = step.z;
    const auto along_x = [&](int k) {
#if !defined(__CUDA_ARCH__)
      if (rx == 0) return scratch.outside[k][word];  // a GPU's threads have different ways to go
#endif
      return (scratch.outside[k][word] >> rx & step.stays_x) |
             (scratch.outside[k + 1][word] << (4 - rx) & ~step.stays_x);
    };
    const auto along_y = [&](int k) {
#if !defined(__CUDA_ARCH__)
      if (ry == 0) return along_x(k);
#endif
      return (along_x(k) >> 4 * ry & step.stays_y) | (along_x(k + kEdge) << (16 - 4 * ry) & ~step.stays_y);
    };
#if !defined(__CUDA_ARCH__)
    if (rz == 0) return along_y(step.brick);
#endif
    return along_y(step.brick) >> 16 * rz | along_y(step.brick + kEdge * kEdge) << 1 << (63 - 16 * rz);
  }
};

struct LightVertices {
  OpennessField field;
  MeshView mesh;
  bool marks;  // whether the second texture coordinate becomes 1
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint32_t vertex = mesh.first_vertex + static_cast<uint32_t>(i);
    const float *const n = mesh.normal(vertex);
    const Vec3<float> x = field.bricks.lattice.from_caller(mesh.position(vertex));
    const Lookout at(x + load_vec3(n) * kLookout);
    const int brick = field.find(at.brick());
    const float light = brick < 0 ? 0.f : open_to(n, at, field.behind + 8 * static_cast<size_t>(brick));
    float *const texcoord = mesh.texcoord(vertex);
    texcoord[0] = minimum(1.f, maximum(0.f, light));
    if (marks) texcoord[1] = 1.f;
  }

 private:
  // bricks: of the first node's and those behind it.
  QSES_FN float open_to(const float *n, const Lookout &at, const int32_t *bricks) const {
    const int crossed = at.crossed();
    OpennessSum sum;
    for (int z = 0; z < 2; ++z)
      for (int y = 0; y < 2; ++y) {
        const float across = at.y.weight(y) * at.z.weight(z);
        const int row = leaf_bit(0, at.y.in_brick(y), at.z.in_brick(z));
        for (int x = 0; x < 2; ++x) {
          const int brick = bricks[(x + 2 * y + 4 * z) & crossed];
          if (brick < 0) continue;
          // None is 0, so that a single node that is free tells.
          sum.add(1e-4f + across * at.x.weight(x),
                  field.nodes[static_cast<size_t>(brick) * kBrickNodes + static_cast<size_t>(row + at.x.in_brick(x))]);
        }
      }
    const Openness o = sum.total();
    return sum.weight() > 0.f ? (o.value[0] * n[0] + o.value[1] * n[1] + o.value[2] * n[2] + o.part()) / sum.weight()
                              : 0.f;
  }
};

// Bricks for that, of 8 Å, are where the atoms are.
struct OcclusionBricks : BallBricks {};
inline ExpectedBricks expected_bricks(const WorkFacts &facts, const OcclusionBricks &items) {
  if (facts.occlusion_bricks > 0) return {facts.occlusion_bricks, 0, 0};
  // Atoms overlap: folded molecules have some quarter of a brick for one, single ones up to 27. Balls that are larger
  // than atoms, as those of coarse-grained models, may each need all of their own.
  constexpr double kAtom = 4;  // Å, of the inflated ball
  const auto bricks_of_ball = [&](double radius) {
    const double across =
        (radius + static_cast<double>(kNodeReach * kOcclusionPoint)) / static_cast<double>(items.lattice.brick_size()) +
        0.9;
    return 4.19 * across * across * across;
  };
  const double of_one =
      0.5 + bricks_of_ball(std::max(kAtom, static_cast<double>(items.max_radius))) - bricks_of_ball(kAtom);
  const double all = 1024 + of_one * items.atoms.count;
  return {
      all < static_cast<double>(items.lattice.table_size()) ? static_cast<uint64_t>(all) : items.lattice.table_size(),
      0, 0};
}

// A GPU looks from so many bricks at a time: where the box has no more, to find out which are needed takes longer than
// to work on the others as well.
constexpr uint64_t kBricksAtATime = 2048;

// frame, low, high: the centred frame's origin is that of frame; bounds of the atoms' centres in it.
template <class Executor>
BrickSet find_occlusion_bricks(Executor &executor, const NeighborGridView &atoms, float max_radius,
                               const Lattice &frame, const glm::vec3 &low, const glm::vec3 &high) {
  Lattice lattice = frame;
  lattice.spacing = kOcclusionPoint;
  lattice = layout_lattice(lattice, low, high, max_radius + kNodeReach * kOcclusionPoint);
  if (Executor::kIsCuda && lattice.table_size() <= kBricksAtATime) return all_bricks(executor, lattice);
  return collect_bricks(executor, OcclusionBricks{{atoms, lattice, max_radius, kNodeReach}}, lattice,
                        "occlusion bricks");
}

// What fills a field: the atoms, somewhat enlarged.
struct FillWithAtoms {
  NeighborGridView atoms;
  SurfaceParameters parameters;
  template <class Executor>
  void operator()(Executor &executor, const OpennessField &field) const {
    executor.fill(Span<uint64_t>{field.outside, size_t(field.bricks.count) * kLeavesPerBrick}, 0xff);
    const Balls balls{atoms, parameters.max_radius, parameters.depth - kFilledGap};
    // All of a run have as many planes, so the few large ones are one by themselves.
    const auto fill = [&](const ItemRun &run, float largest, bool by_rows) {
      const int planes = static_cast<int>(2.f * balls.radius(largest) / kOcclusionPoint) + 1,
                shares = by_rows ? planes : 1;
      const uint64_t rows = static_cast<uint64_t>(planes / shares);
      executor.for_each(size_t(run.end - run.begin) * static_cast<size_t>(planes) * static_cast<size_t>(shares),
                        FillBalls{balls, field, run.begin, planes, shares},
                        kPlainSteps + rows * static_cast<uint64_t>(planes));
    };
    const ItemRun large = atoms.large_items();
    fill({0, large.begin}, atoms.cells.radii.in_cells, false);
    fill(large, balls.max_radius, true);
  }
};

// Or what is within the isovalue. Signs of its points are found leaf by leaf, where the field's words are then.
struct TurnSigns {
  uint64_t *words;
  QSES_HOST_DEVICE void operator()(size_t brick) const {
    uint64_t *const own = words + brick * kLeavesPerBrick, signs[kLeavesPerBrick];
    for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf) signs[leaf] = own[leaf];
    for (int word = 0; word < kLeavesPerBrick; ++word) {
      uint64_t outside = 0;
      for (int bit = 0; bit < 64; ++bit) {
        const int x = 2 * (bit & 3) + (word & 1), y = 2 * (bit >> 2 & 3) + (word >> 1 & 1),
                  z = 2 * (bit >> 4) + (word >> 2);
        outside |= (~signs[leaf_of(x, y, z)] >> leaf_bit(x & 3, y & 3, z & 3) & 1) << bit;
      }
      own[word] = outside;
    }
  }
};
struct FillWithDensity {
  GaussianDensity density;
  template <class Executor>
  void operator()(Executor &executor, const OpennessField &field) const {
    const auto at_once = [&](const auto &work_on) { work_on(BrickRange{0, field.bricks.count}); };
    if (field.bricks.count > 0)
      Backend<Executor>::evaluate_density(executor, density, field.bricks, at_once, field.outside);
    executor.for_each(field.bricks.count, TurnSigns{field.outside}, kPlainTeamSteps);
  }
};

// Writes how open the surface is at vertices, from 0 to 1, into the first of their texture coordinates. Positions and
// normals are finished. marks: see LightVertices.
template <class Executor, class Fill>
void find_openness(Executor &executor, const BrickSet &bricks, const Fill &fill, const MeshView &mesh, size_t vertices,
                   bool marks) {
  const auto mark = executor.arena().mark();
  const Span<uint64_t> outside = executor.template allocate<uint64_t>(size_t(bricks.count) * kLeavesPerBrick);
  const Span<Openness> nodes = executor.template allocate<Openness>(size_t(bricks.count) * kBrickNodes);
  const Span<int32_t> behind = executor.template allocate<int32_t>(size_t(bricks.count) * 8);
  const OpennessField field{bricks, outside.data, nodes.data, behind.data};
  fill(executor, field);
  executor.template for_each_brick<SkyScratch>(bricks.count, OpenNodes{field, SkyDirections()}, 8, kPlainTeamSteps);
  executor.for_each(vertices, LightVertices{field, mesh, marks});
  executor.arena().rewind(mark);
}

}  // namespace quickses
