// SPDX-License-Identifier: MIT
// Meshes that tests of pictures and pages put together.
#pragma once

#include <cstdint>
#include <vector>

#include "io/mesh_writer.h"

namespace quickses::render {

struct DrawnMesh {
  std::vector<float> positions, normals, occlusion;
  std::vector<uint8_t> colors;
  std::vector<uint32_t> indices;

  io::MeshView view() const {
    io::MeshView view;
    view.vertex_count = static_cast<uint32_t>(positions.size() / 3);
    view.triangle_count = static_cast<uint32_t>(indices.size() / 3);
    view.positions = positions.data(), view.normals = normals.data(), view.indices = indices.data();
    if (!colors.empty()) view.colors = colors.data();
    if (!occlusion.empty()) view.occlusion = occlusion.data();
    return view;
  }
};

}  // namespace quickses::render
