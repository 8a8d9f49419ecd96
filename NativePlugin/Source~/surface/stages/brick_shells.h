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
  const bool many = last[1] - first[1] > 64;
  const auto is_short = [&](int axis) { return last[axis] - first[axis] < kLongRow; };
  const auto start_of = [&](int axis, int k) {
    return static_cast<float>(k + lattice.first_brick[axis]) * size + low_offset - c[axis];
  };
  const auto nearest2_of = [&](int axis, int k) {
    const float start = start_of(axis, k), beyond = maximum(start, -start - box);
    return beyond * maximum(beyond, 0.f);  // of the square of a maximum compilers make a branch
  };
  const auto farthest2_of = [&](int axis, int k) {
    const float start = start_of(axis, k), farthest = maximum(absolute(start), absolute(start + box));
    return farthest * farthest;
  };
#if defined(__CUDA_ARCH__)
  const auto known_nearest2 = nearest2_of;
  const auto known_farthest2 = farthest2_of;
#else
  // The same for all rows and layers; a GPU has no room for them.
  float nearest2[2][kLongRow], farthest2[2][kLongRow];
  for (int axis = 0; axis < 2; ++axis)
    for (int k = first[axis]; is_short(axis) && k <= last[axis]; ++k) {
      nearest2[axis][k - first[axis]] = nearest2_of(axis, k);
      farthest2[axis][k - first[axis]] = farthest2_of(axis, k);
    }
  const auto known_nearest2 = [&](int axis, int k) { return nearest2[axis][k - first[axis]]; };
  const auto known_farthest2 = [&](int axis, int k) { return farthest2[axis][k - first[axis]]; };
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
    const float z_near2 = nearest2_of(2, z), z_far2 = farthest2_of(2, z);
    for (int y = y_begin; y <= last[1] && left > 0; ++y, --left) {
      const float near2 = z_near2 + (is_short(1) ? known_nearest2(1, y) : nearest2_of(1, y));
      if (near2 > outer2) continue;
      const float far2 = z_far2 + (is_short(1) ? known_farthest2(1, y) : farthest2_of(1, y));
      const uint64_t row = lattice.linear(glm::ivec3(0, y, z));
      if (is_short(0)) {
        for (int x = first[0]; x <= last[0]; ++x)
          if (near2 + known_nearest2(0, x) <= outer2 && far2 + known_farthest2(0, x) >= inner2)
            visit(row + static_cast<uint64_t>(x), uint64_t(1));
        continue;
      }
      const auto is_near = [&](int x) { return near2 + nearest2_of(0, x) <= outer2; };
      const auto is_far = [&](int x) { return far2 + farthest2_of(0, x) >= inner2; };
      // Along a row bricks come nearer and then go farther: the ends of the runs are looked for by halving.
      const int turn = first_with(first[0], last[0], [&](int x) { return start_of(0, x) + 0.5f * box >= 0.f; });
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
