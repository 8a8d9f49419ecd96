// SPDX-License-Identifier: MIT
// The time in which the driver brings the kernels onto a device. Where the library has none for that GPU, the driver
// compiles them, and until then whatever else is asked of the device may have to wait.
#pragma once

#include "parallel/cuda_memory.h"

#include <functional>
#include <map>
#include <mutex>
#include <set>

namespace quickses {

// Any thread.
class CudaPreparations {
 public:
  // Calls load(), which brings the kernels onto the device, unless that was done before. What it throws comes out.
  void prepare(int device, const std::function<void()> &load);

  // How a device was found, for the time in which it is prepared.
  void remember(int device, const CudaDevice &found);

  // Whether the device is being prepared; then what is known of it, and what is going on.
  bool is_preparing(int device, CudaDevice *known) const;

 private:
  mutable std::mutex mutex_;
  std::map<int, int> loading_;  // callers of load() by device
  std::set<int> prepared_;
  std::map<int, CudaDevice> found_;
};

}  // namespace quickses
