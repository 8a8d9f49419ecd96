// SPDX-License-Identifier: MIT
// Ambient occlusion: how much of an even sky a vertex sees, if what is beyond 20 Å does not count. Balls about the
// atoms fill a lattice of 1 Å. From nodes 2 Å apart around them, rays look in 48 directions which of them are free. A
// node keeps two moments of that, from which follows the light on a plane with any normal (the first two orders of the
// cosine lobe's spherical harmonics: Ramamoorthi and Hanrahan 2001); vertices take it from the eight nodes around them.
#pragma once

#include "parallel/atomics.h"
#include "surface/mesh/mesh_view.h"
#include "surface/stages/ball_points.h"

namespace quickses {

constexpr float kOcclusionPoint = 1.f;  // Å between points of the lattice; its bricks have 8 of them along an edge
constexpr float kSkyDistance = 20.f;    // Å
constexpr int kNodeEdge = 4;            // nodes along a brick: every other point
constexpr int kBrickNodes = kNodeEdge * kNodeEdge * kNodeEdge;

// The balls are larger than the atoms, since between atoms the surface lies above them.
constexpr float kFilledGap = 0.2f;
// Vertices look from so far above the surface, beyond the steps of the lattice.
constexpr float kLookout = 1.f;
// All nodes around a lookout are within so many points of a ball of the neighbour grid, along each axis.
constexpr float kNodeReach = 3.f;

// Evenly spread over the sphere: a spiral with the golden angle.
struct SkyDirections {
  static constexpr int kCount = 48;
  float direction[kCount][kAxes];
  SkyDirections() {
    for (int k = 0; k < kCount; ++k) {
      const double z = 1 - (2 * k + 1) / static_cast<double>(kCount), across = std::sqrt(1 - z * z);
      const double angle = 2.399963229728653 * k;
      direction[k][0] = static_cast<float>(across * std::cos(angle));
      direction[k][1] = static_cast<float>(across * std::sin(angle));
      direction[k][2] = static_cast<float>(z);
    }
  }
};

// What a node knows: the part of the directions that are free, and twice their mean. The light on a plane is then
// part + dot(mean, normal).
struct alignas(16) Openness {
  float part, x, y, z;
};
// Within a ball.
constexpr float kFilled = -1.f;

struct OpennessField {
  BrickSet bricks;
  // [brick][word]: bits of the points in no ball. A word has every other point along each axis, so that the nodes are
  // the points of word 0: word x & 1, ..., and bit x >> 1, ... of the point, counted from the brick's first.
  uint64_t *outside;
  Openness *nodes;  // [brick][node]
  uint8_t *asked;   // [brick]: whether a vertex looks from there; nullptr: all are

  QSES_FN int find(const glm::ivec3 &brick) const { return bricks.find(brick - bricks.lattice.first_brick); }
};

// Takes the points of a ball out of those outside: a thread for each of the planes that may cut it.
struct FillBalls {
  Balls balls;
  OpennessField field;
  int planes;

  QSES_HOST_DEVICE void operator()(size_t i) const {
    const size_t count = static_cast<size_t>(planes);
    const Sphere atom = balls.atoms.items[i / count];
    const float r = balls.radius(atom.radius) / kOcclusionPoint;
    if (atom.center.x >= 0.5f * kFarAway || r <= 0.f) return;
    const Vec3<float> c = Vec3<float>(atom.center) * (1.f / kOcclusionPoint);
    const int z = static_cast<int>(ceilf(c.z - r)) + static_cast<int>(i % count);
    const float dz = static_cast<float>(z) - c.z, rest = r * r - dz * dz;
    if (rest <= 0.f) return;
    for (int y = static_cast<int>(ceilf(c.y - r)); static_cast<float>(y) <= c.y + r; ++y) {
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
  QSES_FN Lookout(const Lattice &lattice, const float *p, const float *n)
      : x(static_cast<float>(static_cast<double>(p[0]) - lattice.center_x) + kLookout * n[0]),
        y(static_cast<float>(static_cast<double>(p[1]) - lattice.center_y) + kLookout * n[1]),
        z(static_cast<float>(static_cast<double>(p[2]) - lattice.center_z) + kLookout * n[2]) {}
  QSES_FN glm::ivec3 brick() const { return glm::ivec3(x.brick(), y.brick(), z.brick()); }
  // Along the axes of these bits, the nodes behind the cell are in another brick.
  QSES_FN int crossed() const {
    return (x.in_brick(1) == 0 ? 1 : 0) | (y.in_brick(1) == 0 ? 2 : 0) | (z.in_brick(1) == 0 ? 4 : 0);
  }
};

// Calls use(k, brick) for the bricks around a lookout, up to eight. Bits of k: along which axes it is the next one.
// brick -1: there is none.
template <class Use>
QSES_FN void for_bricks_around(const OpennessField &field, const Lookout &at, const Use &use) {
  const int crossed = at.crossed();
  for (int k = 0; k < 8; ++k)
    if (k == (k & crossed)) use(k, field.find(at.brick() + glm::ivec3(k & 1, k >> 1 & 1, k >> 2)));
}

struct AskBricks {
  OpennessField field;
  MeshView mesh;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint32_t vertex = mesh.first_vertex + static_cast<uint32_t>(i);
    for_bricks_around(field, Lookout(field.bricks.lattice, mesh.position(vertex), mesh.normal(vertex)),
                      [&](int, int brick) {
                        if (brick >= 0) atomic_set(field.asked + brick);
                      });
  }
};

struct SkyScratch {
  static constexpr int kReach = 3, kEdge = 2 * kReach + 1;  // bricks that rays come to
  uint64_t outside[kEdge * kEdge * kEdge][kLeavesPerBrick];
  uint64_t seen[SkyDirections::kCount];  // nodes from which the direction is free
};

// Rays of all nodes of a brick at a time: a word is what a step meets.
struct OpenNodes {
  OpennessField field;
  SkyDirections sky;

  template <class Team>
  QSES_HOST_DEVICE void operator()(const Team &team, SkyScratch &scratch, size_t i) const {
    if (field.asked && !field.asked[i]) return;
    const uint64_t free_nodes = field.outside[i * kLeavesPerBrick];
    if (free_nodes != 0) {
      bring_points(team, scratch, field.bricks.lattice.brick_at(field.bricks.linear[i]));
      team.sync();
      for (int d = team.rank(); d < SkyDirections::kCount; d += team.size())
        scratch.seen[d] = see(scratch, sky.direction[d], free_nodes);
      team.sync();
    }
    for (int node = team.rank(); node < kBrickNodes; node += team.size())
      field.nodes[i * kBrickNodes + static_cast<size_t>(node)] =
          free_nodes >> node & 1 ? sum_up(scratch, node) : Openness{kFilled, 0.f, 0.f, 0.f};
    team.sync();
  }

 private:
  // Those of the brick and of all that rays come to.
  template <class Team>
  QSES_HOST_DEVICE void bring_points(const Team &team, SkyScratch &scratch, const glm::ivec3 &place) const {
    constexpr int kEdge = SkyScratch::kEdge;
    for (int k = team.rank(); k < kEdge * kEdge * kEdge; k += team.size()) {
      const glm::ivec3 step(k % kEdge, k / kEdge % kEdge, k / (kEdge * kEdge));
      const int brick = field.bricks.find(place + step - SkyScratch::kReach);
      for (int word = 0; word < kLeavesPerBrick; ++word)
        scratch.outside[k][word] =
            brick < 0 ? ~uint64_t(0) : field.outside[static_cast<size_t>(brick) * kLeavesPerBrick + size_t(word)];
    }
  }

  // Those of the nodes that see the sky in a direction. Steps grow with the distance, as what is seen there covers more
  // of the sky, but never beyond a layer of atoms.
  QSES_FN uint64_t see(const SkyScratch &scratch, const float (&direction)[kAxes], uint64_t nodes) const {
    for (float t = 1.f; t <= kSkyDistance / kOcclusionPoint && nodes; t += minimum(2.5f, maximum(1.f, 0.35f * t)))
      nodes &= outside_at(scratch, round(t * direction[0]), round(t * direction[1]), round(t * direction[2]));
    return nodes;
  }
  // Of numbers above -64.
  QSES_FN static int round(float x) { return static_cast<int>(x + 64.5f) - 64; }

  // The outside bits of the points so far from each of the brick's nodes, out of the words of eight bricks.
  QSES_FN static uint64_t outside_at(const SkyScratch &scratch, int dx, int dy, int dz) {
    constexpr int kEdge = SkyScratch::kEdge, kReach = SkyScratch::kReach;
    const int word = (dx & 1) | (dy & 1) << 1 | (dz & 1) << 2;
    const int first = (dx >> 3) + kReach + kEdge * ((dy >> 3) + kReach + kEdge * ((dz >> 3) + kReach));
    const int rx = dx >> 1 & 3, ry = dy >> 1 & 3, rz = dz >> 1 & 3;  // nodes on, besides
    const uint64_t stays_x = static_cast<uint64_t>(0xf >> rx) * 0x1111111111111111ull;
    const uint64_t stays_y = static_cast<uint64_t>(0xffff >> 4 * ry) * 0x0001000100010001ull;
    const auto along_x = [&](int k) {
#if !defined(__CUDA_ARCH__)
      if (rx == 0) return scratch.outside[k][word];  // a GPU's threads have different ways to go
#endif
      return (scratch.outside[k][word] >> rx & stays_x) | (scratch.outside[k + 1][word] << (4 - rx) & ~stays_x);
    };
    const auto along_y = [&](int k) {
#if !defined(__CUDA_ARCH__)
      if (ry == 0) return along_x(k);
#endif
      return (along_x(k) >> 4 * ry & stays_y) | (along_x(k + kEdge) << (16 - 4 * ry) & ~stays_y);
    };
#if !defined(__CUDA_ARCH__)
    if (rz == 0) return along_y(first);
#endif
    return along_y(first) >> 16 * rz | along_y(first + kEdge * kEdge) << 1 << (63 - 16 * rz);
  }

  QSES_FN Openness sum_up(const SkyScratch &scratch, int node) const {
    Openness sum{0.f, 0.f, 0.f, 0.f};
    for (int d = 0; d < SkyDirections::kCount; ++d) {
      const float seen = scratch.seen[d] >> node & 1 ? 1.f : 0.f;
      sum.part += seen;
      sum.x += seen * sky.direction[d][0];
      sum.y += seen * sky.direction[d][1];
      sum.z += seen * sky.direction[d][2];
    }
    constexpr float kPart = 1.f / static_cast<float>(SkyDirections::kCount);
    return {kPart * sum.part, 2.f * kPart * sum.x, 2.f * kPart * sum.y, 2.f * kPart * sum.z};
  }
};

struct LightVertices {
  OpennessField field;
  MeshView mesh;
  bool marks;  // whether the second texture coordinate becomes 1
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint32_t vertex = mesh.first_vertex + static_cast<uint32_t>(i);
    const float *const n = mesh.normal(vertex);
    const Lookout at(field.bricks.lattice, mesh.position(vertex), n);
    const int crossed = at.crossed();
    int bricks[8];
    for_bricks_around(field, at, [&](int k, int brick) { bricks[k] = brick; });
    Openness sum{0.f, 0.f, 0.f, 0.f};
    float weights = 0.f;
    for (int z = 0; z < 2; ++z)
      for (int y = 0; y < 2; ++y) {
        const float across = at.y.weight(y) * at.z.weight(z);
        const int row = leaf_bit(0, at.y.in_brick(y), at.z.in_brick(z));
        for (int x = 0; x < 2; ++x) {
          const int brick = bricks[(x + 2 * y + 4 * z) & crossed];
          if (brick < 0) continue;
          const Openness *const open =
              &field.nodes[static_cast<size_t>(brick) * kBrickNodes + static_cast<size_t>(row + at.x.in_brick(x))];
          // None is 0, so that a single node that is free tells.
          const float weight = open->part < 0.f ? 0.f : 1e-4f + across * at.x.weight(x);
          sum.part += weight * open->part;
          sum.x += weight * open->x;
          sum.y += weight * open->y;
          sum.z += weight * open->z;
          weights += weight;
        }
      }
    const float light = weights > 0.f ? (sum.part + sum.x * n[0] + sum.y * n[1] + sum.z * n[2]) / weights : 0.f;
    float *const texcoord = mesh.texcoord(vertex);
    texcoord[0] = minimum(1.f, maximum(0.f, light));
    if (marks) texcoord[1] = 1.f;
  }
};

// Bricks for that, of 8 Å, are where the atoms are.
struct OcclusionBricks : BallBricks {};
inline ExpectedBricks expected_bricks(const WorkFacts &, const OcclusionBricks &items) {
  // Folded molecules have some quarter of a brick for an atom, single atoms up to 27.
  return {std::min<uint64_t>(items.lattice.table_size(), 1024 + items.atoms.count / 2), 0, 0};
}

// Writes how open the surface is at vertices, from 0 to 1, into the first of their texture coordinates. Positions and
// normals are finished.
//   frame, low, high  the centred frame's origin is that of frame; bounds of the atoms' centres in it
//   marks             see LightVertices
template <class Executor>
void find_openness(Executor &executor, const NeighborGridView &atoms, const SurfaceParameters &parameters,
                   const Lattice &frame, const glm::vec3 &low, const glm::vec3 &high, const MeshView &mesh,
                   size_t vertices, bool marks) {
  const auto mark = executor.arena().mark();
  Lattice lattice = frame;
  lattice.spacing = kOcclusionPoint;
  lattice = layout_lattice(lattice, low, high, parameters.max_radius + kNodeReach * kOcclusionPoint);
  const OcclusionBricks items{{atoms, lattice, parameters.max_radius, kNodeReach}};
  const BrickSet bricks = collect_bricks(executor, items, lattice, "occlusion bricks");
  const Span<uint64_t> outside = executor.template allocate<uint64_t>(size_t(bricks.count) * kLeavesPerBrick);
  const Span<Openness> nodes = executor.template allocate<Openness>(size_t(bricks.count) * kBrickNodes);
  OpennessField field{bricks, outside.data, nodes.data, nullptr};
  executor.fill(outside, 0xff);
  const Balls balls{atoms, parameters.max_radius, parameters.depth - kFilledGap, parameters.inner_part};
  const int planes = static_cast<int>(2.f * balls.radius(balls.max_radius) / kOcclusionPoint) + 1;
  executor.for_each(size_t(atoms.count) * static_cast<size_t>(planes), FillBalls{balls, field, planes},
                    kPlainSteps + static_cast<uint64_t>(planes) * static_cast<uint64_t>(planes));
  if constexpr (!Executor::kIsCuda) {  // a GPU has opened the others before it knows which they are
    const Span<uint8_t> asked = executor.template allocate<uint8_t>(bricks.count);
    executor.fill(asked, 0);
    field.asked = asked.data;
    executor.for_each(vertices, AskBricks{field, mesh});
  }
  executor.template for_each_brick<SkyScratch>(bricks.count, OpenNodes{field, SkyDirections()}, 8, kPlainTeamSteps);
  executor.for_each(vertices, LightVertices{field, mesh, marks});
  executor.arena().rewind(mark);
}

}  // namespace quickses
