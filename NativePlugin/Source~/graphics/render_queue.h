// SPDX-License-Identifier: MIT
// All targets of the process and the events they share: one per frame does the work of all, since each turn from OpenGL
// or Direct3D to CUDA and back costs the GPU a third of a millisecond.
#pragma once

#include "graphics/gpu_target.h"

#include <map>
#include <memory>
#include <mutex>
#include <vector>

namespace quickses {

class RenderQueue {
 public:
  static RenderQueue &instance();  // never destroyed: the thread that draws may be in an event as the process ends

  // ---- from any thread
  void add(std::shared_ptr<GpuTarget> target);
  void remove(const std::shared_ptr<GpuTarget> &target) noexcept;
  // With the number of the event that is being gathered. False as of GpuTarget.
  bool try_submit(GpuTarget &target, Submission submission, int32_t *event);
  int32_t next_event();  // closes it; 0: there is nothing to do

  // ---- from the thread that draws
  void run(int32_t event) noexcept;

 private:
  struct Arrival {
    std::shared_ptr<GpuTarget> target;
    Submission submission;
    AppearanceView look{};
    qses_status outcome = QSES_OK;
    std::string message;
  };
  using Arrivals = std::vector<Arrival *>;
  using Resources = std::vector<cudaGraphicsResource *>;
  // What is copied on one device, and how long that took the last time.
  struct Lane {
    void *stream = nullptr;                 // cudaStream_t
    void *begin = nullptr, *end = nullptr;  // cudaEvent_t
    bool is_timed = false;
    float copy_ms = 0;
    std::vector<std::shared_ptr<StreamMark>> marks;  // behind copies; those that nobody holds are used again
  };

  RenderQueue() = default;
  // An error becomes that of the arrival. False: there was one.
  template <class Call>
  static bool attempt(Arrival &arrival, const Call &call);
  static Resources resources_of(const Arrivals &arrivals);
  Lane &lane_of(int device);
  void serve(int device, const Arrivals &arrivals);
  void prepare(int device, Lane &lane, Arrival &arrival);
  Arrivals map(const Arrivals &arrivals, Lane &lane);
  void copy_and_unmap(int device, Lane &lane, const Arrivals &arrivals);
  std::shared_ptr<const StreamMark> mark(int device, Lane &lane);
  void forget_buffers(GpuTarget &target) noexcept;

  std::mutex mutex_;
  std::vector<std::shared_ptr<GpuTarget>> targets_, ended_;
  int32_t gathering_ = 1;
  bool has_work_ = false;
  std::mutex drawing_;         // held while an event runs
  std::map<int, Lane> lanes_;  // by device, of the thread that draws
};

}  // namespace quickses
