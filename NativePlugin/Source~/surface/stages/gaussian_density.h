// SPDX-License-Identifier: MIT
// The density of Gaussians about the atoms, as QuickSurf of VMD defines it (Krone, Stone, Ertl and Schulten 2012): the
// sum of exp(-d² / 2s²), where s is the atom's radius times a scale, and atoms farther than 4 s (VMD's best quality)
// add nothing. The surface is where it has the isovalue.
#pragma once

#include "surface/stages/marching_cubes.h"

#include <cmath>
#include <cstring>

namespace quickses {

// Standard deviations after which an atom's density ends.
constexpr float kGaussianReach = 4.f;
constexpr float kHalfReach2 = 0.5f * kGaussianReach * kGaussianReach;

// exp(x) for x from -kHalfReach2 to 0, in operations that compilers make packs of.
QSES_FN float gaussian(float x) {
#if defined(__CUDA_ARCH__)
  return __expf(x);
#else
  const float y = x * 1.44269504f;
  const int n = static_cast<int>(y - 0.5f);
  const float f = (y - static_cast<float>(n)) * 0.69314718f;  // half of log 2 at most
  const float e = 1.f + f * (1.f + f * (0.5f + f * (0.166666667f + f * (0.0416666667f + f * 0.00833333333f))));
  const int32_t bits = (n + 127) * (1 << 23);
  float power;
  std::memcpy(&power, &bits, sizeof power);
  return e * power;
#endif
}

struct GaussianDensity {
  NeighborGridView atoms;  // with the radii where their densities end
  float max_radius;        // of those
  float isovalue;
  float atom_part;  // an atom's radius over that where its density ends

  struct Value {
    float density;
    Vec3<float> gradient;
  };

  // Where atoms can be that add to the density in a box.
  QSES_FN CellBox cells_near(const Vec3<float> &low, const Vec3<float> &high) const {
    const Vec3<float> reach(max_radius, max_radius, max_radius);
    return cells_around(atoms.cells, low - reach, high + reach);
  }
  // Calls visit(atom, number) for them, always in the same order.
  template <class Visit>
  QSES_FN void visit_atoms(const CellBox &box, const Visit &visit) const {
    for (int z = box.z0; z <= box.z1; ++z)
      for (int y = box.y0; y <= box.y1; ++y) {
        const ItemRun run = atoms.run(box.x0, box.x1, y, z);
        for (uint32_t k = run.begin; k < run.end; ++k) visit(load(&atoms.items[k]), k);
      }
  }

  QSES_FN Value at(const Vec3<float> &x) const {
    Value sum{0.f, Vec3<float>(0.f, 0.f, 0.f)};
    visit_atoms(cells_near(x, x), [&](const Sphere &atom, uint32_t) {
      const Vec3<float> d = x - Vec3<float>(atom.center);
      const float d2 = dot(d, d), end2 = atom.radius * atom.radius;
      if (d2 >= end2) return;
      const float slope = kHalfReach2 / end2, e = gaussian(-slope * d2);
      sum.density += e;
      sum.gradient = sum.gradient - d * (2.f * slope * e);
    });
    return sum;
  }

  // Place in the grid of the atom whose van der Waals surface is nearest; of several, of the smallest number.
  QSES_FN uint32_t owner_at(const Vec3<float> &x) const {
    uint32_t best = 0;
    float nearest = kFarAway;
    visit_atoms(cells_near(x, x), [&](const Sphere &atom, uint32_t k) {
      const Vec3<float> d = x - Vec3<float>(atom.center);
      const float distance = square_root(dot(d, d)) - atom_part * atom.radius;
      if (distance < nearest || (distance == nearest && atoms.order[k] < atoms.order[best])) {
        nearest = distance;
        best = k;
      }
    });
    return best;
  }
};

struct DensityScratch {
  static constexpr int kMostThreads = 256;
  float bounds[kMostThreads];
  uint8_t halves[kBrickEdge * kBrickEdge][2];  // of each row, the points inside
};

// The signs of a brick.
struct EvaluateDensity {
  GaussianDensity density;
  BrickSet bricks;
  const uint64_t *outside;  // [brick][leaf]: points that no atom alone puts inside
  uint32_t first;
  uint64_t *signs;

  template <class Team>
  QSES_HOST_DEVICE void operator()(const Team &team, DensityScratch &scratch, size_t i) const {
    const size_t brick = first + i;
    const Lattice &lattice = bricks.lattice;
    const glm::ivec3 point = lattice.first_point(lattice.brick_at(bricks.linear[brick]));
    const Vec3<float> low = lattice.position(point.x, point.y, point.z);
    const Vec3<float> high = lattice.position(point.x + 7, point.y + 7, point.z + 7);
    uint64_t undecided = 0;
    for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf)
      undecided |= outside[brick * kLeavesPerBrick + static_cast<size_t>(leaf)];
    const CellBox box = density.cells_near(low, high);
    const bool is_empty = undecided != 0 && most_in_box(team, scratch, box, low, high) < density.isovalue;
    if (undecided != 0 && !is_empty) {
      // A thread has so many points of a row, in registers.
      constexpr int kRows = kBrickEdge * kBrickEdge;
      const int parts = team.size() > kRows ? 2 : 1;
      for (int part = team.rank(); part < kRows * parts; part += team.size()) {
        const int row = part / parts;
        for (int half = part % parts; half < 2; half += parts)
          scratch.halves[row][half] = inside_of_half(box, point + glm::ivec3(4 * half, row % 8, row / 8));
      }
    }
    team.sync();
    for (int leaf = team.rank(); leaf < kLeavesPerBrick; leaf += team.size()) {
      uint64_t word = undecided == 0 ? ~uint64_t(0) : 0;
      for (int k = 0; k < kLeafEdge * kLeafEdge && undecided != 0 && !is_empty; ++k) {
        const glm::ivec3 p = brick_point(leaf, kLeafEdge * k);
        word |= static_cast<uint64_t>(scratch.halves[p.y + kBrickEdge * p.z][p.x / 4]) << (kLeafEdge * k);
      }
      signs[brick * kLeavesPerBrick + static_cast<size_t>(leaf)] = word;
    }
    team.sync();
  }

 private:
  // No point of the box has more; the same for all threads of the team. A bit more, for what rounding takes.
  template <class Team>
  QSES_HOST_DEVICE float most_in_box(const Team &team, DensityScratch &scratch, const CellBox &box,
                                     const Vec3<float> &low, const Vec3<float> &high) const {
    float bound = 0.f;
    uint32_t met = 0;
    density.visit_atoms(box, [&](const Sphere &atom, uint32_t) {
      if (static_cast<int>(met++ % static_cast<uint32_t>(team.size())) != team.rank()) return;
      const float end2 = atom.radius * atom.radius, d2 = distance_to_box_squared(Vec3<float>(atom.center), low, high);
      if (d2 < end2) bound += gaussian(-kHalfReach2 / end2 * d2);
    });
    scratch.bounds[team.rank()] = bound;
    team.sync();
    float sum = 0.f;
    for (int k = 0; k < team.size(); ++k) sum += scratch.bounds[k];
    return 1.001f * sum;
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

// Vertices where the density has the isovalue on their edges, with the gradient's direction as normal.
struct PlaceDensityVertices {
  GaussianDensity density;
  BrickSet bricks;
  MeshLayout layout;
  MeshView mesh;

  static constexpr int kMostSteps = 12;

  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint32_t vertex = mesh.first_vertex + static_cast<uint32_t>(i);
    const uint32_t brick = brick_of_vertex(layout, bricks.count, vertex);
    const CutEdge edge = ends_of_edge(bricks, layout, brick, edge_of_vertex(layout, brick, vertex));
    const Vec3<float> along = edge.outside - edge.inside;
    float inner = 0.f, outer = 1.f, t = 0.5f;
    GaussianDensity::Value found{};
    for (int step = 0; step < kMostSteps; ++step) {  // Newton's, between what is known to be inside and outside
      found = density.at(edge.inside + along * t);
      const float above = found.density - density.isovalue, slope = dot(found.gradient, along);
      (above > 0.f ? inner : outer) = t;
      const float next = t - above / slope;
      if (absolute(next - t) < 1e-3f) {  // the next step would be a thousandth of this one
        t = minimum(1.f, maximum(0.f, next));
        break;
      }
      t = next > inner && next < outer ? next : 0.5f * (inner + outer);
    }
    const Vec3<float> x = edge.inside + along * t;
    const uint32_t owner = density.owner_at(x);
    const float steepness2 = dot(found.gradient, found.gradient);
    mesh.owner(vertex) = density.atoms.order[owner];
    store_vec3(mesh.position(vertex), Vec3<float>(bricks.lattice.to_caller(x)));
    store_vec3(mesh.normal(vertex), steepness2 > 1e-20f ? found.gradient * (-1.f / square_root(steepness2))
                                                        : along * (1.f / bricks.lattice.spacing));
  }
};

}  // namespace quickses
