// SPDX-License-Identifier: MIT
// Checks the caller's atoms and copies them into the back end's memory. All checks throw Error naming the argument and
// the atom.
#pragma once

#include "parallel/cpu_threads.h"
#include "surface/engine.h"

#include <cstddef>

namespace quickses {

// argument: what the caller knows the count as.
void check_layout(const float *positions, size_t stride, size_t count, const char *argument = "count");

// How large they are.
AtomRadii check_radii(const float *radii, size_t count);

// More threads would wait for memory.
constexpr unsigned kMostCopyThreads = 8;

// Where they throw, what they were to fill is of no use. They return the box of the positions; its radii are left
// 0. threads: that help with many atoms for a GPU, no more than kMostCopyThreads; or nullptr, for a CPU.
AtomBounds copy_atoms(const float *positions, size_t stride, const float *radii, size_t count, Sphere *atoms,
                      CpuThreads *threads);
// The same for positions[indices[i]]; indices are checked already.
AtomBounds copy_indexed_atoms(const float *positions, size_t stride, const uint32_t *indices, const float *radii,
                              size_t count, Sphere *atoms, CpuThreads *threads);
void check_indices(const uint32_t *indices, size_t count, size_t position_count);

}  // namespace quickses
