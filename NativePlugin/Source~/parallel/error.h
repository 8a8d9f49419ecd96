// SPDX-License-Identifier: MIT
// The exceptions that travel inside the library; the C API turns them into status codes.
#pragma once

#include "quickses/quickses.h"

#include <stdexcept>
#include <string>

namespace quickses {

class Error : public std::runtime_error {
 public:
  Error(qses_status status, const std::string &message) : std::runtime_error(message), status_(status) {}
  qses_status status() const { return status_; }

 private:
  qses_status status_;
};

// Memory that the budget or the machine refused. Stages that can do with less catch it; else it is the caller's error.
class MemoryRefused : public Error {
 public:
  explicit MemoryRefused(const std::string &message) : Error(QSES_OUT_OF_MEMORY, message) {}
};

// A computation that was told to stop. Not an error: whoever asked for it knows.
struct Cancelled {};

}  // namespace quickses
