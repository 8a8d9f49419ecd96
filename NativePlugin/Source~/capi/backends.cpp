// SPDX-License-Identifier: MIT
#include "capi/backends.h"
#include "io/text.h"

#include "process/host_memory.h"
#include "process/worker_threads.h"
#include "surface/cpu/cpu_kernels.h"
#if defined(QUICKSES_HAS_CUDA)
#include "parallel/cuda_memory.h"
#include "process/stay_loaded.h"
#endif

#include <cstdio>

namespace quickses {
namespace {

qses_backend_description describe_cpu() {
  qses_backend_description d{};
  d.available = 1;
  name_cpu(processors(), &d);
  const HostMemoryStatus memory = describe_host_memory();
  d.total_memory = memory.total;
  d.free_memory = memory.free;
  return d;
}

qses_backend_description describe_cuda(int device) {
  qses_backend_description d{};
#if defined(QUICKSES_HAS_CUDA)
  stay_loaded();
  const CudaDevice found = describe_cuda_device(device);
  d.available = found.available ? 1 : 0;
  d.preparing = found.preparing ? 1 : 0;
  std::snprintf(d.device, sizeof d.device, "%s", found.name.c_str());
  std::snprintf(d.reason, sizeof d.reason, "%s", found.reason.c_str());
  d.total_memory = found.total_memory;
  d.free_memory = found.free_memory;
#else
  (void)device;
  std::snprintf(d.reason, sizeof d.reason, "this build of the library has no CUDA back end");
#endif
  return d;
}

}  // namespace

void name_cpu(unsigned threads, qses_backend_description *description) {
  std::snprintf(description->device, sizeof description->device, "CPU (%s, %s)", cpu_kernels().name,
                io::counted(threads, "thread").c_str());
}

qses_backend_description describe_backend(qses_backend backend, int device) {
  qses_backend_description d = backend == QSES_BACKEND_CPU ? describe_cpu() : describe_cuda(device);
  d.processors = processors();
  return d;
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
