// SPDX-License-Identifier: MIT
// Ambient occlusion: how much of an even sky a vertex sees, if what is beyond 20 Å does not count. Balls about the
// atoms fill a lattice of 1 Å. From nodes 2 Å apart around them, rays look in 48 directions which of them are free. A
// node keeps two moments of that, from which follows the light on a plane with any normal (the first two orders of the
// cosine lobe's spherical harmonics: Ramamoorthi and Hanrahan 2001); vertices take it from the eight nodes around them.
#pragma once

#include "parallel/atomics.h"
#include "surface/mesh/mesh_view.h"
#include "surface/stages/ball_points.h"

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

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
      direction[k][0] = rounded(across * std::cos(angle));
      direction[k][1] = rounded(across * std::sin(angle));
      direction[k][2] = rounded(z);
    }
  }
  // So that sums of them are exact, whatever their order.
  static float rounded(double x) { return static_cast<float>(std::nearbyint(x * 65536) / 65536); }
};

// What a node knows: twice the mean of the directions that are free, and what part of all they are. The light on a
// plane is then dot(mean, normal) + part.
struct alignas(16) Openness {
  float value[4] = {};
  QSES_FN float &part() { return value[3]; }
  QSES_FN float part() const { return value[3]; }
  QSES_FN void add(float weight, const Openness &other) {
#if defined(__SSE__) && !defined(__CUDA_ARCH__)
    const __m128 product = _mm_mul_ps(_mm_set1_ps(weight), _mm_load_ps(other.value));
    _mm_store_ps(value, _mm_add_ps(_mm_load_ps(value), product));
#else
    for (int k = 0; k < 4; ++k) value[k] += weight * other.value[k];
#endif
  }
};
// Within a ball.
constexpr float kFilled = -1.f;

#if !defined(__CUDA_ARCH__)
// Of each set of four directions that follow each other.
struct SkySums {
  static constexpr int kCount = SkyDirections::kCount / 4;
  Openness of[kCount][16];
  SkySums() {
    const SkyDirections sky;
    for (int d = 0; d < SkyDirections::kCount; ++d)
      for (int set = 0; set < 16; ++set) {
        Openness &sum = of[d / 4][set];
        if ((set >> d % 4 & 1) == 0) continue;
        for (int axis = 0; axis < kAxes; ++axis) sum.value[axis] += sky.direction[d][axis];
        sum.part() += 1.f;
      }
  }
};
inline const SkySums &sky_sums() {
  static const SkySums sums;
  return sums;
}
#endif

struct OpennessField {
  BrickSet bricks;
  // [brick][word]: bits of the points in no ball. A word has every other point along each axis, so that the nodes are
  // the points of word 0: word x & 1, ..., and bit x >> 1, ... of the point, counted from the brick's first.
  uint64_t *outside;
  Openness *nodes;  // [brick][node]
  int32_t *behind;  // [brick][k]: the next brick along the axes of k's bits; -1: there is none

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
    const glm::ivec3 place = field.bricks.lattice.brick_at(field.bricks.linear[i]);
    for (int k = team.rank(); k < 8; k += team.size())
      field.behind[8 * i + static_cast<size_t>(k)] = field.bricks.find(place + glm::ivec3(k & 1, k >> 1 & 1, k >> 2));
    const uint64_t free_nodes = field.outside[i * kLeavesPerBrick];
    if (free_nodes != 0) {
      bring_points(team, scratch, place);
      team.sync();
      for (int d = team.rank(); d < SkyDirections::kCount; d += team.size())
        scratch.seen[d] = see(scratch, sky.direction[d], free_nodes);
      team.sync();
    }
    for (int node = team.rank(); node < kBrickNodes; node += team.size())
      field.nodes[i * kBrickNodes + static_cast<size_t>(node)] =
          free_nodes >> node & 1 ? sum_up(scratch, node) : Openness{{0.f, 0.f, 0.f, kFilled}};
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
    Openness sum;
#if defined(__CUDA_ARCH__)
    for (int d = 0; d < SkyDirections::kCount; ++d) {
      const float seen = scratch.seen[d] >> node & 1 ? 1.f : 0.f;
      for (int axis = 0; axis < kAxes; ++axis) sum.value[axis] += seen * sky.direction[d][axis];
      sum.part() += seen;
    }
#else
    for (int four = 0; four < SkySums::kCount; ++four) {
      const uint64_t *const seen = scratch.seen + 4 * four;
      const uint64_t set =
          (seen[0] >> node & 1) | (seen[1] >> node & 1) << 1 | (seen[2] >> node & 1) << 2 | (seen[3] >> node & 1) << 3;
      sum.add(1.f, sky_sums().of[four][set]);
    }
#endif
    constexpr float kPart = 1.f / static_cast<float>(SkyDirections::kCount);
    return {{2.f * kPart * sum.value[0], 2.f * kPart * sum.value[1], 2.f * kPart * sum.value[2], kPart * sum.part()}};
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
    Openness sum;
    float weights = 0.f;
    for (int z = 0; z < 2; ++z)
      for (int y = 0; y < 2; ++y) {
        const float across = at.y.weight(y) * at.z.weight(z);
        const int row = leaf_bit(0, at.y.in_brick(y), at.z.in_brick(z));
        for (int x = 0; x < 2; ++x) {
          const int brick = bricks[(x + 2 * y + 4 * z) & crossed];
          if (brick < 0) continue;
          const Openness &open =
              field.nodes[static_cast<size_t>(brick) * kBrickNodes + static_cast<size_t>(row + at.x.in_brick(x))];
          // None is 0, so that a single node that is free tells.
          const float weight = open.part() < 0.f ? 0.f : 1e-4f + across * at.x.weight(x);
          sum.add(weight, open);
          weights += weight;
        }
      }
    return weights > 0.f ? (sum.value[0] * n[0] + sum.value[1] * n[1] + sum.value[2] * n[2] + sum.part()) / weights
                         : 0.f;
  }
};

// Bricks for that, of 8 Å, are where the atoms are.
struct OcclusionBricks : BallBricks {};
inline ExpectedBricks expected_bricks(const WorkFacts &, const OcclusionBricks &items) {
  // Folded molecules have some quarter of a brick for an atom, single atoms up to 27.
  return {std::min<uint64_t>(items.lattice.table_size(), 1024 + items.atoms.count / 2), 0, 0};
}

// A GPU looks from so many bricks at a time: where the box has no more, to find out which are needed takes longer than
// to work on the others as well.
constexpr uint64_t kBricksAtATime = 2048;

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
  const BrickSet bricks = Executor::kIsCuda && lattice.table_size() <= kBricksAtATime
                              ? all_bricks(executor, lattice)
                              : collect_bricks(executor, items, lattice, "occlusion bricks");
  const Span<uint64_t> outside = executor.template allocate<uint64_t>(size_t(bricks.count) * kLeavesPerBrick);
  const Span<Openness> nodes = executor.template allocate<Openness>(size_t(bricks.count) * kBrickNodes);
  const Span<int32_t> behind = executor.template allocate<int32_t>(size_t(bricks.count) * 8);
  const OpennessField field{bricks, outside.data, nodes.data, behind.data};
  executor.fill(outside, 0xff);
  const Balls balls{atoms, parameters.max_radius, parameters.depth - kFilledGap, parameters.inner_part};
  const int planes = static_cast<int>(2.f * balls.radius(balls.max_radius) / kOcclusionPoint) + 1;
  executor.for_each(size_t(atoms.count) * static_cast<size_t>(planes), FillBalls{balls, field, planes},
                    kPlainSteps + static_cast<uint64_t>(planes) * static_cast<uint64_t>(planes));
  executor.template for_each_brick<SkyScratch>(bricks.count, OpenNodes{field, SkyDirections()}, 8, kPlainTeamSteps);
  executor.for_each(vertices, LightVertices{field, mesh, marks});
  executor.arena().rewind(mark);
}

}  // namespace quickses
