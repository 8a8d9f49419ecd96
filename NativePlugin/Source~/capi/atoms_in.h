// SPDX-License-Identifier: MIT
// Checks the caller's atoms and copies them into the back end's memory. All checks throw Error naming the argument and
// the atom.
#pragma once

#include "surface/engine.h"

#include <cstddef>

namespace quickses {

void check_layout(const float *positions, size_t stride, size_t count);

// Box of the positions; its max_radius is left 0.
AtomBounds check_positions(const float *positions, size_t stride, size_t count);

// The largest radius.
float check_radii(const float *radii, size_t count);

void copy_positions(const float *positions, size_t stride, size_t count, Sphere *atoms);

// The same for positions[indices[i]].
AtomBounds check_indexed_positions(const float *positions, size_t stride, size_t position_count,
                                   const uint32_t *indices, size_t count);
void copy_indexed_positions(const float *positions, size_t stride, const uint32_t *indices, size_t count,
                            Sphere *atoms);

}  // namespace quickses
