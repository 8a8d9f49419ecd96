// SPDX-License-Identifier: MIT
#include "cli/water_hint.h"

#include <cstdio>

namespace quickses::cli {

void hint_at_water(const Options &options, const io::Structure &structure) {
  const io::ReadOptions &read = options.read;
  if (!read.water || !read.hetero || !read.hydrogen || !read.selection.empty() || !structure.has_names) return;
  const std::vector<uint32_t> residues = io::residues_of(structure);
  size_t molecules = 0;
  for (size_t i = 0; i < residues.size(); ++i)
    if (structure.atoms[i].water && (i == 0 || residues[i] != residues[i - 1])) ++molecules;
  if (molecules != 0)
    std::fprintf(stderr, "quickses: %zu water %s part of the surface; --no-water leaves %s out\n", molecules,
                 molecules == 1 ? "molecule is" : "molecules are", molecules == 1 ? "it" : "them");
}

}  // namespace quickses::cli
