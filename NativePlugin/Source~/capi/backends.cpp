// SPDX-License-Identifier: MIT
#include "capi/backends.h"
#include "io/text.h"

#include "parallel/host_memory.h"
#include "surface/cpu/cpu_kernels.h"
#if defined(QUICKSES_HAS_CUDA)
#include "parallel/cuda_memory.h"
#include "parallel/stay_loaded.h"
#endif

#include <algorithm>
#include <cstdio>
#include <thread>

namespace quickses {
namespace {

qses_backend_description describe_cpu() {
  qses_backend_description d{};
  d.available = 1;
  name_cpu(std::max(1u, std::thread::hardware_concurrency()), &d);
  const HostMemoryStatus memory = describe_host_memory();
  d.total_memory = memory.total;
  d.free_memory = memory.free;
  return d;
}

}  // namespace

void name_cpu(unsigned threads, qses_backend_description *description) {
  std::snprintf(description->device, sizeof description->device, "CPU (%s, %s)", cpu_kernels().name,
                io::counted(threads, "thread").c_str());
}

qses_backend_description describe_backend(qses_backend backend, int device) {
  if (backend == QSES_BACKEND_CPU) return describe_cpu();
#if defined(QUICKSES_HAS_CUDA)
  stay_loaded();
  const CudaDevice found = describe_cuda_device(device);
  qses_backend_description d{};
  d.available = found.available ? 1 : 0;
  d.preparing = found.preparing ? 1 : 0;
  std::snprintf(d.device, sizeof d.device, "%s", found.name.c_str());
  std::snprintf(d.reason, sizeof d.reason, "%s", found.reason.c_str());
  d.total_memory = found.total_memory;
  d.free_memory = found.free_memory;
  return d;
#else
  (void)device;
  qses_backend_description d{};
  std::snprintf(d.reason, sizeof d.reason, "this build of the library has no CUDA back end");
  return d;
#endif
}

uint32_t count_devices() {
#if defined(QUICKSES_HAS_CUDA)
  stay_loaded();
  return static_cast<uint32_t>(count_cuda_devices());
#else
  return 0;
#endif
}

}  // namespace quickses
