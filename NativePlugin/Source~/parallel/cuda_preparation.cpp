// SPDX-License-Identifier: MIT
#include "parallel/cuda_preparation.h"

namespace quickses {

void CudaPreparations::prepare(int device, const std::function<void()> &load) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (prepared_.count(device) > 0) return;
    ++loading_[device];
  }
  struct Done {
    CudaPreparations &all;
    int device;
    bool is_loaded = false;
    ~Done() {
      const std::lock_guard<std::mutex> lock(all.mutex_);
      --all.loading_[device];
      if (is_loaded) all.prepared_.insert(device);
    }
  } done{*this, device};
  load();
  done.is_loaded = true;
}

void CudaPreparations::remember(int device, const CudaDevice &found) {
  const std::lock_guard<std::mutex> lock(mutex_);
  found_[device] = found;
}

bool CudaPreparations::is_preparing(int device, CudaDevice *known) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto loading = loading_.find(device);
  const auto found = found_.find(device);
  if (loading == loading_.end() || loading->second == 0 || found == found_.end()) return false;
  *known = found->second;
  known->preparing = true;
  known->reason =
      "the NVIDIA driver makes the kernels ready for this GPU; if this library has none compiled for it, the driver "
      "compiles them, which can take a minute and is done once per driver version (it keeps them)";
  return true;
}

}  // namespace quickses
