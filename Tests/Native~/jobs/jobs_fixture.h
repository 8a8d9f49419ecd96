// SPDX-License-Identifier: MIT
// What the tests of jobs share.
#pragma once

#include "surface/surface_fixture.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace jobs_fixture {

using namespace surface_fixture;

inline qses_progress poll(qses_context *context) {
  qses_progress p;
  qses_progress_init(&p);
  expect_ok(qses_poll(context, &p));
  return p;
}

inline void begin(qses_context *context, qses_settings s, uint32_t frame = 0) {
  s.tag = frame;
  expect_ok(qses_begin(context, &s));
}

inline void wait_for_all(qses_context *context) {
  int32_t finished = 0;
  expect_ok(qses_wait(context, -1, &finished));
  ASSERT_EQ(finished, 1);
}

// The next level that is finished; a view with level_count 0 if the job ends without one.
inline qses_mesh next_level(qses_context *context) {
  qses_mesh mesh;
  for (;;) {
    qses_mesh_init(&mesh);
    if (qses_collect(context, &mesh) == QSES_OK) return mesh;
    if (poll(context).state != QSES_JOB_RUNNING) {
      if (qses_collect(context, &mesh) == QSES_OK) return mesh;
      qses_mesh_init(&mesh);
      return mesh;
    }
    std::this_thread::yield();
  }
}

// The level that is there to be collected.
inline qses_mesh collected(qses_context *context) {
  qses_mesh mesh;
  qses_mesh_init(&mesh);
  expect_ok(qses_collect(context, &mesh));
  return mesh;
}

// Many atoms, quickly made: a cubic lattice of them.
inline Atoms block(int edge) {
  Atoms atoms;
  for (int k = 0; k < edge * edge * edge; ++k)
    atoms.add(2.1 * (k % edge), 2.2 * (k / edge % edge), 2.3 * (k / edge / edge), 1.5 + 0.1 * (k % 4));
  return atoms;
}

// Holds whatever is computed when it first tells how far it is: so it is not over before the gate opens. Lives longer
// than the context.
class Gate {
 public:
  void place_in(qses_context *context) { expect_ok(qses_set_progress_callback(context, stop_at, this)); }
  void wait_until_reached() const {
    while (!is_reached_) std::this_thread::yield();
  }
  void open() { is_open_ = true; }

 private:
  static void stop_at(void *gate, double) {
    Gate &self = *static_cast<Gate *>(gate);
    self.is_reached_ = true;
    while (!self.is_open_) std::this_thread::yield();
  }
  std::atomic<bool> is_reached_{false}, is_open_{false};
};

// A job that the gate holds when this returns.
inline void begin_held(Gate &gate, qses_context *context, const Atoms &atoms, const qses_settings &s,
                       uint32_t frame = 0) {
  set_atoms(context, atoms);
  gate.place_in(context);
  begin(context, s, frame);
  gate.wait_until_reached();
}

}  // namespace jobs_fixture
