// SPDX-License-Identifier: MIT
// Biological assemblies: copies of chains, turned and moved as PDB (REMARK 350) and mmCIF files say.
#pragma once

#include "io/readers.h"  // before other gemmi headers: settles how gemmi formats numbers

#include <string>

namespace quickses::io {

// The assembly of that name. Of mmCIF files, that of the first block with atoms. Throws Error: kUsage (there is none of
// this name; the message lists those there are), kInput (it makes no sense).
gemmi::Assembly find_pdb_assembly(const std::string &text, const std::string &path, const std::string &name);
gemmi::Assembly find_mmcif_assembly(const std::string &text, const std::string &path, const std::string &name);

// Puts the copies in the place of the model, operation after operation, each chain by chain; atoms are numbered anew in
// this order. The first copy of a chain keeps its name, further ones have 2, 3 and so on behind it. An atom that an
// operation leaves in its place (less than 0.2 Å away), as on an axis, is there once. Throws Error (kInput).
void build_assembly(const gemmi::Assembly &assembly, RawModel &raw, const std::string &path);

}  // namespace quickses::io
