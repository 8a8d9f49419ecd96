// SPDX-License-Identifier: MIT
// A picture of a surface, by the processor: z-buffer, several samples per pixel, light of the sky and of a lamp.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "io/mesh_writer.h"
#include "render/camera.h"

namespace quickses::render {

constexpr int kMostSamples = 16;

struct PictureSettings {
  int width = 1024, height = 1024;
  int samples = 4;                                   // along each side of a pixel, up to kMostSamples
  std::optional<std::array<uint8_t, 4>> background;  // sRGB; none: transparent
  bool edges = false;                                // lines along the sides of triangles
  unsigned threads = 1;
};

struct Image {
  int width = 0, height = 0;
  std::vector<uint8_t> rgba;  // sRGB, the alpha not multiplied in
};

// mesh: closed. Its colours are grey and its occlusion 1 where it has none. middle: what the camera looks at. The same
// mesh gives the same picture, whatever the threads.
Image draw(const io::MeshView &mesh, const Camera &camera, glm::vec3 middle, const PictureSettings &settings);

// Throws io::Error (output).
void write_png(const std::string &path, const Image &image);

}  // namespace quickses::render
