// SPDX-License-Identifier: MIT
#include "capi/barrier.h"

namespace quickses {

std::string &last_error_message() noexcept {
  static thread_local std::string message;
  return message;
}

qses_status fail(qses_status status, const char *message) noexcept {
  std::string &kept = last_error_message();
  try {
    kept = message;
  } catch (...) {
    kept.clear();  // the status still tells
  }
  return status;
}

}  // namespace quickses
