// SPDX-License-Identifier: MIT
// Frames of a made-up trajectory, for tests of what happens from frame to frame.
#pragma once

#include "surface/surface_fixture.h"

namespace surface_fixture {

// Positions of a frame: every atom shakes a little, and the whole breathes, so that the mesh shrinks and grows.
class Trajectory {
 public:
  explicit Trajectory(const Atoms &atoms) : atoms_(atoms), positions_(atoms.positions), random_(3) {}
  const std::vector<float> &next() {
    const float size = 1.f + 0.01f * std::sin(static_cast<float>(++frame_));
    std::uniform_real_distribution<float> shake(-0.1f, 0.1f);
    for (size_t k = 0; k < positions_.size(); ++k) positions_[k] = size * atoms_.positions[k] + shake(random_);
    return positions_;
  }

 private:
  const Atoms &atoms_;
  std::vector<float> positions_;
  std::mt19937 random_;
  int frame_ = 0;
};

inline void set_positions(qses_context *context, const std::vector<float> &positions) {
  expect_ok(qses_set_positions(context, positions.data(), 0, positions.size() / 3));
}

// Runs a job to its end, as an application does that looks after it now and then; returns its finest mesh.
inline qses_mesh begin_and_collect(qses_context *context, const qses_settings &s) {
  qses_mesh m;
  qses_mesh_init(&m);
  expect_ok(qses_begin(context, &s));
  for (int32_t finished = 0; !finished;) {
    qses_progress p;
    qses_progress_init(&p);
    expect_ok(qses_poll(context, &p));
    expect_ok(qses_wait(context, 5, &finished));
  }
  expect_ok(qses_collect(context, &m));
  return m;
}

}  // namespace surface_fixture
