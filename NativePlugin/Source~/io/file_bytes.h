// SPDX-License-Identifier: MIT
// Whole files in memory, gunzipped where they are compressed, and how much of them at most.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

namespace quickses::io {

// How many bytes of a file, unpacked, are taken into memory, for the whole process. 0 (default): 4 GiB, and of gzip
// data 100 times its size or 256 MiB, whichever is larger, but no more than 4 GiB either. Calls that have begun may
// still go by the limit before.
void set_input_limit(uint64_t bytes);

// The limit of what is not compressed.
uint64_t input_limit();

// Throws Error (kInput) that names the limit and how to raise it.
[[noreturn]] void fail_too_large(const std::string &name, uint64_t limit);

struct CloseFile {
  void operator()(std::FILE *file) const { std::fclose(file); }
};
using FilePointer = std::unique_ptr<std::FILE, CloseFile>;

// Throws Error (kInput), or std::bad_alloc where it is memory that is missing.
FilePointer open_input(const std::string &path);

// The bytes of a file, a pipe or a device; of gzip data (known by its first two bytes), what is compressed in it, all
// members. Throws Error (kInput): missing, a directory, unreadable, empty, more than the limit, named .gz without being
// one, gzip data that is damaged or cut off, even where the part before the cut would make sense.
std::string read_file_bytes(const std::string &path);

// The same of standard input, which is read to its end.
std::string read_standard_input();

// What standard input is called in messages.
extern const char kStandardInput[];

// Whether they begin as gzip data do.
inline bool has_gzip_magic(std::string_view bytes) { return bytes.substr(0, 2) == "\x1f\x8b"; }

// What is compressed in gzip data; other bytes as they are. name: for messages. Throws as read_file_bytes.
std::string unpack_gzip(std::string bytes, const std::string &name);

}  // namespace quickses::io
