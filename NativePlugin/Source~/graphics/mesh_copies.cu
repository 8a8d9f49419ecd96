// SPDX-License-Identifier: MIT
#include "graphics/mesh_copies.h"

#include "kept/kept_mesh.h"
#include "parallel/cuda_executor.cuh"

#include <algorithm>
#include <cstring>

namespace quickses {
namespace {

// Triangles that are not shown become points, so that what the drawing thread was told stays true.
struct HideTriangles {
  const uint32_t *indices, *owners;
  const uint8_t *visible;
  uint32_t *out;
  QSES_HOST_DEVICE void operator()(size_t triangle) const {
    const uint32_t *const corners = indices + 3 * triangle;
    const bool is_there = is_shown(corners, owners, visible);
    for (int k = 0; k < 3; ++k) out[3 * triangle + static_cast<size_t>(k)] = corners[is_there ? k : 0];
  }
};

// Short work, which needs no cutting (cuda_launch.cuh).
template <class F>
void for_each(cudaStream_t stream, size_t n, const F &f) {
  if (n == 0) return;
  const auto blocks = static_cast<unsigned>((n + gpu::kForEachThreads - 1) / gpu::kForEachThreads);
  cudaGetLastError();  // of something that may fail, as what measures time
  gpu::for_each_kernel<<<blocks, gpu::kForEachThreads, 0, stream>>>(QueuedItems(0, n), f);
  check_cuda(cudaGetLastError(), "a kernel of the graphics event");
}

void copy(cudaStream_t stream, void *to, const void *from, size_t bytes) {
  check_cuda(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToDevice, stream), "cudaMemcpyAsync");
}

void fill(cudaStream_t stream, void *to, int byte, size_t bytes) {
  check_cuda(cudaMemsetAsync(to, byte, bytes, stream), "cudaMemsetAsync");
}

void copy_attributes(const qses_mesh &mesh, const AppearanceView &look, const MappedBuffers &to, cudaStream_t stream) {
  const size_t n = mesh.vertex_count;
  MeshView painted{};  // what the look says, or its default
  painted.owners = const_cast<uint32_t *>(mesh.owners);
  if (to.colors && look.colors)
    painted.colors = to.colors;
  else if (to.colors && mesh.colors)
    copy(stream, to.colors, mesh.colors, 4 * n);
  else if (to.colors)
    fill(stream, to.colors, 0xff, 4 * n);
  if (to.texcoords && (look.texcoords || !mesh.texcoords))
    painted.texcoords = to.texcoords;
  else if (to.texcoords)
    copy(stream, to.texcoords, mesh.texcoords, 8 * n);
  if (painted.colors || painted.texcoords) for_each(stream, n, PaintVertices{look, painted});
  if (to.owners) copy(stream, to.owners, mesh.owners, 4 * n);
}

}  // namespace

AppearanceView DeviceLook::use(const std::shared_ptr<const Appearance> &look, void *stream) {
  if (look == there_) return view_;
  there_ = nullptr;
  view_ = {};
  if (!look) return view_;
  turn_ = 1 - turn_;
  auto &[staging_buffer, copied] = stagings_[turn_];
  if (!copied) copied = std::make_unique<StreamMark>(device_);
  copied->wait();
  const size_t colors = 4 * look->colors.size(), texcoords = 8 * look->texcoords.size(), visible = look->visible.size(),
               bytes = colors + texcoords + visible;
  if (bytes > memory_.size())
    check_cuda(cudaStreamSynchronize(static_cast<cudaStream_t>(stream)), "cudaStreamSynchronize");
  auto *const staging = static_cast<char *>(staging_buffer.reserve(bytes));
  auto *const memory = static_cast<char *>(memory_.reserve(bytes));
  if (colors) std::memcpy(staging, look->colors.data(), colors);
  if (texcoords) std::memcpy(staging + colors, static_cast<const void *>(look->texcoords.data()), texcoords);
  if (visible) std::memcpy(staging + colors + texcoords, look->visible.data(), visible);
  check_cuda(cudaMemcpyAsync(memory, staging, bytes, cudaMemcpyHostToDevice, static_cast<cudaStream_t>(stream)),
             "cudaMemcpyAsync");
  copied->set(stream);
  view_.atoms = std::max(look->colors.size(), look->texcoords.size());
  if (colors) view_.colors = reinterpret_cast<const uint32_t *>(memory);
  if (texcoords) view_.texcoords = reinterpret_cast<const glm::vec2 *>(memory + colors);
  if (visible) view_.visible = reinterpret_cast<const uint8_t *>(memory + colors + texcoords);
  there_ = look;
  return view_;
}

void copy_mesh(const DeviceMesh &from, const AppearanceView &look, const MappedBuffers &to, void *on) {
  const auto stream = static_cast<cudaStream_t>(on);
  const qses_mesh &mesh = from.view.mesh;
  const size_t indices = 3 * size_t(mesh.triangle_count);
  if (mesh.vertex_count > 0) {
    copy(stream, to.vertices, mesh.positions, size_t(mesh.vertex_count) * mesh.vertex_bytes);
    copy_attributes(mesh, look, to, stream);
    if (look.visible)
      for_each(stream, mesh.triangle_count, HideTriangles{mesh.indices, mesh.owners, look.visible, to.indices});
    else
      copy(stream, to.indices, mesh.indices, 4 * indices);
  }
  if (to.index_count > indices) fill(stream, to.indices + indices, 0, 4 * (to.index_count - indices));
}

}  // namespace quickses
