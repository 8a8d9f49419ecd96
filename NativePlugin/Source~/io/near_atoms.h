// SPDX-License-Identifier: MIT
// Which atoms lie near some others.
#pragma once

#include <cstdint>
#include <vector>

namespace quickses::io {

// One byte per atom: whether it is at most `distance` (Å, from 0 on) away from an atom of the set, centre to centre;
// those of the set are near themselves. positions: three numbers per atom. set: 0 or 1 per atom. Atoms more than
// 1,000,000 Å away from the origin are near nothing.
std::vector<uint8_t> atoms_near(const std::vector<float> &positions, const std::vector<uint8_t> &set, double distance);

}  // namespace quickses::io
