// SPDX-License-Identifier: MIT
// Files that appear under their name only when they are complete.
#include "io/atomic_file.h"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <mutex>
#include <set>
#include <system_error>

#if defined(_WIN32)
#include <fcntl.h>
#include <io.h>
#include <process.h>
#include <windows.h>
#define QSES_PROCESS_ID _getpid()
#else
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#define QSES_PROCESS_ID getpid()
#endif

#include "io/error.h"
#include "io/file_path.h"

namespace quickses::io {
namespace {

namespace fs = std::filesystem;

// Temporary files that are neither renamed nor removed yet.
struct Unfinished {
  std::mutex mutex;
  std::set<fs::path> names;
  unsigned counter = 0;
};

Unfinished &unfinished() {
  static Unfinished &all = *new Unfinished;  // never destroyed: a process may be stopped while it ends
  return all;
}

#if defined(_WIN32)

// Null with errno set if it can't be made, EEXIST if there is such a file.
std::FILE *create_new(const fs::path &name, const fs::path &) { return open_stdio(name, "wbx"); }

// Windows denies for a moment what another process is replacing, or looks into, as scanners for viruses do.
template <class Action>
void patiently(const fs::path &target, std::error_code &error, const Action &action) {
  constexpr int kMostTries = 100, kPause = 20;  // 2 s in all
  for (int i = 0; i < kMostTries; ++i) {
    if (i > 0) Sleep(kPause);
    action();
    if (error != std::errc::permission_denied) return;
    const DWORD attributes = GetFileAttributesW(target.c_str());
    if (attributes != INVALID_FILE_ATTRIBUTES && (attributes & FILE_ATTRIBUTE_READONLY)) return;  // that will not pass
  }
}

#else

template <class Action>
void patiently(const fs::path &, std::error_code &, const Action &action) {
  action();
}

// Null with errno set if it can't be made, EEXIST if there is such a file. It has the rights of `like` if that exists,
// else those of new files, and from the beginning no others.
std::FILE *create_new(const fs::path &name, const fs::path &like) {
  struct stat old;
  const bool replaces = ::stat(like.c_str(), &old) == 0;
  const int descriptor = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, replaces ? 0600 : 0666);
  if (descriptor < 0) return nullptr;
  if (replaces) {
    mode_t rights = old.st_mode & 0777;
    // Only root may give files away; where not even the group can be kept, another one gets none of its rights.
    if (::fchown(descriptor, old.st_uid, old.st_gid) != 0 &&
        ::fchown(descriptor, static_cast<uid_t>(-1), old.st_gid) != 0)
      rights &= 0707;
    ::fchmod(descriptor, rights);  // file systems without rights refuse: nothing to fail for
  }
  std::FILE *const file = ::fdopen(descriptor, "wb");
  if (!file) {
    const int error_number = errno;
    ::close(descriptor);
    ::unlink(name.c_str());
    errno = error_number;
  }
  return file;
}

// Null with errno set if the descriptor is not open for writing. Both have one place in the file.
std::FILE *open_copy(int descriptor) {
  const int copy = ::fcntl(descriptor, F_DUPFD_CLOEXEC, 0);
  std::FILE *const file = copy < 0 ? nullptr : ::fdopen(copy, "wb");
  if (file || copy < 0) return file;
  const int error_number = errno;
  ::close(copy);
  errno = error_number;
  return nullptr;
}

#endif

struct Target {
  fs::path place;    // with links resolved
  bool is_replaced;  // else it is written to directly: a device or a pipe
  bool is_pipe;
};

// Throws Error (kOutput) if it can't be written, as far as can be told without opening it.
Target find_target(const std::string &path) {
  Target target = {path_of(path), false, false};
  std::error_code error;
  fs::file_status status;
  patiently(target.place, error, [&] { status = fs::status(target.place, error); });
  if (!fs::status_known(status)) fail_output("'" + path + "' can't be written: " + error.message());
  if (fs::is_directory(status)) fail_output("'" + path + "' is a directory: it can't be written as a file");
  target.is_replaced = !fs::exists(status) || fs::is_regular_file(status);
  target.is_pipe = fs::is_fifo(status);
  // A link stays a link: what it points to is replaced, if it has a name (what /dev/stdout points to may have none).
  if (target.is_replaced && is_link(target.place)) {
    const fs::path place = place_of(target.place);
    target.is_replaced = !fs::exists(status) || fs::equivalent(place, target.place, error);
    if (target.is_replaced) target.place = place;
  }
  const fs::path folder = target.place.parent_path();
  if (!folder.empty() && !fs::is_directory(folder, error))
    fail_output("'" + path + "' can't be written: there is no folder '" + utf8_of(folder) + "'");
#if !defined(_WIN32)
  // Renaming would replace a file that is write-protected: ask first, as writing to it would.
  if (fs::exists(status) && access(target.place.c_str(), W_OK) != 0)
    fail_output("'" + path + "' can't be written: " + std::strerror(errno));
#endif
  return target;
}

}  // namespace

bool is_standard_output(const std::string &path) {
  return path.compare(0, 2, "-.") == 0 && path_of(path).filename() == path_of(path);
}

int descriptor_of([[maybe_unused]] const std::string &path) {
#if !defined(_WIN32)
  constexpr int kMostLinks = 40;  // as many as Linux follows
  std::error_code error;
  fs::path place = path;
  for (int links = 0; links <= kMostLinks; ++links) {
    const fs::path folder = fs::canonical(place.has_parent_path() ? place.parent_path() : ".", error);
    if (error) return -1;
    for (const char *const descriptors : {"/proc/self/fd", "/dev/fd"}) {
      if (folder != fs::canonical(descriptors, error)) continue;
      const std::string digits = place.filename();
      int descriptor = -1;
      const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), descriptor);
      return problem == std::errc() && end == digits.data() + digits.size() ? descriptor : -1;
    }
    const fs::path target = fs::read_symlink(place, error);
    if (error) return -1;  // it is no link
    place = place.parent_path() / target;
  }
#endif
  return -1;
}

AtomicFile::AtomicFile(const std::string &path)
    : path_(path), to_standard_output_(is_standard_output(path)), buffer_(kBufferSize) {
  if (to_standard_output_) {
    path_ = "standard output";
    file_ = stdout;
#if defined(_WIN32)
    _setmode(_fileno(stdout), _O_BINARY);
#endif
  } else {
    open_target();
  }
}

void AtomicFile::open_target() {
#if !defined(_WIN32)
  if (const int descriptor = descriptor_of(path_); descriptor >= 0) {
    file_ = open_copy(descriptor);
    if (!file_) fail(errno);
    std::setvbuf(file_, nullptr, _IONBF, 0);
    return;
  }
#endif
  const Target target = find_target(path_);
  target_ = target.place;
  if (target.is_replaced)
    create_temporary();
  else
    file_ = open_stdio(target_, "wb");
  if (!file_) fail(errno);
  std::setvbuf(file_, nullptr, _IONBF, 0);  // buffer_ is the buffer
}

// Its name has nothing of the target's, which may be as long as names can be.
void AtomicFile::create_temporary() {
  Unfinished &all = unfinished();
  const std::lock_guard<std::mutex> lock(all.mutex);
  constexpr int kMostTries = 1000;  // names are left of killed processes, or in use on another machine
  for (int i = 0; i < kMostTries; ++i) {
    const std::string name =
        ".quickses-" + std::to_string(QSES_PROCESS_ID) + "-" + std::to_string(all.counter++) + ".tmp";
    temporary_ = target_.parent_path() / path_of(name);
    const auto entry = all.names.insert(temporary_).first;
    file_ = create_new(temporary_, target_);
    if (file_) return;
    const int error_number = errno;
    all.names.erase(entry);
    temporary_.clear();
    errno = error_number;
    if (error_number != EEXIST) return;
  }
}

AtomicFile::~AtomicFile() { close_and_remove(); }

void AtomicFile::close_and_remove() {
  if (file_ && !to_standard_output_) std::fclose(file_);
  file_ = nullptr;
  if (temporary_.empty()) return;
  Unfinished &all = unfinished();
  const std::lock_guard<std::mutex> lock(all.mutex);
  std::error_code error;
  fs::remove(temporary_, error);
  all.names.erase(temporary_);
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

void AtomicFile::finish() {
  flush();
  std::FILE *file = file_;
  file_ = nullptr;
  if ((to_standard_output_ ? std::fflush(file) : std::fclose(file)) != 0) fail(errno);
}

void AtomicFile::publish() {
  if (temporary_.empty()) return;
  std::error_code error;
  patiently(target_, error, [&] { fs::rename(temporary_, target_, error); });
  if (error) fail_output("'" + path_ + "' can't be written: " + error.message());
  Unfinished &all = unfinished();
  const std::lock_guard<std::mutex> lock(all.mutex);
  all.names.erase(temporary_);
  temporary_.clear();
}

void check_writable(const std::string &path) {
  if (is_standard_output(path)) return;
  // To open a pipe and to close it would be its end for whoever reads it.
  if (descriptor_of(path) < 0 && find_target(path).is_pipe) return;
  AtomicFile probe(path);  // never committed: its temporary file goes with it
}

void abandon_files() {
  Unfinished &all = unfinished();
  all.mutex.lock();  // for good
  std::error_code error;
  for (const fs::path &name : all.names) fs::remove(name, error);
}

}  // namespace quickses::io
