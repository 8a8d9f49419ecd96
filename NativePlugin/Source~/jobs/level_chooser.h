// SPDX-License-Identifier: MIT
// Which level of the ladder fits a budget of time per frame, from what the last frames cost. No clock in here: costs
// come in, a level goes out.
#pragma once

#include "quickses/quickses.h"
#include "surface/levels.h"

#include <cstddef>
#include <cstdint>

namespace quickses {

// The rules:
//  - A cost is that of computing and that of showing: the latter by the bytes of the mesh, which the caller names.
//  - The first frame is the coarsest level; then the finest one that is expected to fit.
//  - The cost of a level in use is that of the one in the middle of its last three frames, so that one slow frame
//    changes nothing; so is what all levels share of it.
//  - A finer level that was never computed costs at most (ratio of spacings)² of what a coarser one did, or to the
//    fourth power with the grid method, apart from what all levels share; its mesh has (ratio of spacings)² of the
//    bytes. Where this is too pessimistic (on a GPU, coarse levels cost as much as fine ones), the next finer level is
//    tried when the present one leaves half of the budget unused.
//  - Costs of levels not in use follow the one in use: when its frames become cheaper, so do theirs.
//  - A level that turned out too expensive is left at once, and tried again after 8 frames, then 16, 32, ... 1024.
//  - To move to a finer level it must fit with room to spare; to stay it must only fit.
class LevelChooser {
 public:
  // What costs depend on. A change of it makes all that was learnt void.
  struct Subject {
    size_t atoms = 0;
    qses_surface surface = QSES_SURFACE_SES;
    qses_method method = QSES_METHOD_EXACT;
    float probe_radius = 0;
    uint32_t relaxation_steps = 0, slice_size = 0;
    Levels ladder;
    qses_bool creases = 0, hard_edges = 0, occlusion = 0;
    float gaussian_radius_scale = 1, gaussian_isovalue = 0.5f;

    bool operator==(const Subject &other) const;
  };

  // The level for the next frame: its place in the ladder, which must not be empty.
  uint32_t choose(const Subject &subject, double budget_ms, double show_ms_per_mb = 0);

  // What it cost to compute the frame of the level chosen last, how much of that is the same for all levels, and the
  // bytes of its mesh.
  void record(double cost_ms, double shared_ms, double bytes = 0);
  // That level could not be computed.
  void record_failure();

 private:
  struct Frame {
    double cost = 0, shared = 0;
  };
  struct Level {
    Frame recent[3];        // of this stay at the level, newest last
    uint32_t frames = 0;    // of this stay
    double cost = -1;       // what it is expected to cost to compute; negative: unknown
    double shared = 0;      // of that
    double bytes = 0;       // of the mesh, where the cost is known
    uint32_t failures = 0;  // times it was too expensive
    uint32_t wait = 0;      // frames until it may be tried again

    bool known() const { return cost >= 0; }
    void add(const Frame &newest);
  };

  double show_cost(double bytes) const { return show_ms_per_mb_ * 1e-6 * bytes; }
  double expected_cost(uint32_t level) const;
  void retreat(Level &level);

  Subject subject_;
  double budget_ms_ = 0, show_ms_per_mb_ = 0;
  uint32_t current_ = 0;
  Level levels_[Levels::kMax];
};

}  // namespace quickses
