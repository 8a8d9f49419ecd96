// SPDX-License-Identifier: MIT
// Surfaces as a web page that needs nothing but itself: turned, moved and played by whoever opens it. three.js, which
// draws them there, is part of the program if it was found when that was built.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "io/atomic_file.h"
#include "io/mesh_writer.h"
#include "render/camera.h"

namespace quickses::render {

// Throws io::Error (usage) if the program was built without three.js.
void check_pages_can_be_made();

// A mesh as a page has it: text in base64 and what is needed to read it, some 16 bytes per vertex and 6 per triangle.
// Positions have 16 bits per axis of the mesh's box, less the middle, which the camera looks at; normals two bytes
// (octahedral, within a degree); colours and openness a byte each; triangles are differences of vertices' numbers in
// as many bytes as they need. label: of the frame.
std::string page_mesh(const io::MeshView &mesh, glm::vec3 middle, const std::string &label);

struct PageSettings {
  std::string title;
  size_t atom_count = 0;
  std::array<uint8_t, 4> background = {255, 255, 255, 255};  // sRGB
  Camera camera;
};

// All members but the destructor throw io::Error (output).
class Page {
 public:
  static constexpr uint64_t kMostBytes = 500'000'000;  // more than browsers bear
  static constexpr uint64_t kManyBytes = 100'000'000;  // they need some time

  Page(const std::string &path, const PageSettings &settings, uint64_t most_bytes = kMostBytes);

  // The next frame; more: how many of about its size are to come. If the page would become larger than may be, with
  // those less a tenth, since sizes differ, the error says so and how many fit, and there will be no file.
  void add(const std::string &mesh, size_t more);
  void finish();

  uint64_t size() const { return size_; }

 private:
  void write(const std::string &text);

  io::AtomicFile file_;
  const uint64_t most_bytes_;
  uint64_t size_ = 0;
  size_t mesh_count_ = 0;
};

}  // namespace quickses::render
