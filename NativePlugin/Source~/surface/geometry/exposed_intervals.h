// SPDX-License-Identifier: MIT
// Which parts of a circle stay exposed when its neighbours' balls cover stretches of it: directions in the circle's
// plane as pseudo-angles, and a running list of exposed intervals that shrinks with every ball.
#pragma once

#include "surface/geometry/types.h"

namespace quickses {

// Pseudo-angle in [0, 4): the position on the square |x| + |y| = 1, counter-clockwise from (1, 0). It grows with the
// angle, which is all that ordering needs, and costs one division.
template <class T>
QSES_FN T pseudo_angle(T x, T y) {
  const T t = quotient(absolute(y), absolute(x) + absolute(y));
  const T half = select(x < T(0.f), T(2.f) - t, t);
  const T full = select(y < T(0.f), T(4.f) - half, half);
  return select(full >= T(4.f), T(0.f), full);
}

// The unit direction of a pseudo-angle.
QSES_FN glm::vec2 pseudo_direction(float p) {
  const int quadrant = p < 1.f ? 0 : p < 2.f ? 1 : p < 3.f ? 2 : 3;
  const float t = p - static_cast<float>(quadrant);
  const float x = quadrant == 0 ? 1.f - t : quadrant == 1 ? -t : quadrant == 2 ? t - 1.f : t;
  const float y = quadrant == 0 ? t : quadrant == 1 ? 1.f - t : quadrant == 2 ? -t : t - 1.f;
  const float k = reciprocal_root(x * x + y * y);
  return glm::vec2(x * k, y * k);
}

// Counter-clockwise way from one pseudo-angle to another, in [0, 4].
QSES_FN float pseudo_way(float from, float to) {
  const float way = to - from;
  return way < 0.f ? way + 4.f : way;
}
// Counter-clockwise from a pseudo-angle, does a come before b? Itself comes first. Told without ways, which are
// rounded, so that it does not depend on the order of stretches what they leave.
template <class T>
QSES_FN auto comes_before(T from, T a, T b) -> decltype(a < b) {
  return (a < b) ^ (a >= from) ^ (b >= from);
}

// From its begin counter-clockwise to its end, which is not part of it. Not empty.
struct Interval {
  float begin, end;  // pseudo-angles
};

// Rounding may put stretches apart that touch, by no more than this: what is left between them is none.
constexpr float kSliver = 5e-7f;
QSES_FN bool is_sliver(const Interval &v) { return pseudo_way(v.begin, v.end) <= kSliver; }

// The exposed intervals of one circle. Storage for the intervals is the caller's (registers, scratch or global memory).
template <class Storage>
struct ExposedIntervals {
  Storage interval;
  int capacity;
  int count = 0;
  bool whole = true;      // nothing covered yet: count is 0 then
  bool overflow = false;  // more intervals than capacity: the result is useless, use a larger one

  QSES_FN bool empty() const { return !whole && count == 0; }

  // The stretch from begin counter-clockwise to end is covered.
  QSES_FN void cover(float begin, float end) {
    if (whole) {
      whole = false;
      count = 1;
      interval[0] = {end, begin};
      return;
    }
    for (int k = 0; k < count; ++k) {
      const Interval v = interval[k];
      // What stays before the stretch, or, if it contains v.begin, between its end and its begin; and what stays behind
      // it. Written without branches, since none could be foreseen but the rare ones.
      const bool begins_within = comes_before(v.begin, begin, v.end), ends_within = comes_before(v.begin, end, v.end);
      const bool contains_begin = comes_before(begin, v.begin, end);
      const bool has_first = !contains_begin | ends_within;
      const bool has_second = !contains_begin & begins_within & ends_within & (end != v.begin);
      if (!has_first) {
        interval[k--] = interval[--count];
        continue;
      }
      interval[k] = {contains_begin ? end : v.begin, begins_within && begin != v.begin ? begin : v.end};
      if (has_second) {
        if (count == capacity) {
          overflow = true;
          return;
        }
        interval[count++] = {end, v.end};  // disjoint from the stretch: looked at again without effect
      }
    }
  }

  // Once all is covered that is: without slivers, and in the order of where they begin.
  QSES_FN void settle() {
    int kept = 0;
    for (int k = 0; k < count; ++k)
      if (!is_sliver(interval[k])) interval[kept++] = interval[k];
    count = kept;
    int gap = 1;
    while (3 * gap < count) gap = 3 * gap + 1;  // Knuth's, for Shell's sort
    for (; gap > 0; gap /= 3)
      for (int k = gap; k < count; ++k) {
        const Interval v = interval[k];
        int to = k;
        for (; to >= gap && interval[to - gap].begin > v.begin; to -= gap) interval[to] = interval[to - gap];
        interval[to] = v;
      }
  }
};

}  // namespace quickses
