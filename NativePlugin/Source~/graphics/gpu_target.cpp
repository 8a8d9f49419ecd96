// SPDX-License-Identifier: MIT
#include "graphics/gpu_target.h"

#include "graphics/gpu_patience.h"
#include "parallel/error.h"

#include <cstdio>

namespace quickses {
namespace {

void check_room(const char *of, uint64_t capacity, uint64_t needed) {
  if (capacity < needed)
    invalid("buffers." + std::string(of) + "_capacity is " + std::to_string(capacity) + ", but the mesh needs " +
            std::to_string(needed));
}

void check_buffers(const DeviceMesh &mesh, const qses_gpu_buffers &buffers) {
  if (!buffers.vertices) invalid("buffers.vertices is 0");
  if (!buffers.indices) invalid("buffers.indices is 0");
  if (mesh.shape.layout == QSES_VERTICES_SEPARATE && mesh.view.mesh.vertex_count > 0)
    invalid("the mesh was made with settings.vertex_layout SEPARATE: a buffer takes INTERLEAVED or COMPACT");
  check_room("vertex", buffers.vertex_capacity, mesh.view.mesh.vertex_count);
  check_room("index", buffers.index_capacity, 3 * uint64_t(mesh.view.mesh.triangle_count));
}

}  // namespace

void GpuTarget::set_look(std::shared_ptr<const Appearance> look, size_t atom_count) {
  const std::lock_guard<std::mutex> lock(mutex_);
  look_ = std::move(look);
  look_atoms_ = atom_count;
}

bool GpuTarget::try_submit(Submission submission) {
  const DeviceMesh &mesh = *submission.mesh;
  check_buffers(mesh, submission.buffers);
  const std::lock_guard<std::mutex> lock(mutex_);
  if (look_ && look_atoms_ != mesh.atom_count)
    invalid("the look is of " + std::to_string(look_atoms_) + " atoms, but the mesh was made of " +
            std::to_string(mesh.atom_count));
  look_at_clock();
  if (status_.stopped || waiting_.size() >= QSES_GPU_MAX_WAITING) return false;
  submission.look = look_;
  submission.since = std::chrono::steady_clock::now();
  status_.submitted = submission.event;
  waiting_.push_back(std::move(submission));
  return true;
}

qses_gpu_status GpuTarget::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  look_at_clock();
  status_.waiting = static_cast<uint32_t>(waiting_.size()) + (is_in_event_ ? 1 : 0);
  return status_;
}

bool GpuTarget::is_stopped() const { return status().stopped != 0; }

void GpuTarget::let_go() noexcept {
  std::deque<Submission> gone;  // ends outside of the lock
  const std::lock_guard<std::mutex> lock(mutex_);
  gone.swap(waiting_);
}

bool GpuTarget::take(int32_t event, Submission *submission) {
  const std::lock_guard<std::mutex> lock(mutex_);
  status_.stopped = 0;
  bool found = false;
  while (!waiting_.empty() && !is_later(waiting_.front().event, event)) {
    *submission = std::move(waiting_.front());
    waiting_.pop_front();
    found = true;
  }
  is_in_event_ = found;
  return found;
}

void GpuTarget::note_outcome(int32_t event, qses_status outcome, const char *message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  is_in_event_ = false;
  status_.done = event;
  status_.status = outcome;
  status_.registrations = registered.registrations();
  std::snprintf(status_.message, sizeof status_.message, "%s", message);
}

void GpuTarget::note_interruption(int32_t event) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!is_in_event_) return;
  }
  note_outcome(event, QSES_OUT_OF_MEMORY, "the machine refused memory");
}

void GpuTarget::note_times(float event_ms, float copy_ms) {
  const std::lock_guard<std::mutex> lock(mutex_);
  status_.event_ms = event_ms;
  status_.copy_ms = copy_ms;
}

// Memory is not held for events that may never come.
void GpuTarget::look_at_clock() const {
  if (waiting_.empty() || std::chrono::steady_clock::now() - waiting_.front().since < gpu_patience.load()) return;
  waiting_.clear();
  status_.stopped = 1;
}

}  // namespace quickses
