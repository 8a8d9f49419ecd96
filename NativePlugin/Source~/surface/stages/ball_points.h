// SPDX-License-Identifier: MIT
// Which points of a lattice lie in balls about the atoms, and which bricks have such points.
#pragma once

#include "parallel/atomics.h"
#include "surface/stages/bricks.h"

namespace quickses {

// Balls about the atoms of a grid: of the radii that it has, less `inset`, Å.
struct Balls {
  NeighborGridView atoms;
  float max_radius;  // of the grid's
  float inset;
  QSES_FN float radius(float of_grid) const { return of_grid - inset; }
};

// Bricks that hold a lattice point of a ball of the grid, grown by `margin` spacings.
struct BallBricks {
  NeighborGridView atoms;
  Lattice lattice;
  float max_radius;
  float margin;
  QSES_FN size_t size() const { return atoms.count; }
  uint64_t most_across() const { return most_bricks_across(lattice, max_radius + (margin - 1.f) * lattice.spacing); }
  template <class Visit>
  QSES_FN void visit(size_t i, const RowRange &rows, const Visit &visit_brick) const {
    const Sphere atom = atoms.items[i];
    if (is_removed(atom)) return;
    visit_bricks_of_shell(lattice, atom.center, 0.f, atom.radius, margin, rows, visit_brick);
  }
  QSES_FN double fewest(size_t i) const {
    const Sphere atom = atoms.items[i];
    return is_removed(atom) ? 0.0 : fewest_bricks_of_ball(lattice, atom.radius);
  }
};

// Those bricks, grown by one spacing.
template <class Executor>
BrickSet collect_ball_bricks(Executor &executor, const NeighborGridView &atoms, float max_radius,
                             const Lattice &lattice, uint64_t *listed = nullptr) {
  const double reach = static_cast<double>(max_radius) / static_cast<double>(lattice.brick_size());
  if (atoms.count > 0 && 4.0 / 3.0 * 3.14159265358979 * reach * reach * reach > static_cast<double>(kMaxBricks))
    throw Error(QSES_TOO_FINE,
                "the largest inflated atom alone needs more bricks of the SES grid than 32-bit numbers can name: use a "
                "larger spacing");
  return collect_bricks(executor, BallBricks{atoms, lattice, max_radius, 1.f}, lattice, "bricks", listed);
}

struct ClassifyScratch {
  static constexpr int kListed = 128, kBlock = 64;
  Sphere listed[kListed];
  uint32_t count;
  float beyond_ball[kBrickPoints];  // smallest |x - c|² - R², x fastest; >= 0 outside
};

// Writes the outside bits of a brick: of the points in no ball.
struct ClassifyBrick {
  Balls balls;
  BrickSet bricks;
  uint64_t *outside;  // [brick][leaf]
  MetItems part{};    // of the atoms around a brick; the first part comes first

  // How far behind a point a centre is looked for, so that rounding loses none.
  QSES_FN static float slack(float spacing) { return 1e-4f + 1e-3f * spacing; }

  template <class Team>
  QSES_HOST_DEVICE void operator()(const Team &team, ClassifyScratch &scratch, size_t brick) const {
    const NeighborGridView &atoms = balls.atoms;
    const Lattice &lattice = bricks.lattice;
    const glm::ivec3 first = lattice.first_point(bricks.place(brick));
    const Vec3<float> low = lattice.position(first.x, first.y, first.z);
    const Vec3<float> high = lattice.position(first.x + 7, first.y + 7, first.z + 7);
    const float reach = balls.radius(atoms.cells.radii.in_cells) + slack(lattice.spacing);
    const CellBox box = cells_within(atoms.cells, low, high, reach);
    for (int i = team.rank(); i < kBrickPoints; i += team.size()) scratch.beyond_ball[i] = kFarAway;
    if (team.rank() == 0) scratch.count = 0;
    team.sync();
    MetItems met = part;
    atoms.for_each_run(box, [&](const ItemRun &whole) {
      const ItemRun run = met.cut(whole);
      for (uint32_t begin = run.begin; begin < run.end; begin += ClassifyScratch::kBlock) {
        const uint32_t end = run.end - begin < ClassifyScratch::kBlock ? run.end : begin + ClassifyScratch::kBlock;
        list(team, scratch, begin, end, low, high);
        team.sync();
        const uint32_t count = scratch.count;
        team.sync();
        if (count > ClassifyScratch::kListed - ClassifyScratch::kBlock) apply(team, scratch, count, first);
      }
      return true;
    });
    apply(team, scratch, scratch.count, first);
    // Byte by byte, of which there are enough for all threads. (Every machine this runs on is little-endian.)
    uint8_t *const bytes = reinterpret_cast<uint8_t *>(outside + brick * kLeavesPerBrick);
    for (int byte = team.rank(); byte < kBrickPoints / 8; byte += team.size()) {
      int out = 0;
      for (int bit = 0; bit < 8; ++bit) {
        const glm::ivec3 p = brick_point(byte >> 3, 8 * (byte & 7) + bit);
        const float beyond = scratch.beyond_ball[p.x + kBrickEdge * (p.y + kBrickEdge * p.z)];
        out |= (beyond < 0.f ? 0 : 1) << bit;
      }
      bytes[byte] = static_cast<uint8_t>(part.first > 0 ? bytes[byte] & out : out);
    }
    team.sync();
  }

 private:
  // Lists the atoms begin ... end - 1 whose balls touch the box of the brick's lattice points. In any order: the minima
  // below do not depend on it.
  template <class Team>
  QSES_HOST_DEVICE void list(const Team &team, ClassifyScratch &scratch, uint32_t begin, uint32_t end,
                             const Vec3<float> &low, const Vec3<float> &high) const {
    for (uint32_t k = begin + static_cast<uint32_t>(team.rank()); k < end; k += static_cast<uint32_t>(team.size())) {
      Sphere s = balls.atoms.items[k];
      s.radius = balls.radius(s.radius);
      const float r = s.radius + slack(bricks.lattice.spacing);
      if (distance_to_box_squared(Vec3<float>(s.center), low, high) <= r * r)
        scratch.listed[atomic_add(&scratch.count, uint32_t(1))] = s;
    }
  }

  // Takes the listed atoms into account and empties the list.
  template <class Team>
  QSES_HOST_DEVICE void apply(const Team &team, ClassifyScratch &scratch, uint32_t count,
                              const glm::ivec3 &first) const {
    // A thread has so many points of a row, in registers.
    constexpr int kRows = kBrickEdge * kBrickEdge;
    const int shares = team.size() > kRows ? team.size() / kRows : 1, points = kBrickEdge / shares;
    const float h = bricks.lattice.spacing;
    for (int share = team.rank(); share < kRows * shares; share += team.size()) {
      const int row = share / shares, first_x = share % shares * points;
      const float py = static_cast<float>(first.y + row % kBrickEdge) * h;
      const float pz = static_cast<float>(first.z + row / kBrickEdge) * h;
      float *const in_brick = scratch.beyond_ball + row * kBrickEdge + first_x;
      float px[kBrickEdge], beyond[kBrickEdge];
      for (int k = 0; k < points; ++k) {
        px[k] = static_cast<float>(first.x + first_x + k) * h;
        beyond[k] = in_brick[k];
      }
      for (uint32_t i = 0; i < count; ++i) {
        const Sphere s = scratch.listed[i];
        const float dy = py - s.center.y, dz = pz - s.center.z, across2 = dy * dy + dz * dz;
        const float ball2 = s.radius * s.radius;
        if (across2 >= ball2) continue;
        bool all_in = true;
        for (int k = 0; k < points; ++k) {
          const float dx = px[k] - s.center.x, d2 = dx * dx + across2;
          beyond[k] = minimum(beyond[k], d2 - ball2);
          all_in &= beyond[k] < 0.f;
        }
        if (all_in) break;  // deeper does not matter
      }
      for (int k = 0; k < points; ++k) in_brick[k] = beyond[k];
    }
    team.sync();
    if (team.rank() == 0) scratch.count = 0;
    team.sync();
  }
};

// Finds the outside bits of all bricks.
template <class Executor>
void find_outside_points(Executor &executor, const Balls &balls, const BrickSet &bricks, uint64_t *outside) {
  // Per atom that is listed, a thread looks at four points of a row.
  constexpr uint64_t kAtomSteps = 4, kMost = kThreadSteps / (2 * kAtomSteps);
  const auto steps_of = [&](uint64_t near) { return 512 + kAtomSteps * std::min(near, kMost); };
  uint64_t near = balls.atoms.count;
  if constexpr (Executor::kIsCuda) {
    const float spacing = bricks.lattice.spacing, reach = balls.radius(balls.max_radius) + 1.1f * spacing + 1e-3f;
    near = most_atoms_near(executor, balls.atoms, 8.f * spacing + 2.f * reach, [&](uint64_t n) {
      return executor.is_few_launches(bricks.count, executor.for_each_brick_shape(steps_of(n)));
    });
  }
  for_parts_of_met_items(near, Executor::kIsCuda ? kMost : near, [&](const MetItems &part, bool) {
    executor.template for_each_brick<ClassifyScratch>(bricks.count, ClassifyBrick{balls, bricks, outside, part}, 8,
                                                      steps_of(near));
  });
}

}  // namespace quickses
