// SPDX-License-Identifier: MIT
// Copies of a structure side by side.
#include "cli/copies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "cli/exit_code.h"
#include "io/limits.h"

namespace quickses::cli {
namespace {

using Counts = std::array<unsigned, 3>;
using Vector = std::array<double, 3>;

struct Box {
  Vector low, high;
};

Box box_of(const io::Structure &structure) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Box box = {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  for (size_t i = 0; i < structure.positions.size(); ++i) {
    const double x = structure.positions[i], r = structure.radii[i / 3];
    box.low[i % 3] = std::min(box.low[i % 3], x - r);
    box.high[i % 3] = std::max(box.high[i % 3], x + r);
  }
  return box;
}

// How many along each axis: of all grids with room for the copies, the one whose diagonal is the shortest.
Counts find_grid(unsigned copies, const Vector &period) {
  const auto square = [](double x) { return x * x; };
  Counts best = {copies, 1, 1};
  double shortest = std::numeric_limits<double>::infinity();
  for (unsigned x = 1; x <= copies; ++x)
    for (unsigned y = 1; y <= (copies + x - 1) / x; ++y) {
      const unsigned z = (copies + x * y - 1) / (x * y);
      const double diagonal = square(x * period[0]) + square(y * period[1]) + square(z * period[2]);
      if (diagonal >= shortest) continue;
      shortest = diagonal;
      best = {x, y, z};
    }
  return best;
}

}  // namespace

io::Structure make_copies(io::Structure structure, unsigned copies, float spacing, double gap) {
  if (copies == 1) return structure;
  const double h = spacing;
  const Box box = box_of(structure);
  Vector period, first;  // Å, whole spacings
  for (int k = 0; k < 3; ++k) period[k] = h * std::ceil((box.high[k] - box.low[k] + gap) / h);
  const Counts grid = find_grid(copies, period);
  for (int k = 0; k < 3; ++k) {
    const double width = (grid[k] - 1) * period[k];
    first[k] = -h * std::round(0.5 * (box.low[k] + box.high[k] + width) / h);
    if (box.low[k] + first[k] < -io::kFarthest || box.high[k] + first[k] + width > io::kFarthest)
      throw Failure(kUsage, "--copies: " + std::to_string(copies) + " reach beyond 10^6 angstrom from the origin");
  }

  io::Structure all = structure;
  all.positions.clear();
  for (unsigned copy = 0; copy < copies; ++copy) {
    const Counts place = {copy % grid[0], copy / grid[0] % grid[1], copy / grid[0] / grid[1]};
    for (size_t i = 0; i < structure.positions.size(); ++i) {
      const size_t k = i % 3;
      all.positions.push_back(static_cast<float>(structure.positions[i] + first[k] + place[k] * period[k]));
    }
    if (copy == 0) continue;
    all.atoms.insert(all.atoms.end(), structure.atoms.begin(), structure.atoms.end());
    all.radii.insert(all.radii.end(), structure.radii.begin(), structure.radii.end());
  }
  return all;
}

}  // namespace quickses::cli
