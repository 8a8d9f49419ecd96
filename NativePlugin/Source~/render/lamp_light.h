// SPDX-License-Identifier: MIT
// Soft shadows of a lamp.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace quickses::render {

// A closed mesh as the eye sees it: x to the right, y up, z towards it.
struct SeenMesh {
  std::vector<glm::vec3> positions, normals;
  const uint32_t *indices = nullptr;
  size_t index_count = 0;
};

// Of each vertex, how much of the lamp it sees, 0 to 1: the lamp is a disk far away in that direction. Shadow maps
// [Williams 1978] are drawn from points of it.
std::vector<float> lamp_light(const SeenMesh &mesh, glm::vec3 lamp, unsigned threads);

}  // namespace quickses::render
