// SPDX-License-Identifier: MIT
// Colours of atoms from what a file says about them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "io/structure.h"

namespace quickses::io {

using Rgba = std::array<uint8_t, 4>;  // sRGB

enum class ColorScheme { kUniform, kElement, kChain, kResidue, kHydrophobicity, kSequence };

// Writes a colour per atom, opaque, to rgba, which has room for 4 bytes of each. Atoms of which the scheme tells
// nothing, such as those of ligands in the schemes of residues, have the colour `uniform`, whatever its alpha.
void color_atoms(const Structure &structure, ColorScheme scheme, Rgba uniform, uint8_t *rgba);

// Of the k-th of any number of things: neighbours differ most.
Rgba distinct_color(size_t k);

}  // namespace quickses::io
