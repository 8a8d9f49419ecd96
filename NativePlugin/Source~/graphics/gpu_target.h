// SPDX-License-Identifier: MIT
// One surface that is drawn: the meshes on their way to its buffers, and how that went.
#pragma once

#include "graphics/mesh_copies.h"
#include "graphics/registered_buffers.h"
#include "kept/device_mesh.h"

#include <chrono>
#include <deque>
#include <memory>
#include <mutex>

namespace quickses {

// A mesh that waits for its event.
struct Submission {
  int32_t event = 0;
  std::shared_ptr<const DeviceMesh> mesh;
  std::shared_ptr<const Appearance> look;
  qses_gpu_buffers buffers{};
  std::chrono::steady_clock::time_point since;
};

// Events are numbered in turn, and 1 follows the last number. Of two that are near each other.
inline bool is_later(int32_t event, int32_t than) {
  constexpr uint32_t kNumbers = uint32_t(1) << 31;
  const uint32_t steps = (static_cast<uint32_t>(event) - static_cast<uint32_t>(than)) % kNumbers;
  return steps > 0 && steps < kNumbers / 2;
}

class GpuTarget {
 public:
  GpuTarget() { qses_gpu_status_init(&status_); }
  GpuTarget(const GpuTarget &) = delete;
  GpuTarget &operator=(const GpuTarget &) = delete;

  // ---- from any thread
  void set_look(std::shared_ptr<const Appearance> look, size_t atom_count);
  // False: as many as may wait do so already, or events have stopped. Throws Error if mesh, buffers and look don't fit
  // together.
  bool try_submit(Submission submission);
  qses_gpu_status status() const;
  bool is_stopped() const;
  void let_go() noexcept;  // of what waits

  // ---- from the thread that draws, one at a time
  // The newest that is to be done with this event; older ones are let go. False: there is none; else the outcome is to
  // be noted.
  bool take(int32_t event, Submission *submission);
  void note_outcome(int32_t event, qses_status outcome, const char *message);
  void note_interruption(int32_t event);  // for want of memory; if something was taken
  void note_times(float event_ms, float copy_ms);

  RegisteredBuffers registered;  // of that thread alone, like the next
  std::unique_ptr<DeviceLook> look_there;
  int device = -1;  // that knows the buffers

 private:
  void look_at_clock() const;  // the mutex is held

  mutable std::mutex mutex_;
  mutable std::deque<Submission> waiting_;
  bool is_in_event_ = false;  // one has been taken, whose outcome is not known yet
  mutable qses_gpu_status status_{};
  std::shared_ptr<const Appearance> look_;
  size_t look_atoms_ = 0;
};

}  // namespace quickses
