// SPDX-License-Identifier: MIT
#include "cli/wildcards.h"

#if defined(_WIN32)
#include <windows.h>
// after windows.h
#include <shlwapi.h>

#include <algorithm>
#include <filesystem>

#include "io/file_path.h"
#endif

namespace quickses::cli {

#if defined(_WIN32)

namespace {

std::vector<std::string> files_that_fit(const std::string &name) {
  std::vector<std::string> files;
  const std::filesystem::path pattern = io::path_of(name);
  const std::string folder = name.substr(0, name.find_last_of("/\\:") + 1);
  WIN32_FIND_DATAW found;
  const HANDLE search = FindFirstFileW(pattern.c_str(), &found);
  if (search == INVALID_HANDLE_VALUE) return files;
  do {
    // The search looks at short names, too, by which *.pdb fits a.pdb1.
    if (!(found.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) &&
        PathMatchSpecW(found.cFileName, pattern.filename().c_str()))
      files.push_back(folder + io::utf8_of(found.cFileName));
  } while (FindNextFileW(search, &found));
  FindClose(search);
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

void expand_wildcards(std::vector<std::string> *names) {
  std::vector<std::string> all;
  for (const std::string &name : *names) {
    std::vector<std::string> files;
    if (name.find_first_of("*?") != std::string::npos) files = files_that_fit(name);
    if (files.empty()) files = {name};
    all.insert(all.end(), files.begin(), files.end());
  }
  *names = all;
}

#else

void expand_wildcards(std::vector<std::string> *) {}

#endif

}  // namespace quickses::cli
