// SPDX-License-Identifier: MIT
// Which bricks of a lattice meet a spherical shell.
#pragma once

#include "parallel/scalar.h"
#include "surface/geometry/lattice.h"

#include <cmath>

namespace quickses {

// The first of the numbers from first to last with a property that all behind it have too; last + 1 if none has.
template <class Property>
QSES_FN int first_with(int first, int last, const Property &has) {
  while (first <= last) {
    const int middle = first + (last - first) / 2;
    if (has(middle))
      last = middle - 1;
    else
      first = middle + 1;
  }
  return first;
}

// Of the rows along x of the bricks around something: those to look at. If they are all of them, perhaps only those of
// the layers along z from one on, so many apart.
struct RowRange {
  uint64_t first = 0, last = ~uint64_t(0);
  int layer = 0, layers = 1;
};

// Calls visit(linear index of the first, number) for the runs along x of the bricks whose boxes, grown by so many
// spacings, meet the shell between two radii about a centre.
template <class Visit>
QSES_FN void visit_bricks_of_shell(const Lattice &lattice, const glm::vec3 &center, float inner, float outer,
                                   float margin, const RowRange &rows, const Visit &visit) {
  const float h = lattice.spacing, size = lattice.brick_size(), slack = 0.01f * h + 1e-4f;
  const float grown = margin * h + slack, box = size - h + 2.f * grown;
  const float low_offset = -grown;
  outer += slack;
  inner = maximum(0.f, inner - slack);
  const float inner2 = inner * inner, outer2 = outer * outer;
  const float inverse = 1.f / size;
  int first[3], last[3];
  const float c[3] = {center.x, center.y, center.z};
  for (int d = 0; d < 3; ++d) {
    const int origin = lattice.first_brick[d];
    first[d] = static_cast<int>(floorf((c[d] - outer - low_offset - box) * inverse)) - origin;
    last[d] = static_cast<int>(floorf((c[d] + outer - low_offset) * inverse)) - origin;
    first[d] = first[d] < 0 ? 0 : first[d];
    last[d] = last[d] >= lattice.brick_count[d] ? lattice.brick_count[d] - 1 : last[d];
  }
  constexpr int kLongRow = 16;  // fewer bricks are tried one by one
  const bool many = last[1] - first[1] > 64, is_short = last[0] - first[0] < kLongRow;
  const auto start_of = [&](int x) { return static_cast<float>(x + lattice.first_brick.x) * size + low_offset - c[0]; };
  const auto nearest2_of = [&](int x) {
    const float x0 = start_of(x), nx = maximum(0.f, maximum(x0, -x0 - box));
    return nx * nx;
  };
  const auto farthest2_of = [&](int x) {
    const float x0 = start_of(x), fx = maximum(absolute(x0), absolute(x0 + box));
    return fx * fx;
  };
#if !defined(__CUDA_ARCH__)
  // The same for all rows; a GPU has no room for them.
  float nearest2[kLongRow], farthest2[kLongRow];
  for (int x = first[0]; is_short && x <= last[0]; ++x) {
    nearest2[x - first[0]] = nearest2_of(x);
    farthest2[x - first[0]] = farthest2_of(x);
  }
#endif
  int z = first[2] + rows.layer, y_begin = first[1];
  if (rows.first > 0 && last[1] >= first[1]) {
    const uint64_t rows_y = static_cast<uint64_t>(last[1] - first[1]) + 1;
    z += static_cast<int>(rows.first / rows_y);
    y_begin += static_cast<int>(rows.first % rows_y);
  }
  uint64_t left = rows.last - rows.first;
  for (; z <= last[2] && left > 0; z += rows.layers, y_begin = first[1]) {
    if (many) look_for_stop();
    const float z0 = static_cast<float>(z + lattice.first_brick.z) * size + low_offset - c[2];
    const float nz = maximum(0.f, maximum(z0, -z0 - box)), fz = maximum(absolute(z0), absolute(z0 + box));
    for (int y = y_begin; y <= last[1] && left > 0; ++y, --left) {
      const float y0 = static_cast<float>(y + lattice.first_brick.y) * size + low_offset - c[1];
      const float ny = maximum(0.f, maximum(y0, -y0 - box)), fy = maximum(absolute(y0), absolute(y0 + box));
      const float near2 = nz * nz + ny * ny, far2 = fz * fz + fy * fy;
      if (near2 > outer2) continue;
      const uint64_t row = lattice.linear(glm::ivec3(0, y, z));
      const auto is_near = [&](int x) { return near2 + nearest2_of(x) <= outer2; };
      const auto is_far = [&](int x) { return far2 + farthest2_of(x) >= inner2; };
      if (is_short) {
        for (int x = first[0]; x <= last[0]; ++x) {
#if defined(__CUDA_ARCH__)
          if (is_near(x) && is_far(x)) visit(row + static_cast<uint64_t>(x), uint64_t(1));
#else
          if (near2 + nearest2[x - first[0]] <= outer2 && far2 + farthest2[x - first[0]] >= inner2)
            visit(row + static_cast<uint64_t>(x), uint64_t(1));
#endif
        }
        continue;
      }
      // Along a row bricks come nearer and then go farther: the ends of the runs are looked for by halving.
      const int turn = first_with(first[0], last[0], [&](int x) { return start_of(x) + 0.5f * box >= 0.f; });
      const int begin = first_with(first[0], turn - 1, is_near);
      const int end = first_with(turn, last[0], [&](int x) { return !is_near(x); });
      const int hole = first_with(begin, turn - 1, [&](int x) { return !is_far(x); });
      const int hole_end = first_with(turn, end - 1, is_far);
      const auto visit_run = [&](int from, int to) {
        if (from < to) visit(row + static_cast<uint64_t>(from), static_cast<uint64_t>(to - from));
      };
      visit_run(begin, hole);
      visit_run(hole_end, end);
    }
  }
}

// So many bricks along an axis meet a ball, at most.
inline uint64_t most_bricks_across(const Lattice &lattice, float radius) {
  return static_cast<uint64_t>(2.0 * static_cast<double>(radius) / static_cast<double>(lattice.brick_size())) + 4;
}

// At least so many bricks meet a ball about a place in the table: most of an octant of it lies in there.
QSES_FN double fewest_bricks_of_ball(const Lattice &lattice, float radius) {
  const double bricks = static_cast<double>(radius) / static_cast<double>(lattice.brick_size());
  return bricks * bricks * bricks / 4;
}

}  // namespace quickses
