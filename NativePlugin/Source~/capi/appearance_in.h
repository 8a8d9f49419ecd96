// SPDX-License-Identifier: MIT
// Copies what a caller gives per atom. NULL: nothing is set.
#pragma once

#include "surface/stages/appearance.h"

#include <algorithm>
#include <cstring>

namespace quickses {

// Where all are visible, nothing is set either.
inline void copy_visible(const uint8_t *visible, size_t count, Appearance *to) {
  to->visible.clear();
  if (visible && std::find(visible, visible + count, uint8_t(0)) != visible + count)
    to->visible.assign(visible, visible + count);
}

inline void copy_colors(const uint8_t *rgba, size_t count, Appearance *to) {
  to->colors.resize(rgba ? count : 0);
  if (rgba && count > 0) std::memcpy(to->colors.data(), rgba, 4 * count);
}

inline void copy_texcoords(const float *uv, size_t count, Appearance *to) {
  to->texcoords.resize(uv ? count : 0);
  if (uv && count > 0) std::memcpy(static_cast<void *>(to->texcoords.data()), uv, sizeof(glm::vec2) * count);
}

}  // namespace quickses
