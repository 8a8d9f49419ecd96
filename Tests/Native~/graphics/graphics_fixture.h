// SPDX-License-Identifier: MIT
// What the tests of meshes that go to OpenGL share: buffers of a surface, targets, and what the buffers should hold.
#pragma once

#include "capi/device_mesh_fixture.h"
#include "graphics/gl_without_window.h"
#include "graphics/long_gpu_patience.h"

#include "quickses/quickses_gpu.h"

namespace graphics_fixture {

using namespace device_mesh_fixture;
using gl_without_window::gl;
using gl_without_window::read_buffer;

inline std::string why_no_graphics() { return has_device() ? gl_without_window::refusal() : "no CUDA device"; }

// What buffers hold before anything was copied there.
constexpr char kUntouched = 0x5a;

// The buffers of one surface.
class SurfaceBuffers {
 public:
  SurfaceBuffers() = default;
  ~SurfaceBuffers() { end(); }
  SurfaceBuffers(const SurfaceBuffers &) = delete;
  SurfaceBuffers &operator=(const SurfaceBuffers &) = delete;

  // New ones, with a new generation. room: for which the real buffers are made, if that is not what is told.
  void make(uint64_t vertices, uint64_t indices, uint64_t vertex_bytes = 24, double room = 1.0) {
    end();
    qses_gpu_buffers_init(&told);
    told.vertex_capacity = vertices;
    told.index_capacity = indices;
    told.generation = ++generation_;
    const auto make_one = [&](uint64_t *name, uint64_t bytes) {
      const std::vector<char> nothing(static_cast<size_t>(static_cast<double>(bytes) * room), kUntouched);
      unsigned buffer = 0;
      gl.CreateBuffers(1, &buffer);
      gl.NamedBufferData(buffer, static_cast<ptrdiff_t>(nothing.size()), nothing.data(),
                         gl_without_window::kDynamicDraw);
      *name = buffer;
    };
    make_one(&told.vertices, vertices * vertex_bytes);
    make_one(&told.colors, vertices * 4);
    make_one(&told.owners, vertices * 4);
    make_one(&told.texcoords, vertices * 8);
    make_one(&told.indices, indices * 4);
  }
  // A quarter more than the mesh needs.
  void make_for(const qses_mesh &mesh) {
    make(mesh.vertex_count + mesh.vertex_count / 4 + 8, 3 * (mesh.triangle_count + mesh.triangle_count / 4 + 8),
         mesh.vertex_bytes ? mesh.vertex_bytes : 24);
  }
  // The names are not used any more; what was told stays.
  void end() {
    for (const uint64_t name : {told.vertices, told.colors, told.owners, told.texcoords, told.indices}) {
      const auto buffer = static_cast<unsigned>(name);
      if (buffer) gl.DeleteBuffers(1, &buffer);
    }
    told.vertices = told.colors = told.owners = told.texcoords = told.indices = 0;
  }
  // They went with their context.
  void forget() { told.vertices = told.colors = told.owners = told.texcoords = told.indices = 0; }

  std::vector<char> read(uint64_t name, size_t bytes) const { return read_buffer(static_cast<unsigned>(name), bytes); }
  bool are_untouched() const {
    const std::vector<char> vertices = read(told.vertices, static_cast<size_t>(told.vertex_capacity) * 4),
                            indices = read(told.indices, static_cast<size_t>(told.index_capacity) * 4);
    const auto is_touched = [](char c) { return c != kUntouched; };
    return std::none_of(vertices.begin(), vertices.end(), is_touched) &&
           std::none_of(indices.begin(), indices.end(), is_touched);
  }

  qses_gpu_buffers told{};

 private:
  uint32_t generation_ = 0;
};

inline bool holds(const SurfaceBuffers &buffers, uint64_t name, const std::vector<char> &expected) {
  return buffers.read(name, expected.size()) == expected;
}

inline void expect_holds(const SurfaceBuffers &buffers, const HostMesh &mesh) {
  EXPECT_GT(mesh.vertices.size(), 0u);
  EXPECT_TRUE(holds(buffers, buffers.told.vertices, mesh.vertices));
  EXPECT_TRUE(holds(buffers, buffers.told.owners, mesh.owners));
  EXPECT_TRUE(holds(buffers, buffers.told.indices, mesh.indices));
  EXPECT_EQ(gl.GetError(), gl_without_window::kNoError);
}

// A target that ends with the scope.
class Target {
 public:
  Target() { expect_ok(qses_gpu_target_create(&target_)); }
  ~Target() { end(); }
  Target(const Target &) = delete;
  Target &operator=(const Target &) = delete;
  operator qses_gpu_target *() const { return target_; }

  void end() {
    qses_gpu_target_destroy(target_);
    target_ = nullptr;
  }
  qses_gpu_status status() const {
    qses_gpu_status status;
    qses_gpu_status_init(&status);
    expect_ok(qses_gpu_target_status(target_, &status));
    return status;
  }
  // With the number of the event.
  int32_t submit(qses_kept_mesh *kept, const SurfaceBuffers &buffers) const {
    int32_t event = 0;
    expect_ok(qses_gpu_target_submit(target_, kept, &buffers.told, &event));
    return event;
  }

 private:
  qses_gpu_target *target_ = nullptr;
};

inline int32_t next_event() {
  int32_t event = -1;
  expect_ok(qses_gpu_next_event(&event));
  return event;
}

inline void run_event(int32_t event) { qses_gpu_event_function()(event); }

// What was submitted is done on this thread, which draws.
inline void run_next_event() {
  const int32_t event = next_event();
  ASSERT_NE(event, 0) << "nothing was submitted";
  run_event(event);
}

inline void expect_done(const Target &target) {
  const qses_gpu_status status = target.status();
  EXPECT_EQ(status.status, QSES_OK) << status.message;
  EXPECT_STREQ(status.message, "");
  EXPECT_EQ(status.done, status.submitted);
  EXPECT_EQ(status.waiting, 0u);
}

// The last event failed for this target, with a sentence.
inline void expect_failed(const Target &target) {
  const qses_gpu_status status = target.status();
  EXPECT_NE(status.status, QSES_OK);
  EXPECT_NE(std::string(status.message), "");
  EXPECT_EQ(status.done, status.submitted);
}

// A context of OpenGL is current on the test's thread.
class Graphics : public testing::Test {
 protected:
  void SetUp() override {
    const std::string why = why_no_graphics();
    if (!why.empty()) GTEST_SKIP() << why;
    drawing_ = std::make_unique<gl_without_window::Context>();
    drawing_->make_current();
  }
  void TearDown() override {
    if (!drawing_) return;
    if (const int32_t event = next_event()) run_event(event);  // lets go of what the targets had
    EXPECT_EQ(gl.GetError(), gl_without_window::kNoError);
    gl_without_window::Context::release();
  }
  // The context goes, with all its buffers, and another one comes.
  void lose_context() {
    gl_without_window::Context::release();
    drawing_ = nullptr;
  }
  void make_context() {
    drawing_ = std::make_unique<gl_without_window::Context>();
    drawing_->make_current();
  }

  std::unique_ptr<gl_without_window::Context> drawing_;

 private:
  const LongGpuPatience patience_;
};

}  // namespace graphics_fixture
