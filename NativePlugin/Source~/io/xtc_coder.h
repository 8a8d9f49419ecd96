// SPDX-License-Identifier: MIT
// The compressed coordinates of XTC files.
#pragma once

#include <cstddef>
#include <cstdint>

namespace quickses::io {

struct XtcBlock {
  double precision = 0;  // stored integers are nm times this
  int32_t min[3] = {};   // range of the stored integers
  int32_t max[3] = {};
  int32_t small_index = 0;  // where the size of differences starts in the table of sizes
};

// Unpacks atom_count positions to Å. Any bytes are safe. Gives null, or what is wrong, to stand behind "is damaged: ".
const char *unpack_xtc(const XtcBlock &block, const unsigned char *bytes, size_t size, size_t atom_count, float *xyz);

// Fewest bytes that so many atoms can take.
uint64_t min_xtc_bytes(uint64_t atom_count);

}  // namespace quickses::io
