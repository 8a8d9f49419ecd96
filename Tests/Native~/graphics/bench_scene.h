// SPDX-License-Identifier: MIT
// A surface drawn in colours and light to a picture that nobody sees, for benchmarks. Of the thread that draws, with a
// context of gl_without_window current there.
#pragma once

#include "quickses/quickses_gpu.h"

namespace bench_scene {

constexpr int kWidth = 1920, kHeight = 1080;

// The middle of a mesh, and by how much it is scaled to fill the picture.
struct View {
  explicit View(const qses_mesh &mesh);
  float middle_and_scale[4];
};

class Scene {
 public:
  Scene();  // throws std::runtime_error
  ~Scene();
  Scene(const Scene &) = delete;
  Scene &operator=(const Scene &) = delete;

  // Vertices of 24 bytes (INTERLEAVED), colours and indices.
  void draw(const qses_gpu_buffers &buffers, const View &view, uint32_t index_count);
  double draw_ms() const;  // of the GPU, the last draw; waits for it

 private:
  unsigned program_ = 0, vertex_array_ = 0, framebuffer_ = 0, textures_[2] = {0, 0}, query_ = 0;
};

}  // namespace bench_scene
