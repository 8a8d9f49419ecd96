// SPDX-License-Identifier: MIT
#include "jobs/surface_job.h"

#include "parallel/error.h"
#include "parallel/working_thread.h"

#include <chrono>
#include <cstdio>
#include <cstring>
#include <system_error>

namespace quickses {

SurfaceJob::SurfaceJob(std::unique_ptr<SurfaceEngine> engine, bool in_background)
    : engine_(std::move(engine)), in_background_(in_background) {
  qses_progress_init(&state_);
}

SurfaceJob::~SurfaceJob() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    quit_ = true;
    stop_now_ = true;
  }
  changed_.notify_all();
  if (worker_.joinable()) worker_.join();
}

void SurfaceJob::begin(SurfaceRequest request) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!worker_.joinable()) {
      try {
        worker_ = std::thread([this] { work(); });
      } catch (const std::system_error &e) {
        throw Error(QSES_OUT_OF_MEMORY, std::string("the machine refused a thread: ") + e.what());
      }
    }
    if (request.frame_budget_ms > 0) choosers_.reserve();  // here it may fail
    state_.tag_requested = request.settings.tag;
    waiting_ = std::move(request);
    if (running_) {
      // The picture must keep moving: the coarsest level is finished first.
      superseded_ = true;
      if (levels_finished_ > 0) stop_now_ = true;
    } else {
      announce(waiting_);
    }
  }
  changed_.notify_all();
}

void SurfaceJob::announce(const SurfaceRequest &request) {
  superseded_ = false;
  stop_now_ = false;
  fraction_ = 0.f;
  levels_finished_ = 0;
  level_count_ = request.frame_budget_ms > 0 ? 1 : request.ladder.count;
  atom_count_ = request.atoms->count;
  state_.state = QSES_JOB_RUNNING;
  state_.tag = request.settings.tag;
  state_.levels_finished = 0;
  state_.level_count = level_count_;
  state_.status = QSES_OK;
  state_.message[0] = '\0';
}

void SurfaceJob::choose_levels(const SurfaceRequest &request) {
  ladder_count_ = request.ladder.count;
  first_level_ = 0;
  chooser_ = nullptr;
  if (request.frame_budget_ms <= 0) return;
  const qses_settings &s = request.settings;
  const LevelChooser::Subject subject = {
      request.atoms->count, s.surface, s.method,     s.probe_radius, s.relaxation_steps,      s.slice_size,
      request.ladder,       s.creases, s.hard_edges, s.occlusion,    s.gaussian_radius_scale, s.gaussian_isovalue};
  chooser_ = &choosers_.of(s.series);
  first_level_ = chooser_->choose(subject, request.frame_budget_ms, static_cast<double>(s.show_ms_per_mb));
}

void SurfaceJob::work() {
  const FloatScope floats;
  if (in_background_) stand_back();
  std::unique_lock<std::mutex> lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return quit_ || !waiting_.empty(); });
    if (quit_) return;
    const SurfaceRequest request = std::move(waiting_);
    waiting_ = {};
    running_ = true;
    announce(request);
    choose_levels(request);
    lock.unlock();
    qses_status status = QSES_OK;
    char message[sizeof state_.message] = "";  // no string, which may find no memory
    try {
      run(request);
    } catch (const Cancelled &) {
    } catch (...) {
      explain_exception([&](qses_status failure, const char *sentence) {
        status = failure;
        std::snprintf(message, sizeof message, "%s", sentence);
      });
    }
    lock.lock();
    note_end(status, message);
    changed_.notify_all();
  }
}

void SurfaceJob::note_end(qses_status status, const char *message) {
  running_ = false;
  state_.status = status;
  std::snprintf(state_.message, sizeof state_.message, "%s", message);
  state_.state = status != QSES_OK                  ? QSES_JOB_FAILED
                 : levels_finished_ == level_count_ ? QSES_JOB_FINISHED
                                                    : QSES_JOB_CANCELLED;
}

void SurfaceJob::run(const SurfaceRequest &request) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  try {
    engine_->compute(*request.atoms, *request.appearance, request.settings,
                     {request.ladder.spacings + first_level_, level_count_}, *this);
  } catch (const Cancelled &) {
    // A cancel that came too late takes nothing back. Else the time says nothing about the cost.
    if (levels_finished_ < level_count_) throw;
  } catch (...) {
    if (chooser_) chooser_->record_failure();
    throw;
  }
  if (chooser_)
    chooser_->record(std::chrono::duration<double, std::milli>(Clock::now() - start).count(), shared_ms_, mesh_bytes_);
}

void SurfaceJob::wait_for_turn(std::unique_lock<std::mutex> &lock) {
  cancelled_call_ = false;
  changed_.wait(lock, [&] { return !running_ && waiting_.empty(); });
  if (cancelled_call_) throw Cancelled{};
}

void SurfaceJob::compute(SurfaceRequest request) {
  {
    std::unique_lock<std::mutex> lock(mutex_);
    state_.tag_requested = request.settings.tag;  // also if it is cancelled before its turn
    wait_for_turn(lock);
    // No worker runs and only this thread can begin one: it is safe to compute here.
    announce(request);
    choose_levels(request);
    running_ = true;
  }
  const auto end = [&](qses_status status, const char *message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    note_end(status, message);
    if (state_.state == QSES_JOB_FINISHED) hold_what_is_ready();
  };
  try {
    run(request);
  } catch (const Cancelled &) {
    end(QSES_OK, "");
    throw;
  } catch (...) {
    explain_exception(end);
    throw;
  }
  end(QSES_OK, "");
}

qses_size_estimate SurfaceJob::estimate(const SurfaceRequest &request) {
  {
    std::unique_lock<std::mutex> lock(mutex_);
    wait_for_turn(lock);
    stop_now_ = false;
  }
  return engine_->estimate(*request.atoms, *request.appearance, request.settings, stop_now_);
}

void SurfaceJob::hold_what_is_ready() {
  let_go_ = std::move(held_.mesh.memory);
  held_ = std::move(ready_);
  ready_ = {};
}

void SurfaceJob::give_back() {
  MeshHold let_go;
  const std::lock_guard<std::mutex> lock(mutex_);
  let_go = std::move(let_go_);
}

void SurfaceJob::finished(FinishedMesh mesh) {
  MeshHold let_go;  // so that none waits for it when this one is collected
  const std::lock_guard<std::mutex> lock(mutex_);
  let_go = std::move(let_go_);
  ready_.is_there = true;
  std::swap(ready_.mesh, mesh);
  ready_.atom_count = atom_count_;
  mesh_bytes_ = static_cast<double>(ready_.mesh.report.mesh_bytes);
  for (qses_mesh *view : {&ready_.mesh.on_host, &ready_.mesh.on_device.mesh}) {
    view->level = first_level_ + levels_finished_;
    view->level_count = ladder_count_;
  }
  state_.levels_finished = ++levels_finished_;
  if (superseded_) stop_now_ = true;
}

void SurfaceJob::advance(double fraction) { fraction_.store(static_cast<float>(fraction), std::memory_order_relaxed); }

bool SurfaceJob::collect() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!ready_.is_there) return false;
  hold_what_is_ready();
  return true;
}

const FinishedMesh *SurfaceJob::held() const { return held_.is_there ? &held_.mesh : nullptr; }

bool SurfaceJob::collect_on_device(qses_device_mesh *mesh) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const Level &newest = ready_.is_there ? ready_ : held_;
  if (!newest.is_there) return false;
  if (!is_for_device(newest.mesh.delivery))
    invalid("the mesh was made with another settings.delivery than DEVICE or BOTH: it is not on the device");
  if (ready_.is_there) hold_what_is_ready();
  *mesh = held_.mesh.on_device;
  return true;
}

void SurfaceJob::keep(KeptMesh *kept) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!held_.is_there) throw Error(QSES_NO_RESULT, "nothing has been computed or collected that could be kept");
  FinishedMesh &mesh = held_.mesh;
  if (mesh.delivery == QSES_DELIVERY_NONE)
    invalid("the mesh was made with settings.delivery NONE: there is none to be kept");
  const auto on_device = is_for_device(mesh.delivery) ? std::make_shared<DeviceMesh>() : nullptr;
  kept->clear();
  if (on_device) {
    on_device->view = mesh.on_device;
    on_device->shape = mesh.shape;
    on_device->atom_count = held_.atom_count;
    on_device->memory = std::move(mesh.memory.on_device);
  }
  kept->mesh = mesh.on_host;
  kept->boxes = mesh.boxes;
  kept->report = mesh.report;
  kept->atom_count = held_.atom_count;
  kept->memory = std::move(mesh.memory.on_host);
  kept->on_device = on_device;
  kept->host_pool = std::move(mesh.memory.host_pool);
  kept->is_full = true;
  held_ = {};
}

bool SurfaceJob::wait(double milliseconds) {
  std::unique_lock<std::mutex> lock(mutex_);
  const auto idle = [&] { return !running_ && waiting_.empty(); };
  if (milliseconds == 0.0) return idle();  // the system would let some ten microseconds pass
  constexpr double kForEver = 1e9;         // 11 days; much more overflows the clock
  if (milliseconds < 0.0 || milliseconds > kForEver) {
    changed_.wait(lock, idle);
    return true;
  }
  return changed_.wait_for(lock, std::chrono::duration<double, std::milli>(milliseconds), idle);
}

void SurfaceJob::cancel() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    cancelled_call_ = true;
    stop_now_ = true;  // whatever is computed; what is begun later takes it back
    if (!running_ && !waiting_.empty()) state_.state = QSES_JOB_CANCELLED;
    waiting_ = {};
  }
  changed_.notify_all();
}

qses_progress SurfaceJob::progress() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  qses_progress p = state_;
  p.fraction = p.state == QSES_JOB_FINISHED ? 1.f : fraction_.load(std::memory_order_relaxed);
  p.mesh_ready = ready_.is_there ? 1 : 0;
  return p;
}

}  // namespace quickses
