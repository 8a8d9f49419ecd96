// SPDX-License-Identifier: MIT
#include "capi/barrier.h"

#include <cstring>

namespace quickses {
namespace {

// Without a destructor: to register one may end the process where memory is refused, and what a thread destroys as it
// ends may call the library. Threads of a program that is linked to the library have so much less stack.
constexpr size_t kMessageRoom = 2048;
thread_local char message_of_thread[kMessageRoom];

bool continues_letter(char c) { return (static_cast<unsigned char>(c) & 0xc0) == 0x80; }  // of UTF-8

}  // namespace

const char *last_error_message() noexcept { return message_of_thread; }

qses_status fail(qses_status status, const char *message) noexcept {
  size_t size = std::strlen(message);
  if (size >= kMessageRoom) {
    size = kMessageRoom - 1;
    while (size > 0 && continues_letter(message[size])) --size;
  }
  std::memcpy(message_of_thread, message, size);
  message_of_thread[size] = '\0';
  return status;
}

}  // namespace quickses
