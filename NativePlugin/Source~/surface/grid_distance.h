// SPDX-License-Identifier: MIT
// Distance refinement of the voxel method (QuickSES 2019, section 2.3): for every lattice point the squared distance,
// in lattice steps, to the nearest lattice point outside all inflated balls, within a cube of points around it. The
// paper visits the whole cube; here the minimum is taken one axis at a time, which gives the same integers.
#pragma once

#include "surface/stages.h"

namespace quickses {

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

// The lattice as the later steps see it.
struct GridField {
  NeighborGridView atoms;  // inflated spheres, order = the caller's numbers
  BrickSet bricks;
  const uint64_t *outside;  // [brick][leaf]: bit set = in no inflated ball; so are all points of inactive bricks
  GridParameters parameters;
};

// Outside bits of the eight lattice points of one row of a brick.
QSES_FN uint32_t outside_row(const GridField &f, const glm::ivec3 &place, int y, int z) {
  const int brick = f.bricks.find(place);
  if (brick < 0) return 0xff;
  const uint64_t *leaf = f.outside + static_cast<size_t>(brick) * kLeavesPerBrick + leaf_of(0, y, z);
  const int shift = leaf_bit(0, y & 3, z & 3);
  return static_cast<uint32_t>(leaf[0] >> shift & 15) | static_cast<uint32_t>(leaf[1] >> shift & 15) << 4;
}

// Squared distances along the row at (y, z), counted from the first point of the brick at place and maybe outside it,
// from the first N points in x to the nearest outside point of that row.
template <int N>
QSES_FN void row_distances(const GridField &f, glm::ivec3 place, int y, int z, int32_t *out) {
  static_assert(N <= 2 * kBrickEdge, "the points of a row lie in two bricks");
  const int reach = f.parameters.reach, x = place.x, far_away = 2 * kBrickEdge + reach;
  place.y += y >> 3;
  place.z += z >> 3;
  y &= 7;
  z &= 7;
  const auto bits_at = [&](int bricks_on) {
    place.x = x + bricks_on;
    return outside_row(f, place, y, z);
  };
  const uint32_t bits = bits_at(0) | bits_at(1) << kBrickEdge;
  int before = far_away;  // from the first point back to an outside one
  for (int j = 1; kBrickEdge * (j - 1) < reach; ++j)
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
    for (int j = 2; kBrickEdge * j - (N - 1) <= reach; ++j)
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
struct DistanceScratch {
  static constexpr int kTilePlanes = 8, kTileRows = 24;
  int32_t nearest[N * N * N];                 // the result, x fastest
  int32_t planes[kTilePlanes * N * N];        // nearest within one plane of constant z
  int32_t rows[kTilePlanes * kTileRows * N];  // nearest within one row along x
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

// Fills scratch.nearest for a brick. All of the team must call it; it ends with a sync.
template <int N, class Team>
QSES_HOST_DEVICE inline void find_distances(const GridField &f, uint32_t brick, const Team &team,
                                            DistanceScratch<N> &scratch) {
  constexpr int kTilePlanes = DistanceScratch<N>::kTilePlanes, kTileRows = DistanceScratch<N>::kTileRows;
  const int reach = f.parameters.reach;
  const glm::ivec3 place = f.bricks.lattice.brick_at(f.bricks.linear[brick]);
  const RowShare share = row_share<N>(team);
  for (int r = share.first_row; r < N * N; r += share.row_step)
    for (int x = share.first_x; x < N; x += share.x_step) scratch.nearest[r * N + x] = kNoneInReach;

  for (int z0 = -reach; z0 < N + reach; z0 += kTilePlanes) {
    const int planes = N + reach - z0 < kTilePlanes ? N + reach - z0 : kTilePlanes;
    team.sync();  // the planes of the tile before have been read
    for (int r = share.first_row; r < planes * N; r += share.row_step)
      for (int x = share.first_x; x < N; x += share.x_step) scratch.planes[r * N + x] = kNoneInReach;

    for (int y0 = -reach; y0 < N + reach; y0 += kTileRows) {
      const int rows = N + reach - y0 < kTileRows ? N + reach - y0 : kTileRows;
      for (int i = team.rank(); i < planes * rows; i += team.size()) {
        const int plane = i / rows, row = i - plane * rows;
        row_distances<N>(f, place, y0 + row, z0 + plane, scratch.rows + i * N);
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
      team.sync();
    }

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
  team.sync();
}

// Stores the squared distances of the first N x N x N points of bricks first, first + 1, ...
template <int N>
struct StoreDistances {
  GridField field;
  uint32_t first;
  int32_t *distances;
  template <class Team>
  QSES_HOST_DEVICE void operator()(const Team &team, DistanceScratch<N> &scratch, size_t i) const {
    find_distances<N>(field, first + static_cast<uint32_t>(i), team, scratch);
    constexpr int kPoints = N * N * N;
    for (int k = team.rank(); k < kPoints; k += team.size())
      distances[i * kPoints + static_cast<size_t>(k)] = scratch.nearest[k];
    team.sync();
  }
};

}  // namespace quickses
