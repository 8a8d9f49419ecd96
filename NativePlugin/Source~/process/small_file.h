// SPDX-License-Identifier: MIT
// The beginning of a small file, as systems tell about themselves by. Nothing is taken from the heap, which may be what
// there is nothing left of.
#pragma once

#include <cstddef>

#include <fcntl.h>
#include <unistd.h>

namespace quickses {

template <size_t kRoom>
class SmallFile {
 public:
  // Empty if it can't be read.
  explicit SmallFile(const char *path) {
    const int file = open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0) return;
    size_t length = 0;
    while (length < kRoom - 1) {
      const ssize_t more = read(file, text_ + length, kRoom - 1 - length);
      if (more <= 0) break;
      length += static_cast<size_t>(more);
    }
    close(file);
    text_[length] = '\0';
  }
  const char *text() const { return text_; }

 private:
  char text_[kRoom] = {};
};

}  // namespace quickses
