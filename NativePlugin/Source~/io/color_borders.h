// SPDX-License-Identifier: MIT
// Triangles cut along the borders of the colours of atoms, so that each has one colour.
#pragma once

#include <cstdint>
#include <vector>

#include "io/mesh_writer.h"

namespace quickses::io {

// What vertices belong to.
struct OwnerSpheres {
  const uint32_t *owners = nullptr;  // the sphere of each vertex of the mesh
  const float *centers = nullptr;    // x 3, where the positions of the mesh are
  const float *radii = nullptr;
};

// A mesh with arrays of its own.
struct OwnedMesh {
  std::vector<float> positions, normals, occlusion;
  std::vector<uint32_t> owners, component_ids, indices, repeated;
  std::vector<uint8_t> patches, colors;
  MeshView others;  // what else there is to say

  MeshView view() const;
};

// A mesh with colours, which go by the owners of vertices: an edge between two colours is cut where its ends' spheres
// are equally near, and a triangle of three colours where all three are, if that is within it. What is new lies on the
// old triangles, and is there once per colour: like other repeated vertices, all but one stand for one of the rest, and
// with these taken for one the mesh is as closed as it was. A repeated vertex gets the colour of what it stands for.
// Throws Error (kOutput) if 32 bits can't number the vertices.
OwnedMesh cut_at_color_borders(const MeshView &mesh, const OwnerSpheres &spheres);

}  // namespace quickses::io
