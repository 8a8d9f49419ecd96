// SPDX-License-Identifier: MIT
// Triangles cut along the borders of the colours of atoms.
#include "io/color_borders.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <unordered_map>
#include <utility>

#include "io/error.h"
#include "io/mesh_formats.h"

namespace quickses::io {
namespace {

using Vec = std::array<double, 3>;

Vec vector_at(const float *vectors, size_t i) { return {vectors[3 * i], vectors[3 * i + 1], vectors[3 * i + 2]}; }

Vec mix(const Vec &a, const Vec &b, double t) {
  return {a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t};
}

double dot(const Vec &a, const Vec &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec minus(const Vec &a, const Vec &b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double length(const Vec &a) { return std::sqrt(dot(a, a)); }

// Cuts keep this part of an edge away from its ends, so that no triangle is a needle.
constexpr double kLeast = 0.02;

// A point of a triangle: how much of each corner.
using Weights = std::array<double, 3>;

class Cutter {
 public:
  Cutter(const MeshView &mesh, const OwnerSpheres &spheres) : mesh_(mesh), spheres_(spheres) { copy_vertices(); }

  OwnedMesh run() {
    for (size_t t = 0; t < mesh_.triangle_count; ++t) cut({corner(t, 0), corner(t, 1), corner(t, 2)});
    return numbered_anew();
  }

 private:
  using Triangle = std::array<uint32_t, 3>;

  static constexpr uint32_t kNone = UINT32_MAX;

  // Where an edge between places is cut.
  struct Cut {
    double part;     // of the way from the place with the smaller number
    uint32_t first;  // the vertex that is there first
  };

  uint32_t corner(size_t t, size_t k) const { return mesh_.indices[3 * t + k]; }
  uint32_t place(uint32_t vertex) const { return place_of(mesh_, vertex); }
  Vec position(uint32_t vertex) const { return vector_at(made_.positions.data(), vertex); }

  uint32_t color(uint32_t vertex) const {
    uint32_t value;
    std::memcpy(&value, &mesh_.colors[4 * size_t(place(vertex))], sizeof value);
    return value;
  }

  template <class T>
  static std::vector<T> copy_of(const T *values, size_t count) {
    return values ? std::vector<T>(values, values + count) : std::vector<T>();
  }

  void copy_vertices() {
    const size_t count = mesh_.vertex_count;
    made_.positions = copy_of(mesh_.positions, 3 * count);
    made_.normals = copy_of(mesh_.normals, 3 * count);
    made_.occlusion = copy_of(mesh_.occlusion, count);
    made_.owners = copy_of(mesh_.owners, count);
    made_.component_ids = copy_of(mesh_.component_ids, count);
    made_.patches = copy_of(mesh_.patches, count);
    made_.colors = copy_of(mesh_.colors, 4 * count);
    stands_for_.assign(count, kNone);
    for (uint32_t i = place_count(mesh_); i < count; ++i) {
      stands_for_[i] = place(i);
      std::copy_n(&made_.colors[4 * size_t(place(i))], 4, &made_.colors[4 * size_t(i)]);
    }
  }

  // How far x is outside the sphere of a vertex.
  double distance(uint32_t vertex, const Vec &x) const {
    const uint32_t owner = spheres_.owners[place(vertex)];
    return length(minus(x, vector_at(spheres_.centers, owner))) - spheres_.radii[owner];
  }

  // Of the edge between two places. Where the ends are not nearer to their own spheres than to each other's, as after
  // the smoothing of the voxel method, it is the middle.
  double find_part(uint32_t from, uint32_t to) const {
    const Vec a = position(from), b = position(to);
    const auto difference = [&](double t) {
      const Vec x = mix(a, b, t);
      return distance(from, x) - distance(to, x);
    };
    if (difference(0) > 0 || difference(1) < 0) return 0.5;
    double low = 0, high = 1;
    for (int i = 0; i < 40; ++i) {
      const double middle = (low + high) / 2;
      (difference(middle) < 0 ? low : high) = middle;
    }
    return std::clamp(low, kLeast, 1 - kLeast);
  }

  Cut &cut_of(uint32_t a, uint32_t b) {
    const uint32_t from = std::min(place(a), place(b)), to = std::max(place(a), place(b));
    const auto [found, is_new] = cuts_.try_emplace(uint64_t{from} << 32 | to, Cut{0, kNone});
    if (is_new) found->second.part = find_part(from, to);
    return found->second;
  }

  // Of the way from a to b.
  double part_of(uint32_t a, uint32_t b) {
    const double part = cut_of(a, b).part;
    return place(a) < place(b) ? part : 1 - part;
  }

  // A vertex within a triangle, with all that `like`, one of its corners, has.
  uint32_t add_vertex(const Triangle &corners, const Weights &weights, uint32_t like, uint32_t stands_for) {
    constexpr size_t kMost = UINT32_MAX;  // indices end before it
    const size_t number = stands_for_.size();
    if (number + 1 >= kMost) fail_output("with colours cut sharply the mesh has more vertices than files can number");
    Vec position = {0, 0, 0}, normal = {0, 0, 0};
    double occlusion = 0;
    for (size_t k = 0; k < 3; ++k) {
      const Vec p = vector_at(mesh_.positions, corners[k]), n = vector_at(mesh_.normals, corners[k]);
      for (size_t axis = 0; axis < 3; ++axis) {
        position[axis] += weights[k] * p[axis];
        normal[axis] += weights[k] * n[axis];
      }
      if (mesh_.occlusion) occlusion += weights[k] * mesh_.occlusion[corners[k]];
    }
    const double size = length(normal);
    for (size_t axis = 0; axis < 3; ++axis) {
      made_.positions.push_back(stands_for == kNone ? static_cast<float>(position[axis])
                                                    : made_.positions[3 * size_t(stands_for) + axis]);
      made_.normals.push_back(size > 0 ? static_cast<float>(normal[axis] / size)
                                       : mesh_.normals[3 * size_t(like) + axis]);
    }
    if (mesh_.occlusion) made_.occlusion.push_back(static_cast<float>(occlusion));
    if (mesh_.owners) made_.owners.push_back(mesh_.owners[like]);
    if (mesh_.component_ids) made_.component_ids.push_back(mesh_.component_ids[like]);
    if (mesh_.patches) made_.patches.push_back(mesh_.patches[like]);
    for (size_t k = 0; k < 4; ++k) made_.colors.push_back(mesh_.colors[4 * size_t(place(like)) + k]);
    stands_for_.push_back(stands_for);
    return static_cast<uint32_t>(number);
  }

  // The end, where the edge is cut, of what is left of it at a.
  uint32_t end_of(uint32_t a, uint32_t b) {
    const auto [found, is_new] = ends_.try_emplace(uint64_t{a} << 32 | b, kNone);
    if (is_new) {
      Cut &cut = cut_of(a, b);
      const double part = part_of(a, b);
      found->second = add_vertex({a, b, b}, {1 - part, part, 0}, a, cut.first);
      if (cut.first == kNone) cut.first = found->second;
    }
    return found->second;
  }

  void add(uint32_t a, uint32_t b, uint32_t c) { made_.indices.insert(made_.indices.end(), {a, b, c}); }

  void cut(const Triangle &t) {
    const bool differ[3] = {color(t[0]) != color(t[1]), color(t[1]) != color(t[2]), color(t[2]) != color(t[0])};
    const int count = differ[0] + differ[1] + differ[2];  // never one
    if (count == 0) return add(t[0], t[1], t[2]);
    if (count == 3) return cut_in_three(t);
    // The corner that differs from both others comes first.
    const size_t k = !differ[1] ? 0 : !differ[2] ? 1 : 2;
    cut_off(t[k], t[(k + 1) % 3], t[(k + 2) % 3]);
  }

  void cut_off(uint32_t a, uint32_t b, uint32_t c) {
    add(a, end_of(a, b), end_of(a, c));
    const uint32_t p = end_of(b, a), q = end_of(c, a);
    if (length(minus(position(p), position(c))) < length(minus(position(b), position(q)))) {
      add(p, b, c);
      add(p, c, q);
    } else {
      add(p, b, q);
      add(b, c, q);
    }
  }

  void cut_in_three(const Triangle &t) {
    const Weights inner = find_inner(t);
    uint32_t first = kNone;
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t a = t[k], before = t[(k + 2) % 3], after = t[(k + 1) % 3];
      const uint32_t middle = add_vertex(t, inner, a, first);
      if (k == 0) first = middle;
      add(a, end_of(a, after), middle);
      add(a, middle, end_of(a, before));
    }
  }

  // Where the spheres of the three corners are equally near, by Newton's method; if that is not well within the
  // triangle, the middle of the cuts of its edges.
  Weights find_inner(const Triangle &t) {
    Weights middle = {0, 0, 0};
    for (size_t k = 0; k < 3; ++k) {
      const double part = part_of(t[k], t[(k + 1) % 3]);
      middle[k] += (1 - part) / 3;
      middle[(k + 1) % 3] += part / 3;
    }
    const Vec origin = position(t[0]), u = minus(position(t[1]), origin), v = minus(position(t[2]), origin);
    double s = middle[1], r = middle[2];
    for (int step = 0; step < 20; ++step) {
      Vec x = origin;
      for (size_t axis = 0; axis < 3; ++axis) x[axis] += s * u[axis] + r * v[axis];
      double distances[3];
      Vec away[3];  // the gradient of each
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t owner = spheres_.owners[place(t[k])];
        away[k] = minus(x, vector_at(spheres_.centers, owner));
        const double size = length(away[k]);
        if (!(size > 0)) return middle;
        for (double &component : away[k]) component /= size;
        distances[k] = size - spheres_.radii[owner];
      }
      const Vec g = minus(away[0], away[1]), h = minus(away[0], away[2]);
      const double f1 = distances[0] - distances[1], f2 = distances[0] - distances[2];
      const double a = dot(g, u), b = dot(g, v), c = dot(h, u), d = dot(h, v), determinant = a * d - b * c;
      if (!(std::abs(determinant) > 1e-12)) return middle;
      const double ds = (d * f1 - b * f2) / determinant, dr = (a * f2 - c * f1) / determinant;
      s -= ds;
      r -= dr;
      if (std::abs(ds) + std::abs(dr) > 1e-6) continue;
      const Weights found = {1 - s - r, s, r};
      return *std::min_element(found.begin(), found.end()) >= kLeast ? found : middle;
    }
    return middle;
  }

  // Rows of the vertices in a new order.
  template <class T>
  static void reorder(std::vector<T> &values, size_t width, const std::vector<uint32_t> &numbers) {
    if (values.empty()) return;
    std::vector<T> moved(values.size());
    for (size_t i = 0; i < numbers.size(); ++i)
      std::copy_n(&values[width * i], width, &moved[width * size_t(numbers[i])]);
    values = std::move(moved);
  }

  // Vertices that stand for others go behind those that don't.
  OwnedMesh numbered_anew() {
    const size_t count = stands_for_.size();
    const auto places = static_cast<uint32_t>(std::count(stands_for_.begin(), stands_for_.end(), kNone));
    std::vector<uint32_t> numbers(count);
    uint32_t next_place = 0, next_repeated = places;
    for (size_t i = 0; i < count; ++i) numbers[i] = stands_for_[i] == kNone ? next_place++ : next_repeated++;
    for (size_t i = 0; i < count; ++i)
      if (stands_for_[i] != kNone) made_.repeated.push_back(numbers[stands_for_[i]]);
    for (uint32_t &index : made_.indices) index = numbers[index];
    reorder(made_.positions, 3, numbers);
    reorder(made_.normals, 3, numbers);
    reorder(made_.occlusion, 1, numbers);
    reorder(made_.owners, 1, numbers);
    reorder(made_.component_ids, 1, numbers);
    reorder(made_.patches, 1, numbers);
    reorder(made_.colors, 4, numbers);
    made_.others = mesh_;
    return std::move(made_);
  }

  const MeshView mesh_;
  const OwnerSpheres spheres_;
  OwnedMesh made_;
  std::vector<uint32_t> stands_for_;             // of each vertex so far; kNone: itself
  std::unordered_map<uint64_t, Cut> cuts_;       // of two places, the smaller one first
  std::unordered_map<uint64_t, uint32_t> ends_;  // of two vertices
};

template <class T>
const T *pointer_to(const std::vector<T> &values) {
  return values.empty() ? nullptr : values.data();
}

}  // namespace

MeshView OwnedMesh::view() const {
  MeshView view = others;
  view.vertex_count = static_cast<uint32_t>(positions.size() / 3);
  view.triangle_count = static_cast<uint32_t>(indices.size() / 3);
  view.positions = positions.data();
  view.normals = normals.data();
  view.owners = pointer_to(owners);
  view.patches = pointer_to(patches);
  view.component_ids = pointer_to(component_ids);
  view.colors = pointer_to(colors);
  view.occlusion = pointer_to(occlusion);
  view.indices = indices.data();
  view.repeated = pointer_to(repeated);
  view.repeated_count = static_cast<uint32_t>(repeated.size());
  return view;
}

OwnedMesh cut_at_color_borders(const MeshView &mesh, const OwnerSpheres &spheres) {
  return Cutter(mesh, spheres).run();
}

}  // namespace quickses::io
