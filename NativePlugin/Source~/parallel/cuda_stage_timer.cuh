// SPDX-License-Identifier: MIT
// Times of the stages on the GPU, by events in the stream: taking them does not make anything wait.
#pragma once

#include "parallel/cuda_executor.cuh"

#include <cstring>
#include <utility>
#include <vector>

namespace quickses {

// The same members as CpuStageTimer.
class CudaStageTimer {
 public:
  explicit CudaStageTimer(CudaExecutor &executor) : executor_(executor) {}
  ~CudaStageTimer() {
    if (events_.empty()) return;
    try {
      const DeviceGuard guard(executor_.device());
      if (!may_hand_back()) return;
      for (cudaEvent_t event : events_) cudaEventDestroy(event);
    } catch (...) {  // the device is lost
    }
  }
  CudaStageTimer(const CudaStageTimer &) = delete;
  CudaStageTimer &operator=(const CudaStageTimer &) = delete;

  void enable(bool enabled) { enabled_ = enabled; }
  bool is_enabled() const { return enabled_; }
  void reset() { marks_.clear(); }

  // Ends the stage before, and starts one. A name that has been there before goes on adding to it.
  void begin(const char *name) { mark(name); }
  void end() { mark(nullptr); }

  // Waits for the last mark. Names and milliseconds in the order of first appearance; valid until the next call.
  const std::vector<std::pair<const char *, double>> &collect() {
    times_.clear();
    if (marks_.empty()) return times_;
    check_cuda(cudaEventSynchronize(events_[marks_.size() - 1]), "cudaEventSynchronize");
    for (size_t k = 0; k + 1 < marks_.size(); ++k) {
      if (!marks_[k]) continue;
      float ms = 0;
      check_cuda(cudaEventElapsedTime(&ms, events_[k], events_[k + 1]), "cudaEventElapsedTime");
      auto t = std::find_if(times_.begin(), times_.end(),
                            [&](const auto &entry) { return std::strcmp(entry.first, marks_[k]) == 0; });
      if (t == times_.end()) t = times_.insert(t, {marks_[k], 0.0});
      t->second += static_cast<double>(ms);
    }
    return times_;
  }

 private:
  void mark(const char *name) {
    if (!enabled_) return;
    if (marks_.size() == events_.size()) {
      cudaEvent_t event;
      check_cuda(cudaEventCreate(&event), "cudaEventCreate");
      events_.push_back(event);
    }
    check_cuda(cudaEventRecord(events_[marks_.size()], executor_.stream()), "cudaEventRecord");
    marks_.push_back(name);
  }

  CudaExecutor &executor_;
  bool enabled_ = false;
  std::vector<cudaEvent_t> events_;
  std::vector<std::pair<const char *, double>> times_;
  std::vector<const char *> marks_;  // what begins at each event; nullptr: nothing
};

}  // namespace quickses
