// SPDX-License-Identifier: MIT
// For tests that run with a fake driver: which one it is, and the functions that only a fake has.
#pragma once

#include <cstdlib>
#include <string>

#if defined(_WIN32)
#define WIN32_LEAN_AND_MEAN
#include <windows.h>
#else
#include <dlfcn.h>
#endif

// CTest says it in the environment.
#define REQUIRE_DRIVER(name)                                                                         \
  if (const char *given = std::getenv("QUICKSES_FAKE_DRIVER"); !given || std::string(given) != name) \
  GTEST_SKIP() << "skipped: is for the fake driver " name

namespace fake_driver {

#if defined(_WIN32)
constexpr const char *kLibrary = "nvcuda.dll";
#else
constexpr const char *kLibrary = "libcuda.so.1";
#endif

// Calls one of the fake's own functions.
template <class Result = int, class... Arguments>
Result tell_driver(const char *name, Arguments... arguments) {
  using Function = Result (*)(Arguments...);
#if defined(_WIN32)
  void *const found = reinterpret_cast<void *>(GetProcAddress(LoadLibraryA(kLibrary), name));
#else
  void *const found = dlsym(dlopen(kLibrary, RTLD_NOW), name);
#endif
  return reinterpret_cast<Function>(found)(arguments...);
}

inline int fail_after(int good, int error) { return tell_driver("fake_driver_fail_after", good, error); }

}  // namespace fake_driver
