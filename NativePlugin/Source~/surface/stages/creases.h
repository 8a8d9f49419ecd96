// SPDX-License-Identifier: MIT
// Creases: where two sheets of a surface meet at an angle. The sheets are those of balls (sphere_sheets.h) or of probes
// (probe_sheets.h); here is what both say of a point of a crease, and how a vertex of a mesh tells that it is on one.
#pragma once

#include "surface/geometry/lattice.h"
#include "surface/mesh/creased_mesh.h"
#include "surface/stages/side_normals.h"

namespace quickses {

constexpr uint32_t kNoNumber = ~uint32_t(0);

// Sheets whose normals have a larger cosine than this pass smoothly into each other: there is nothing to sharpen.
constexpr float kSmoothCosine = 0.995f;

// A crease nearer to an end of an edge than this part of its length takes the end instead of a new vertex,
constexpr float kSnapPart = 0.4f;
// and no edge is split nearer to its end than this.
constexpr float kLeastPart = 0.08f;
// How far a point of the crease may be from where the edge passes under it, in lengths of the edge.
constexpr float kFarthestPart = 1.5f;
// Of an edge along a crease: it is split where it is further from the crease than this, in units of the spacing.
constexpr float kLeastSagitta = 0.03f;

// A point of a crease, or of a corner where three meet.
struct CreasePoint {
  enum Kind : uint32_t { kNone, kCrossed, kAlong };  // the edge crosses the crease here, or runs along it
  Vec3<float> position, normal, second_normal;       // centred frame; those of two of the sheets
  uint32_t owner, second_owner;                      // caller's numbers of the atoms they belong to
  qses_patch patch;
  Kind kind;
  float to_first, to_second;     // distances to the ends of the edge
  float off2;                    // from where the edge passes under it, squared
  bool first_fits, second_fits;  // may the end be moved there? Not off a crease that it is on
};

// An end of an edge, or a corner of a piece of a triangle: its place and its sides.
struct CreaseEnd {
  Vec3<float> position, normal, second_normal;  // centred frame; the normals are equal away from creases
  uint32_t owner, second_owner;

  QSES_FN bool is_of(uint32_t atom) const { return owner == atom || second_owner == atom; }
  QSES_FN bool on_crease() const { return normal != second_normal; }
};

QSES_FN CreaseEnd end_of_vertex(const CreasedMesh &mesh, const Lattice &lattice, uint32_t v) {
  const bool has_second = mesh.second_owners && mesh.on_crease(v);
  return {lattice.from_caller(mesh.position(v)), load_vec3(mesh.normal(v)), load_vec3(mesh.second_normal(v)),
          mesh.owner(v), has_second ? mesh.second_owners[v] : mesh.owner(v)};
}
QSES_FN CreaseEnd end_of_point(const CreasePoint &p) {
  return {p.position, p.normal, p.second_normal, p.owner, p.second_owner};
}

// Writes what there is to say of a vertex that is on a crease.
QSES_FN void mark_on_crease(const CreasedMesh &mesh, uint32_t vertex, const CreasePoint &p) {
  store_vec3(mesh.normal(vertex), p.normal);
  store_vec3(mesh.second_normal(vertex), p.second_normal);
  mesh.owner(vertex) = p.owner;
  if (mesh.patches) mesh.patch(vertex) = static_cast<uint8_t>(p.patch);
  if (mesh.second_owners) mesh.second_owners[vertex] = p.second_owner;
  mesh.crease_marks[vertex] = 1;
}
// Writes a vertex onto a crease. Positions of a mesh are the caller's.
QSES_FN void put_on_crease(const CreasedMesh &mesh, const Lattice &lattice, uint32_t vertex, const CreasePoint &p) {
  store_vec3(mesh.position(vertex), Vec3<float>(lattice.to_caller(p.position)));
  mark_on_crease(mesh, vertex, p);
}

// What vertices begin with.
struct MarkVertices {
  CreasedMesh mesh;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint32_t v = static_cast<uint32_t>(i);
    const bool on = is_crest_vertex(mesh, v);
    mesh.crease_marks[v] = on ? 1 : 0;
    if (mesh.second_owners) mesh.second_owners[v] = on ? mesh.owner(v) : kNoNumber;
  }
};

}  // namespace quickses
