// SPDX-License-Identifier: MIT
// GPU: signs and vertices of Gaussian densities (stages/gaussian_density.h).
#pragma once

#include "surface/cuda/mesh_cuda.cuh"
#include "surface/stages/gaussian_density.h"

namespace quickses {
namespace gpu {

struct DensityScratch {
  float least[BlockTeam::kSize], most[BlockTeam::kSize];
  uint8_t halves[kBrickEdge * kBrickEdge][2];  // of each row, the points inside
};

// The signs of a brick.
struct EvaluateDensity {
  GaussianDensity density;
  BrickSet bricks;
  uint32_t first;
  uint64_t *signs;

  template <class Team>
  QSES_HOST_DEVICE void operator()(const Team &team, DensityScratch &scratch, size_t i) const {
    const size_t brick = first + i;
    const Lattice &lattice = bricks.lattice;
    const glm::ivec3 point = lattice.first_point(bricks.place(brick));
    const Vec3<float> low = lattice.position(point.x, point.y, point.z);
    const Vec3<float> high = lattice.position(point.x + 7, point.y + 7, point.z + 7);
    const CellBox box = density.cells_near(low, high);
    const Bounds bounds = bounds_in_box(team, scratch, box, low, high);
    const bool is_full = bounds.least > density.isovalue;
    const bool is_open = !is_full && !(bounds.most < density.isovalue);
    if (is_open) {
      // A thread has so many points of a row, in registers.
      constexpr int kHalves = 2 * kBrickEdge * kBrickEdge;
      for (int k = team.rank(); k < kHalves; k += team.size()) {
        const int row = k / 2, half = k % 2;
        scratch.halves[row][half] = inside_of_half(box, point + glm::ivec3(4 * half, row % 8, row / 8));
      }
    }
    team.sync();
    for (int leaf = team.rank(); leaf < kLeavesPerBrick; leaf += team.size()) {
      uint64_t word = is_full ? ~uint64_t(0) : 0;
      for (int k = 0; is_open && k < kLeafEdge * kLeafEdge; ++k) {
        const glm::ivec3 p = brick_point(leaf, kLeafEdge * k);
        word |= static_cast<uint64_t>(scratch.halves[p.y + kBrickEdge * p.z][p.x / 4]) << (kLeafEdge * k);
      }
      signs[brick * kLeavesPerBrick + static_cast<size_t>(leaf)] = word;
    }
    team.sync();
  }

 private:
  // No point of the box has less or more; the same for all threads of the team.
  struct Bounds {
    float least, most;
  };
  template <class Team>
  QSES_HOST_DEVICE Bounds bounds_in_box(const Team &team, DensityScratch &scratch, const CellBox &box,
                                        const Vec3<float> &low, const Vec3<float> &high) const {
    Bounds sum{0.f, 0.f};
    uint32_t met = 0;
    density.visit_atoms(box, [&](const Sphere &atom, uint32_t) {
      if (static_cast<int>(met++ % static_cast<uint32_t>(team.size())) != team.rank()) return;
      GaussianDensity::add_bounds(Vec3<float>(atom.center), atom.radius * atom.radius, (low + high) * 0.5f,
                                  (high - low) * 0.5f, &sum.least, &sum.most);
    });
    scratch.least[team.rank()] = sum.least;
    scratch.most[team.rank()] = sum.most;
    team.sync();
    sum = {0.f, 0.f};
    for (int k = 0; k < team.size(); ++k) {
      sum.least += scratch.least[k];
      sum.most += scratch.most[k];
    }
    return {GaussianDensity::kSurelyLess * sum.least, GaussianDensity::kSurelyMore * sum.most};
  }

  // Bits of four points along x.
  QSES_FN uint8_t inside_of_half(const CellBox &box, const glm::ivec3 &point) const {
    const Vec3<float> p = bricks.lattice.position(point.x, point.y, point.z);
    const float h = bricks.lattice.spacing;
    float sums[4] = {};
    density.visit_atoms(box, [&](const Sphere &atom, uint32_t) {
      const float dx = p.x - atom.center.x, dy = p.y - atom.center.y, dz = p.z - atom.center.z;
      const float across2 = dy * dy + dz * dz, end2 = atom.radius * atom.radius;
      if (across2 >= end2) return;
      const float slope = kHalfReach2 / end2;
      for (int k = 0; k < 4; ++k) {
        const float x = dx + static_cast<float>(k) * h, d2 = x * x + across2;
        const float e = gaussian(-slope * minimum(d2, end2));
        sums[k] += d2 < end2 ? e : 0.f;
      }
    });
    int bits = 0;
    for (int k = 0; k < 4; ++k) bits |= (sums[k] > density.isovalue ? 1 : 0) << k;
    return static_cast<uint8_t>(bits);
  }
};

struct PlaceDensityVertices {
  GaussianDensity density;
  BrickSet bricks;
  MeshLayout layout;
  MeshView mesh;

  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint32_t vertex = mesh.first_vertex + static_cast<uint32_t>(i);
    const uint32_t brick = brick_of_vertex(layout, {0, bricks.count}, vertex);
    place_density_vertex(
        density, bricks, layout, brick, vertex, mesh, [&](const Vec3<float> &x) { return density.at(x); },
        [&](const Vec3<float> &x) { return density.owner_at(x); });
  }
};

// Rounds of the loops of a thread that looks at the atoms around a place so many times. Waits, maybe.
template <class E>
uint64_t density_steps(E &executor, const GaussianDensity &density, size_t items, uint64_t looks, float extent) {
  const auto steps_of = [&](uint64_t near) { return kPlainSteps + looks * near; };
  const uint64_t near = most_atoms_near(executor, density.atoms, 2.f * density.max_radius + extent, [&](uint64_t n) {
    return steps_of(n) <= kThreadSteps && executor.is_few_launches(items, executor.for_each_shape(steps_of(n)));
  });
  if (steps_of(near) > kThreadSteps)
    throw Error(QSES_TOO_FINE,
                "the Gaussians of " + std::to_string(near) +
                    " atoms may reach one place, which is more than a GPU is given at a time: use a smaller "
                    "gaussian_radius_scale, or the CPU");
  return steps_of(near);
}

template <class E, class Slices>
void evaluate_density(E &executor, const GaussianDensity &density, const BrickSet &bricks, const Slices &slices,
                      uint64_t *signs) {
  const float extent = static_cast<float>(kBrickEdge) * bricks.lattice.spacing;
  const uint64_t steps = density_steps(executor, density, bricks.count, 2, extent);
  slices([&](BrickRange slice) {
    executor.template for_each_brick<DensityScratch>(slice.size(), EvaluateDensity{density, bricks, slice.first, signs},
                                                     8, steps);
  });
}

template <class E>
void emit_density_vertices(E &executor, const GaussianDensity &density, const BrickSet &bricks,
                           const MeshLayout &layout, const MeshView &mesh) {
  executor.for_each(layout.vertex_total, PlaceDensityVertices{density, bricks, layout, mesh},
                    density_steps(executor, density, layout.vertex_total, GaussianDensity::kMostLooks + 1, 0.f));
}

}  // namespace gpu
}  // namespace quickses
