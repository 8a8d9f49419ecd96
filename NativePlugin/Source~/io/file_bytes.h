// SPDX-License-Identifier: MIT
// Whole files in memory, gunzipped where they are compressed.
#pragma once

#include <string>

namespace quickses::io {

// The bytes of a file; of a gzip file (known by its first two bytes), what is compressed in it, all members.
// Throws Error (kInput): missing, a directory, unreadable, empty, named .gz without being one, gzip data that is
// damaged or cut off, even where the part before the cut would make sense.
std::string read_file_bytes(const std::string &path);

// What is compressed in gzip data; other bytes as they are. name: for messages. Throws as read_file_bytes.
std::string unpack_gzip(std::string bytes, const std::string &name);

}  // namespace quickses::io
