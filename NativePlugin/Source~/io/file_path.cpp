// SPDX-License-Identifier: MIT
// Paths are UTF-8 wherever they are strings. Windows has its own encoding of file names; elsewhere they are plain
// bytes.
#include "io/file_path.h"

#if defined(_WIN32)
#include <fcntl.h>
#include <io.h>
#include <windows.h>
#endif

#include <cerrno>
#include <cstring>
#include <cwchar>
#include <system_error>

#include "io/error.h"
#include "io/text.h"

namespace quickses::io {

namespace fs = std::filesystem;

#if defined(_WIN32)

namespace {

int error_number_of(DWORD code) {
  switch (code) {
    case ERROR_FILE_NOT_FOUND:
    case ERROR_PATH_NOT_FOUND:
    case ERROR_INVALID_NAME:
    case ERROR_BAD_PATHNAME:
      return ENOENT;
    case ERROR_FILE_EXISTS:
      return EEXIST;
    case ERROR_DISK_FULL:
      return ENOSPC;
    case ERROR_FILENAME_EXCED_RANGE:
      return ENAMETOOLONG;
    case ERROR_TOO_MANY_OPEN_FILES:
      return EMFILE;
    default:
      return EACCES;
  }
}

// How paths begin that may be longer than 260 characters: functions of the C library take none of them.
constexpr wchar_t kAnyLength[] = L"\\\\?\\", kShareOfAnyLength[] = L"\\\\?\\UNC\\";

bool begins(const std::wstring &text, const wchar_t *with) { return text.compare(0, std::wcslen(with), with) == 0; }

// Where what is there really is; empty: nothing is there, or that has no plain name.
fs::path final_path(const fs::path &path) {
  const HANDLE file = CreateFileW(path.c_str(), 0, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, nullptr,
                                  OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, nullptr);
  if (file == INVALID_HANDLE_VALUE) return {};
  std::wstring place(32768, L'\0');
  const DWORD size = GetFinalPathNameByHandleW(file, &place[0], static_cast<DWORD>(place.size()), 0);
  CloseHandle(file);
  if (size == 0 || size >= place.size()) return {};
  place.resize(size);
  const bool is_share = begins(place, kShareOfAnyLength);
  if (!is_share && !begins(place, kAnyLength)) return place;
  place.erase(0, std::wcslen(is_share ? kShareOfAnyLength : kAnyLength));
  if (is_share) place.insert(0, L"\\\\");
  return place.size() < MAX_PATH ? fs::path(place) : fs::path();
}

}  // namespace

fs::path path_of(const std::string &utf8) {
  try {
    return fs::u8path(utf8);
  } catch (const std::system_error &) {
    fail_input("'" + utf8 + "' is no path: it is not UTF-8");
  }
}

std::string utf8_of(const fs::path &path) { return path.u8string(); }

// Others may replace the file, or remove it, while it is open, as they may elsewhere: the C library denies that.
std::FILE *open_stdio(const fs::path &path, const char *mode) {
  const bool reads = mode[0] == 'r', is_new = std::strchr(mode, 'x') != nullptr;
  const HANDLE handle = CreateFileW(path.c_str(), reads ? GENERIC_READ : GENERIC_WRITE,
                                    FILE_SHARE_READ | FILE_SHARE_DELETE | (reads ? FILE_SHARE_WRITE : 0), nullptr,
                                    reads    ? OPEN_EXISTING
                                    : is_new ? CREATE_NEW
                                             : CREATE_ALWAYS,
                                    FILE_ATTRIBUTE_NORMAL, nullptr);
  if (handle == INVALID_HANDLE_VALUE) {
    errno = error_number_of(GetLastError());
    return nullptr;
  }
  const int descriptor = _open_osfhandle(reinterpret_cast<intptr_t>(handle), _O_BINARY | (reads ? _O_RDONLY : 0));
  if (descriptor < 0) {
    CloseHandle(handle);
    return nullptr;
  }
  std::FILE *const file = _fdopen(descriptor, reads ? "rb" : "wb");
  if (!file) _close(descriptor);
  return file;
}

bool is_link(const fs::path &path) {  // of which GCC's filesystem library knows nothing on Windows
  WIN32_FIND_DATAW found;
  const HANDLE search = FindFirstFileW(path.c_str(), &found);
  if (search == INVALID_HANDLE_VALUE) return false;
  FindClose(search);
  return (found.dwFileAttributes & FILE_ATTRIBUTE_REPARSE_POINT) != 0 &&
         (found.dwReserved0 == IO_REPARSE_TAG_SYMLINK || found.dwReserved0 == IO_REPARSE_TAG_MOUNT_POINT);
}

fs::path place_of(const fs::path &path) {
  if (fs::path place = final_path(path); !place.empty()) return place;
  const fs::path folder = final_path(path.has_parent_path() ? path.parent_path() : fs::path("."));
  return folder.empty() ? path : folder / path.filename();
}

#else

fs::path path_of(const std::string &utf8) { return utf8; }

std::string utf8_of(const fs::path &path) { return path.string(); }

std::FILE *open_stdio(const fs::path &path, const char *mode) {
  for (;;) {
    std::FILE *const file = std::fopen(path.c_str(), mode);
    if (file || errno != EINTR) return file;  // by a signal, while it waited for the other end of a pipe
  }
}

bool is_link(const fs::path &path) {
  std::error_code error;
  return fs::is_symlink(path, error);
}

fs::path place_of(const fs::path &path) {
  constexpr int kMostLinks = 40;  // as many as Linux follows
  std::error_code error;
  fs::path place = path;
  for (int links = 0; links <= kMostLinks && is_link(place); ++links) {
    place = place.parent_path() / fs::read_symlink(place, error);
    if (error) return path;
  }
  if (is_link(place)) return path;
  const fs::path folder = fs::canonical(place.has_parent_path() ? place.parent_path() : ".", error);
  return error ? place : folder / place.filename();
}

#endif

std::string lower_extension(const fs::path &path) { return lowered(utf8_of(path.extension())); }

std::string lower_extension_of_content(const fs::path &path) {
  const std::string extension = lower_extension(path);
  return extension == ".gz" ? lower_extension_of_content(fs::path(path).replace_extension()) : extension;
}

}  // namespace quickses::io
