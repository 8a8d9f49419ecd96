// SPDX-License-Identifier: MIT
#include "cli/water_hint.h"

#include "cli/tell.h"
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
    tell(io::counted(molecules, "water molecule is", "water molecules are") +
         " part of the surface; --no-water leaves " + (molecules == 1 ? "it" : "them") + " out");
}

}  // namespace quickses::cli
