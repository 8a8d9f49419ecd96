// SPDX-License-Identifier: MIT
// Meshes that are kept on the GPU, and the same ones of a second context in host memory. No CUDA in this header.
#pragma once

#include "capi/kept_mesh_fixture.h"

#include <algorithm>
#include <memory>

namespace device_mesh_fixture {

using namespace kept_mesh_fixture;

inline bool has_device() {
  qses_backend_description description = empty_description();
  return qses_backend_info(QSES_BACKEND_CUDA, &description) == QSES_OK && description.available;
}

#define REQUIRE_CUDA_DEVICE() \
  if (!has_device()) GTEST_SKIP() << "no CUDA device"

struct CudaContext : Context {
  explicit CudaContext(uint64_t memory_budget = 0) : Context(0, memory_budget, QSES_BACKEND_CUDA) {}
};

// As meshes are made for buffers of a graphics API.
inline qses_settings interleaved(double spacing = 0.6) {
  qses_settings s = settings(spacing);
  s.vertex_layout = QSES_VERTICES_INTERLEAVED;
  s.level_count = 0;
  s.measure = 0;
  return s;
}

inline qses_settings on_device(qses_settings s) {
  s.delivery = QSES_DELIVERY_DEVICE;
  return s;
}

// The bytes of all arrays of a mesh. Empty: there is no such array.
struct HostMesh {
  uint32_t vertex_count = 0, triangle_count = 0;
  std::vector<char> vertices, normals, colors, texcoords, owners, patches, indices, component_ids, repeated;
};

inline std::vector<char> bytes_of(const void *from, size_t bytes) {
  const char *const first = static_cast<const char *>(from);
  return first ? std::vector<char>(first, first + bytes) : std::vector<char>();
}

inline HostMesh copy_of(const qses_mesh &m) {
  const size_t v = m.vertex_count;
  HostMesh mesh;
  mesh.vertex_count = m.vertex_count;
  mesh.triangle_count = m.triangle_count;
  mesh.vertices = bytes_of(m.positions, v * (m.vertex_bytes ? m.vertex_bytes : 12));
  mesh.normals = m.vertex_bytes ? std::vector<char>() : bytes_of(m.normals, 12 * v);
  mesh.colors = bytes_of(m.colors, 4 * v);
  mesh.texcoords = bytes_of(m.texcoords, 8 * v);
  mesh.owners = bytes_of(m.owners, 4 * v);
  mesh.patches = bytes_of(m.patches, v);
  mesh.indices = bytes_of(m.indices, 12 * size_t(m.triangle_count));
  mesh.component_ids = bytes_of(m.component_ids, 4 * v);
  mesh.repeated = bytes_of(m.repeated, 4 * static_cast<size_t>(m.repeated_count));
  return mesh;
}

inline HostMesh host_mesh(qses_context *context, const Atoms &atoms, qses_settings s) {
  s.delivery = QSES_DELIVERY_HOST;
  set_atoms(context, atoms);
  return copy_of(compute_view(context, s));
}

// The ordinary mesh, of a context of its own.
inline HostMesh host_mesh(const Atoms &atoms, const qses_settings &s) {
  const CudaContext context;
  return host_mesh(context, atoms, s);
}

inline void expect_equal(const HostMesh &a, const HostMesh &b) {
  EXPECT_EQ(a.vertex_count, b.vertex_count);
  EXPECT_EQ(a.triangle_count, b.triangle_count);
  EXPECT_TRUE(a.vertices == b.vertices);
  EXPECT_TRUE(a.normals == b.normals);
  EXPECT_TRUE(a.colors == b.colors);
  EXPECT_TRUE(a.texcoords == b.texcoords);
  EXPECT_TRUE(a.owners == b.owners);
  EXPECT_TRUE(a.patches == b.patches);
  EXPECT_TRUE(a.indices == b.indices);
  EXPECT_TRUE(a.component_ids == b.component_ids);
  EXPECT_TRUE(a.repeated == b.repeated);
}

// Computes on the device and keeps the mesh there.
inline void keep_on_device(qses_context *context, const qses_settings &s, qses_kept_mesh *kept) {
  compute_view(context, on_device(s));
  expect_ok(qses_keep(context, kept));
}

inline void keep_on_device(qses_context *context, const Atoms &atoms, const qses_settings &s, qses_kept_mesh *kept) {
  set_atoms(context, atoms);
  keep_on_device(context, s, kept);
}

// How many meshes of the device can be kept until memory is refused.
inline size_t keep_until_refused(qses_context *context, const qses_settings &s,
                                 std::vector<std::unique_ptr<Kept>> *kept) {
  constexpr size_t kMost = 2000;
  for (size_t count = 0; count < kMost; ++count) {
    const qses_status status = qses_compute(context, &s, nullptr);
    if (status != QSES_OK) {
      expect_error(status, QSES_OUT_OF_MEMORY, {});
      return count;
    }
    kept->push_back(std::make_unique<Kept>());
    expect_ok(qses_keep(context, *kept->back()));
  }
  ADD_FAILURE() << "so many meshes can't be within the budget";
  return kMost;
}

// The atoms of a frame: each one is moved by a tenth of an ångström at most, other ways in each frame.
inline Atoms frame_of(const Atoms &atoms, unsigned frame) {
  std::mt19937 random(frame);
  Atoms moved = atoms;
  for (float &x : moved.positions) x += 0.2f * (static_cast<float>(random() >> 8) / 16777216.f - 0.5f);
  return moved;
}

}  // namespace device_mesh_fixture
