// SPDX-License-Identifier: MIT
#include "cli/water_hint.h"

#include <cstdio>

#include "io/text.h"

namespace quickses::cli {

void hint_at_water(const Options &options, const io::Structure &structure) {
  const io::ReadOptions &read = options.read;
  if (!read.water || !read.hetero || !read.hydrogen || !read.selection.empty() || !structure.has_names) return;
  const std::vector<uint32_t> residues = io::residues_of(structure);
  size_t molecules = 0;
  for (size_t i = 0; i < residues.size(); ++i)
    if (structure.atoms[i].is_water() && (i == 0 || residues[i] != residues[i - 1])) ++molecules;
  if (molecules != 0)
    std::fprintf(stderr, "quickses: %s part of the surface; --no-water leaves %s out\n",
                 io::counted(molecules, "water molecule is", "water molecules are").c_str(),
                 molecules == 1 ? "it" : "them");
}

}  // namespace quickses::cli
