// SPDX-License-Identifier: MIT
// Structures and enumerations as they cross the border to C.
#pragma once

#include "capi/barrier.h"
#include "io/text.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

namespace quickses {

// Of a caller's array. whole: whose atoms it is about.
inline void check_atom_count(size_t count, size_t atoms, const char *whole) {
  if (count != atoms)
    invalid("count is " + std::to_string(count) + " but the " + whole + " has " + io::counted(atoms, "atom"));
}

// Structures with a struct_size: callers may have been compiled with an older header or a newer one, so what they hand
// over may be shorter or longer than ours. No byte behind struct_size is looked at or touched.

// A size that no header can have is that of a structure that was not prepared. name: its type.
template <class T>
void check_struct(const T *given, const char *name) {
  constexpr uint32_t kSmallest = 8, kLargest = 4096;
  const uint32_t size = given->struct_size;
  if (size < kSmallest || size > kLargest || size % alignof(T) != 0)
    invalid(std::string(name) + ".struct_size is " + std::to_string(size) + ": use " + name +
            "_init of the header first");
}

// What the caller gives; what an older caller's structure lacks keeps its default. What a newer caller's has in
// addition must be 0: then it asks for nothing that would not be done here. (The rule of Linux for extensible system
// calls, copy_struct_from_user.) NULL: the defaults.
template <class T>
T read_struct(const T *given, void (*init)(T *), const char *name) {
  T value;
  init(&value);
  if (!given) return value;
  check_struct(given, name);
  const char *const bytes = reinterpret_cast<const char *>(given);
  for (size_t k = sizeof(T); k < given->struct_size; ++k)
    if (bytes[k] != 0)
      invalid(std::string(name) + " has something in byte " + std::to_string(k) +
              ", but version " QUICKSES_VERSION " of the library knows the first " + std::to_string(sizeof(T)) +
              " only");
  std::memcpy(static_cast<void *>(&value), given, std::min<size_t>(given->struct_size, sizeof(T)));
  value.struct_size = sizeof(T);
  return value;
}

// As much of the value as the caller's structure has room for; struct_size stays the caller's.
template <class T>
void write_struct(T *out, const T &value, const char *name) {
  check_struct(out, name);
  constexpr size_t kSize = sizeof out->struct_size;
  std::memcpy(reinterpret_cast<char *>(out) + kSize, reinterpret_cast<const char *>(&value) + kSize,
              std::min<size_t>(out->struct_size, sizeof(T)) - kSize);
}

// Its mesh has a size of its own, which stays the caller's too.
inline void write_device_mesh(qses_device_mesh *out, qses_device_mesh value) {
  check_struct(out, "qses_device_mesh");
  if (out->struct_size >= offsetof(qses_device_mesh, mesh) + sizeof out->mesh.struct_size)
    value.mesh.struct_size = out->mesh.struct_size;
  write_struct(out, value, "qses_device_mesh");
}

// A C caller may put any number into an enumeration: it is looked at as a number before it is used as one.
template <class Choice>
void check_choice(const char *name, const Choice &given, Choice last) {
  int32_t value;
  static_assert(sizeof value == sizeof given, "enumerations of the header have the size of an int");
  std::memcpy(&value, &given, sizeof value);
  if (value < 0 || value > static_cast<int32_t>(last))
    invalid(std::string(name) + " is " + std::to_string(value) + ", which names nothing in the header");
}

// A float, or a whole number, with the digits that tell it from its neighbours: 100.00001, not the 100 that it
// exceeds.
inline std::string number_text(double value) {
  char text[32];
  const bool whole = value == std::floor(value) && std::fabs(value) < 1e15;
  int digits = whole ? 16 : 6;
  do std::snprintf(text, sizeof text, "%.*g", digits, value);
  while (++digits <= 9 && std::strtof(text, nullptr) != static_cast<float>(value));
  return text;
}

// The k-th of some things. name: of one.
template <class T>
const T &pick(const std::vector<T> &things, uint32_t k, const char *name) {
  if (k >= things.size()) invalid("k is " + std::to_string(k) + " but " + io::there_are(things.size(), name));
  return things[k];
}

}  // namespace quickses
