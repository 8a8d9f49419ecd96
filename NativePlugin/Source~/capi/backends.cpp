// SPDX-License-Identifier: MIT
#include "capi/backends.h"

#include "surface/cpu/cpu_kernels.h"
#if defined(QUICKSES_HAS_CUDA)
#include "parallel/cuda_memory.h"
#endif

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <thread>

#if defined(_WIN32)
#include <windows.h>
#else
#include <unistd.h>
#endif

namespace quickses {
namespace {

void host_memory(uint64_t *total, uint64_t *free) {
#if defined(_WIN32)
  MEMORYSTATUSEX status;
  status.dwLength = sizeof status;
  if (GlobalMemoryStatusEx(&status)) {
    *total = status.ullTotalPhys;
    *free = status.ullAvailPhys;
  }
#else
  const long page = sysconf(_SC_PAGESIZE), pages = sysconf(_SC_PHYS_PAGES);
  *total = page > 0 && pages > 0 ? static_cast<uint64_t>(page) * static_cast<uint64_t>(pages) : 0;
  *free = *total;
#if defined(_SC_AVPHYS_PAGES)
  const long available = sysconf(_SC_AVPHYS_PAGES);
  if (page > 0 && available > 0) *free = static_cast<uint64_t>(page) * static_cast<uint64_t>(available);
#endif
  // The kernel's own estimate counts memory it can give back, such as file caches.
  if (FILE *info = std::fopen("/proc/meminfo", "r")) {
    char line[128];
    unsigned long long kib;
    while (std::fgets(line, sizeof line, info))
      if (std::sscanf(line, "MemAvailable: %llu kB", &kib) == 1) *free = kib * 1024;
    std::fclose(info);
  }
#endif
}

qses_backend_description describe_cpu() {
  qses_backend_description d{};
  d.available = 1;
  std::snprintf(d.device, sizeof d.device, "CPU (%s, %u threads)", cpu_kernels().name,
                std::max(1u, std::thread::hardware_concurrency()));
  host_memory(&d.total_memory, &d.free_memory);
  return d;
}

}  // namespace

qses_backend_description describe_backend(qses_backend backend, int device) {
  if (backend == QSES_BACKEND_CPU) return describe_cpu();
#if defined(QUICKSES_HAS_CUDA)
  const CudaDevice found = describe_cuda_device(device);
  qses_backend_description d{};
  d.available = found.available ? 1 : 0;
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
  return static_cast<uint32_t>(count_cuda_devices());
#else
  return 0;
#endif
}

}  // namespace quickses
