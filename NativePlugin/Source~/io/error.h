// SPDX-License-Identifier: MIT
// The exception of the input and output library: a sentence that names the file and what is wrong with it.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace quickses::io {

enum class ErrorKind {
  kUsage,   // the caller asked for something that makes no sense, such as a selection with a wrong syntax
  kInput,   // a file can't be read, or what is in it can't be used
  kOutput,  // a file can't be written
};

// Text of a file may be part of a message: it must not steer a terminal, nor fill it.
inline std::string printable(std::string message) {
  constexpr size_t kMostBytes = 8000;  // two of the longest paths there are still fit in
  if (message.size() > kMostBytes) {
    message.resize(kMostBytes);
    while ((static_cast<unsigned char>(message.back()) & 0xc0) == 0x80) message.pop_back();  // of a cut letter
    message.back() = '?';
  }
  const auto byte = [&](size_t k) { return k < message.size() ? static_cast<unsigned char>(message[k]) : 0u; };
  for (size_t k = 0; k < message.size(); ++k) {
    if (byte(k) < 0x20 || byte(k) == 0x7f) message[k] = '?';
    if (byte(k) == 0xc2 && byte(k + 1) >= 0x80 && byte(k + 1) < 0xa0) message[k] = message[k + 1] = '?';
  }
  return message;
}

class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, std::string message) : std::runtime_error(printable(std::move(message))), kind_(kind) {}
  ErrorKind kind() const { return kind_; }

 private:
  ErrorKind kind_;
};

[[noreturn]] inline void fail_input(const std::string &message) { throw Error(ErrorKind::kInput, message); }
[[noreturn]] inline void fail_output(const std::string &message) { throw Error(ErrorKind::kOutput, message); }
[[noreturn]] inline void fail_usage(const std::string &message) { throw Error(ErrorKind::kUsage, message); }

// "'FILE', line 12: " for messages.
inline std::string at_line(const std::string &path, size_t line) {
  return "'" + path + "', line " + std::to_string(line) + ": ";
}

}  // namespace quickses::io
