// SPDX-License-Identifier: MIT
#include "io/alternate_locations.h"

#include <algorithm>

#include "io/error.h"

namespace quickses::io {
namespace {

std::string key_of(const gemmi::Chain &chain, const gemmi::Residue &residue) {
  return chain.name + '/' + residue.seqid.str();
}

}  // namespace

AlternateLocations::AlternateLocations(const std::string &choice) {
  takes_highest_ = choice == "highest";
  if (choice.empty() || choice == "first" || takes_highest_) return;
  if (choice.size() != 1)
    fail_usage("the alternate location '" + choice + "' is neither 'first', 'highest' nor a label of one letter");
  wanted_ = choice[0];
}

void AlternateLocations::see(const gemmi::Chain &chain, const gemmi::Residue &residue, const gemmi::Atom &atom) {
  if (atom.altloc == '\0') return;
  std::vector<Location> &locations = locations_[key_of(chain, residue)];
  auto location =
      std::find_if(locations.begin(), locations.end(), [&](const Location &l) { return l.label == atom.altloc; });
  if (location == locations.end()) location = locations.insert(location, {atom.altloc, 0, 0});
  location->occupancies += static_cast<double>(atom.occ);
  ++location->count;
}

bool AlternateLocations::keep(const gemmi::Chain &chain, const gemmi::Residue &residue, const gemmi::Atom &atom) const {
  return atom.altloc == '\0' || atom.altloc == chosen_of(locations_.at(key_of(chain, residue)));
}

char AlternateLocations::chosen_of(const std::vector<Location> &locations) const {
  const auto mean = [](const Location &l) { return l.occupancies / static_cast<double>(l.count); };
  if (takes_highest_)
    return std::max_element(locations.begin(), locations.end(),
                            [&](const Location &a, const Location &b) { return mean(a) < mean(b); })
        ->label;
  const bool has_wanted =
      std::any_of(locations.begin(), locations.end(), [&](const Location &l) { return l.label == wanted_; });
  return has_wanted ? wanted_ : locations.front().label;
}

}  // namespace quickses::io
