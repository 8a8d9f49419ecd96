// SPDX-License-Identifier: MIT
#include "cli/utf8.h"

#if defined(_WIN32)
#include <windows.h>
// after windows.h
#include <shellapi.h>

#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "io/file_path.h"
#endif

namespace quickses::cli {

#if defined(_WIN32)
namespace {
UINT before = 0;
}

void use_utf8(int *argc, char ***argv) {
  static std::vector<std::string> texts;
  static std::vector<char *> pointers;
  before = GetConsoleOutputCP();
  std::atexit(leave_utf8);
  SetConsoleOutputCP(CP_UTF8);
  int count = 0;
  const std::unique_ptr<LPWSTR, decltype(&LocalFree)> wide(CommandLineToArgvW(GetCommandLineW(), &count), &LocalFree);
  if (!wide) return;
  for (int i = 0; i < count; ++i) texts.push_back(io::utf8_of(wide.get()[i]));
  for (std::string &text : texts) pointers.push_back(&text[0]);
  pointers.push_back(nullptr);
  *argc = count;
  *argv = pointers.data();
}

void leave_utf8() noexcept {
  if (before != 0) SetConsoleOutputCP(before);
}
#else
void use_utf8(int *, char ***) {}
void leave_utf8() noexcept {}
#endif

}  // namespace quickses::cli
