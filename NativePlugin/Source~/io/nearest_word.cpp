// SPDX-License-Identifier: MIT
#include "io/nearest_word.h"

#include <algorithm>

#include "io/text.h"

namespace quickses::io {
namespace {

constexpr size_t kLongest = 64;  // a longer word is no slip of the finger

// Optimal string alignment: insertions, deletions, substitutions and swaps of neighbours, a letter in one of them only.
size_t edit_distance(const std::string &a, const std::string &b) {
  std::vector<size_t> before_last, last(b.size() + 1), row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
    before_last = last;
    last = row;
  }
  return last[b.size()];
}

}  // namespace

std::string nearest_word(const std::string &word, const std::vector<std::string> &known) {
  if (word.empty() || word.size() > kLongest) return "";
  const std::string given = lowered(word);
  size_t smallest = std::max<size_t>(1, word.size() / 3) + 1;
  std::string nearest;
  for (const std::string &candidate : known) {
    const size_t distance = edit_distance(given, lowered(candidate));
    if (distance >= smallest || distance >= candidate.size()) continue;
    smallest = distance;
    nearest = candidate;
  }
  if (!nearest.empty() || given.size() < 3) return nearest;
  for (const std::string &candidate : known)
    if (lowered(candidate).compare(0, given.size(), given) == 0) {
      if (!nearest.empty()) return "";
      nearest = candidate;
    }
  return nearest;
}

}  // namespace quickses::io
