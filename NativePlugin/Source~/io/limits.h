// SPDX-License-Identifier: MIT
// What the surface library takes.
#pragma once

#include <cstdint>

namespace quickses::io {

constexpr double kFarthest = 1e6;       // Å from the origin, per axis
constexpr double kLargestRadius = 100;  // Å

// Of one model: far more than any structure has.
constexpr uint32_t kMostAtoms = 43'770'000;

}  // namespace quickses::io
