// SPDX-License-Identifier: MIT
// Uniform neighbour grid (QuickSES 2019, section 2.1): items are hashed to cells, put in order by cell, and found again
// by the runs of cells along x. Used for the atoms (edge p + r_max) and for the balls around exposed arcs. The order is
// found by counting where cells are few and none is crowded, else by sorting.
#pragma once

#include "parallel/anticipation.h"
#include "parallel/atomics.h"
#include "parallel/executor.h"
#include "surface/geometry/types.h"

#include <algorithm>
#include <cmath>

namespace quickses {

// How large items are. Look-ups reach as far as the largest item in a cell does; a few that are much larger than all
// others are in none: they come behind, and every look-up meets them.
struct ItemRadii {
  float in_cells;  // the largest
  uint32_t large;  // number of larger items
};

// Where the cells of a grid lie. Cells are numbered x fastest.
struct CellLayout {
  glm::vec3 origin;
  float inverse_edge;
  glm::ivec3 count;
  ItemRadii radii;

  QSES_FN bool is_large(float radius) const { return radii.large > 0 && radius > radii.in_cells; }

  QSES_FN int cell_along(float position, float start, int n) const {
    const float c = (position - start) * inverse_edge, last = static_cast<float>(n - 1);
    const int cell = static_cast<int>(c > 0.f ? c < last ? c : last : 0.f);
    return cell < n ? cell : n - 1;  // beyond 2^24 the last one may have been rounded up
  }
  QSES_FN uint64_t hash(const glm::vec3 &p) const {
    return row(cell_along(p.y, origin.y, count.y), cell_along(p.z, origin.z, count.z)) +
           static_cast<uint64_t>(cell_along(p.x, origin.x, count.x));
  }
  QSES_FN uint64_t row(int y, int z) const {
    return (static_cast<uint64_t>(z) * static_cast<uint64_t>(count.y) + static_cast<uint64_t>(y)) *
           static_cast<uint64_t>(count.x);
  }
  QSES_FN uint64_t cells() const { return row(0, count.z); }
};

// Number of the first of n sorted keys that is not below the key.
QSES_FN uint32_t lower_bound(const uint64_t *keys, uint32_t n, uint64_t key) {
  uint32_t first = 0;
  while (n > 0) {
    const uint32_t half = n >> 1;
    const bool below = keys[first + half] < key;
    first = below ? first + half + 1 : first;
    n = below ? n - half - 1 : half;
  }
  return first;
}

// Cells that a box can touch, clamped to the grid: rows along x, numbered y fastest.
struct CellBox {
  int x0, x1, y0, y1, z0, z1;
  struct Row {
    int y, z;
  };
  QSES_FN int rows_along_y() const { return y1 - y0 + 1; }
  QSES_FN int rows() const { return rows_along_y() * (z1 - z0 + 1); }
  // By a quotient of floats, which is quicker on a GPU, and wrong by one at most.
  QSES_FN Row row(int r) const {
    const int along_y = rows_along_y();
    int z = static_cast<int>(quotient(static_cast<float>(r), static_cast<float>(along_y))), y = r - z * along_y;
    if (y < 0) --z, y += along_y;
    if (y >= along_y) ++z, y -= along_y;
    return {y0 + y, z0 + z};
  }
};
QSES_FN CellBox cells_around(const CellLayout &cells, const Vec3<float> &low, const Vec3<float> &high) {
  return {
      cells.cell_along(low.x, cells.origin.x, cells.count.x), cells.cell_along(high.x, cells.origin.x, cells.count.x),
      cells.cell_along(low.y, cells.origin.y, cells.count.y), cells.cell_along(high.y, cells.origin.y, cells.count.y),
      cells.cell_along(low.z, cells.origin.z, cells.count.z), cells.cell_along(high.z, cells.origin.z, cells.count.z)};
}
// Of a box that is so much wider on every side; and around a point.
QSES_FN CellBox cells_within(const CellLayout &cells, const Vec3<float> &low, const Vec3<float> &high, float reach) {
  const Vec3<float> r(reach, reach, reach);
  return cells_around(cells, low - r, high + r);
}
QSES_FN CellBox cells_within(const CellLayout &cells, const Vec3<float> &x, float reach) {
  return cells_within(cells, x, x, reach);
}

// The grid as kernels see it.
struct NeighborGridView {
  CellLayout cells;
  const Sphere *items;          // sorted by cell, then by the order they were given in
  const uint32_t *order;        // sorted place -> number when given
  const uint32_t *starts;       // first item of each cell, and the total; nullptr if the grid is sparse
  const uint64_t *sorted_keys;  // cell of each sorted item, if the grid is sparse
  uint32_t count;

  // Items of the cells x0 ... x1 of a row: one run, since x is fastest.
  QSES_FN ItemRun run(int x0, int x1, int y, int z) const {
    if (starts) {  // there are fewer cells than 2^32
      const uint32_t *const row = starts + static_cast<uint32_t>(cells.row(y, z));
      return {row[x0], row[x1 + 1]};
    }
    const uint64_t row = cells.row(y, z);
    const uint64_t first = row + static_cast<uint64_t>(x0), last = row + static_cast<uint64_t>(x1) + 1;
    const uint32_t begin = lower_bound(sorted_keys, count, first);
    return {begin, begin + lower_bound(sorted_keys + begin, count - begin, last)};
  }
  // All runs that a look-up in a box meets: one for each row, and that of the large items.
  QSES_FN int runs(const CellBox &box) const { return box.rows() + (cells.radii.large > 0 ? 1 : 0); }
  QSES_FN ItemRun run(const CellBox &box, int r) const {
    if (r >= box.rows()) return large_items();
    const CellBox::Row row = box.row(r);
    return run(box.x0, box.x1, row.y, row.z);
  }
  QSES_FN ItemRun large_items() const { return {count - cells.radii.large, count}; }
  // The same for one thread: use(run), until it returns false, and then so does this.
  template <class Use>
  QSES_FN bool for_each_run(const CellBox &box, const Use &use) const {
    for (int z = box.z0; z <= box.z1; ++z)
      for (int y = box.y0; y <= box.y1; ++y)
        if (!use(run(box.x0, box.x1, y, z))) return false;
    return cells.radii.large == 0 || use(large_items());
  }
};

// Stands where there may have been one more item: in no cell, and behind all others from the start. No grid has both
// such items and large ones.
QSES_FN bool is_no_item(const Sphere &s) { return s.radius < 0.f; }
QSES_FN Sphere no_item() { return {glm::vec3(kFarAway), -1.f}; }

// More items in a cell are sorted: counting asks each of a cell's items for its rank among the others.
constexpr uint32_t kCrowd = 2048;
static_assert(kCrowd / 4 <= kPlainSteps, "so that ranking is a plain pass: five instructions for each item of a cell");
// Fewer are not told to the host, so that it does not matter to it that they change.
constexpr uint32_t kFewInCell = 256;
// Items in the fullest cell.
using CrowdTally = Tally<uint32_t, kFewInCell>;

struct CellCounts {
  uint32_t *in_cell = nullptr;  // zeros at first, behind the cells for large items; nullptr: nothing is counted
  uint32_t *slots = nullptr;    // of each item, how many of its cell were counted before it
  CrowdTally *fullest = nullptr;
  QSES_FN void add(size_t i, uint64_t cell) const {
    const uint32_t slot = slots[i] = atomic_add(&in_cell[cell], uint32_t(1));
    if (slot >= kFewInCell && slot >= atomic_load(&fullest->count)) atomic_max(&fullest->count, slot + 1);
  }
};

template <class ItemAt>
struct HashItems {
  CellLayout cells;
  ItemAt item_at;
  Sphere *items;
  uint64_t *keys;
  CellCounts counts;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const Sphere item = item_at(i);
    items[i] = item;
    keys[i] = is_no_item(item) || cells.is_large(item.radius) ? cells.cells() : cells.hash(item.center);
    if (counts.in_cell && !is_no_item(item)) counts.add(i, keys[i]);
  }
};

struct LoadItem {
  const Sphere *items;
  QSES_HOST_DEVICE Sphere operator()(size_t i) const { return items[i]; }
};

// The items of each cell together, in whatever order they were counted.
struct CollectNumbers {
  const uint64_t *keys;
  const uint32_t *starts, *slots;
  uint64_t cells;
  uint32_t large;
  uint32_t *numbers;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint64_t cell = keys[i];
    if (cell < cells || large > 0) numbers[starts[cell] + slots[i]] = static_cast<uint32_t>(i);
  }
};

constexpr size_t kBehindItems = 8;  // kernels load whole packs

// Puts them in order, and leaves what kernels may load behind the last item. For kBehindItems or all items, whichever
// are more. bring(place, i): what else is to be in that order.
struct BringNothing {
  QSES_FN void operator()(size_t, size_t) const {}
};
template <class Bring>
struct RankItems {
  const uint64_t *keys;
  const uint32_t *starts, *numbers;
  const Sphere *items;
  uint64_t cells;
  uint32_t large;
  size_t count;
  Sphere *sorted;
  uint32_t *order;
  Bring bring;
  QSES_HOST_DEVICE void operator()(size_t place) const {
    if (place < kBehindItems) sorted[count + place] = removed_atom();
    if (place >= count) return;
    if (place >= starts[cells] + large) {  // no item
      sorted[place] = items[place];
      order[place] = static_cast<uint32_t>(place);
      return;
    }
    const uint32_t i = numbers[place];
    const uint32_t begin = starts[keys[i]], found = keys[i] < cells ? starts[keys[i] + 1] - begin : large;
    uint32_t rank = begin;
    if (found <= kCrowd)
      for (uint32_t k = 0; k < found; ++k) rank += numbers[begin + k] < i ? 1 : 0;
    else  // only in a frame that is thrown away
      rank = static_cast<uint32_t>(place);
    sorted[rank] = items[i];
    order[rank] = i;
    bring(rank, i);
  }
};

// First item of each cell of a chunk: found once, then walked. On the GPU a chunk is one cell.
template <uint64_t kChunk>
struct FindCellStarts {
  const uint64_t *keys;
  uint32_t count;
  uint64_t cells;
  uint32_t *starts;
  QSES_HOST_DEVICE void operator()(size_t chunk) const {
    const uint64_t first = chunk * kChunk, last = first + kChunk <= cells ? first + kChunk : cells + 1;
    uint32_t i = lower_bound(keys, count, first);
    for (uint64_t cell = first; cell < last; ++cell) {
      while (i < count && keys[i] < cell) ++i;
      starts[cell] = i;
    }
  }
};

// Puts items in order, finds where cells start, and leaves what kernels may load behind the last item.
template <uint64_t kChunk, class Bring>
struct ArrangeItems {
  const Sphere *items;
  const uint32_t *order;
  Sphere *sorted;
  size_t count, chunks;
  FindCellStarts<kChunk> find_starts;
  Bring bring;
  // As many as there are items, chunks, or spheres behind, whichever is the most.
  size_t size() const { return std::max({count, chunks, kBehindItems}); }
  QSES_HOST_DEVICE void operator()(size_t i) const {
    if (i < count) {
      sorted[i] = items[order[i]];
      if (!is_no_item(sorted[i])) bring(i, order[i]);
    }
    if (i < chunks) find_starts(i);
    if (i < kBehindItems) sorted[count + i] = removed_atom();
  }
};

// A table with an entry per cell is used while it is small against the items; beyond that cells are looked up by
// binary search, so that one stray atom far away costs nothing.
constexpr uint64_t kMaxDenseCells = 100000000;
constexpr uint64_t kSmallTable = uint64_t(1) << 22;  // entries that nobody notices
constexpr bool dense_table_pays(uint64_t entries, uint64_t items) {
  return entries <= kMaxDenseCells && (entries <= kSmallTable || entries <= 64 * items);
}

// Whether to count pays, which goes over all cells.
constexpr bool counting_pays(uint64_t cells, uint64_t items) { return cells <= 65536 || cells <= 32 * items; }

inline CellLayout layout_cells(const glm::vec3 &low, const glm::vec3 &high, float edge, const ItemRadii &radii) {
  CellLayout cells;
  cells.radii = radii;
  cells.origin = low;
  cells.inverse_edge = 1.f / edge;
  for (int d = 0; d < 3; ++d) cells.count[d] = static_cast<int>((high[d] - low[d]) / edge) + 1;
  return cells;
}
// As wide as the largest item.
inline CellLayout layout_cells(const glm::vec3 &low, const glm::vec3 &high, float edge) {
  return layout_cells(low, high, edge, {edge, 0});
}

// Of items that a look-up meets run by run: those whose places among them are in a range. With very many of them the
// GPU looks at some per launch.
struct MetItems {
  uint64_t first = 0, last = ~uint64_t(0);
  uint64_t met = 0;
  QSES_FN ItemRun cut(const ItemRun &run) {
    const uint64_t begin = met, count = run.end - run.begin;
    met += count;
    return {run.begin + place(first, begin, count), run.begin + place(last, begin, count)};
  }

 private:
  QSES_FN static uint32_t place(uint64_t at, uint64_t begin, uint64_t count) {
    return static_cast<uint32_t>(at <= begin ? 0 : at - begin < count ? at - begin : count);
  }
};

// Calls pass(part, is_last) for parts of so many items at most, of those that a look-up can meet.
template <class Pass>
void for_parts_of_met_items(uint64_t near, uint64_t most, const Pass &pass) {
  for (uint64_t first = 0; first == 0 || first < near; first += most) {
    const bool is_last = first + most >= near;
    pass(MetItems{first, is_last ? ~uint64_t(0) : first + most}, is_last);
  }
}

// Items in the fullest cell.
struct FindFullestCell {
  NeighborGridView grid;
  Tally<uint32_t> *fullest;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const CellLayout &cells = grid.cells;
    const glm::vec3 p = grid.items[i].center;
    const int x = cells.cell_along(p.x, cells.origin.x, cells.count.x);
    const ItemRun run = grid.run(x, x, cells.cell_along(p.y, cells.origin.y, cells.count.y),
                                 cells.cell_along(p.z, cells.origin.z, cells.count.z));
    if (run.end - run.begin > atomic_load(&fullest->count)) atomic_max(&fullest->count, run.end - run.begin);
  }
};

// How many items look-ups in boxes of this extent meet, at most: for the steps of launches on the GPU. Where it is not
// enough to take all items there are, those in the fullest cell are counted. name: of the grid.
template <class Executor, class IsEnough>
uint64_t most_items_near(Executor &executor, const char *name, const NeighborGridView &grid, float extent,
                         const IsEnough &is_enough) {
  if (grid.count == 0 || is_enough(uint64_t(grid.count))) return grid.count;
  const double edges = std::floor(static_cast<double>(extent) * static_cast<double>(grid.cells.inverse_edge)) + 2;
  auto *const fullest = executor.template take_counts<Tally<uint32_t>>();
  executor.for_each(grid.count, FindFullestCell{grid, fullest});
  const double items = executor.expect(name, fullest, Tally<uint32_t>{grid.count}).count;
  return static_cast<uint64_t>(std::min(static_cast<double>(grid.count),
                                        edges * edges * edges * items + static_cast<double>(grid.cells.radii.large)));
}

// The same for the grid of atoms.
template <class Executor, class IsEnough>
uint64_t most_atoms_near(Executor &executor, const NeighborGridView &atoms, float extent, const IsEnough &is_enough) {
  return most_items_near(executor, "fullest cell of atoms", atoms, extent, is_enough);
}

// A grid of n items. prepare() returns what makes one from its number; what it allocates is given up again, as is all
// else but the grid. The cells bound the items' centres. name: of the count of the fullest cell, if it is crowded.
template <class Executor, class Prepare, class Bring = BringNothing>
NeighborGridView build_neighbor_grid(Executor &executor, const char *name, size_t n, const CellLayout &cells,
                                     const Prepare &prepare, const Bring &bring = {}) {
  Span<Sphere> sorted = executor.template allocate<Sphere>(n + kBehindItems);
  Span<uint32_t> order = executor.template allocate<uint32_t>(n);
  const bool dense = dense_table_pays(cells.cells(), n);
  Span<uint32_t> starts{};
  Span<uint64_t> keys{};
  if (dense)
    starts = executor.template allocate<uint32_t>(cells.cells() + 1);
  else
    keys = executor.template allocate<uint64_t>(n);
  const auto mark = executor.arena().mark();
  const auto item_at = prepare();
  const Span<Sphere> items = executor.template allocate<Sphere>(n);
  if (dense) keys = executor.template allocate<uint64_t>(n);
  bool is_counted = dense && counting_pays(cells.cells(), n);
  CellCounts counts{};
  if (is_counted) {
    const Span<uint32_t> in_cell = executor.template allocate_zeros<uint32_t>(cells.cells() + 1);
    counts = {in_cell.data, executor.template allocate<uint32_t>(n).data, executor.template take_counts<CrowdTally>()};
  }
  const ForEach hash{n, HashItems<std::decay_t<decltype(item_at)>>{cells, item_at, items.data, keys.data, counts}};
  const bool may_be_crowded = n > kCrowd;
  if (may_be_crowded || !is_counted) do_in_turn(executor, hash);
  if (is_counted && may_be_crowded)
    is_counted = executor.expect(name, counts.fullest, CrowdTally{static_cast<uint32_t>(n)}).count <= kCrowd;
  if (is_counted) {
    const Span<uint32_t> numbers = executor.template allocate<uint32_t>(n);
    const auto arrange = [&](const auto &...before) {
      do_in_turn(executor, before..., Scan{cells.cells(), LoadCount<uint32_t>{counts.in_cell}, starts},
                 ForEach{n, CollectNumbers{keys.data, starts.data, counts.slots, cells.cells(), cells.radii.large,
                                           numbers.data}},
                 ForEach{std::max(n, kBehindItems),
                         RankItems<Bring>{keys.data, starts.data, numbers.data, items.data, cells.cells(),
                                          cells.radii.large, n, sorted.data, order.data, bring}});
    };
    if (may_be_crowded)
      arrange();
    else
      arrange(hash);
  } else {
    constexpr uint64_t kChunk = Executor::kIsCuda ? 1 : 16;
    executor.for_each(n, NumberItems{order.data});
    executor.sort_by_key(keys, order);
    const FindCellStarts<kChunk> find_starts{keys.data, static_cast<uint32_t>(n), cells.cells(), starts.data};
    const ArrangeItems<kChunk, Bring> arrange{
        items.data, order.data, sorted.data, n, dense ? cells.cells() / kChunk + 1 : 0, find_starts, bring};
    executor.for_each(arrange.size(), arrange);
  }
  executor.arena().rewind(mark);
  return {cells, sorted.data, order.data, starts.data, dense ? nullptr : keys.data, static_cast<uint32_t>(n)};
}

// The same for items that are there already.
template <class Executor>
NeighborGridView build_neighbor_grid(Executor &executor, Span<Sphere> items, const CellLayout &cells) {
  return build_neighbor_grid(executor, "crowded cell", items.size, cells, [&] { return LoadItem{items.data}; });
}

}  // namespace quickses
