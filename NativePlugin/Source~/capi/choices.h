// SPDX-License-Identifier: MIT
// Enumerations of the header that name what others of the library name: as lists, in the order of those.
#pragma once

#include <cstddef>
#include <optional>

namespace quickses {

// None: the header's AUTO.
template <class Own, class Public, size_t kCount>
std::optional<Own> own_choice(const Public (&list)[kCount], Public choice) {
  for (size_t k = 0; k < kCount; ++k)
    if (list[k] == choice) return static_cast<Own>(k);
  return std::nullopt;
}
template <class Own, class Public, size_t kCount>
Public public_choice(const Public (&list)[kCount], Own own) {
  return list[static_cast<size_t>(own)];
}

}  // namespace quickses
