// SPDX-License-Identifier: MIT
// What a busy thread of a program loses to jobs that run beside it.   busy_thread_bench FILE [SECONDS [cpu|cuda]]
// Frames of a fixed amount of work, one after the other: by themselves, then beside a context that computes surfaces
// all the time, as contexts are by default, then with qses_context_options.background. Not a test: times are printed.
#include "quickses/quickses.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;

void expect_ok(qses_status status) {
  if (status != QSES_OK) throw std::runtime_error(qses_last_error());
}

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// Some milliseconds of a thread that has a core to itself.
uint32_t frame_of_work(uint32_t seed) {
  for (int k = 0; k < 2000000; ++k) {
    seed ^= seed << 13;
    seed ^= seed >> 17;
    seed ^= seed << 5;
  }
  return seed;
}

class Jobs {
 public:
  Jobs(const qses_structure_description &atoms, qses_backend backend, bool background) {
    qses_context_options options;
    qses_context_options_init(&options);
    options.backend = backend;
    options.background = background ? 1 : 0;
    expect_ok(qses_context_create(&options, &context_));
    expect_ok(qses_set_atoms(context_, atoms.positions, 0, atoms.radii, atoms.atom_count));
    qses_settings_init(&settings_);
    settings_.level_count = 0;
    begin();
  }
  ~Jobs() { qses_context_destroy(context_); }
  Jobs(const Jobs &) = delete;
  Jobs &operator=(const Jobs &) = delete;

  void poll() {
    qses_mesh mesh;
    qses_mesh_init(&mesh);
    if (qses_collect(context_, &mesh) != QSES_OK) return;
    ++surfaces;
    begin();
  }
  int surfaces = 0;

 private:
  void begin() { expect_ok(qses_begin(context_, &settings_)); }

  qses_context *context_ = nullptr;
  qses_settings settings_;
};

void measure(const char *name, double seconds, Jobs *jobs) {
  std::vector<double> frames;
  uint32_t seed = 1;
  const auto start = Clock::now();
  while (ms_since(start) < 1000 * seconds) {
    const auto begin = Clock::now();
    seed = frame_of_work(seed);
    frames.push_back(ms_since(begin));
    if (jobs) jobs->poll();
  }
  std::sort(frames.begin(), frames.end());
  std::printf("%-24s frames of %6.2f ms (median), %6.2f (99 %%), %6.2f (longest); %5.2f surfaces per second%s\n", name,
              frames[frames.size() / 2], frames[frames.size() * 99 / 100], frames.back(),
              jobs ? jobs->surfaces / seconds : 0.0, seed == 0 ? " " : "");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char **argv) try {
  if (argc < 2) throw std::runtime_error("busy_thread_bench FILE [SECONDS [cpu|cuda]]");
  const double seconds = argc > 2 ? std::atof(argv[2]) : 5.0;
  const qses_backend backend = argc > 3 && std::strcmp(argv[3], "cuda") == 0 ? QSES_BACKEND_CUDA : QSES_BACKEND_CPU;
  qses_structure *structure = nullptr;
  expect_ok(qses_structure_open(argv[1], nullptr, &structure));
  qses_structure_description atoms;
  qses_structure_description_init(&atoms);
  expect_ok(qses_structure_info(structure, &atoms));
  measure("by itself", seconds, nullptr);
  for (const bool background : {false, true}) {
    Jobs jobs(atoms, backend, background);
    measure(background ? "beside background jobs" : "beside jobs", seconds, &jobs);
  }
  qses_structure_close(structure);
  return 0;
} catch (const std::exception &e) {
  std::fprintf(stderr, "busy_thread_bench: %s\n", e.what());
  return 1;
}
