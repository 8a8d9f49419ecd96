// SPDX-License-Identifier: MIT
// Distance refinement of the voxel method (QuickSES 2019, section 2.3): for every lattice point the squared distance,
// in lattice steps, to the nearest lattice point outside all inflated balls, within a cube of points around it. The
// paper visits the whole cube; here the minimum is taken one axis at a time, which gives the same integers.
#pragma once

#include "parallel/working_thread.h"
#include "surface/stages/hot_stages.h"

namespace quickses {

// Where the cube is large most of its rows have nothing to tell. Bricks know from the beginning how far along x the
// next outside point can be, and that alone settles which side of the surface most of them are on.

// What the voxel method needs to know about a surface.
struct GridParameters {
  float probe, spacing;  // p, h
  float max_radius;      // largest inflated radius
  int32_t reach;         // ceil(p / h): half edge of the cube of lattice points
  int32_t max_outside;   // largest squared distance, in lattice steps, at which the field is not negative
};

// Squared distance of a lattice point that has no outside lattice point in its cube, or anything above.
constexpr int32_t kNoneInReach = 1 << 30;
// Largest p / h: keeps sums of three squares below kNoneInReach.
constexpr double kMaxGridReach = 16384.0;

// The field f at a lattice point: p minus the distance to the nearest outside point, -h where none is in reach. Inside
// is f < 0, strictly. This is decided on the integers, so a zero (p / h a whole number, say h = 0.7 or 0.35 Å) is
// outside everywhere, whatever the rounding of h * sqrt(d2).
QSES_FN bool grid_is_inside(const GridParameters &g, int32_t distance2) { return distance2 > g.max_outside; }
QSES_FN float grid_value(const GridParameters &g, int32_t distance2) {
  if (distance2 >= kNoneInReach) return -g.spacing;
  const float f = g.probe - g.spacing * square_root(static_cast<float>(distance2));
  return grid_is_inside(g, distance2) ? minimum(f, -1e-6f * g.spacing) : maximum(f, 0.f);
}

// What is known of a brick from how far bricks with outside points are.
enum class BrickSide : uint8_t {
  kOutside,   // every lattice point has an outside point so near that it is no inside one of the surface
  kInside,    // none has
  kUndecided  // its points are looked at
};

// The lattice as the later steps see it.
struct GridField {
  NeighborGridView atoms;  // inflated spheres, order = the caller's numbers
  BrickSet bricks;
  const uint64_t *outside;  // [brick][leaf]: bit set = in no inflated ball; so are all points of inactive bricks
  GridParameters parameters;
  const uint16_t *along_x;  // [brick]: see bricks_to_outside
  const BrickSide *sides;   // [brick]

  // No outside point beyond so many bricks along an axis is within reach of a brick or the next one.
  QSES_FN int bricks_in_reach() const { return parameters.reach / kBrickEdge + 2; }
  // How many bricks on, in either direction along x, there may be one with outside points; one more than are in reach
  // if there is none.
  QSES_FN int bricks_to_outside(const glm::ivec3 &place) const {
    const int brick = bricks.find(place);
    return brick < 0 ? 0 : along_x[brick];
  }
};

// Lattice steps along an axis from the first N points of a brick to the points of the one so many bricks on: the
// fewest.
template <int N>
QSES_FN int32_t fewest_steps(int bricks_on) {
  const int steps = bricks_on < 0 ? -kBrickEdge * (bricks_on + 1) + 1 : kBrickEdge * bricks_on - (N - 1);
  return bricks_on == 0 || steps < 0 ? 0 : steps;
}
// The most, from the points of a brick.
QSES_FN int32_t most_steps(int bricks_on) {
  return kBrickEdge * (bricks_on < 0 ? -bricks_on : bricks_on) + kBrickEdge - 1;
}
QSES_FN int32_t squared(int32_t n) { return n * n; }
// 0, 1, -1, 2, -2 ...
QSES_FN int alternating(int k) { return k & 1 ? (k + 1) / 2 : -k / 2; }

struct FindOutsideAlongX {
  GridField field;
  uint16_t *along_x;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const glm::ivec3 place = field.bricks.place(i);
    const auto has_outside = [&](int bricks_on) {
      const int brick = field.bricks.find(glm::ivec3(place.x + bricks_on, place.y, place.z));
      if (brick < 0) return true;
      uint64_t any = 0;
      for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf)
        any |= field.outside[static_cast<size_t>(brick) * kLeavesPerBrick + static_cast<size_t>(leaf)];
      return any != 0;
    };
    int k = 0;
    while (k <= field.bricks_in_reach() && !has_outside(k) && !has_outside(-k)) ++k;
    along_x[i] = static_cast<uint16_t>(k);
  }
};

// Of work on a brick that goes through rows or tiles of a cube, numbered: those of this pass. The GPU takes several
// passes where p / h is so large that one would take too long; they come in order.
struct CubePart {
  int64_t first = 0, last = int64_t(1) << 62;
};

struct FindBrickSides {
  GridField field;
  BrickSide *sides;
  CubePart part{};
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const BrickSide before = part.first > 0 ? sides[i] : BrickSide::kInside;
    if (before != BrickSide::kOutside) sides[i] = side_of(i, before == BrickSide::kUndecided);
  }

 private:
  QSES_FN BrickSide side_of(size_t i, bool in_reach) const {
    const glm::ivec3 place = field.bricks.place(i);
    const int rows = 2 * field.bricks_in_reach() + 1, limit = field.parameters.max_outside;
    int64_t left = part.last - part.first;
    int first_l = static_cast<int>(part.first % rows);
    for (int k = static_cast<int>(part.first / rows); k < rows && left > 0; ++k, first_l = 0) {
      const int dz = alternating(k);
      const int32_t least_z = squared(fewest_steps<kBrickEdge>(dz)), most_z = squared(most_steps(dz));
      if (least_z > limit) break;
      if (rows > 64) look_for_stop();
      const int64_t after_row = left - (rows - first_l);
      for (int l = first_l; l < rows && left > 0; ++l, --left) {
        const int dy = alternating(l);
        const int32_t least = least_z + squared(fewest_steps<kBrickEdge>(dy));
        if (least > limit) break;
        const int dx = field.bricks_to_outside(glm::ivec3(place.x, place.y + dy, place.z + dz));
        if (most_z + squared(most_steps(dy)) + squared(most_steps(dx)) <= limit) return BrickSide::kOutside;
        in_reach = in_reach || least + squared(fewest_steps<kBrickEdge>(dx)) <= limit;
      }
      left = after_row;
    }
    return in_reach ? BrickSide::kUndecided : BrickSide::kInside;
  }
};

// Outside bits of the eight lattice points of one row of a brick; all, if it is not active.
QSES_FN uint32_t outside_row(const GridField &f, int brick, int y, int z) {
  if (brick < 0) return 0xff;
  const uint64_t *leaf = f.outside + static_cast<size_t>(brick) * kLeavesPerBrick + leaf_of(0, y, z);
  const int shift = leaf_bit(0, y & 3, z & 3);
  return static_cast<uint32_t>(leaf[0] >> shift & 15) | static_cast<uint32_t>(leaf[1] >> shift & 15) << 4;
}

// Squared distances along the row at (y, z), counted from the first point of the brick at place and maybe outside it,
// from the first N points in x to the nearest outside point of that row. bricks_on: of bricks_to_outside there.
template <int N>
QSES_FN void row_distances(const GridField &f, glm::ivec3 place, int y, int z, int bricks_on, int32_t *out) {
  static_assert(N <= 2 * kBrickEdge, "the points of a row lie in two bricks");
  const int reach = f.parameters.reach, x = place.x, far_away = 2 * kBrickEdge + reach;
  place.y += y >> 3;
  place.z += z >> 3;
  y &= 7;
  z &= 7;
  const auto bits_at = [&](int bricks_on) {
    place.x = x + bricks_on;
    return outside_row(f, f.bricks.find(place), y, z);
  };
  const uint32_t bits = bits_at(0) | bits_at(1) << kBrickEdge;
  int before = far_away;  // from the first point back to an outside one
  for (int j = bricks_on > 1 ? bricks_on : 1; kBrickEdge * (j - 1) < reach; ++j)
    if (const uint32_t b = bits_at(-j)) {
      int highest = kBrickEdge - 1;
      while (!(b >> highest & 1)) --highest;
      before = kBrickEdge * j - highest;
      break;
    }
  int after = far_away;  // from the last point on to an outside one
  if (bits >> N) {
    after = lowest_bit32(bits >> N) + 1;
  } else {
    for (int j = bricks_on > 2 ? bricks_on : 2; kBrickEdge * j - (N - 1) <= reach; ++j)
      if (const uint32_t b = bits_at(j)) {
        after = kBrickEdge * j + lowest_bit32(b) - (N - 1);
        break;
      }
  }
  int d = before - 1;
  for (int k = 0; k < N; ++k) out[k] = d = bits >> k & 1 ? 0 : d + 1;
  d = after - 1;
  for (int k = N - 1; k >= 0; --k) {
    d = bits >> k & 1 ? 0 : d + 1;
    const int nearest = out[k] < d ? out[k] : d;
    out[k] = nearest <= reach ? nearest * nearest : kNoneInReach;
  }
}

// The first N x N x N lattice points of a brick: 8 for its own, 9 for the corners of its cells too. The cube around
// them is worked off in tiles, so that the scratch does not grow with p / h.
template <int N>
struct alignas(16) DistanceScratch {  // kernels read whole vectors of it
  static constexpr int kTilePlanes = kBrickEdge, kTileBricks = 3, kTileRows = kTileBricks * kBrickEdge;
  int32_t nearest[N * N * N];                 // the result, x fastest
  int32_t planes[kTilePlanes * N * N];        // nearest within one plane of constant z
  int32_t rows[kTilePlanes * kTileRows * N];  // nearest within one row along x
  int32_t bricks_on[kTileBricks];             // per row of bricks, of bricks_to_outside; -1: too far off to matter
};

// Work on rows of N values: as many threads as there are values share a row, a single thread takes them all, so that
// its compiler can vectorise.
struct RowShare {
  int first_row, row_step, first_x, x_step;
};
template <int N, class Team>
QSES_FN RowShare row_share(const Team &team) {
  if (team.size() < N) return {team.rank(), team.size(), 0, 1};
  const int rows = team.size() / N, row = team.rank() / N;
  // Threads that are left over get no x.
  return {row, rows, row < rows ? team.rank() % N : N, N};
}

// Planes of bricks that the cube around the first N x N x N lattice points of a brick passes, and tiles in each.
struct CubeTiles {
  int bricks_back, planes, tiles;
  template <int N>
  QSES_FN static CubeTiles of(int32_t reach) {
    const int back = (reach + kBrickEdge - 1) / kBrickEdge, planes = back + (N + reach + kBrickEdge - 1) / kBrickEdge;
    return {back, planes, (planes + DistanceScratch<N>::kTileBricks - 1) / DistanceScratch<N>::kTileBricks};
  }
  QSES_FN int64_t all() const { return int64_t(planes) * tiles; }
  // Steps of a thread of a team of the GPU: what a row takes, whose bricks may have to be gone through.
  uint64_t tile_steps() const { return 160 + 16 * static_cast<uint64_t>(bricks_back); }
  uint64_t steps() const { return static_cast<uint64_t>(planes) * (16 + static_cast<uint64_t>(tiles) * tile_steps()); }
};

// Fills scratch.nearest for a brick. Squared distances above the limit may come out too large. All of the team must
// call it; it ends with a sync. saved: where the passes leave the distances if there are several; nullptr: one does
// all.
template <int N, class Team>
QSES_HOST_DEVICE inline void find_distances(const GridField &f, uint32_t brick, const Team &team,
                                            DistanceScratch<N> &scratch, int32_t limit, const CubePart &part = {},
                                            int32_t *saved = nullptr) {
  constexpr int kTileBricks = DistanceScratch<N>::kTileBricks;
  const int reach = f.parameters.reach;
  const CubeTiles cube = CubeTiles::of<N>(reach);
  const glm::ivec3 place = f.bricks.place(brick);
  const RowShare share = row_share<N>(team);
  for (int r = share.first_row; r < N * N; r += share.row_step)
    for (int x = share.first_x; x < N; x += share.x_step)
      scratch.nearest[r * N + x] = part.first > 0 ? saved[r * N + x] : kNoneInReach;

  // Tiles end where bricks end, and where the cube does.
  const auto within = [&](int at) { return at < -reach ? -reach : at > N + reach ? N + reach : at; };
  int first_tile = static_cast<int>(part.first % cube.tiles);
  for (int plane = static_cast<int>(part.first / cube.tiles); plane < cube.planes; ++plane, first_tile = 0) {
    const int64_t before = int64_t(plane) * cube.tiles;
    if (before >= part.last) break;
    const int dz = plane - cube.bricks_back;
    const int32_t least_z = squared(fewest_steps<N>(dz));
    if (least_z > limit) continue;
    const int z0 = within(kBrickEdge * dz), planes = within(kBrickEdge * (dz + 1)) - z0;
    bool any_in_plane = false;
    look_for_stop();
    for (int t = first_tile; t < cube.tiles && before + t < part.last; ++t) {
      const int tile = kTileBricks * t - cube.bricks_back;
      const int y0 = within(kBrickEdge * tile), rows = within(kBrickEdge * (tile + kTileBricks)) - y0;
      team.sync();  // what was there has been read
      for (int b = team.rank(); b < kTileBricks; b += team.size()) {
        const int dy = tile + b, dx = f.bricks_to_outside(place + glm::ivec3(0, dy, dz));
        const int32_t least = least_z + squared(fewest_steps<N>(dy)) + squared(fewest_steps<N>(dx));
        scratch.bricks_on[b] = least <= limit && dx <= f.bricks_in_reach() ? dx : -1;
      }
      team.sync();
      bool any = false;
      for (int b = 0; b < kTileBricks; ++b) any = any || scratch.bricks_on[b] >= 0;
      if (!any) continue;
      if (!any_in_plane)
        for (int r = share.first_row; r < planes * N; r += share.row_step)
          for (int x = share.first_x; x < N; x += share.x_step) scratch.planes[r * N + x] = kNoneInReach;
      any_in_plane = true;

      for (int i = team.rank(); i < planes * rows; i += team.size()) {
        const int plane = i / rows, row = i - plane * rows;
        const int bricks_on = scratch.bricks_on[(y0 + row - kBrickEdge * tile) / kBrickEdge];
        if (bricks_on >= 0)
          row_distances<N>(f, place, y0 + row, z0 + plane, bricks_on, scratch.rows + i * N);
        else
          for (int x = 0; x < N; ++x) scratch.rows[i * N + x] = kNoneInReach;
      }
      team.sync();
      for (int r = share.first_row; r < planes * N; r += share.row_step) {
        const int plane = r / N, y = r - plane * N;
        const int first = y - reach - y0 > 0 ? y - reach - y0 : 0;
        const int last = y + reach - y0 < rows - 1 ? y + reach - y0 : rows - 1;
        int32_t *to = scratch.planes + r * N;
        for (int i = first; i <= last; ++i) {
          const int32_t *from = scratch.rows + (plane * rows + i) * N;
          const int32_t step2 = (y - y0 - i) * (y - y0 - i);
          for (int x = share.first_x; x < N; x += share.x_step)
            to[x] = to[x] < from[x] + step2 ? to[x] : from[x] + step2;
        }
      }
    }
    if (!any_in_plane) continue;
    team.sync();
    for (int r = share.first_row; r < N * N; r += share.row_step) {
      const int z = r / N, y = r - z * N;
      const int first = z - reach - z0 > 0 ? z - reach - z0 : 0;
      const int last = z + reach - z0 < planes - 1 ? z + reach - z0 : planes - 1;
      int32_t *to = scratch.nearest + r * N;
      for (int i = first; i <= last; ++i) {
        const int32_t *from = scratch.planes + (i * N + y) * N;
        const int32_t step2 = (z - z0 - i) * (z - z0 - i);
        for (int x = share.first_x; x < N; x += share.x_step) to[x] = to[x] < from[x] + step2 ? to[x] : from[x] + step2;
      }
    }
  }
  if (saved)
    for (int r = share.first_row; r < N * N; r += share.row_step)
      for (int x = share.first_x; x < N; x += share.x_step) saved[r * N + x] = scratch.nearest[r * N + x];
  team.sync();
}

// Distances that several passes find, of the bricks from `first` on for which wanted(brick) holds.
template <int N, class Wanted>
struct FindSavedDistances {
  GridField field;
  Wanted wanted;
  uint32_t first;
  int32_t limit;
  CubePart part{};
  int32_t *saved;  // N x N x N per brick
  template <class Team>
  QSES_HOST_DEVICE void operator()(const Team &team, DistanceScratch<N> &scratch, size_t i) const {
    const uint32_t brick = first + static_cast<uint32_t>(i);
    if (wanted(brick)) find_distances<N>(field, brick, team, scratch, limit, part, saved + i * (N * N * N));
  }
};

// What finds the distances of brick i of a range for one of the steps below: at once, or they are there already.
template <int N, class Team>
QSES_HOST_DEVICE inline void bring_distances(const GridField &f, uint32_t brick, const Team &team,
                                             DistanceScratch<N> &scratch, int32_t limit, int32_t *saved) {
  if (!saved) return find_distances<N>(f, brick, team, scratch, limit);
  find_distances<N>(f, brick, team, scratch, limit, CubePart{CubeTiles::of<N>(f.parameters.reach).all(), 0}, saved);
}

// Calls work(range, saved, steps) for all bricks of a range: at once, or with their distances found before, for some
// bricks after the other, where that takes too long for one launch.
template <int N, class Executor, class Wanted, class Work>
void with_distances(Executor &executor, const GridField &field, BrickRange range, int32_t limit, const Wanted &wanted,
                    const Work &work) {
  const CubeTiles cube = CubeTiles::of<N>(field.parameters.reach);
  if (!Executor::kIsCuda || cube.steps() <= kThreadSteps / 2) return work(range, nullptr, cube.steps());
  constexpr uint32_t kBricks = 4096;
  const auto mark = executor.arena().mark();
  const Span<int32_t> saved = executor.template allocate<int32_t>(size_t(kBricks) * N * N * N);
  const int64_t most = static_cast<int64_t>(kThreadSteps / cube.tile_steps());
  for (uint32_t first = range.first; first < range.last; first += std::min(kBricks, range.last - first)) {
    const BrickRange some{first, first + std::min(kBricks, range.last - first)};
    for (int64_t tile = 0; tile < cube.all(); tile += most)
      executor.template for_each_brick<DistanceScratch<N>>(
          some.size(),
          FindSavedDistances<N, Wanted>{field, wanted, first, limit, CubePart{tile, tile + most}, saved.data}, 8,
          kThreadSteps);
    work(some, saved.data, kPlainTeamSteps);
  }
  executor.arena().rewind(mark);
}

}  // namespace quickses
