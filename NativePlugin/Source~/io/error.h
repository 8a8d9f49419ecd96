// SPDX-License-Identifier: MIT
// The exception of the input and output library: a sentence that names the file and what is wrong with it.
#pragma once

#include <stdexcept>
#include <string>

namespace quickses::io {

enum class ErrorKind {
  kUsage,   // the caller asked for something that makes no sense, such as a selection with a wrong syntax
  kInput,   // a file can't be read, or what is in it can't be used
  kOutput,  // a file can't be written
};

class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string &message) : std::runtime_error(message), kind_(kind) {}
  ErrorKind kind() const { return kind_; }

 private:
  ErrorKind kind_;
};

[[noreturn]] inline void fail_input(const std::string &message) { throw Error(ErrorKind::kInput, message); }
[[noreturn]] inline void fail_output(const std::string &message) { throw Error(ErrorKind::kOutput, message); }
[[noreturn]] inline void fail_usage(const std::string &message) { throw Error(ErrorKind::kUsage, message); }

}  // namespace quickses::io
