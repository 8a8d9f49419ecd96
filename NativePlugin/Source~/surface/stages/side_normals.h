// SPDX-License-Identifier: MIT
// The normals of vertices where two sheets of the surface meet: one per side while a mesh is made, if someone asks for
// that, and one between them for a vertex that both sides share.
#pragma once

#include "surface/geometry/vec3.h"
#include "surface/mesh/mesh_view.h"

namespace quickses {

// Between two normals of unit length: their mean, or the first one where they are opposite.
QSES_FN Vec3<float> mean_normal(const Vec3<float> &a, const Vec3<float> &b) {
  if (a == b) return a;
  const Vec3<float> sum = a + b;
  const float length2 = length_squared(sum);
  return length2 > 1e-8f ? sum * reciprocal_root(length2) : a;
}

QSES_FN void store_normals(const MeshView &mesh, uint32_t vertex, const Vec3<float> &first, const Vec3<float> &second) {
  if (mesh.second_normals) {
    store_vec3(mesh.normal(vertex), first);
    store_vec3(mesh.second_normal(vertex), second);
  } else {
    store_vec3(mesh.normal(vertex), mean_normal(first, second));
  }
}

// The normal that both sides of a vertex share, whichever way it is kept.
QSES_FN Vec3<float> shared_normal(const MeshView &mesh, uint32_t vertex) {
  const Vec3<float> first = load_vec3(mesh.normal(vertex));
  return mesh.second_normals ? mean_normal(first, load_vec3(mesh.second_normal(vertex))) : first;
}

// Outward, of twice the area.
QSES_FN Vec3<float> face_normal(const MeshView &mesh, const uint32_t *triangle) {
  const Vec3<float> a = load_vec3(mesh.position(triangle[0])), b = load_vec3(mesh.position(triangle[1])),
                    c = load_vec3(mesh.position(triangle[2]));
  return mesh.reversed ? cross(c - a, b - a) : cross(b - a, c - a);
}

QSES_FN bool is_crest_vertex(const MeshView &mesh, uint32_t vertex) {
  return load_vec3(mesh.normal(vertex)) != load_vec3(mesh.second_normal(vertex));
}

// How well a vertex fits on a sphere through another one, whatever the radius: 1 where it does. On a sphere the normals
// of two points are mirror images in the plane halfway between them.
QSES_FN float sphere_fit(const Vec3<float> &way, const Vec3<float> &normal, const Vec3<float> &other_normal) {
  const float length2 = maximum(length_squared(way), 1e-12f);
  return dot(normal, other_normal) - quotient(2.f * dot(normal, way) * dot(other_normal, way), length2);
}

// To which side of a crest a corner of a triangle belongs, 0 or 1: to the one that the triangle faces; if it faces
// both, to the one on whose sphere the other corners lie.
QSES_FN int side_of_corner(const MeshView &mesh, const uint32_t *triangle, int corner) {
  const uint32_t vertex = triangle[corner];
  const Vec3<float> first = load_vec3(mesh.normal(vertex)), second = load_vec3(mesh.second_normal(vertex));
  const Vec3<float> face = face_normal(mesh, triangle);
  const float faces_first = dot(face, first), faces_second = dot(face, second);
  if ((faces_first > 0.f) != (faces_second > 0.f)) return faces_first > 0.f ? 0 : 1;
  float fit = 0.f;
  for (int k = 1; k < 3; ++k) {
    const uint32_t other = triangle[(corner + k) % 3];
    const Vec3<float> way = load_vec3(mesh.position(other)) - load_vec3(mesh.position(vertex)),
                      one = load_vec3(mesh.normal(other)), two = load_vec3(mesh.second_normal(other));
    fit += maximum(sphere_fit(way, first, one), sphere_fit(way, first, two)) -
           maximum(sphere_fit(way, second, one), sphere_fit(way, second, two));
  }
  constexpr float kClear = 1e-2f;
  if (absolute(fit) > kClear) return fit > 0.f ? 0 : 1;
  return faces_first >= faces_second ? 0 : 1;
}

struct ShareNormals {
  MeshView mesh;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint32_t vertex = static_cast<uint32_t>(i);
    store_vec3(mesh.normal(vertex), shared_normal(mesh, vertex));
  }
};

// One normal for each vertex of a finished mesh.
template <class Executor>
void share_normals(Executor &executor, const MeshView &mesh, size_t vertices) {
  if (mesh.second_normals) executor.for_each(vertices, ShareNormals{mesh});
}

}  // namespace quickses
