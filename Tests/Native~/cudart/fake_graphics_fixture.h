// SPDX-License-Identifier: MIT
// For tests of the graphics event with the fake driver: meshes on its GPU, buffers of its graphics APIs, what was asked
// of it.
#pragma once

#include "capi/capi_fixture.h"
#include "capi/context.h"
#include "cudart/fake_driver_functions.h"
#include "graphics/long_gpu_patience.h"
#include "parallel/cuda_memory.h"
#include "quickses/quickses_gpu.h"
#include "surface/mesh/mesh_memory.h"

#if defined(_WIN32)
#include "cudart/fake_direct3d11.h"
#endif

#include <algorithm>
#include <memory>
#include <sstream>

namespace fake_driver {

using namespace capi_fixture;
using Bytes = std::vector<unsigned char>;

// ---- a mesh on a device, which none of its kernels could make: bytes that tell where they belong

class HandMadeMesh {
 public:
  explicit HandMadeMesh(unsigned char seed, uint32_t vertices = 5, uint32_t triangles = 4, int device = 0,
                        bool painted = false, qses_vertex_layout layout = QSES_VERTICES_INTERLEAVED) {
    quickses::MeshShape shape;
    shape.layout = layout;
    shape.colors = shape.texcoords = painted;
    const quickses::MeshArrays arrays(vertices, triangles, shape);
    pool_ = std::make_shared<quickses::MeshPool>(memory_of(device));
    auto made = std::make_shared<quickses::DeviceMesh>();
    made->shape = shape;
    made->atom_count = kAtoms;
    qses_device_mesh_init(&made->view);
    made->view.device = device;
    made->view.mesh.vertex_count = vertices;
    made->view.mesh.triangle_count = triangles;
    if (vertices > 0) {
      made->memory = quickses::MeshLease(pool_, arrays.bytes());
      auto *const memory = static_cast<unsigned char *>(made->memory.memory());  // the fake's is the host's
      for (size_t k = 0; k < arrays.bytes(); ++k) memory[k] = static_cast<unsigned char>(seed + 7 * k);
      quickses::point_at(arrays.view(memory), shape, &made->view.mesh);
      bytes_.assign(memory, memory + arrays.bytes());
      const quickses::MeshView copy = arrays.view(bytes_.data());
      qses_mesh_init(&here_);
      quickses::point_at(copy, shape, &here_);
    }
    here_.vertex_count = vertices;
    here_.triangle_count = triangles;
    watch_ = made;
    kept_.held.on_device = std::move(made);
    kept_.held.atom_count = kAtoms;
    kept_.held.is_full = true;
  }
  HandMadeMesh(const HandMadeMesh &) = delete;
  HandMadeMesh &operator=(const HandMadeMesh &) = delete;

  static constexpr size_t kAtoms = 3;
  operator const qses_kept_mesh *() const { return &kept_; }
  // A copy of it that the device can't reach.
  const qses_mesh &here() const { return here_; }
  // What was kept is let go, and the pool of its memory with it.
  void let_go() {
    kept_.held.clear();
    pool_->close();
  }
  // Whether anyone has it still.
  bool is_held() const { return !watch_.expired(); }
  // Who is to be waited for before its memory is written again; forgets it.
  std::shared_ptr<const quickses::StreamMark> take_readers() {
    return const_cast<quickses::DeviceMesh &>(*kept_.held.on_device).memory.take_readers();
  }

 private:
  static quickses::MeshPool::Source memory_of(int device) {
    return {"the fake GPU",
            [device](size_t bytes) {
              const quickses::DeviceGuard guard(device);
              return quickses::DeviceMemory::acquire(bytes);
            },
            [](quickses::MeshBuffer &buffer) {
              buffer.readers.reset();
              quickses::DeviceMemory::release(buffer.memory);
            },
            2};
  }

  std::shared_ptr<quickses::MeshPool> pool_;
  qses_kept_mesh kept_;
  std::weak_ptr<const quickses::DeviceMesh> watch_;
  Bytes bytes_;
  qses_mesh here_ = empty_mesh();
};

// ---- buffers

#if defined(_WIN32)
inline FakeDirect3D11Device &direct3d11_device() {
  static FakeDirect3D11Device device;
  return device;
}
#endif

// Says which CUDA device draws; -1: none does.
inline void draw_on(int device) {
#if defined(_WIN32)
  void *const d3d = direct3d11_device().as_device();
#else
  void *const d3d = nullptr;
#endif
  tell_driver("fake_graphics_draw_on", device, d3d);
}

class Buffer {
 public:
  Buffer(qses_graphics api, int number, unsigned bytes) : key_(static_cast<uint64_t>(number)) {
#if defined(_WIN32)
    if (api == QSES_GRAPHICS_D3D11) {
      d3d_ = std::make_unique<FakeDirect3D11Buffer>(direct3d11_device(), bytes);
      key_ = reinterpret_cast<uintptr_t>(static_cast<ID3D11Resource *>(d3d_.get()));
    }
#else
    EXPECT_EQ(api, QSES_GRAPHICS_OPENGL);
#endif
    make_anew(number, bytes);
  }
  void make_anew(int number, unsigned bytes) const { tell_driver("fake_graphics_make", key_, number, bytes); }
  void spoil() const { tell_driver("fake_graphics_spoil", key_); }
  uint64_t key() const { return key_; }
  Bytes first(size_t bytes) const {
    Bytes out(bytes);
    void *const to = out.data();
    EXPECT_EQ(tell_driver("fake_graphics_read", key_, to, static_cast<unsigned>(bytes)), 1) << "it has less";
    return out;
  }
#if defined(_WIN32)
  D3D11_BUFFER_DESC &description() const { return d3d_->description; }

 private:
  std::unique_ptr<FakeDirect3D11Buffer> d3d_;
#endif

 private:
  uint64_t key_;
};

// ---- a target with buffers for 8 vertices of any layout and 8 triangles

class DrawnSurface {
 public:
  // The buffers have numbers from `first` on: vertices, indices, and if all are wanted colours, owners and texcoords.
  DrawnSurface(qses_graphics api, int first, bool all = false) : api_(api), first_(first), all_(all) {
    status_ = qses_gpu_target_create(&target_);
    qses_gpu_buffers_init(&to);
    to.graphics = api;
    to.vertex_capacity = kVertices;
    to.index_capacity = 3 * kTriangles;
    make_buffers(first);
  }
  DrawnSurface(const DrawnSurface &) = delete;
  DrawnSurface &operator=(const DrawnSurface &) = delete;
  ~DrawnSurface() { destroy(); }

  static constexpr unsigned kVertices = 8, kTriangles = 8;

  // Other buffers, as another generation. The former ones stay until the end.
  void make_buffers(int first) {
    for (auto &buffer : buffers_) former_.push_back(std::move(buffer));
    buffers_.clear();
    const unsigned sizes[] = {24 * kVertices, 12 * kTriangles, 4 * kVertices, 4 * kVertices, 8 * kVertices};
    uint64_t *const places[] = {&to.vertices, &to.indices, &to.colors, &to.owners, &to.texcoords};
    for (int k = 0; k < (all_ ? 5 : 2); ++k) {
      buffers_.push_back(std::make_unique<Buffer>(api_, first + k, sizes[k]));
      *places[k] = buffers_.back()->key();
    }
    ++to.generation;
  }
  const Buffer &vertices() const { return *buffers_[0]; }
  const Buffer &indices() const { return *buffers_[1]; }
  const Buffer &colors() const { return *buffers_[2]; }
  const Buffer &owners() const { return *buffers_[3]; }
  const Buffer &texcoords() const { return *buffers_[4]; }

  qses_status submit(const qses_kept_mesh *mesh, int32_t *event = nullptr) const {
    return target_ ? qses_gpu_target_submit(target_, mesh, &to, event) : status_;
  }
  qses_gpu_status status() const {
    qses_gpu_status status;
    qses_gpu_status_init(&status);
    EXPECT_EQ(qses_gpu_target_status(target_, &status), QSES_OK) << qses_last_error();
    return status;
  }
  qses_gpu_target *target() const { return target_; }
  void destroy() {
    qses_gpu_target_destroy(target_);
    target_ = nullptr;
  }

  void expect_shows(const HandMadeMesh &made) const {
    const qses_mesh &mesh = made.here();
    EXPECT_EQ(mesh.vertex_bytes > 0, mesh.vertex_count > 0) << "nothing is compared";
    expect_has(vertices(), mesh.positions, size_t(mesh.vertex_count) * mesh.vertex_bytes, "vertices");
    expect_has(indices(), mesh.indices, 12 * size_t(mesh.triangle_count), "indices");
    if (all_) expect_has(owners(), mesh.owners, 4 * size_t(mesh.vertex_count), "owners");
    if (all_ && mesh.colors) expect_has(colors(), mesh.colors, 4 * size_t(mesh.vertex_count), "colors");
    if (all_ && mesh.texcoords) expect_has(texcoords(), mesh.texcoords, 8 * size_t(mesh.vertex_count), "texcoords");
  }
  void expect_status(qses_status expected, std::initializer_list<const char *> words) const {
    const qses_gpu_status now = status();
    EXPECT_EQ(now.status, expected) << now.message;
    EXPECT_EQ(now.message[0] == 0, expected == QSES_OK) << now.message;
    for (const char *word : words)
      EXPECT_NE(std::string(now.message).find(word), std::string::npos) << '"' << now.message << "\" lacks " << word;
  }

  qses_gpu_buffers to;

 private:
  static void expect_has(const Buffer &buffer, const void *expected, size_t bytes, const char *what) {
    const auto *const first = static_cast<const unsigned char *>(expected);
    EXPECT_EQ(buffer.first(bytes), Bytes(first, first + bytes)) << what;
  }

  const qses_graphics api_;
  const int first_;
  const bool all_;
  qses_status status_;
  qses_gpu_target *target_ = nullptr;
  std::vector<std::unique_ptr<Buffer>> buffers_, former_;
};

// Colours for all atoms, and the second of them hidden.
inline void paint_and_hide(const DrawnSurface &surface) {
  const std::vector<uint8_t> colors(4 * HandMadeMesh::kAtoms, 1), visible = {1, 0, 1};
  qses_gpu_look look;
  qses_gpu_look_init(&look);
  look.atom_count = HandMadeMesh::kAtoms;
  look.colors = colors.data();
  look.visible = visible.data();
  expect_ok(qses_gpu_target_set_look(surface.target(), &look));
}

// ---- events

// As the thread that draws.
inline void issue(int32_t event) {
  tell_driver("fake_graphics_draw_here", 1);
  qses_gpu_event_function()(event);
  tell_driver("fake_graphics_draw_here", 0);
}

// Has the event run that is to run now. Returns its number; 0: there is none.
inline int32_t draw() {
  int32_t event = 0;
  EXPECT_EQ(qses_gpu_next_event(&event), QSES_OK) << qses_last_error();
  if (event > 0) issue(event);
  return event;
}

// The calls since the last time. Buffers in the order of their numbers; without the question which device draws.
inline std::vector<std::string> calls() {
  std::istringstream log(tell_driver<const char *>("fake_graphics_log"));
  std::vector<std::string> found;
  for (std::string line; std::getline(log, line);) {
    if (line.find("GetDevices") != std::string::npos) continue;
    std::istringstream words(line);
    std::string name;
    words >> name;
    if (name == "Map" || name == "Unmap") {
      std::vector<int> numbers;
      for (int number; words >> number;) numbers.push_back(number);
      std::sort(numbers.begin(), numbers.end());
      words.clear();
      std::string rest;
      std::getline(words, rest);
      line = name;
      for (const int number : numbers) line += " " + std::to_string(number);
      if (!rest.empty()) line += " " + rest;
    }
    found.push_back(line);
  }
  return found;
}

// The calls since the last time are these: of each group in any order, the groups one after the other.
inline void expect_calls(std::vector<std::vector<std::string>> groups) {
  std::vector<std::string> found = calls(), expected;
  size_t begin = 0;
  for (std::vector<std::string> &group : groups) {
    const size_t end = std::min(found.size(), begin + group.size());
    std::sort(found.begin() + static_cast<std::ptrdiff_t>(begin), found.begin() + static_cast<std::ptrdiff_t>(end));
    std::sort(group.begin(), group.end());
    expected.insert(expected.end(), group.begin(), group.end());
    begin = end;
  }
  EXPECT_EQ(found, expected);
}

// One call each.
inline std::vector<std::string> each(const std::string &name, int first, int last) {
  std::vector<std::string> calls;
  for (int number = first; number <= last; ++number) calls.push_back(name + " " + std::to_string(number));
  return calls;
}
inline std::string all(const std::string &name, int first, int last) {
  std::string call = name;
  for (int number = first; number <= last; ++number) call += " " + std::to_string(number);
  return call;
}
// How buffers are made known for writing only. Flags 2: what they had is discarded.
inline std::vector<std::string> registering(qses_graphics api, int first, int last) {
  std::vector<std::string> calls;
  for (int number = first; number <= last; ++number) {
    const std::string n = std::to_string(number);
    if (api == QSES_GRAPHICS_OPENGL) {
      calls.push_back("GLRegisterBuffer " + n + " flags 2");
    } else {
      calls.push_back("D3D11RegisterResource " + n + " flags 0");
      calls.push_back("SetMapFlags " + n + " flags 2");
    }
  }
  return calls;
}

// ---- what a test begins and ends with

// From now on no call fails. Where those did that give a thread its former context back, it has none again.
inline void stop_failing() {
  fail_after(-1, 0);
  tell_driver("fake_driver_drop_context");
}

inline std::vector<qses_graphics> graphics_apis() {
#if defined(_WIN32)
  return {QSES_GRAPHICS_OPENGL, QSES_GRAPHICS_D3D11};
#else
  return {QSES_GRAPHICS_OPENGL};
#endif
}

inline std::string name_of_api(const testing::TestParamInfo<qses_graphics> &info) {
  return info.param == QSES_GRAPHICS_OPENGL ? "OpenGL" : "Direct3D11";
}

// Of one graphics API. Device 0 draws; in the end nothing is registered any more.
template <class Parameter>
class GraphicsTest : public testing::TestWithParam<Parameter> {
 protected:
  void SetUp() override {
    REQUIRE_DRIVER("graphics");
    ASSERT_EQ(qses_gpu_check_graphics(api()), QSES_OK) << qses_last_error();  // loads it
    draw_on(0);
    calls();
    is_loaded_ = true;
  }
  void TearDown() override {
    if (!is_loaded_) return;
    stop_failing();
    draw();
    EXPECT_EQ(tell_driver("fake_graphics_registered"), 0);
    EXPECT_EQ(tell_driver("fake_driver_has_context"), 0) << "the thread was left with a context of CUDA";
#if defined(_WIN32)
    EXPECT_EQ(direct3d11_device().held_by(), 1u);
#endif
  }
  virtual qses_graphics api() const = 0;

 private:
  const LongGpuPatience patience_;
  bool is_loaded_ = false;
};

class GraphicsTestOfApi : public GraphicsTest<qses_graphics> {
 protected:
  qses_graphics api() const override { return GetParam(); }
};

}  // namespace fake_driver
