// SPDX-License-Identifier: MIT
// Structures and enumerations as they cross the border to C.
#pragma once

#include "capi/barrier.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace quickses {

// The caller's structure may be older, hence shorter, than ours: what it lacks keeps its default.
template <class T>
T read_struct(const T *given, void (*init)(T *), const char *name) {
  T value;
  init(&value);
  if (!given) return value;
  if (given->struct_size < sizeof(uint32_t) || given->struct_size > 65536)
    invalid(std::string(name) + "->struct_size is " + std::to_string(given->struct_size) + ": use " + name +
            "_init of the header first");
  std::memcpy(static_cast<void *>(&value), given, std::min<size_t>(given->struct_size, sizeof(T)));
  value.struct_size = sizeof(T);
  return value;
}

template <class T>
void check_output(const T *out, const char *name) {
  if (out->struct_size < sizeof(uint32_t) || out->struct_size > 65536)
    invalid(std::string(name) + "->struct_size is " + std::to_string(out->struct_size) + ": use qses_" + name +
            "_init first");
}

template <class T>
void write_struct(T *out, const T &value, const char *name) {
  check_output(out, name);
  const uint32_t size = out->struct_size;
  std::memcpy(static_cast<void *>(out), &value, std::min<size_t>(size, sizeof(T)));
  out->struct_size = size;
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

// The k-th sentence for the user.
inline const char *pick_warning(const std::vector<std::string> &warnings, uint32_t k) {
  if (k >= warnings.size())
    invalid("k is " + std::to_string(k) + " but there are " + std::to_string(warnings.size()) + " warnings");
  return warnings[k].c_str();
}

}  // namespace quickses
