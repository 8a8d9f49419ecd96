// SPDX-License-Identifier: MIT
// Where a ray meets a mesh. After Woop, Benthin, Wald, "Watertight ray/triangle intersection", 2013: corners are
// sheared so that the ray is an axis, and what is computed for an edge is the same number, but for its sign, for both
// of its triangles. So no ray slips through between them.
#include "kept/kept_mesh.h"

#include "surface/stages/packed_normals.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace quickses {
namespace {

struct Point {
  double x, y, z;
};

// The ray's frame: z along the axis that is nearest to its direction.
class Ray {
 public:
  Ray(const float origin[3], const float direction[3]) {
    for (int d = 0; d < 3; ++d) {
      origin_[d] = static_cast<double>(origin[d]);
      if (std::abs(direction[d]) > std::abs(direction[z_])) z_ = d;
    }
    x_ = (z_ + 1) % 3;
    y_ = (z_ + 2) % 3;
    const double along = static_cast<double>(direction[z_]);
    shear_x_ = static_cast<double>(direction[x_]) / along;
    shear_y_ = static_cast<double>(direction[y_]) / along;
    scale_ = 1.0 / along;
  }
  // z in lengths of the direction.
  Point sheared(const float *p) const {
    const double z = static_cast<double>(p[z_]) - origin_[z_];
    return {static_cast<double>(p[x_]) - origin_[x_] - shear_x_ * z,
            static_cast<double>(p[y_]) - origin_[y_] - shear_y_ * z, scale_ * z};
  }

 private:
  double origin_[3], shear_x_, shear_y_, scale_;
  int x_, y_, z_ = 0;
};

// The ray against boxes. They are taken a bit larger than they are, by more than what rounding does to the triangles.
class BoxRay {
 public:
  BoxRay(const float origin[3], const float direction[3], const qses_mesh &mesh) {
    double largest = 0;
    for (int d = 0; d < 3; ++d)
      for (const float c : {origin[d], mesh.bounds_min[d], mesh.bounds_max[d]})
        largest = std::max(largest, std::abs(static_cast<double>(c)));
    for (int d = 0; d < 3; ++d) {
      inverse_[d] = 1.0 / static_cast<double>(direction[d]);
      is_backward_[d] = inverse_[d] < 0;
      const double slack = is_backward_[d] ? -1e-10 * largest : 1e-10 * largest;
      from_near_[d] = static_cast<double>(origin[d]) + slack;
      from_far_[d] = static_cast<double>(origin[d]) - slack;
    }
  }
  // Where the ray enters the box; infinite: nowhere. With a direction of 0 along an axis all is infinite, as it should
  // be: nowhere is 0 * infinity, since the slack keeps what it would come from apart, or counts as inside.
  double entry(const Box &box) const {
    double enter = 0, leave = std::numeric_limits<double>::max();
    for (int d = 0; d < 3; ++d) {
      const float *const near_side = is_backward_[d] ? box.high : box.low;
      const float *const far_side = is_backward_[d] ? box.low : box.high;
      const double near = (static_cast<double>(near_side[d]) - from_near_[d]) * inverse_[d],
                   far = (static_cast<double>(far_side[d]) - from_far_[d]) * inverse_[d];
      enter = near > enter ? near : enter;
      leave = far < leave ? far : leave;
    }
    return enter <= leave ? enter : std::numeric_limits<double>::infinity();
  }

 private:
  double from_near_[3], from_far_[3], inverse_[3];
  bool is_backward_[3];
};

struct Meeting {
  double distance = std::numeric_limits<double>::infinity();
  double weights[3] = {};
  uint32_t triangle = 0;
  bool found = false;
};

// Visits boxes in the order in which the ray enters them, as far as the nearest meeting; if it goes through more than
// there is room for, this holds for so many at a time.
template <size_t kRoom, class Visit>
void visit_in_order(const BoxRay &ray, const Box *boxes, size_t first, size_t last, const Meeting &nearest,
                    const Visit &visit) {
  struct Entry {
    double distance;
    size_t box;
  };
  Entry entries[kRoom];
  // Distances of triangles are rounded otherwise than those of boxes.
  const auto is_behind = [&](double distance) { return distance > nearest.distance * (1 + 1e-9); };
  while (first < last) {
    size_t count = 0;
    for (; first < last && count < kRoom; ++first) {
      const double distance = ray.entry(boxes[first]);
      if (distance < std::numeric_limits<double>::infinity() && !is_behind(distance))
        entries[count++] = {distance, first};
    }
    std::sort(entries, entries + count, [](const Entry &a, const Entry &b) { return a.distance < b.distance; });
    for (size_t k = 0; k < count && !is_behind(entries[k].distance); ++k) visit(entries[k].box);
  }
}

// Float32 triples that lie so many bytes apart.
class Triples {
 public:
  Triples(const float *first, size_t bytes) : first_(reinterpret_cast<const char *>(first)), bytes_(bytes) {}
  const float *operator[](uint32_t k) const { return reinterpret_cast<const float *>(first_ + bytes_ * k); }

 private:
  const char *first_;
  size_t bytes_;
};

size_t vertex_bytes(const qses_mesh &mesh) { return mesh.vertex_bytes ? mesh.vertex_bytes : 3 * sizeof(float); }

Triples positions_of(const qses_mesh &mesh) { return {mesh.positions, vertex_bytes(mesh)}; }

void read_normal(const qses_mesh &mesh, uint32_t vertex, double normal[3]) {
  if (mesh.normals) {
    const float *const n = Triples(mesh.normals, vertex_bytes(mesh))[vertex];
    for (int d = 0; d < 3; ++d) normal[d] = static_cast<double>(n[d]);
  } else {
    const uint8_t *const n = reinterpret_cast<const uint8_t *>(positions_of(mesh)[vertex] + 3);
    for (int d = 0; d < 3; ++d) normal[d] = static_cast<double>(unpack_component(n[d]));
  }
}

// Looks at triangles first..last-1. Of two at the same distance, the one with the lower number counts.
void look_at(const qses_mesh &mesh, size_t first, size_t last, const Ray &given_ray, VisibleAtoms visible,
             Meeting *nearest) {
  const Ray ray = given_ray;
  const Triples positions = positions_of(mesh);
  const uint32_t *corner = mesh.indices + 3 * first;
  for (size_t number = first; number < last; ++number, corner += 3) {
    const Point a = ray.sheared(positions[corner[0]]), b = ray.sheared(positions[corner[1]]),
                c = ray.sheared(positions[corner[2]]);
    const double u = c.x * b.y - c.y * b.x, v = a.x * c.y - a.y * c.x, w = b.x * a.y - b.y * a.x;
    // One jump that is nearly always taken, rather than six that nobody can foresee.
    if (std::min({u, v, w}) < 0 && std::max({u, v, w}) > 0) continue;
    const double sum = u + v + w;
    const uint32_t triangle = static_cast<uint32_t>(number);
    const double distance = (u * a.z + v * b.z + w * c.z) / sum;  // no number if the ray lies in the triangle's plane
    if (!(distance >= 0) || distance > nearest->distance) continue;
    if (nearest->found && distance == nearest->distance && triangle > nearest->triangle) continue;
    if (visible && !is_shown(mesh, triangle, visible)) continue;
    *nearest = {distance, {u / sum, v / sum, w / sum}, triangle, true};
  }
}

qses_hit describe(const qses_mesh &mesh, const Meeting &meeting) {
  qses_hit hit;
  qses_hit_init(&hit);
  if (!meeting.found) return hit;
  const uint32_t *const corner = mesh.indices + 3 * size_t(meeting.triangle);
  int heaviest = 0;
  double position[3] = {}, normal[3] = {}, corner_normal[3][3];
  for (int k = 0; k < 3; ++k) {
    if (meeting.weights[k] > meeting.weights[heaviest]) heaviest = k;
    const float *const p = positions_of(mesh)[corner[k]];
    read_normal(mesh, corner[k], corner_normal[k]);
    for (int d = 0; d < 3; ++d) {
      position[d] += meeting.weights[k] * static_cast<double>(p[d]);
      normal[d] += meeting.weights[k] * corner_normal[k][d];
    }
  }
  double length = std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
  if (length < 1e-6) {  // opposite ones: of the nearest corner
    for (int d = 0; d < 3; ++d) normal[d] = corner_normal[heaviest][d];
    length = std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
  }
  hit.found = 1;
  hit.triangle = meeting.triangle;
  hit.vertex = corner[heaviest];
  hit.owner = mesh.owners[hit.vertex];
  hit.distance = static_cast<float>(std::min(meeting.distance, static_cast<double>(std::numeric_limits<float>::max())));
  for (int d = 0; d < 3; ++d) {
    hit.position[d] = static_cast<float>(position[d]);
    hit.normal[d] = static_cast<float>(normal[d] / length);
  }
  return hit;
}

}  // namespace

qses_hit pick(const qses_mesh &mesh, const PickBoxes &boxes, const float origin[3], const float direction[3],
              VisibleAtoms visible) {
  const Ray ray(origin, direction);
  Meeting nearest;
  const size_t triangles = mesh.triangle_count;
  if (!boxes.runs) {
    look_at(mesh, 0, triangles, ray, visible, &nearest);
    return describe(mesh, nearest);
  }
  const BoxRay box_ray(origin, direction, mesh);
  const size_t runs = PickBoxes::run_count(triangles), groups = PickBoxes::group_count(triangles);
  const Triples positions = positions_of(mesh);
  visit_in_order<256>(box_ray, boxes.groups, 0, groups, nearest, [&](size_t group) {
    const size_t first = group * kGroupRuns, last = std::min(runs, first + kGroupRuns);
    visit_in_order<kGroupRuns>(box_ray, boxes.runs, first, last, nearest, [&](size_t run) {
      const size_t begin = run * kRunTriangles, end = std::min(triangles, begin + kRunTriangles);
      // They are seldom in a cache, and waiting for one after the other would be most of the time. (Written here since
      // GCC drops calls of functions that do nothing else.)
      for (size_t k = 3 * begin; k < 3 * end; ++k) __builtin_prefetch(positions[mesh.indices[k]]);
      look_at(mesh, begin, end, ray, visible, &nearest);
    });
  });
  return describe(mesh, nearest);
}

}  // namespace quickses
