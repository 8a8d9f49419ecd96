// SPDX-License-Identifier: MIT
// What graphics_bench computes and draws: molecules whose atoms move a little in each frame, and their surfaces.
#pragma once

#include "graphics/gl_without_window.h"
#include "quickses/quickses_gpu.h"

#include <algorithm>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace bench_surface {

using gl_without_window::gl;

constexpr unsigned kDistinctFrames = 16;

inline void expect_ok(qses_status status) {
  if (status != QSES_OK) throw std::runtime_error(qses_last_error());
}

struct Molecule {
  std::string name;
  std::vector<float> radii;
  std::vector<uint8_t> colors;
  std::vector<std::vector<float>> frames;  // positions

  size_t size() const { return radii.size(); }
};

inline Molecule molecule_of(const float *positions, const float *radii, size_t n) {
  Molecule m;
  m.radii.assign(radii, radii + n);
  for (size_t k = 0; k < 4 * n; ++k) m.colors.push_back(k % 4 == 3 ? 255 : static_cast<uint8_t>(96 + k * 37 % 150));
  for (unsigned frame = 0; frame < kDistinctFrames; ++frame) {
    std::mt19937 random(frame);
    m.frames.emplace_back(positions, positions + 3 * n);
    for (float &x : m.frames.back()) x += 0.2f * (static_cast<float>(random() >> 8) / 16777216.f - 0.5f);
  }
  return m;
}

// most: only the first so many atoms.
inline Molecule load(const std::string &path, size_t most = ~size_t(0)) {
  qses_structure_options options;
  qses_structure_options_init(&options);
  options.water = 0;
  qses_structure *structure = nullptr;
  expect_ok(qses_structure_open(path.c_str(), &options, &structure));
  qses_structure_description atoms;
  qses_structure_description_init(&atoms);
  expect_ok(qses_structure_info(structure, &atoms));
  Molecule m = molecule_of(atoms.positions, atoms.radii, std::min<size_t>(most, atoms.atom_count));
  m.name = path.substr(path.find_last_of('/') + 1);
  m.name = m.name.substr(0, m.name.find('.'));
  qses_structure_close(structure);
  return m;
}

// A context with a molecule, its target, and the mesh that was computed last.
class Surface {
 public:
  Surface(const Molecule &molecule, bool on_gpu) : molecule_(molecule) {
    qses_context_options options;
    qses_context_options_init(&options);
    options.backend = QSES_BACKEND_CUDA;
    expect_ok(qses_context_create(&options, &context_));
    expect_ok(qses_set_atoms(context_, molecule.frames[0].data(), 0, molecule.radii.data(), molecule.size()));
    expect_ok(qses_set_colors(context_, molecule.colors.data(), molecule.size()));
    expect_ok(qses_kept_mesh_create(&kept_));
    expect_ok(qses_gpu_target_create(&target_));
    qses_settings_init(&settings_);
    settings_.vertex_layout = QSES_VERTICES_INTERLEAVED;
    settings_.delivery = on_gpu ? QSES_DELIVERY_DEVICE : QSES_DELIVERY_HOST;
    settings_.measure = 0;
    settings_.level_count = 0;
    qses_mesh_init(&mesh);
    qses_gpu_buffers_init(&buffers);
  }
  ~Surface() {
    qses_gpu_target_destroy(target_);
    qses_kept_mesh_destroy(kept_);
    qses_context_destroy(context_);
  }
  Surface(const Surface &) = delete;
  Surface &operator=(const Surface &) = delete;

  void set_frame(unsigned frame) {
    expect_ok(qses_set_positions(context_, molecule_.frames[frame % kDistinctFrames].data(), 0, molecule_.size()));
  }
  void compute() { expect_ok(qses_compute(context_, &settings_, &mesh)); }
  void begin() { expect_ok(qses_begin(context_, &settings_)); }
  bool collect() {
    const qses_status status = qses_collect(context_, &mesh);
    if (status == QSES_NOTHING_NEW) {
      qses_progress progress;
      qses_progress_init(&progress);
      expect_ok(qses_poll(context_, &progress));
      if (progress.state == QSES_JOB_FAILED) throw std::runtime_error(progress.message);
      return false;
    }
    expect_ok(status);
    return true;
  }
  void keep() { expect_ok(qses_keep(context_, kept_)); }
  bool submit() {
    const qses_status status = qses_gpu_target_submit(target_, kept_, &buffers, nullptr);
    if (status != QSES_BUSY) expect_ok(status);
    return status == QSES_OK;
  }
  qses_gpu_status status() const {
    qses_gpu_status status;
    qses_gpu_status_init(&status);
    expect_ok(qses_gpu_target_status(target_, &status));
    if (status.status != QSES_OK) throw std::runtime_error(status.message);
    return status;
  }

  size_t vertex_bytes() const { return size_t(mesh.vertex_count) * 24; }
  size_t color_bytes() const { return size_t(mesh.vertex_count) * 4; }
  size_t index_bytes() const { return size_t(mesh.triangle_count) * 12; }
  size_t bytes() const { return vertex_bytes() + color_bytes() + index_bytes(); }

  // On the thread that draws. With a quarter to spare.
  void make_buffers() {
    buffers.vertex_capacity = mesh.vertex_count + mesh.vertex_count / 4;
    buffers.index_capacity = 3 * (uint64_t(mesh.triangle_count) + mesh.triangle_count / 4);
    const auto make = [](uint64_t *name, uint64_t bytes) {
      unsigned buffer = 0;
      gl.CreateBuffers(1, &buffer);
      gl.NamedBufferData(buffer, static_cast<ptrdiff_t>(bytes), nullptr, gl_without_window::kDynamicDraw);
      *name = buffer;
    };
    make(&buffers.vertices, 24 * buffers.vertex_capacity);
    make(&buffers.colors, 4 * buffers.vertex_capacity);
    make(&buffers.indices, 4 * buffers.index_capacity);
    ++buffers.generation;
  }
  void end_buffers() {
    for (const uint64_t name : {buffers.vertices, buffers.colors, buffers.indices}) {
      const auto buffer = static_cast<unsigned>(name);
      gl.DeleteBuffers(1, &buffer);
    }
  }

  qses_mesh mesh;  // its counts stay when it is kept
  qses_gpu_buffers buffers;

 private:
  const Molecule &molecule_;
  qses_context *context_ = nullptr;
  qses_kept_mesh *kept_ = nullptr;
  qses_gpu_target *target_ = nullptr;
  qses_settings settings_;
};

inline int32_t next_event() {
  int32_t event = 0;
  expect_ok(qses_gpu_next_event(&event));
  return event;
}

// Lets go of the targets that ended.
inline void end_targets() {
  if (const int32_t event = next_event()) qses_gpu_event_function()(event);
}

}  // namespace bench_surface
