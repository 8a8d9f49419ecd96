// SPDX-License-Identifier: MIT
// One surface over time: computations one after the other on a worker thread, coarse levels first, the newest request
// replacing older ones, and the finished meshes handed over without copying.
#pragma once

#include "jobs/series_choosers.h"
#include "kept/kept_mesh.h"
#include "surface/engine.h"

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>

namespace quickses {

// A computation asked for: atoms as they were then, and how.
struct SurfaceRequest {
  std::shared_ptr<const AtomSet> atoms;
  std::shared_ptr<const Appearance> appearance;
  qses_settings settings;
  Levels ladder;
  // Of the ladder, only the finest level that is expected to cost no more than this, ms; 0: all levels.
  double frame_budget_ms = 0;

  bool empty() const { return !atoms; }
};

class SurfaceJob : private LevelSink {
 public:
  // in_background: its thread stands back behind others.
  explicit SurfaceJob(std::unique_ptr<SurfaceEngine> engine, bool in_background = false);
  ~SurfaceJob() override;  // cancels and joins
  SurfaceJob(const SurfaceJob &) = delete;
  SurfaceJob &operator=(const SurfaceJob &) = delete;

  SurfaceEngine &engine() { return *engine_; }

  // ---- from the thread that uses the context
  // Replaces the request that waits, if any. A running job still finishes its coarsest level, then this one starts.
  void begin(SurfaceRequest request);
  // Computes on the calling thread once no job runs. Throws what went wrong.
  void compute(SurfaceRequest request);
  // What a computation would need; once no job runs. Throws what went wrong.
  qses_size_estimate estimate(const SurfaceRequest &request);
  // The finest level finished since the last call; false if there is none. Its memory stays until the next call that
  // returns true, or a compute.
  bool collect();
  // The mesh collected or computed last; nullptr if there is none.
  const FinishedMesh *held() const;
  // The finest level finished since the last call, or else the mesh collected or computed last; false if there is
  // neither. Throws Error if it is not on the device, and leaves it where it is.
  bool collect_on_device(qses_device_mesh *mesh);
  // Moves what is held out of here, with its memory. Throws Error; the other one is as it was then.
  void keep(KeptMesh *kept);
  // Until no job runs or waits, or the time is over (negative: no limit). True if none runs or waits.
  bool wait(double milliseconds);

  // ---- from any thread
  void cancel();
  qses_progress progress() const;

 private:
  // LevelSink, called by the thread that computes.
  void prepared(double milliseconds) override { shared_ms_ = milliseconds; }
  void give_back() override;
  void finished(FinishedMesh mesh) override;
  const std::atomic<bool> &stop_flag() const override { return stop_now_; }
  void advance(double fraction) override;

  // Waits until no job runs, with the mutex held before and behind; throws if that was cancelled meanwhile.
  void wait_for_turn(std::unique_lock<std::mutex> &lock);
  // The mesh that is ready takes the place of the one that is held. The mutex is held.
  void hold_what_is_ready();
  // The state of a job that is about to run. The mutex is held.
  void announce(const SurfaceRequest &request);
  // Which levels of the ladder will be computed. The mutex is held.
  void choose_levels(const SurfaceRequest &request);
  // How the job ended. The mutex is held.
  void note_end(qses_status status, const char *message);
  void work();
  void run(const SurfaceRequest &request);

  struct Level {
    bool is_there = false;
    FinishedMesh mesh{};
    size_t atom_count = 0;
  };

  std::unique_ptr<SurfaceEngine> engine_;
  const bool in_background_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  SurfaceRequest waiting_;
  bool running_ = false, quit_ = false, superseded_ = false;
  bool cancelled_call_ = false;                     // while a compute or estimate waits for a job to end
  uint32_t levels_finished_ = 0, level_count_ = 0;  // of the job
  uint32_t first_level_ = 0, ladder_count_ = 0;     // where they are in the ladder
  SeriesChoosers choosers_;                         // like the next two: of the thread that computes
  LevelChooser *chooser_ = nullptr;                 // of the job's series; null without a frame budget
  size_t atom_count_ = 0;                           // of the job
  double shared_ms_ = 0, mesh_bytes_ = 0;           // of the job's cost, what all levels share; of its last mesh
  Level held_, ready_;
  MeshHold let_go_;  // of the one held before: given back by the thread that computes, since that may take a while
  qses_progress state_{};
  std::atomic<bool> stop_now_{false};
  std::atomic<float> fraction_{0.f};
  std::thread worker_;
};

}  // namespace quickses
