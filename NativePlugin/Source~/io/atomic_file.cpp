// SPDX-License-Identifier: MIT
// Files that appear under their name only when they are complete.
#include "io/atomic_file.h"

#include <atomic>
#include <cerrno>
#include <cstring>
#include <system_error>

#if defined(_WIN32)
#include <process.h>
#define QSES_PROCESS_ID _getpid()
#else
#include <unistd.h>
#define QSES_PROCESS_ID getpid()
#endif

#include "io/error.h"
#include "io/file_path.h"

namespace quickses::io {
namespace {

namespace fs = std::filesystem;

fs::path temporary_name(const fs::path &target) {
  static std::atomic<unsigned> counter{0};
  const std::string name = "." + utf8_of(target.filename()) + "." + std::to_string(QSES_PROCESS_ID) + "." +
                           std::to_string(counter++) + ".tmp";
  return target.parent_path() / path_of(name);
}

}  // namespace

AtomicFile::AtomicFile(const std::string &path) : path_(path), target_(path_of(path)), buffer_(kBufferSize) {
  std::error_code error;
  // A link stays a link: what it points to is replaced.
  if (fs::is_symlink(target_, error)) {
    const fs::path resolved = fs::weakly_canonical(target_, error);
    if (!error) target_ = resolved;
  }
  const fs::file_status status = fs::status(target_, error);
  if (fs::is_directory(status)) fail_output("'" + path_ + "' is a directory: it can't be written as a file");
  const fs::path folder = target_.parent_path();
  if (!folder.empty() && !fs::is_directory(folder, error))
    fail_output("'" + path_ + "' can't be written: there is no folder '" + utf8_of(folder) + "'");
  const bool replace = !fs::exists(status) || fs::is_regular_file(status);
#if !defined(_WIN32)
  // Renaming would replace a file that is write-protected: ask first, as writing to it would.
  if (replace && fs::exists(status) && access(target_.c_str(), W_OK) != 0) fail(errno);
#endif
  if (replace) temporary_ = temporary_name(target_);
  file_ = open_stdio(replace ? temporary_ : target_, "wb");
  if (!file_) {
    temporary_.clear();
    fail(errno);
  }
  std::setvbuf(file_, nullptr, _IONBF, 0);  // buffer_ is the buffer
}

AtomicFile::~AtomicFile() { close_and_remove(); }

void AtomicFile::close_and_remove() {
  if (file_) std::fclose(file_);
  file_ = nullptr;
  std::error_code error;
  if (!temporary_.empty()) fs::remove(temporary_, error);
  temporary_.clear();
}

void AtomicFile::fail(int error_number) {
  close_and_remove();
  fail_output("'" + path_ + "' can't be written: " + std::strerror(error_number));
}

void AtomicFile::flush() {
  if (used_ != 0 && std::fwrite(buffer_.data(), 1, used_, file_) != used_) fail(errno);
  used_ = 0;
}

void AtomicFile::write(const void *data, size_t size) {
  if (size > buffer_.size() - used_) {
    flush();
    if (size > buffer_.size()) {
      if (std::fwrite(data, 1, size, file_) != size) fail(errno);
      return;
    }
  }
  std::memcpy(buffer_.data() + used_, data, size);
  used_ += size;
}

void AtomicFile::commit() {
  flush();
  std::FILE *file = file_;
  file_ = nullptr;
  if (std::fclose(file) != 0) fail(errno);
  if (temporary_.empty()) return;
  std::error_code error;
  fs::rename(temporary_, target_, error);
  if (error) {
    close_and_remove();
    fail_output("'" + path_ + "' can't be written: " + error.message());
  }
  temporary_.clear();
}

void check_writable(const std::string &path) {
  AtomicFile probe(path);  // never committed: its temporary file goes with it
}

}  // namespace quickses::io
