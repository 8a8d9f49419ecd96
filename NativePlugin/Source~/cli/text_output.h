// SPDX-License-Identifier: MIT
// Text to a file or to standard output.
#pragma once

#include <memory>
#include <string>

#include "io/atomic_file.h"

namespace quickses::cli {

// A file that appears when it is complete, standard output ("-"), or nothing (""). All but the destructor throw
// io::Error or Failure (output).
class TextOutput {
 public:
  explicit TextOutput(const std::string &path);

  void write(const std::string &text);
  void finish();

 private:
  const bool to_standard_output_;
  std::unique_ptr<io::AtomicFile> file_;
};

// Throws Failure (output) if something of what was printed so far could not be written.
void flush_standard_output();

// Before anything takes time: throws if the text could not be written.
inline void check_text_output(const std::string &path) {
  if (!path.empty() && path != "-") io::check_writable(path);
}
inline void write_text(const std::string &path, const std::string &text) {
  TextOutput output(path);
  output.write(text);
  output.finish();
}

}  // namespace quickses::cli
