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

// A computation that was told to stop. Not an error: whoever asked for it knows.
struct Cancelled {};

}  // namespace quickses
