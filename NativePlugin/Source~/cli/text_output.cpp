// SPDX-License-Identifier: MIT
// Text to a file or to standard output.
#include "cli/text_output.h"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "cli/exit_code.h"

#if defined(_WIN32)
#include <fcntl.h>
#include <io.h>
#endif

namespace quickses::cli {

void flush_standard_output() {
  const bool was_written = std::ferror(stdout) == 0;  // an error is kept, its reason isn't
  if (std::fflush(stdout) != 0)
    throw Failure(kOutputUnwritable, std::string("standard output can't be written: ") + std::strerror(errno));
  if (!was_written) throw Failure(kOutputUnwritable, "standard output can't be written");
}

TextOutput::TextOutput(const std::string &path) : to_standard_output_(path == "-") {
#if defined(_WIN32)
  if (to_standard_output_) _setmode(_fileno(stdout), _O_BINARY);  // lines end as in files
#endif
  if (!path.empty() && !to_standard_output_) file_ = std::make_unique<io::AtomicFile>(path);
}

void TextOutput::write(const std::string &text) {
  if (file_) file_->write(text);
  if (!to_standard_output_ || text.empty()) return;
  std::fwrite(text.data(), 1, text.size(), stdout);
  flush_standard_output();  // what there is stays if the program is stopped
}

void TextOutput::finish() {
  if (file_) file_->commit();
  if (to_standard_output_) flush_standard_output();
}

}  // namespace quickses::cli
