// SPDX-License-Identifier: MIT
#include "jobs/level_chooser.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace quickses {
namespace {

// Parts of the budget: what a finer level may cost to be moved to, the same shortly after it was too expensive, and
// what the present level may cost for the next one to be tried.
constexpr double kRoomToRise = 0.8, kRoomToReturn = 0.5, kRoomToTry = 0.5;
constexpr uint32_t kFirstWait = 8, kMostDoublings = 7;
constexpr uint32_t kFramesOfTrust = 64;  // after so many frames that fit, failures before are forgotten

// How fast the work grows with the number of lattice points along an edge. The exact method looks at points near the
// surface; the grid method, from each of them, at those within a probe radius.
double growth(qses_method method) { return method == QSES_METHOD_GRID ? 4 : 2; }
constexpr double kGrowthOfMesh = 2;

}  // namespace

bool LevelChooser::Subject::operator==(const Subject &other) const {
  return atoms == other.atoms && surface == other.surface && method == other.method &&
         probe_radius == other.probe_radius && relaxation_steps == other.relaxation_steps &&
         slice_size == other.slice_size && ladder == other.ladder && creases == other.creases &&
         hard_edges == other.hard_edges && occlusion == other.occlusion &&
         gaussian_radius_scale == other.gaussian_radius_scale && gaussian_isovalue == other.gaussian_isovalue;
}

void LevelChooser::Level::add(const Frame &newest) {
  std::move(recent + 1, recent + 3, recent);
  recent[2] = newest;
  ++frames;
  const uint32_t used = std::min(frames, 3u);
  Frame sorted[3];
  std::partial_sort_copy(recent + 3 - used, recent + 3, sorted, sorted + used,
                         [](const Frame &x, const Frame &y) { return x.cost < y.cost; });
  const Frame &usual = sorted[(used - 1) / 2];
  cost = usual.cost;
  shared = usual.shared;
}

double LevelChooser::expected_cost(uint32_t level) const {
  const Level &asked = levels_[level];
  if (asked.known()) return asked.cost + show_cost(asked.bytes);
  const auto scaled = [&](uint32_t from) {
    const double ratio = static_cast<double>(subject_.ladder.spacings[from] / subject_.ladder.spacings[level]);
    return levels_[from].shared +
           (levels_[from].cost - levels_[from].shared) * std::pow(ratio, growth(subject_.method)) +
           show_cost(levels_[from].bytes) * std::pow(ratio, kGrowthOfMesh);
  };
  for (uint32_t k = level; k-- > 0;)
    if (levels_[k].known()) return scaled(k);
  return std::numeric_limits<double>::infinity();
}

uint32_t LevelChooser::choose(const Subject &subject, double budget_ms, double show_ms_per_mb) {
  if (!(subject == subject_)) {
    *this = LevelChooser();
    subject_ = subject;
  }
  if (budget_ms != budget_ms_) {
    budget_ms_ = budget_ms;
    for (Level &level : levels_) level.failures = level.wait = 0;
  }
  show_ms_per_mb_ = show_ms_per_mb;
  for (Level &level : levels_)
    if (level.wait > 0) --level.wait;

  uint32_t chosen = subject_.ladder.count - 1;
  for (; chosen > 0; --chosen) {
    const double share = chosen <= current_ ? 1.0 : levels_[chosen].wait > 0 ? kRoomToReturn : kRoomToRise;
    if (expected_cost(chosen) <= share * budget_ms_) break;
  }
  const Level &present = levels_[current_];
  const uint32_t next = current_ + 1;
  if (chosen == current_ && next < subject_.ladder.count && present.frames >= 2 &&
      expected_cost(current_) <= kRoomToTry * budget_ms_ && levels_[next].wait == 0)
    chosen = next;
  if (chosen != current_) levels_[chosen].frames = 0;
  current_ = chosen;
  return chosen;
}

void LevelChooser::record(double cost_ms, double shared_ms, double bytes) {
  Level &level = levels_[current_];
  const double before = level.cost, bytes_before = level.bytes;
  const bool settled = level.frames >= 3;
  level.add({cost_ms, std::max(0.0, std::min(shared_ms, cost_ms))});
  level.bytes = bytes;
  if (settled && before > 0)
    for (Level &other : levels_)
      if (&other != &level && other.known()) {
        other.cost *= level.cost / before;
        other.shared *= level.cost / before;
        if (bytes_before > 0) other.bytes *= bytes / bytes_before;
      }
  if (level.cost + show_cost(level.bytes) > budget_ms_)
    retreat(level);
  else if (level.frames >= kFramesOfTrust)
    level.failures = 0;
}

void LevelChooser::record_failure() {
  Level &level = levels_[current_];
  level.cost = std::numeric_limits<double>::max();
  level.frames = 0;
  retreat(level);
}

void LevelChooser::retreat(Level &level) {
  level.wait = kFirstWait << std::min(level.failures, kMostDoublings);
  ++level.failures;
}

}  // namespace quickses
