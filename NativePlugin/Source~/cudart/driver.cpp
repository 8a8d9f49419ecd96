// SPDX-License-Identifier: MIT
#include "cudart/driver.h"

#if defined(_WIN32)
#define WIN32_LEAN_AND_MEAN
#include <windows.h>
#else
#include <dlfcn.h>
#endif

namespace quickses {
namespace cudart {
namespace {

#if defined(_WIN32)
constexpr const char *kLibrary = "nvcuda.dll";
// From the system's folder only: nobody can put another file of this name before it.
void *open_library() { return LoadLibraryExW(L"nvcuda.dll", nullptr, LOAD_LIBRARY_SEARCH_SYSTEM32); }
void *find(void *library, const char *name) {
  return reinterpret_cast<void *>(GetProcAddress(static_cast<HMODULE>(library), name));
}
#else
constexpr const char *kLibrary = "libcuda.so.1";
void *open_library() { return dlopen("libcuda.so.1", RTLD_NOW | RTLD_LOCAL); }
void *find(void *library, const char *name) { return dlsym(library, name); }
#endif

// As drivers count: 1000 * major + 10 * minor of the newest CUDA they serve. Machine code of any toolkit runs with the
// drivers of the same major version ("minor version compatibility", CUDA Compatibility guide).
constexpr int kOldestDriver = CUDA_VERSION / 1000 * 1000;

std::string version_text(int version) {
  return std::to_string(version / 1000) + "." + std::to_string(version % 1000 / 10);
}

Driver load() {
  Driver d;
  void *const library = open_library();
  if (!library) {
    d.refusal = std::string("no NVIDIA driver is installed (") + kLibrary + " was not found)";
    return d;
  }
  const char *missing = nullptr;
#define QSES_FIND(name, ...)                                                    \
  d.name = reinterpret_cast<DriverFunction<__VA_ARGS__>>(find(library, #name)); \
  if (!d.name && !missing) missing = #name;
  QSES_DRIVER_FUNCTIONS(QSES_FIND)
#undef QSES_FIND
#define QSES_FIND(name, ...) d.name = reinterpret_cast<DriverFunction<__VA_ARGS__>>(find(library, #name));
  QSES_DRIVER_NEWER_FUNCTIONS(QSES_FIND)
  QSES_DRIVER_GRAPH_FUNCTIONS(QSES_FIND)
  QSES_DRIVER_EDGE_FUNCTIONS(QSES_FIND)
  QSES_DRIVER_GRAPHICS_FUNCTIONS(QSES_FIND)
#undef QSES_FIND
  int version = 0;
  const CUresult told = d.cuDriverGetVersion ? d.cuDriverGetVersion(&version) : CUDA_SUCCESS;
  if (told != CUDA_SUCCESS)
    d.state = told;
  else if (d.cuDriverGetVersion && version < kOldestDriver)
    d.refusal = "the NVIDIA driver serves CUDA " + version_text(version) + ", but this library needs " +
                version_text(kOldestDriver) + ": update the driver";
  else if (missing)
    d.refusal = std::string("the NVIDIA driver (") + kLibrary + ") lacks the function " + missing +
                ": install the driver again";
  else
    d.state = d.cuInit(0);
  if (d.state == CUDA_ERROR_STUB_LIBRARY && d.refusal.empty())
    d.refusal = std::string("the ") + kLibrary +
                " that was found is the CUDA Toolkit's stub, not an NVIDIA driver: take it off the loader's path";
  return d;
}

}  // namespace

const Driver &driver() {
  static const Driver &loaded = *new Driver(load());  // never destroyed: contexts may be as late as the process ends
  return loaded;
}

}  // namespace cudart
}  // namespace quickses
