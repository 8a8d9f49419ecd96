// SPDX-License-Identifier: MIT
// Meshes that stay on the GPU: the same bytes as on the host, no download unless asked for, valid like host views.
#include "surface/surface_fixture.h"

#include "parallel/cuda_memory.h"

#include <cuda_runtime.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

using namespace surface_fixture;

namespace {

bool has_device() { return quickses::describe_cuda_device(0).available; }
#define REQUIRE_DEVICE() \
  if (!has_device()) GTEST_SKIP() << "no CUDA device"

template <class T>
std::vector<T> fetched(const qses_device_mesh &m, const T *device, size_t n) {
  std::vector<T> host(device ? n : 0);
  const cudaStream_t stream = static_cast<cudaStream_t>(m.stream);
  if (device) {
    EXPECT_EQ(cudaMemcpyAsync(host.data(), device, n * sizeof(T), cudaMemcpyDeviceToHost, stream), cudaSuccess);
  }
  EXPECT_EQ(cudaStreamSynchronize(stream), cudaSuccess);
  return host;
}

template <class T>
void expect_same(const qses_device_mesh &m, const T *device, const T *host, size_t n, const char *what) {
  ASSERT_EQ(device == nullptr, host == nullptr) << what;
  if (host) {
    EXPECT_EQ(std::memcmp(fetched(m, device, n).data(), host, n * sizeof(T)), 0) << what;
  }
}

void expect_same_mesh(const qses_device_mesh &m, const qses_mesh &host) {
  const qses_mesh &d = m.mesh;
  ASSERT_EQ(d.vertex_count, host.vertex_count);
  ASSERT_EQ(d.triangle_count, host.triangle_count);
  ASSERT_EQ(d.vertex_bytes, host.vertex_bytes);
  const size_t v = host.vertex_count;
  if (host.vertex_bytes) {
    expect_same(m, reinterpret_cast<const char *>(d.positions), reinterpret_cast<const char *>(host.positions),
                v * host.vertex_bytes, "vertices");
  } else {
    expect_same(m, d.positions, host.positions, 3 * v, "positions");
    expect_same(m, d.normals, host.normals, 3 * v, "normals");
  }
  expect_same(m, d.colors, host.colors, 4 * v, "colors");
  expect_same(m, d.texcoords, host.texcoords, 2 * v, "texcoords");
  expect_same(m, d.owners, host.owners, v, "owners");
  expect_same(m, d.patches, host.patches, v, "patches");
  expect_same(m, d.indices, host.indices, 3 * size_t(host.triangle_count), "indices");
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(d.bounds_min[k], host.bounds_min[k]);
    EXPECT_EQ(d.bounds_max[k], host.bounds_max[k]);
  }
  EXPECT_EQ(d.tag, host.tag);
  EXPECT_EQ(d.level, host.level);
  EXPECT_EQ(d.spacing, host.spacing);
}

std::vector<qses_settings> variants() {
  std::vector<qses_settings> all;
  qses_settings s = settings(0.5);
  s.tag = 9;
  all.push_back(s);
  s.vertex_layout = QSES_VERTICES_INTERLEAVED;
  s.texcoords = 1;
  s.relaxation_steps = 3;
  s.components = 1;
  all.push_back(s);
  s.vertex_layout = QSES_VERTICES_COMPACT;
  all.push_back(s);
  s = settings(0.4);
  s.patch_types = 1;
  all.push_back(s);
  s.patch_types = 0;
  s.method = QSES_METHOD_GRID;
  all.push_back(s);
  return all;
}

qses_device_mesh collect_device(qses_context *context) {
  qses_device_mesh mesh;
  qses_device_mesh_init(&mesh);
  expect_ok(qses_collect_device(context, &mesh));
  return mesh;
}

TEST(DeviceMesh, IsTheSameAsOnTheHost) {
  REQUIRE_DEVICE();
  const Atoms atoms = crambin();
  const Context context(0, 0, QSES_BACKEND_CUDA);
  set_atoms(context, atoms);
  const std::vector<uint8_t> rgba(4 * atoms.size(), 90);
  std::vector<uint8_t> visible(atoms.size(), 1);
  for (size_t i = 0; i < atoms.size() / 3; ++i) visible[i] = 0;
  for (const bool masked : {false, true}) {
    expect_ok(qses_set_colors(context, rgba.data(), atoms.size()));
    expect_ok(qses_set_visible(context, masked ? visible.data() : nullptr, atoms.size()));
    for (qses_settings s : variants()) {
      const Context other(0, 0, QSES_BACKEND_CUDA);
      set_atoms(other, atoms);
      expect_ok(qses_set_colors(other, rgba.data(), atoms.size()));
      expect_ok(qses_set_visible(other, masked ? visible.data() : nullptr, atoms.size()));
      const qses_mesh expected = compute_view(other, s);
      s.delivery = QSES_DELIVERY_DEVICE;
      const qses_mesh without = compute_view(context, s);
      EXPECT_EQ(without.positions, nullptr);
      EXPECT_EQ(without.indices, nullptr);
      EXPECT_EQ(without.vertex_count, expected.vertex_count);
      expect_same_mesh(collect_device(context), expected);
      s.delivery = QSES_DELIVERY_BOTH;
      const qses_mesh host = compute_view(context, s);
      ASSERT_NE(host.positions, nullptr);
      const qses_device_mesh device = collect_device(context);
      expect_same_mesh(device, host);
      expect_same_mesh(device, expected);
    }
  }
}

// What goes to the host does so array by array, or all in one go where it is at most 1 MiB; triangles apart where they
// are more than a few thousand.
TEST(DeviceMesh, IsBroughtWholeWhateverItsSize) {
  REQUIRE_DEVICE();
  const Context context(0, 0, QSES_BACKEND_CUDA);
  set_atoms(context, crambin());
  for (const qses_vertex_layout layout : {QSES_VERTICES_SEPARATE, QSES_VERTICES_INTERLEAVED, QSES_VERTICES_COMPACT}) {
    constexpr size_t kOneGo = size_t(1) << 20;
    size_t least = ~size_t(0), most = 0;
    for (double spacing = 1.6; spacing > 0.21; spacing *= 0.93) {
      SCOPED_TRACE(spacing);
      qses_settings s = settings(spacing);
      s.vertex_layout = layout;
      s.delivery = QSES_DELIVERY_BOTH;
      const qses_mesh host = compute_view(context, s);
      expect_same_mesh(collect_device(context), host);
      const size_t bytes = host.vertex_count * (size_t(host.vertex_bytes ? host.vertex_bytes : 24) + sizeof(uint32_t));
      least = std::min(least, bytes);
      most = std::max(most, bytes);
    }
    EXPECT_LT(least, kOneGo / 4);
    EXPECT_GT(most, kOneGo + kOneGo / 4);
  }
}

// The mesh that the caller holds is not touched by jobs that run meanwhile.
TEST(DeviceMesh, StaysUntilTheNextIsCollected) {
  REQUIRE_DEVICE();
  const Atoms atoms = crambin();
  const Context context(0, 0, QSES_BACKEND_CUDA);
  set_atoms(context, atoms);
  qses_settings s = settings(0.5);
  s.delivery = QSES_DELIVERY_DEVICE;
  compute_view(context, s);
  const qses_device_mesh held = collect_device(context);
  const std::vector<float> before = fetched(held, held.mesh.positions, 3 * size_t(held.mesh.vertex_count));
  for (int frame = 1; frame < 5; ++frame) {
    const Atoms moved = shifted(atoms, 3.0 * frame, 0, 0);
    expect_ok(qses_set_positions(context, moved.positions.data(), 0, moved.size()));
    expect_ok(qses_begin(context, &s));
    expect_ok(qses_wait(context, -1, nullptr));
  }
  EXPECT_EQ(fetched(held, held.mesh.positions, before.size()), before);
  EXPECT_NE(collect_device(context).mesh.positions, held.mesh.positions);
}

TEST(DeviceMesh, TheBudgetCoversIt) {
  REQUIRE_DEVICE();
  const Atoms atoms = crambin();
  qses_settings s = settings(0.4);
  const Context unbounded(0, 0, QSES_BACKEND_CUDA);
  set_atoms(unbounded, atoms);
  const qses_mesh expected = compute_view(unbounded, s);
  s.delivery = QSES_DELIVERY_DEVICE;
  int refused = 0, made = 0;
  for (uint64_t budget = uint64_t(1) << 18; budget < (uint64_t(1) << 27); budget += budget / 2) {
    const Context context(0, budget, QSES_BACKEND_CUDA);
    set_atoms(context, atoms);
    for (int frame = 0; frame < 3; ++frame) {
      const qses_status status = qses_compute(context, &s, nullptr);
      if (status == QSES_OUT_OF_MEMORY) {
        ++refused;
        continue;
      }
      ASSERT_EQ(status, QSES_OK) << qses_last_error();
      ++made;
      EXPECT_LE(report_of(context).work_bytes_peak, budget);
      expect_same_mesh(collect_device(context), expected);
    }
  }
  EXPECT_GT(refused, 0);
  EXPECT_GT(made, 0);
}

// What is said to be the least budget does; and where one is refused, that is named which would.
TEST(DeviceMesh, TheLeastBudgetIsNamedWithTheMesh) {
  REQUIRE_DEVICE();
  const Atoms atoms = crambin();
  const Context unbounded(0, 0, QSES_BACKEND_CUDA);
  set_atoms(unbounded, atoms);
  for (const qses_delivery delivery : {QSES_DELIVERY_HOST, QSES_DELIVERY_DEVICE, QSES_DELIVERY_BOTH}) {
    SCOPED_TRACE(delivery);
    qses_settings s = settings(0.4);
    s.delivery = delivery;
    const qses_size_estimate e = estimate_of(unbounded, s);
    EXPECT_EQ(e.fits, 1);
    // Of further frames, the one that is held comes on top, if it is there.
    const uint64_t held = delivery == QSES_DELIVERY_HOST ? 0 : e.mesh_bytes + e.mesh_bytes / 8 + 4096;
    for (const uint64_t more : {uint64_t(0), held}) {
      const uint64_t budget = e.smallest_budget + more;
      const Context context(0, budget, QSES_BACKEND_CUDA);
      set_atoms(context, atoms);
      for (int frame = 0; frame < (more < held ? 1 : 3); ++frame) {
        ASSERT_EQ(qses_compute(context, &s, nullptr), QSES_OK) << qses_last_error();
        EXPECT_LE(report_of(context).work_bytes_peak, budget);
      }
    }
    // Once more by what the refusal says, which is rounded.
    const Context small(0, e.smallest_budget / 2, QSES_BACKEND_CUDA);
    set_atoms(small, atoms);
    ASSERT_EQ(qses_compute(small, &s, nullptr), QSES_OUT_OF_MEMORY);
    const std::string message = qses_last_error();
    double mib = 0;
    const size_t about = message.find("about ");
    ASSERT_NE(about, std::string::npos) << message;
    ASSERT_EQ(std::sscanf(message.c_str() + about, "about %lf MiB", &mib), 1) << message;
    const Context enough(0, static_cast<uint64_t>((mib + 0.05) * (1 << 20)), QSES_BACKEND_CUDA);
    set_atoms(enough, atoms);
    EXPECT_EQ(qses_compute(enough, &s, nullptr), QSES_OK) << qses_last_error() << " after: " << message;
  }
}

TEST(DeviceMesh, IsNotThereUnlessAskedFor) {
  REQUIRE_DEVICE();
  const Context context(0, 0, QSES_BACKEND_CUDA);
  set_atoms(context, crambin());
  qses_device_mesh mesh;
  qses_device_mesh_init(&mesh);
  EXPECT_EQ(qses_collect_device(context, &mesh), QSES_NO_RESULT);
  compute_view(context, settings(0.7));
  EXPECT_EQ(qses_collect_device(context, &mesh), QSES_INVALID_ARGUMENT);
  EXPECT_NE(std::string(qses_last_error()).find("settings.delivery"), std::string::npos);
}

}  // namespace
