// SPDX-License-Identifier: MIT
// What the program tells the shell, and the exception that carries it to main.
#pragma once

#include <exception>
#include <stdexcept>
#include <string>

#include "quickses/quickses.h"

namespace quickses::cli {

enum ExitCode {
  kOk = 0,
  kUsage = 1,               // wrong flags or values
  kInputUnreadable = 2,     // an input file is missing or can't be used
  kOutputUnwritable = 3,    // an output file can't be written
  kComputingFailed = 4,     // memory, device, spacing too fine
  kBackendUnavailable = 5,  // the back end asked for can't be used here
  kSomeFailed = 6,          // some frames of a trajectory, or some of several structures; the others are done
};

constexpr const char *kNotEnoughMemory = "the machine has not enough memory for this";

class Failure : public std::runtime_error {
 public:
  Failure(ExitCode code, const std::string &message) : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

// What an exception means to the user.
Failure failure_of(std::exception_ptr exception);

inline ExitCode exit_code_of(qses_status status) {
  switch (status) {
    case QSES_OK:
      return kOk;
    case QSES_INVALID_ARGUMENT:
      return kUsage;
    case QSES_BACKEND_UNAVAILABLE:
      return kBackendUnavailable;
    default:
      return kComputingFailed;
  }
}

}  // namespace quickses::cli
