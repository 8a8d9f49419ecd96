// SPDX-License-Identifier: MIT
// Files that appear under their name only when they are complete.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace quickses::io {

// Names such as "-.ply" stand for standard output, and say what is written there.
bool is_standard_output(const std::string &path);

// The descriptor of this process that a name stands for, as /dev/stdout, /dev/fd/3 and links to them do; -1: none.
int descriptor_of(const std::string &path);

// Buffered output that goes to a temporary name in the folder of the target. commit() renames it over the target, with
// the rights that the target had; without it the destructor removes it, and whatever the target was before stays as it
// was. Devices and pipes are opened once and written directly; what a descriptor leads to, such as standard output,
// goes on where it is, as bytes. All but the destructor throw Error (kOutput), naming the target.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string &path);
  ~AtomicFile();
  AtomicFile(const AtomicFile &) = delete;
  AtomicFile &operator=(const AtomicFile &) = delete;

  // Room for size bytes (at most kBufferSize / 2) of which the caller then says how many it filled.
  char *reserve(size_t size) {
    if (buffer_.size() - used_ < size) flush();
    return buffer_.data() + used_;
  }
  void advance(size_t size) { used_ += size; }
  void write(const void *data, size_t size);
  void write(const std::string &text) { write(text.data(), text.size()); }
  void commit() {
    finish();
    publish();
  }
  // In two steps, for several files that belong together: all that was written is on its way to the disk, or it
  // throws; then it gets its name.
  void finish();
  void publish();

  // As it was given.
  const std::string &path() const { return path_; }

  static constexpr size_t kBufferSize = 1 << 20;

 private:
  void open_target();
  void create_temporary();
  void flush();
  [[noreturn]] void fail(int error_number);
  void close_and_remove();

  std::string path_;                 // as given, for messages
  std::filesystem::path target_;     // with links resolved
  std::filesystem::path temporary_;  // empty: the target is written directly
  const bool to_standard_output_;
  std::FILE *file_ = nullptr;
  std::vector<char> buffer_;
  size_t used_ = 0;
};

// Throws Error (kOutput) if AtomicFile could not write there: asks the file system itself, leaves nothing behind.
void check_writable(const std::string &path);

// For a process that is about to be ended: removes the temporary files of all AtomicFiles. No more can be made, nor can
// those there are fail or be destroyed: whoever tries, waits for the end.
void abandon_files();

}  // namespace quickses::io
