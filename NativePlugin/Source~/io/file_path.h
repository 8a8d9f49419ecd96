// SPDX-License-Identifier: MIT
// Paths are UTF-8 wherever they are strings. Windows has its own encoding of file names; elsewhere they are plain
// bytes.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string>

namespace quickses::io {

// Throws Error (kInput) on Windows if it is no UTF-8.
std::filesystem::path path_of(const std::string &utf8);

std::string utf8_of(const std::filesystem::path &path);

// With its dot, letters of ASCII in lower case; "" if there is none.
std::string lower_extension(const std::filesystem::path &path);
// The same of what is in a gzip file: that before .gz, if it ends so.
std::string lower_extension_of_content(const std::filesystem::path &path);

// Whether its last name is a link, of files or folders.
bool is_link(const std::filesystem::path &path);

// Where a file is, or would be made: links are followed, also one that leads to nothing yet (not on Windows). Absolute,
// unless its folder is missing; the path as it is where that can't be told, as in a circle of links.
std::filesystem::path place_of(const std::filesystem::path &path);

// As std::fopen, of which mode is "rb", "wb" or "wbx".
std::FILE *open_stdio(const std::filesystem::path &path, const char *mode);

}  // namespace quickses::io
