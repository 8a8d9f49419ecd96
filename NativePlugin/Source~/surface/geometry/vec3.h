// SPDX-License-Identifier: MIT
// Vec3<T>: the vector that geometry functions compute with, where T is a float or a pack of floats (glm::dot refuses
// packs). Storage and interfaces use glm::vec3.
#pragma once

#include "parallel/scalar.h"

#include <glm/glm.hpp>

namespace quickses {

template <class T>
struct Vec3 {
  T x, y, z;
  Vec3() = default;
  QSES_FN Vec3(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
  QSES_FN explicit Vec3(const glm::vec3 &v) : x(v.x), y(v.y), z(v.z) {}
};

template <class T>
QSES_FN Vec3<T> operator+(const Vec3<T> &a, const Vec3<T> &b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
QSES_FN Vec3<T> operator-(const Vec3<T> &a, const Vec3<T> &b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
QSES_FN Vec3<T> operator*(const Vec3<T> &a, T s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class T>
QSES_FN T dot(const Vec3<T> &a, const Vec3<T> &b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
QSES_FN T length_squared(const Vec3<T> &a) {
  return dot(a, a);
}
template <class T>
QSES_FN Vec3<T> cross(const Vec3<T> &a, const Vec3<T> &b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class Mask, class T>
QSES_FN Vec3<T> select(Mask m, const Vec3<T> &yes, const Vec3<T> &no) {
  return {select(m, yes.x, no.x), select(m, yes.y, no.y), select(m, yes.z, no.z)};
}
// From a point to the nearest one of a box.
QSES_FN float distance_to_box_squared(const Vec3<float> &x, const Vec3<float> &low, const Vec3<float> &high) {
  return length_squared(Vec3<float>(maximum(0.f, maximum(low.x - x.x, x.x - high.x)),
                                    maximum(0.f, maximum(low.y - x.y, x.y - high.y)),
                                    maximum(0.f, maximum(low.z - x.z, x.z - high.z))));
}
QSES_FN bool operator==(const Vec3<float> &a, const Vec3<float> &b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
QSES_FN bool operator!=(const Vec3<float> &a, const Vec3<float> &b) { return !(a == b); }
QSES_FN Vec3<float> load_vec3(const float *p) { return {p[0], p[1], p[2]}; }
QSES_FN void store_vec3(float *p, const Vec3<float> &v) {
  p[0] = v.x;
  p[1] = v.y;
  p[2] = v.z;
}
QSES_FN glm::vec3 to_glm(const Vec3<float> &v) { return glm::vec3(v.x, v.y, v.z); }

}  // namespace quickses
