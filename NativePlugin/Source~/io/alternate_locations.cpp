// SPDX-License-Identifier: MIT
#include "io/alternate_locations.h"

#include <algorithm>
#include <set>

#include "io/error.h"
#include "io/text.h"

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
    fail_usage("the alternate location '" + excerpt_of(choice) +
               "' is neither 'first', 'highest' nor a label of one letter");
  wanted_ = choice[0];
}

void AlternateLocations::see(const gemmi::Chain &chain, const gemmi::Residue &residue, const gemmi::Atom &atom) {
  if (atom.altloc == '\0') return;
  const std::string key = key_of(chain, residue);
  Locations &locations = locations_[key];
  const auto find = [&](char label) {
    return std::find_if(locations.begin(), locations.end(), [&](const Location &l) { return l.label == label; });
  };
  if (find(atom.altloc) == locations.end()) locations.push_back({atom.altloc, 0, 0, residue.name, locations.size()});
  const auto location = find(atom.altloc);
  location->occupancies += static_cast<double>(atom.occ);
  ++location->count;

  const auto join = [&](size_t group) {
    for (Location &other : locations)
      if (other.group == group) other.group = location->group;
  };
  join(find(first_labels_.emplace(key + '/' + atom.name, atom.altloc).first->second)->group);
  for (const Location &other : locations)
    if (other.residue != residue.name) join(other.group);
}

bool AlternateLocations::keep(const gemmi::Chain &chain, const gemmi::Residue &residue, const gemmi::Atom &atom) const {
  if (atom.altloc == '\0') return true;
  const Locations &locations = locations_.at(key_of(chain, residue));
  const auto location =
      std::find_if(locations.begin(), locations.end(), [&](const Location &l) { return l.label == atom.altloc; });
  return atom.altloc == chosen_of(locations, location->group);
}

char AlternateLocations::chosen_of(const Locations &locations, size_t group) const {
  const auto mean = [](const Location &l) { return l.occupancies / static_cast<double>(l.count); };
  const Location *chosen = nullptr;
  for (const Location &location : locations) {
    if (location.group != group) continue;
    const bool is_better = !chosen || location.label == wanted_ || (takes_highest_ && mean(location) > mean(*chosen));
    if (is_better) chosen = &location;
  }
  return chosen->label;
}

std::string AlternateLocations::warning() const {
  if (wanted_ == '\0') return "";
  std::set<char> labels;
  for (const auto &[residue, locations] : locations_)
    for (const Location &location : locations) labels.insert(location.label);
  if (labels.count(wanted_) != 0) return "";
  std::string sentence = std::string("no residue has the alternate location '") + wanted_ + "'";
  for (const char label : labels)
    sentence += (label == *labels.begin() ? "; there are " : ", ") + std::string(1, label);
  return sentence + (labels.empty() ? "; there are none" : "");
}

}  // namespace quickses::io
