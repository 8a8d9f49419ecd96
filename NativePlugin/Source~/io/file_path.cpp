// SPDX-License-Identifier: MIT
// Paths are UTF-8 wherever they are strings. Windows has its own encoding of file names; elsewhere they are plain
// bytes.
#include "io/file_path.h"

#include <cerrno>
#include <system_error>

#include "io/error.h"
#include "io/text.h"

namespace quickses::io {

#if defined(_WIN32)

std::filesystem::path path_of(const std::string &utf8) {
  try {
    return std::filesystem::u8path(utf8);
  } catch (const std::system_error &) {
    fail_input("'" + utf8 + "' is no path: it is not UTF-8");
  }
}

std::string utf8_of(const std::filesystem::path &path) { return path.u8string(); }

std::FILE *open_stdio(const std::filesystem::path &path, const char *mode) {
  return _wfopen(path.c_str(), std::wstring(mode, mode + std::char_traits<char>::length(mode)).c_str());
}

#else

std::filesystem::path path_of(const std::string &utf8) { return utf8; }

std::string utf8_of(const std::filesystem::path &path) { return path.string(); }

std::FILE *open_stdio(const std::filesystem::path &path, const char *mode) {
  for (;;) {
    std::FILE *const file = std::fopen(path.c_str(), mode);
    if (file || errno != EINTR) return file;  // by a signal, while it waited for the other end of a pipe
  }
}

#endif

std::filesystem::path place_of(const std::filesystem::path &path) {
  namespace fs = std::filesystem;
  constexpr int kMostLinks = 40;  // as many as Linux follows
  std::error_code error;
  fs::path place = path;
  for (int links = 0; links <= kMostLinks && fs::is_symlink(place, error); ++links) {
    place = place.parent_path() / fs::read_symlink(place, error);
    if (error) return path;
  }
  if (fs::is_symlink(place, error)) return path;
  const fs::path folder = fs::canonical(place.has_parent_path() ? place.parent_path() : ".", error);
  return error ? place : folder / place.filename();
}

std::string lower_extension(const std::filesystem::path &path) { return lowered(utf8_of(path.extension())); }

std::string lower_extension_of_content(const std::filesystem::path &path) {
  const std::string extension = lower_extension(path);
  return extension == ".gz" ? lower_extension_of_content(std::filesystem::path(path).replace_extension()) : extension;
}

}  // namespace quickses::io
