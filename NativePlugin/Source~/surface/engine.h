// SPDX-License-Identifier: MIT
// What the jobs see of a back end: atoms in, meshes out, one level after the other. One implementation per executor
// (memory_ladder.h).
#pragma once

#include "process/worker_threads.h"
#include "quickses/quickses.h"
#include "surface/memory/atom_set.h"
#include "surface/mesh/mesh_memory.h"
#include "surface/stages/appearance.h"

#include <atomic>
#include <functional>
#include <memory>

namespace quickses {

// Who receives the levels. Called on the thread that computes.
class LevelSink {
 public:
  virtual ~LevelSink() = default;
  virtual void prepared(double milliseconds) = 0;  // what all levels share is made; with CUDA: asked for
  virtual void give_back() = 0;                    // the memory of meshes that nobody wants any more
  virtual void finished(FinishedMesh mesh) = 0;
  virtual void advance(double fraction) = 0;  // of all levels; never falls
  virtual const std::atomic<bool> &stop_flag() const = 0;
};

// Levels of ladders that take no longer, in ms, leave a GPU idle enough to be made beside each other, and are small
// enough for memory of their own. Of those that take longer than first_alone, the first would be kept back by the
// others, which begin behind it. Tests change both.
inline double short_ladder = 8, first_alone = 2;

class SurfaceEngine {
 public:
  virtual ~SurfaceEngine() = default;

  // Room for the atoms of a frame. Memory of sets that nobody holds any more is used again. Throws Error.
  virtual std::shared_ptr<AtomSet> make_atoms(size_t count) = 0;

  // Computes the surface at each spacing, all of them of the settings' ladder, in that order; atoms, neighbour grid and
  // features are made once. Settings are checked already; what the appearance has is there for all atoms. Throws Error,
  // or Cancelled soon after the stop flag is set; levels finished before stay as they are.
  virtual void compute(const AtomSet &atoms, const Appearance &appearance, const qses_settings &settings,
                       Span<const float> spacings, LevelSink &sink) = 0;

  // What a computation at settings.spacing would need. Throws Error, or Cancelled as above.
  virtual qses_size_estimate estimate(const AtomSet &atoms, const Appearance &appearance, const qses_settings &settings,
                                      const std::atomic<bool> &stop) = 0;

  virtual void enable_stage_times(bool enabled) = 0;
  // Called with the fraction done; empty: not at all.
  virtual void set_progress(std::function<void(double)> progress) = 0;
};

// Budgets in bytes, 0 for none; then work beyond what is free when a computation starts is refused.
std::unique_ptr<SurfaceEngine> make_cpu_engine(const WorkerThreads &threads, uint64_t memory_budget);
// Where CUDA is built.
std::unique_ptr<SurfaceEngine> make_cuda_engine(int device, const WorkerThreads &threads, uint64_t memory_budget);

}  // namespace quickses
