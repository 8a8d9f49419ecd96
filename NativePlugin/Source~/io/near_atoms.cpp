// SPDX-License-Identifier: MIT
// The atoms of the set go into cubic cells. An atom looks at the cells that its sphere reaches: one that lies in the
// sphere as a whole settles it, so that large distances don't cost more than small ones.
#include "io/near_atoms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <unordered_map>

#include "io/limits.h"

namespace quickses::io {
namespace {

constexpr double kSmallestCell = 4;  // Å: some atoms per cell, and numbers of cells in 21 bits per axis
constexpr int kCellsPerSphere = 4;   // of its radius: a compromise between cells and atoms to look at
constexpr double kRounding = 1e-6;   // Å, of the borders of cells

using Point = std::array<double, 3>;

class Cells {
 public:
  Cells(const std::vector<float> &positions, const std::vector<uint8_t> &set, double distance)
      : distance_(distance),
        edge_(std::max(kSmallestCell, distance / kCellsPerSphere)),
        reach_(static_cast<int64_t>(std::ceil(distance / edge_))) {
    std::vector<std::pair<uint64_t, Point>> members;
    for (size_t i = 0; i < set.size(); ++i) {
      const Point point = {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]};
      if (set[i] && is_in_reach(point)) members.emplace_back(key_of(cell_of(point)), point);
    }
    std::sort(members.begin(), members.end());
    for (size_t first = 0, last = 0; first < members.size(); first = last) {
      while (last < members.size() && members[last].first == members[first].first) ++last;
      places_[members[first].first] = filled_.size();
      filled_.push_back({cell_of(members[first].second), first, last});
    }
    for (const auto &member : members) points_.push_back(member.second);
  }

  bool has_near(const Point &point) const {
    if (!is_in_reach(point)) return false;
    const Cell home = cell_of(point);
    if (look_into(home, point)) return true;  // mostly that is enough
    const auto width = static_cast<uint64_t>(2 * reach_ + 1);
    if (filled_.size() < width * width * width)
      return std::any_of(filled_.begin(), filled_.end(),
                         [&](const FilledCell &filled) { return look_into(filled, point); });
    Cell cell;
    for (cell[0] = home[0] - reach_; cell[0] <= home[0] + reach_; ++cell[0])
      for (cell[1] = home[1] - reach_; cell[1] <= home[1] + reach_; ++cell[1])
        for (cell[2] = home[2] - reach_; cell[2] <= home[2] + reach_; ++cell[2])
          if (cell != home && look_into(cell, point)) return true;
    return false;
  }

 private:
  using Cell = std::array<int64_t, 3>;

  struct FilledCell {
    Cell cell;
    size_t first, last;  // points
  };

  static bool is_in_reach(const Point &point) {
    return std::all_of(point.begin(), point.end(), [](double x) { return std::abs(x) <= kFarthest; });
  }

  Cell cell_of(const Point &point) const {
    Cell cell;
    for (int axis = 0; axis < 3; ++axis) cell[axis] = static_cast<int64_t>(std::floor(point[axis] / edge_));
    return cell;
  }

  static uint64_t key_of(const Cell &cell) {
    constexpr int64_t kOffset = 1 << 20;
    uint64_t key = 0;
    for (const int64_t place : cell) key = key << 21 | static_cast<uint64_t>(place + kOffset);
    return key;
  }

  bool look_into(const Cell &cell, const Point &point) const {
    const auto found = places_.find(key_of(cell));
    return found != places_.end() && look_into(filled_[found->second], point);
  }

  bool look_into(const FilledCell &filled, const Point &point) const {
    const Cell &cell = filled.cell;
    double nearest = 0, farthest = 0;  // squared distances to the cell
    for (int axis = 0; axis < 3; ++axis) {
      const double low = static_cast<double>(cell[axis]) * edge_ - point[axis];
      const double high = low + edge_;
      const double near_side = std::max({low - kRounding, -high - kRounding, 0.0});
      const double far_side = std::max(-low, high) + kRounding;
      nearest += near_side * near_side;
      farthest += far_side * far_side;
    }
    const double square = distance_ * distance_;
    if (farthest < square) return true;
    if (nearest > square) return false;
    return std::any_of(points_.begin() + static_cast<ptrdiff_t>(filled.first),
                       points_.begin() + static_cast<ptrdiff_t>(filled.last), [&](const Point &other) {
                         double sum = 0;
                         for (int axis = 0; axis < 3; ++axis)
                           sum += (other[axis] - point[axis]) * (other[axis] - point[axis]);
                         return sum <= square;
                       });
  }

  const double distance_, edge_;
  const int64_t reach_;  // cells
  std::vector<Point> points_;
  std::vector<FilledCell> filled_;
  std::unordered_map<uint64_t, size_t> places_;  // of filled cells, by their keys
};

}  // namespace

std::vector<uint8_t> atoms_near(const std::vector<float> &positions, const std::vector<uint8_t> &set, double distance) {
  const Cells cells(positions, set, distance);
  std::vector<uint8_t> is_near(set.size());
  for (size_t i = 0; i < set.size(); ++i)
    is_near[i] = set[i] || cells.has_near({positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]});
  return is_near;
}

}  // namespace quickses::io
