// SPDX-License-Identifier: MIT
// What a frame costs whose mesh goes to OpenGL on the GPU, and one that goes through host memory.
//   graphics_bench FRAMES FILE...
// Surfaces of 0.5 Å of atoms that move a little in each frame, drawn in 1920 x 1080. Medians of FRAMES, in ms. Not a
// test: times are printed.
#include "graphics/bench_scene.h"
#include "graphics/gl_without_window.h"
#include "graphics/render_thread.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using bench_scene::Scene;
using bench_scene::View;
using gl_without_window::gl;
using Clock = std::chrono::steady_clock;

constexpr int kWarmUp = 10;
constexpr unsigned kDistinctFrames = 16;

void expect_ok(qses_status status) {
  if (status != QSES_OK) throw std::runtime_error(qses_last_error());
}

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// Of all but the first ones, in which memory is taken and buffers are made known.
struct Times {
  std::vector<double> all;
  void add(double ms) { all.push_back(ms); }
  double median() const {
    std::vector<double> some(all.begin() + std::min<ptrdiff_t>(kWarmUp, static_cast<ptrdiff_t>(all.size())), all.end());
    if (some.empty()) return 0;
    std::sort(some.begin(), some.end());
    return some[some.size() / 2];
  }
};

// ---- what is drawn

struct Molecule {
  std::string name;
  std::vector<float> radii;
  std::vector<uint8_t> colors;
  std::vector<std::vector<float>> frames;  // positions

  size_t size() const { return radii.size(); }
};

Molecule molecule_of(const float *positions, const float *radii, size_t n) {
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
Molecule load(const std::string &path, size_t most = ~size_t(0)) {
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

int32_t next_event() {
  int32_t event = 0;
  expect_ok(qses_gpu_next_event(&event));
  return event;
}

// Lets go of the targets that ended.
void end_targets() {
  if (const int32_t event = next_event()) qses_gpu_event_function()(event);
}

// ---- the way through host memory

struct Arrays {
  const char *vertices, *colors, *indices;
  size_t vertex_bytes, color_bytes, index_bytes;
};

Arrays arrays_of(const Surface &surface) {
  return {reinterpret_cast<const char *>(surface.mesh.positions),
          reinterpret_cast<const char *>(surface.mesh.colors),
          reinterpret_cast<const char *>(surface.mesh.indices),
          surface.vertex_bytes(),
          surface.color_bytes(),
          surface.index_bytes()};
}

// A copy in ordinary memory, as a Mesh of Unity has one.
Arrays copied(const Arrays &from, std::vector<char> *into) {
  const size_t all = from.vertex_bytes + from.color_bytes + from.index_bytes;
  if (into->size() < all) into->resize(all + all / 4);
  char *const vertices = into->data(), *const colors = vertices + from.vertex_bytes,
              *const indices = colors + from.color_bytes;
  std::memcpy(vertices, from.vertices, from.vertex_bytes);
  std::memcpy(colors, from.colors, from.color_bytes);
  std::memcpy(indices, from.indices, from.index_bytes);
  return {vertices, colors, indices, from.vertex_bytes, from.color_bytes, from.index_bytes};
}

void upload(const Arrays &from, const qses_gpu_buffers &to) {
  const auto give = [](uint64_t name, const char *data, size_t bytes) {
    gl.NamedBufferSubData(static_cast<unsigned>(name), 0, static_cast<ptrdiff_t>(bytes), data);
  };
  give(to.vertices, from.vertices, from.vertex_bytes);
  give(to.colors, from.colors, from.color_bytes);
  give(to.indices, from.indices, from.index_bytes);
}

// ---- one frame after the other, everything waited for

enum class Way { kGpu, kPinned, kPageable };

struct Serial {
  Times frame, compute, hand_over, copy, draw;
};

Serial measure_serial(const Molecule &molecule, Way way, int frames) {
  Scene scene;
  Surface surface(molecule, way == Way::kGpu);
  surface.compute();
  surface.make_buffers();
  std::vector<char> pageable;
  Serial times;
  for (int f = 0; f < kWarmUp + frames; ++f) {
    gl.Finish();
    const auto start = Clock::now();
    surface.set_frame(static_cast<unsigned>(f));
    const auto computing = Clock::now();
    surface.compute();
    times.compute.add(ms_since(computing));
    const View view(surface.mesh);
    const uint32_t indices = 3 * surface.mesh.triangle_count;
    const auto handing_over = Clock::now();
    if (way == Way::kGpu) {
      surface.keep();
      if (!surface.submit()) throw std::runtime_error("the mesh before is still waiting");
      qses_gpu_event_function()(next_event());
    } else {
      upload(way == Way::kPageable ? copied(arrays_of(surface), &pageable) : arrays_of(surface), surface.buffers);
    }
    times.hand_over.add(ms_since(handing_over));
    scene.draw(surface.buffers, view, indices);
    gl.Finish();
    times.frame.add(ms_since(start));
    times.draw.add(scene.draw_ms());
    if (way == Way::kGpu) times.copy.add(static_cast<double>(surface.status().copy_ms));
  }
  surface.end_buffers();
  return times;
}

// ---- three threads

struct Threaded {
  Times main, render, between;
};

Threaded measure_threaded(const Molecule &molecule, bool on_gpu, int frames, gl_without_window::Context *context) {
  Surface surface(molecule, on_gpu);
  surface.compute();
  surface.make_buffers();
  gl.Finish();
  gl_without_window::Context::release();
  Threaded times;
  {
    std::unique_ptr<Scene> scene;
    gl_without_window::Fence fences[2];
    std::vector<char> staging[4];  // more than may be under way
    graphics_fixture::RenderThread render(*context);
    render.draw([&] { scene = std::make_unique<Scene>(); });
    auto last = Clock::now();
    unsigned begun = 0;
    const auto begin = [&] {
      surface.set_frame(begun++);
      surface.begin();
    };
    begin();
    for (int f = 0; f < kWarmUp + frames;) {
      if (!surface.collect()) {
        std::this_thread::yield();
        continue;
      }
      const View view(surface.mesh);
      const uint32_t indices = 3 * surface.mesh.triangle_count;
      auto working = Clock::now();
      int32_t event = 0;
      Arrays arrays{};
      double main_ms = 0;
      if (on_gpu) {
        surface.keep();
        begin();
        main_ms = ms_since(working);
        do {  // waiting for the thread that draws is no work
          working = Clock::now();
        } while (!surface.submit());
        event = next_event();
      } else {
        begin();
        arrays = copied(arrays_of(surface), &staging[f % 4]);
      }
      times.main.add(main_ms + ms_since(working));
      render.draw([&, view, indices, event, arrays, f] {
        fences[f % 2].wait();  // as a swap chain of two pictures
        const auto drawing = Clock::now();
        if (on_gpu)
          qses_gpu_event_function()(event);
        else
          upload(arrays, surface.buffers);
        times.render.add(ms_since(drawing));
        scene->draw(surface.buffers, view, indices);
        fences[f % 2].set();
        times.between.add(ms_since(last));
        last = Clock::now();
      });
      ++f;
    }
    render.draw([&] {
      for (gl_without_window::Fence &fence : fences) fence.wait();
      scene = nullptr;
    });
    render.finish();
  }
  context->make_current();
  if (on_gpu) surface.status();
  surface.end_buffers();
  return times;
}

// ---- many small surfaces

struct Many {
  Times all, events;
};

constexpr int kSurfaces = 16;

Many measure_many(const std::vector<std::unique_ptr<Surface>> &surfaces, int events, int frames) {
  unsigned sink = 0;
  gl.CreateBuffers(1, &sink);
  gl.NamedBufferData(sink, 256, nullptr, gl_without_window::kDynamicDraw);
  Many times;
  for (int f = 0; f < kWarmUp + frames; ++f) {
    for (const auto &surface : surfaces) {
      surface->compute();
      surface->keep();
    }
    gl.Finish();
    const auto start = Clock::now();
    double in_events = 0;
    for (int k = 0; k < kSurfaces && events > 0; ++k) {
      if (!surfaces[static_cast<size_t>(k)]->submit()) throw std::runtime_error("a mesh before is still waiting");
      if ((k + 1) % (kSurfaces / events) != 0) continue;
      const auto running = Clock::now();
      qses_gpu_event_function()(next_event());
      in_events += ms_since(running);
    }
    for (const auto &surface : surfaces)  // OpenGL uses them
      for (const uint64_t name : {surface->buffers.vertices, surface->buffers.colors, surface->buffers.indices})
        gl.CopyNamedBufferSubData(static_cast<unsigned>(name), sink, 0, 0, 256);
    gl.Finish();
    times.all.add(ms_since(start));
    times.events.add(in_events);
  }
  gl.DeleteBuffers(1, &sink);
  for (const auto &surface : surfaces) surface->status();
  return times;
}

void print_many(const std::string &path, int frames) {
  constexpr size_t kAtoms = 550;
  const Molecule part = load(path, kAtoms);
  std::vector<std::unique_ptr<Surface>> surfaces;
  double mb = 0;
  for (int k = 0; k < kSurfaces; ++k) {
    surfaces.push_back(std::make_unique<Surface>(part, true));
    surfaces.back()->compute();
    surfaces.back()->make_buffers();
    mb = 1e-6 * static_cast<double>(surfaces.back()->bytes());
  }
  std::printf("\n%d surfaces of %.2f MB, from their meshes to the end of the frame (of it in events, on the CPU)\n",
              kSurfaces, mb);
  for (const int events : {0, 1, kSurfaces}) {
    const Many times = measure_many(surfaces, events, frames);
    std::printf("  %-18s %7.3f (%.3f)\n",
                events == 0   ? "nothing copied"
                : events == 1 ? "one event for all"
                              : "one event each",
                times.all.median(), times.events.median());
    std::fflush(stdout);
  }
  for (const auto &surface : surfaces) surface->end_buffers();
}

}  // namespace

int main(int argc, char **argv) try {
  if (argc < 3 || std::atoi(argv[1]) < 1) throw std::runtime_error("usage: graphics_bench FRAMES FILE...");
  const int frames = std::atoi(argv[1]);
  expect_ok(qses_gpu_check_graphics(QSES_GRAPHICS_OPENGL));
  gl_without_window::Context context;
  context.make_current();
  std::printf("%s, medians of %d frames, ms\n",
              reinterpret_cast<const char *>(gl.GetString(gl_without_window::kRenderer)), frames);
  std::fflush(stdout);
  std::vector<Molecule> molecules;
  for (int k = 2; k < argc; ++k) molecules.push_back(load(argv[k]));
  std::printf(
      "\none frame, everything waited for\n%-8s %8s %8s %8s %8s   of GPU: compute, event on the CPU, copy, draw\n", "",
      "MB", "GPU", "pinned", "pageable");
  for (const Molecule &molecule : molecules) {
    double mb = 0;
    {
      Surface surface(molecule, true);
      surface.compute();
      mb = 1e-6 * static_cast<double>(surface.bytes());
    }
    const Serial gpu = measure_serial(molecule, Way::kGpu, frames),
                 pinned = measure_serial(molecule, Way::kPinned, frames),
                 pageable = measure_serial(molecule, Way::kPageable, frames);
    end_targets();
    std::printf("%-8s %8.1f %8.2f %8.2f %8.2f   %.2f %.3f %.3f %.2f\n", molecule.name.c_str(), mb, gpu.frame.median(),
                pinned.frame.median(), pageable.frame.median(), gpu.compute.median(), gpu.hand_over.median(),
                gpu.copy.median(), gpu.draw.median());
    std::fflush(stdout);
  }
  std::printf("\nthree threads: GPU / host pageable\n%-8s %19s %19s %19s\n", "", "main", "render", "between frames");
  for (const Molecule &molecule : molecules) {
    const Threaded gpu = measure_threaded(molecule, true, frames, &context),
                   pageable = measure_threaded(molecule, false, frames, &context);
    end_targets();
    std::printf("%-8s %9.3f /%8.3f %9.3f /%8.3f %9.3f /%8.3f\n", molecule.name.c_str(), gpu.main.median(),
                pageable.main.median(), gpu.render.median(), pageable.render.median(), gpu.between.median(),
                pageable.between.median());
    std::fflush(stdout);
  }
  print_many(argv[2], frames);
  end_targets();
  gl_without_window::Context::release();
  return 0;
} catch (const std::exception &e) {
  std::fprintf(stderr, "graphics_bench: %s\n", e.what());
  return 1;
}
