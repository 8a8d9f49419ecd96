// SPDX-License-Identifier: MIT
// Frame after frame as in Unity: one thread that computes and submits, one that draws some frames later, and the
// library's own. What was drawn is the mesh of the frame, byte for byte.
#include "graphics/graphics_fixture.h"
#include "graphics/render_thread.h"
#include "process/patience.h"

#include <atomic>
#include <chrono>
#include <map>

using namespace graphics_fixture;

namespace {

constexpr unsigned kDistinctFrames = 37, kFrames = 300;

// A molecule that moves, with the ordinary mesh of each of its frames.
struct Movie {
  Movie(size_t atoms, unsigned seed, qses_vertex_layout layout) {
    settings = interleaved();
    settings.vertex_layout = layout;
    const CudaContext other;
    for (unsigned k = 0; k < kDistinctFrames; ++k) {
      frames.push_back(frame_of(cluster(atoms, seed), k));
      meshes.push_back(host_mesh(other, frames.back(), settings));
      vertices = std::max(vertices, meshes.back().vertex_count);
      triangles = std::max(triangles, meshes.back().triangle_count);
    }
  }
  uint32_t vertex_bytes() const { return settings.vertex_layout == QSES_VERTICES_COMPACT ? 16 : 24; }
  // On the thread that draws.
  void make_buffers(SurfaceBuffers *buffers) const { buffers->make(vertices, 3 * uint64_t(triangles), vertex_bytes()); }

  qses_settings settings;
  std::vector<Atoms> frames;
  std::vector<HostMesh> meshes;
  uint32_t vertices = 0, triangles = 0;  // of the largest
};

// What is done instead of drawing: the GPU reads the buffers, in its turn, and the CPU looks at that two frames later.
class Pictures {
 public:
  explicit Pictures(const Movie &movie) : movie_(movie) {
    for (Picture &picture : pictures_)
      picture.read.make(movie.vertices, 3 * uint64_t(movie.triangles), movie.vertex_bytes());
  }
  void take(const SurfaceBuffers &of, uint32_t frame) {
    Picture &picture = pictures_[next_++ % kUnderWay];
    look_at(&picture);
    const HostMesh &mesh = movie_.meshes[frame];
    copy(of.told.vertices, picture.read.told.vertices, mesh.vertices);
    copy(of.told.owners, picture.read.told.owners, mesh.owners);
    copy(of.told.indices, picture.read.told.indices, mesh.indices);
    picture.is_taken.set();
    picture.frame = frame;
    picture.is_full = true;
  }
  void finish() {
    for (Picture &picture : pictures_) {
      look_at(&picture);
      picture.read.end();
    }
  }
  unsigned right = 0, wrong = 0;

 private:
  static constexpr size_t kUnderWay = 2;
  struct Picture {
    SurfaceBuffers read;
    gl_without_window::Fence is_taken;
    uint32_t frame = 0;
    bool is_full = false;
  };
  static void copy(uint64_t from, uint64_t to, const std::vector<char> &as_much_as) {
    gl.CopyNamedBufferSubData(static_cast<unsigned>(from), static_cast<unsigned>(to), 0, 0,
                              static_cast<ptrdiff_t>(as_much_as.size()));
  }
  void look_at(Picture *picture) {
    if (!picture->is_full) return;
    picture->is_taken.wait();
    picture->is_full = false;
    const HostMesh &mesh = movie_.meshes[picture->frame];
    const bool is_right = holds(picture->read, picture->read.told.vertices, mesh.vertices) &&
                          holds(picture->read, picture->read.told.owners, mesh.owners) &&
                          holds(picture->read, picture->read.told.indices, mesh.indices);
    ++(is_right ? right : wrong);
  }

  const Movie &movie_;
  Picture pictures_[kUnderWay];
  size_t next_ = 0;
};

// A surface that a thread of its own submits frames of.
class Film {
 public:
  Film(size_t atoms, unsigned seed, qses_vertex_layout layout) : movie(atoms, seed, layout) {
    movie.settings.delivery = QSES_DELIVERY_DEVICE;
  }

  // ---- the thread that draws
  void start_drawing() {
    movie.make_buffers(&buffers);
    pictures = std::make_unique<Pictures>(movie);
  }
  // After an event: takes a picture, if the event had a mesh for this surface.
  void take_picture(int32_t event) {
    const qses_gpu_status status = target.status();
    if (status.done != event) return;
    if (status.status != QSES_OK) {
      ++failures;
      return;
    }
    pictures->take(buffers, frame_of_event(event));
    ++drawn;
  }
  void stop_drawing() {
    pictures->finish();
    buffers.end();
  }

  // ---- the thread that computes
  bool is_over() const { return drawn >= kFrames || failures > 0 || std::chrono::steady_clock::now() > last_moment_; }
  // A mesh that was computed by a job is submitted, and the next job begins, if that can be done now.
  void go_on() {
    try {
      if (has_mesh_ || collect()) submit();
    } catch (const std::exception &e) {
      ADD_FAILURE() << e.what();
      ++failures;
    }
    std::this_thread::yield();
  }

  Movie movie;
  const CudaContext context;
  const Kept kept;
  const Target target;
  SurfaceBuffers buffers;
  std::unique_ptr<Pictures> pictures;
  std::atomic<unsigned> drawn{0}, failures{0};

 private:
  bool collect() {
    qses_mesh mesh = empty_mesh();
    const qses_status status = qses_collect(context, &mesh);
    if (status == QSES_NOTHING_NEW) {
      qses_progress progress;
      qses_progress_init(&progress);
      expect_ok(qses_poll(context, &progress));
      if (progress.state == QSES_JOB_FAILED) throw std::runtime_error(progress.message);
      if (progress.state == QSES_JOB_IDLE) begin();
      return false;
    }
    expect_ok(status);
    shown_ = mesh.tag;
    expect_ok(qses_keep(context, kept));
    has_mesh_ = true;
    begin();
    return true;
  }
  void submit() {
    const std::lock_guard<std::mutex> lock(mutex_);
    int32_t event = 0;
    const qses_status status = qses_gpu_target_submit(target, kept, &buffers.told, &event);
    if (status == QSES_BUSY) return;
    expect_ok(status);
    submitted_[event] = shown_;
    has_mesh_ = false;
  }
  void begin() {
    next_ = (next_ + 1) % kDistinctFrames;
    movie.settings.tag = next_;
    set_atoms(context, movie.frames[next_]);
    expect_ok(qses_begin(context, &movie.settings));
  }
  uint32_t frame_of_event(int32_t event) {
    const std::lock_guard<std::mutex> lock(mutex_);
    // The newest that was submitted for this event or one before it.
    auto at = submitted_.upper_bound(event);
    return at == submitted_.begin() ? ~0u : std::prev(at)->second;
  }

  bool has_mesh_ = false;
  uint32_t next_ = 0, shown_ = 0;
  // Should no frame be drawn any more, the test ends all the same.
  const std::chrono::steady_clock::time_point last_moment_ = std::chrono::steady_clock::now() + kPatience;
  std::mutex mutex_;
  std::map<int32_t, uint32_t> submitted_;  // event, frame
};

class GpuFrames : public Graphics {
 protected:
  // The context goes to the thread that draws, and comes back.
  void play(const std::vector<Film *> &films, const std::function<void(RenderThread *)> &main) {
    gl_without_window::Context::release();
    {
      RenderThread render(*drawing_);
      std::atomic<bool> is_ready{false};
      render.draw([&] {
        for (Film *const film : films) film->start_drawing();
        is_ready = true;
      });
      while (!is_ready) std::this_thread::yield();
      main(&render);
      render.draw([&] {
        for (Film *const film : films) film->stop_drawing();
      });
    }
    drawing_->make_current();
    for (Film *const film : films) {
      EXPECT_EQ(film->failures, 0u);
      EXPECT_EQ(film->pictures->wrong, 0u);
      EXPECT_EQ(film->pictures->right, film->drawn);
      EXPECT_GE(film->drawn, kFrames);
      EXPECT_EQ(film->target.status().registrations, 5u);
    }
  }
};

void run_and_look(const std::vector<Film *> &films, int32_t event) {
  run_event(event);
  for (Film *const film : films) film->take_picture(event);
}

TEST_F(GpuFrames, AreDrawnAsTheyWereSubmitted) {
  for (const qses_vertex_layout layout : {QSES_VERTICES_INTERLEAVED, QSES_VERTICES_COMPACT}) {
    Film film(250, 1, layout);
    const std::vector<Film *> films = {&film};
    play(films, [&](RenderThread *render) {
      while (!film.is_over()) {
        film.go_on();
        if (const int32_t next = next_event()) render->draw([&films, next] { run_and_look(films, next); });
      }
    });
  }
}

// Several surfaces of one thread, all in one event per frame.
TEST_F(GpuFrames, OfSeveralSurfacesAreDrawnTogether) {
  std::vector<std::unique_ptr<Film>> owned;
  std::vector<Film *> films;
  for (unsigned k = 0; k < 4; ++k) {
    owned.push_back(std::make_unique<Film>(60 + 40 * k, k, QSES_VERTICES_INTERLEAVED));
    films.push_back(owned.back().get());
  }
  const auto is_over = [](const Film *film) { return film->is_over(); };
  play(films, [&](RenderThread *render) {
    while (!std::all_of(films.begin(), films.end(), is_over)) {
      for (Film *const film : films) film->go_on();
      if (const int32_t next = next_event()) render->draw([&films, next] { run_and_look(films, next); });
    }
  });
}

// Contexts with threads of their own, while another thread issues the events.
TEST_F(GpuFrames, OfSeveralThreadsAreDrawnTogether) {
  Film one(150, 1, QSES_VERTICES_INTERLEAVED), other(250, 2, QSES_VERTICES_COMPACT);
  const std::vector<Film *> films = {&one, &other};
  play(films, [&](RenderThread *render) {
    std::vector<std::thread> threads;
    std::atomic<int> running{0};
    for (Film *const film : films) {
      ++running;
      threads.emplace_back([film, &running] {
        while (!film->is_over()) film->go_on();
        --running;
      });
    }
    while (running > 0) {
      const int32_t next = next_event();
      if (next) render->draw([&films, next] { run_and_look(films, next); });
      if (!next) std::this_thread::yield();
    }
    for (std::thread &thread : threads) thread.join();
  });
}

// Events that never reach the thread that draws, as Unity drops some: the next one makes up for them.
TEST_F(GpuFrames, AreRightWhenEventsAreDropped) {
  Film film(150, 3, QSES_VERTICES_INTERLEAVED);
  const std::vector<Film *> films = {&film};
  play(films, [&](RenderThread *render) {
    std::mt19937 random(1);
    int32_t last = 0;
    while (!film.is_over()) {
      film.go_on();
      const int32_t next = next_event();
      if (next) last = next;
      // At times one that was dropped is issued later, so that it goes on when as many meshes wait as may.
      const bool is_issued = next ? random() % 3 != 0 : random() % 50 == 0;
      if (is_issued && last) render->draw([&films, last] { run_and_look(films, last); });
    }
  });
}

// Targets come and go while another thread runs events.
TEST_F(GpuFrames, TargetsEndWhileEventsRun) {
  const Atoms atoms = cluster(100, 4);
  const CudaContext context;
  const Kept kept;
  keep_on_device(context, atoms, interleaved(), kept);
  SurfaceBuffers buffers, others;
  buffers.make_for(kept.view());
  others.make_for(kept.view());
  const Target lasting;
  gl_without_window::Context::release();
  {
    RenderThread render(*drawing_);
    for (int round = 0; round < 200; ++round) {
      Target passing;
      passing.submit(kept, buffers);
      const qses_status status = qses_gpu_target_submit(lasting, kept, &others.told, nullptr);
      EXPECT_TRUE(status == QSES_OK || status == QSES_BUSY) << qses_last_error();
      const int32_t event = next_event();
      render.draw([event] { run_event(event); });
    }
  }
  drawing_->make_current();
  if (const int32_t event = next_event()) run_event(event);
  expect_done(lasting);
  expect_holds(others, host_mesh(atoms, interleaved()));
}

}  // namespace
