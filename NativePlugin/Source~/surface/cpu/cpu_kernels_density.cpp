// SPDX-License-Identifier: MIT
// CPU kernels: signs and vertices of a brick of a Gaussian density (stages/gaussian_density.h), eight points or atoms
// at a time.
#include "parallel/pack.h"
#include "surface/cpu/cpu_kernels.h"

namespace quickses {
namespace QSES_CPU_ISA {

QSES_FN Pack gaussian(Pack x) { return gaussian_series(x); }

namespace {

float horizontal_sum(Pack a) {
  float lanes[kPackSize];
  store_pack(lanes, a);
  return ((lanes[0] + lanes[4]) + (lanes[1] + lanes[5])) + ((lanes[2] + lanes[6]) + (lanes[3] + lanes[7]));
}

// Atoms whose densities reach a box, in columns; up to seven more at the end that reach nothing.
struct NearAtoms {
  static constexpr int kColumns = 6;
  static_assert(kColumns <= BrickScratch::kAtomColumns, "room for the columns");
  const GaussianDensity &density;
  float *x, *y, *z, *end2, *distance;
  int32_t *place;  // in the grid
  int capacity, count = 0;

  NearAtoms(const GaussianDensity &density, const BrickScratch &scratch) : density(density) {
    const size_t stride = static_cast<size_t>(scratch.atom_capacity) + 16;
    float *const memory = scratch.atom_memory;
    x = memory, y = memory + stride, z = memory + 2 * stride, end2 = memory + 3 * stride;
    distance = memory + 4 * stride;
    place = reinterpret_cast<int32_t *>(memory + 5 * stride);
    capacity = scratch.atom_capacity;
  }

  // Those within `reach(atom)` of the box. False if there are more than there is room for: then count tells how many.
  template <class Reach>
  bool gather(const Vec3<float> &low, const Vec3<float> &high, const Reach &reach) {
    count = 0;
    density.visit_atoms(density.cells_near(low, high), [&](const Sphere &atom, uint32_t k) {
      const float most = reach(atom);
      if (distance_to_box_squared(Vec3<float>(atom.center), low, high) >= most * most) return;
      if (count < capacity) put(count, atom, k);
      ++count;
    });
    if (count > capacity) return false;
    const Sphere none{glm::vec3(kFarAway), 0.f};
    for (int k = count; k % kPackSize != 0; ++k) put(k, none, 0);
    return true;
  }

  GaussianDensity::Value at(const Vec3<float> &p) const {
    GaussianDensity::Sum<Pack> sum{Pack(0.f), {Pack(0.f), Pack(0.f), Pack(0.f)}};
    for (int k = 0; k < count; k += kPackSize) {
      const Vec3<Pack> d = from_centers(p, k);
      const Pack d2 = dot(d, d), end = load_pack(end2 + k);
      const PackMask reaches = d2 < end;
      if (lane_bits(reaches) == 0) continue;
      GaussianDensity::add(d, minimum(d2, end), maximum(end, Pack(1e-20f)), reaches, &sum);
    }
    const Vec3<Pack> &g = sum.gradient;
    return {horizontal_sum(sum.density), {horizontal_sum(g.x), horizontal_sum(g.y), horizontal_sum(g.z)}};
  }

  // As GaussianDensity::owner_at.
  uint32_t owner_at(const Vec3<float> &p) const {
    Pack nearest(kFarAway);
    for (int k = 0; k < count; k += kPackSize) {
      const Vec3<Pack> d = from_centers(p, k);
      const Pack to_surface = square_root(dot(d, d)) - Pack(density.atom_part) * square_root(load_pack(end2 + k));
      store_pack(distance + k, to_surface);
      nearest = minimum(nearest, to_surface);
    }
    const float least = horizontal_minimum(nearest);
    uint32_t best = 0, order = ~uint32_t(0);
    for (int k = 0; k < count; k += kPackSize)
      for (uint32_t lanes = lane_bits(load_pack(distance + k) <= Pack(least)); lanes; lanes &= lanes - 1) {
        const uint32_t atom = static_cast<uint32_t>(place[k + lowest_bit32(lanes)]);
        if (density.atoms.order[atom] >= order) continue;
        order = density.atoms.order[atom];
        best = atom;
      }
    return best;
  }

 private:
  Vec3<Pack> from_centers(const Vec3<float> &p, int k) const {
    return {Pack(p.x) - load_pack(x + k), Pack(p.y) - load_pack(y + k), Pack(p.z) - load_pack(z + k)};
  }
  void put(int k, const Sphere &atom, uint32_t number) {
    x[k] = atom.center.x, y[k] = atom.center.y, z[k] = atom.center.z;
    end2[k] = atom.radius * atom.radius;
    place[k] = static_cast<int32_t>(number);
  }
};

// No point of the box has less or more.
struct DensityBounds {
  float least, most;
};
DensityBounds bounds_in_box(const NearAtoms &atoms, const Vec3<float> &low, const Vec3<float> &high) {
  const Vec3<float> m = (low + high) * 0.5f, e = (high - low) * 0.5f;
  const Vec3<Pack> middle(m.x, m.y, m.z), half(e.x, e.y, e.z);
  Pack least(0.f), most(0.f);
  for (int k = 0; k < atoms.count; k += kPackSize) {
    const Vec3<Pack> center(load_pack(atoms.x + k), load_pack(atoms.y + k), load_pack(atoms.z + k));
    GaussianDensity::add_bounds(center, load_pack(atoms.end2 + k), middle, half, &least, &most);
  }
  return {GaussianDensity::kSurelyLess * horizontal_sum(least), GaussianDensity::kSurelyMore * horizontal_sum(most)};
}

// The densities of the brick's points, of each row along x as a pack. An atom's is a product of three, one for
// each axis.
void sum_rows(const NearAtoms &atoms, const Vec3<float> &low, float h, float (*rows)[kBrickEdge]) {
  static_assert(kBrickEdge == kPackSize, "a pack is a row");
  float steps[kBrickEdge];
  for (int k = 0; k < kBrickEdge; ++k) steps[k] = static_cast<float>(k) * h;
  const Pack step = load_pack(steps);
  for (int row = 0; row < kBrickEdge * kBrickEdge; ++row) store_pack(rows[row], Pack(0.f));
  for (int k = 0; k < atoms.count; ++k) {
    const float end2 = atoms.end2[k], slope = -kHalfReach2 / end2;
    const auto along = [&](float from, Pack *d2, Pack *e) {
      const Pack d = Pack(from) + step;
      *d2 = d * d;
      *e = gaussian(Pack(slope) * minimum(*d2, Pack(end2)));
    };
    Pack x2, ex, y2, ey, z2, ez;
    along(low.x - atoms.x[k], &x2, &ex);
    along(low.y - atoms.y[k], &y2, &ey);
    along(low.z - atoms.z[k], &z2, &ez);
    float across[2][kBrickEdge], parts[2][kBrickEdge];
    store_pack(across[0], y2);
    store_pack(across[1], z2);
    store_pack(parts[0], ey);
    store_pack(parts[1], ez);
    for (int z = 0; z < kBrickEdge; ++z) {
      if (across[1][z] >= end2) continue;
      for (int y = 0; y < kBrickEdge; ++y) {
        const float rest = end2 - across[0][y] - across[1][z];
        if (rest <= 0.f) continue;
        float *const row = rows[y + kBrickEdge * z];
        const Pack e = select(x2 < Pack(rest), ex, Pack(0.f));
        store_pack(row, multiply_add(e, Pack(parts[0][y] * parts[1][z]), load_pack(row)));
      }
    }
  }
}

}  // namespace

BrickNeeds evaluate_brick_density(const GaussianDensity &density, const BrickSet &bricks, uint32_t brick,
                                  const BrickScratch &scratch, uint64_t *words) {
  const Lattice &lattice = bricks.lattice;
  const glm::ivec3 point = lattice.first_point(bricks.place(brick));
  const Vec3<float> low = lattice.position(point.x, point.y, point.z);
  const Vec3<float> high = lattice.position(point.x + 7, point.y + 7, point.z + 7);
  NearAtoms atoms(density, scratch);
  if (!atoms.gather(low, high, [](const Sphere &atom) { return atom.radius; })) return {atoms.count, 0};
  const DensityBounds bounds = bounds_in_box(atoms, low, high);
  const bool is_full = bounds.least > density.isovalue, is_empty = bounds.most < density.isovalue;
  for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf) words[leaf] = is_full ? ~uint64_t(0) : 0;
  if (is_full || is_empty) return {};
  float rows[kBrickEdge * kBrickEdge][kBrickEdge];
  sum_rows(atoms, low, lattice.spacing, rows);
  for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf)
    for (int k = 0; k < kLeafEdge * kLeafEdge; ++k) {
      const glm::ivec3 p = brick_point(leaf, kLeafEdge * k);
      const uint32_t inside = lane_bits(load_pack(rows[p.y + kBrickEdge * p.z]) > Pack(density.isovalue));
      words[leaf] |= static_cast<uint64_t>(inside >> p.x & 0xf) << (kLeafEdge * k);
    }
  return {};
}

BrickNeeds emit_brick_density_vertices(const GaussianDensity &density, const BrickSet &bricks, const MeshLayout &layout,
                                       uint32_t brick, const BrickScratch &scratch, const MeshView &mesh) {
  const uint32_t first = layout.base[brick].vertices, last = layout.base[brick + 1].vertices;
  if (first == last) return {};
  const Lattice &lattice = bricks.lattice;
  const glm::ivec3 point = lattice.first_point(bricks.place(brick));
  NearAtoms atoms(density, scratch);
  // The nearest atom may be one whose density has ended.
  if (!atoms.gather(lattice.position(point.x, point.y, point.z),
                    lattice.position(point.x + 8, point.y + 8, point.z + 8),
                    [&](const Sphere &) { return density.max_radius; }))
    return {atoms.count, 0};
  for (uint32_t vertex = first; vertex < last; ++vertex)
    place_density_vertex(
        density, bricks, layout, brick, vertex, mesh, [&](const Vec3<float> &x) { return atoms.at(x); },
        [&](const Vec3<float> &x) { return atoms.owner_at(x); });
  return {};
}

}  // namespace QSES_CPU_ISA
}  // namespace quickses
