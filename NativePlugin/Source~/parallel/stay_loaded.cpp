// SPDX-License-Identifier: MIT
#include "parallel/stay_loaded.h"

#if defined(_WIN32)
#ifndef NOMINMAX
#define NOMINMAX
#endif
#include <windows.h>
#else
#include <dlfcn.h>
#endif

namespace quickses {
namespace {

char in_this_library;

bool pin() {
#if defined(_WIN32)
  HMODULE library = nullptr;
  return GetModuleHandleExW(GET_MODULE_HANDLE_EX_FLAG_PIN | GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS,
                            reinterpret_cast<LPCWSTR>(&in_this_library), &library) != 0;
#else
  Dl_info library{};
  if (dladdr(&in_this_library, &library) == 0 || !library.dli_fname) return false;
  return dlopen(library.dli_fname, RTLD_NOW | RTLD_NOLOAD | RTLD_NODELETE) != nullptr;
#endif
}

}  // namespace

void stay_loaded() {
  static const bool is_pinned = pin();
  (void)is_pinned;  // false in a program, which nobody unloads
}

}  // namespace quickses
