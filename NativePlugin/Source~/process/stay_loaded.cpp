// SPDX-License-Identifier: MIT
#include "process/stay_loaded.h"

#include "process/work_before_exit.h"

#include <cstdlib>

#if defined(_WIN32)
#include <windows.h>
#else
#include <dlfcn.h>
#endif

namespace quickses {
namespace {

char in_this_library;

// Does nothing in a program, which nobody unloads.
void pin() noexcept {
#if defined(_WIN32)
  HMODULE library = nullptr;
  GetModuleHandleExW(GET_MODULE_HANDLE_EX_FLAG_PIN | GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS,
                     reinterpret_cast<LPCWSTR>(&in_this_library), &library);
#else
  Dl_info library{};
  if (dladdr(&in_this_library, &library) != 0 && library.dli_fname)
    dlopen(library.dli_fname, RTLD_NOW | RTLD_NOLOAD | RTLD_NODELETE);
#endif
}

WorkBeforeExit pinning;
const int registered = std::atexit([] { pinning.end(); });

}  // namespace

void stay_loaded() {
  static const bool was_pinned = (pinning.run(pin), true);
  (void)was_pinned;
}

}  // namespace quickses
