// SPDX-License-Identifier: MIT
// The sparse set of bricks that can hold surface (QuickSES 2019 section 2.2 narrows the voxels down to the border in
// the same spirit). A brick is active if the box of its lattice points, grown by one spacing, meets the part of an
// exposed atom's surface, or comes as near to an exposed arc as the surface does: then every corner of every cell that
// the surface passes lies in an active brick.
#pragma once

#include "parallel/anticipation.h"
#include "parallel/arena.h"
#include "parallel/atomics.h"
#include "parallel/error.h"
#include "surface/memory/counting_executor.h"
#include "surface/stages/brick_set.h"
#include "surface/stages/brick_shells.h"
#include "surface/stages/solvent_features.h"

#include <algorithm>
#include <string>

namespace quickses {

// What the passes below go through: size() items, and visit(i, rows, v), which calls v(linear index, number) for each
// run of bricks that item i makes active; at least fewest(i) of them, in at most most_across() rows along y and z. Of
// the features, an item is an atom (i < atom count) or an arc's ball.
struct FeatureBricks {
  FeatureView features;
  Lattice lattice;

  // Grown by one spacing, every corner of every cell that the surface passes lies in an active brick. By two, so do the
  // points next to such corners, which matter where a corner's sign is mended (thin_walls.h).
  QSES_FN float margin() const { return features.parameters.has_thin_walls() ? 2.f : 1.f; }

  QSES_FN size_t size() const { return size_t(features.atoms.count) + features.arc_bounds.count; }

  uint64_t most_across() const {
    const SurfaceParameters &p = features.parameters;
    return most_bricks_across(lattice, std::max(p.max_radius - p.depth, features.max_arc_bound + p.depth));
  }

  template <class Visit>
  QSES_FN void visit(size_t i, const RowRange &rows, const Visit &visit_brick) const {
    const bool is_atom = i < features.atoms.count;
    if (is_atom && features.cap_ranges[i].count == kBuriedAtom) return;
    const Sphere item = is_atom ? features.atoms.items[i] : features.arc_bounds.items[i - features.atoms.count];
    if (is_no_item(item)) return;
    const float depth = features.parameters.depth;
    const float outer = is_atom ? maximum(0.f, item.radius - depth) : item.radius + depth;
    visit_bricks_of_shell(lattice, item.center, is_atom ? outer : 0.f, outer, margin(), rows, visit_brick);
  }
  QSES_FN double fewest(size_t i) const {
    return i < features.atoms.count ? 0.0 : fewest_bricks_of_ball(lattice, features.parameters.depth);
  }
};

template <class Items>
struct FlagBricks {
  Items items;
  uint8_t *flags;
  RowRange rows{};
  struct Visit {
    uint8_t *flags;
    QSES_FN void operator()(uint64_t linear, uint64_t count) const {
      for (const uint64_t end = linear + count; linear < end; ++linear) atomic_set(&flags[linear]);
    }
  };
  int layers = 1;  // threads of an item
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const ThreadOfItem thread = thread_of_item(i, static_cast<uint32_t>(layers));
    RowRange own = rows;
    own.layer = static_cast<int>(thread.rank);
    own.layers = layers;
    items.visit(thread.item, own, Visit{flags});
  }
};

template <class Items>
struct CountBricks {
  Items items;
  uint64_t *counts;
  RowRange rows{};
  struct Visit {
    uint64_t *count;
    QSES_FN void operator()(uint64_t, uint64_t more) const { *count += more; }
  };
  QSES_HOST_DEVICE void operator()(size_t i) const {
    uint64_t count = rows.first > 0 ? counts[i] : 0;
    items.visit(i, rows, Visit{&count});
    counts[i] = count;
  }
};

template <class Items>
struct FewestBricks {
  Items items;
  QSES_HOST_DEVICE double operator()(size_t i) const { return items.fewest(i); }
};

template <class Items>
struct ListBricks {
  Items items;
  uint64_t *first;  // place of the item's next key
  uint64_t *keys;
  RowRange rows{};
  struct Visit {
    uint64_t **next;
    QSES_FN void operator()(uint64_t linear, uint64_t number) const {
      for (const uint64_t end = linear + number; linear < end; ++linear) *(*next)++ = linear;
    }
  };
  QSES_HOST_DEVICE void operator()(size_t i) const {
    uint64_t *next = keys + first[i];
    items.visit(i, rows, Visit{&next});
    first[i] = static_cast<uint64_t>(next - keys);
  }
};

struct IsFirstOfEqual {
  const uint64_t *keys;
  QSES_HOST_DEVICE bool operator()(size_t i) const { return i == 0 || keys[i] != keys[i - 1]; }
};

struct GatherPlaces {
  Lattice lattice;
  const uint64_t *keys;
  uint64_t *places;  // in: where the first of equal keys is; out: packed
  QSES_HOST_DEVICE void operator()(size_t i) const { places[i] = pack_place(lattice.brick_at(keys[places[i]])); }
};

// Stands in the list where there may have been one more brick: the first of the box, which is beyond the reach of
// all atoms. It takes part in all passes as one of which all points are outside, and no look-up finds it.
constexpr uint64_t kNoBrick = 0;

// Numbers the flagged bricks in linear order, and lists them.
struct FillBrickTable {
  Lattice lattice;
  const uint8_t *flags;
  int32_t *table;  // in: how many were flagged before, and of all behind the last; out: number, or -1
  uint64_t entries;
  uint64_t *places;
  uint64_t room;  // bricks that the set has room for: the others are none
  Tally<uint64_t> *found;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint64_t total = static_cast<uint32_t>(table[entries]), number = static_cast<uint32_t>(table[i]);
    if (i == 0) found->count = total;
    if (flags[i] && number < room) places[number] = pack_place(lattice.brick_at(i));
    if (!flags[i] || number >= room) table[i] = -1;
    if (i >= total && i < room) places[i] = pack_place(lattice.brick_at(kNoBrick));
  }
};

// Bytes per entry of a dense table of bricks, and per visit where the visits are listed and sorted instead.
constexpr uint64_t kDenseEntryBytes = sizeof(int32_t) + sizeof(uint8_t);
constexpr uint64_t kVisitBytes = 2 * sizeof(uint64_t) + sizeof(uint32_t);

inline uint32_t checked_brick_count(size_t found) {
  if (found > kMaxBricks)
    throw Error(QSES_TOO_FINE, "the surface needs " + std::to_string(found) +
                                   " bricks of the SES grid, more than 32-bit numbers can name: use a larger spacing");
  return static_cast<uint32_t>(found);
}

// Memory of the two ways to make a set. Room: whoever gives memory.
struct FlaggedBricks {
  Span<int32_t> table;
  Span<uint8_t> flags;
  template <class Room>
  FlaggedBricks(Room &room, uint64_t entries)
      : table(room.template allocate<int32_t>(entries + 1)), flags(room.template allocate_zeros<uint8_t>(entries)) {}
};
struct SortedBricks {
  Span<uint64_t> keys, places;
  Span<uint32_t> unused;
  template <class Room>
  SortedBricks(Room &room, uint64_t visits)
      : keys(room.template allocate<uint64_t>(visits)),
        places(room.template allocate<uint64_t>(visits)),
        unused(room.template allocate<uint32_t>(visits)) {}
};

// Whether the list gets room for all entries: while that is little.
inline bool lists_all_entries(uint64_t entries, bool has_budget) { return entries <= kSmallTable && !has_budget; }

// pass(rows, steps) for all rows of bricks of the items: on the GPU in several parts where an item, a giant atom at a
// fine spacing, has too many of them for one launch.
template <class Executor, class Items, class Pass>
void for_rows_of_bricks(const Items &items, const Pass &pass) {
  const uint64_t across = items.most_across(), row_steps = 24 + across, rows = across * across;
  const uint64_t most = Executor::kIsCuda ? std::max<uint64_t>(1, kThreadSteps / row_steps) : rows;
  for (uint64_t first = 0; first < rows; first += most) {
    const bool is_last = first + most >= rows;
    pass(RowRange{first, is_last ? ~uint64_t(0) : first + most},
         std::max(kPlainSteps, std::min(most, rows) * row_steps));
  }
}

template <class Executor, class Items>
BrickSet flag_bricks(Executor &executor, const Items &items, const Lattice &lattice, const char *name) {
  const uint64_t entries = lattice.table_size();
  const FlaggedBricks memory(executor, entries);
  const Span<int32_t> table = memory.table;
  const Span<uint8_t> flags = memory.flags;
  for_rows_of_bricks<Executor>(items, [&](const RowRange &rows, uint64_t steps) {
    const bool is_all = rows.first == 0 && rows.last == ~uint64_t(0);
    const size_t layers = Executor::kIsCuda && is_all && items.size() < kManyItems ? 4 : 1;
    executor.for_each(items.size() * layers, FlagBricks<Items>{items, flags.data, rows, static_cast<int>(layers)},
                      steps);
  });
  // Room for the list: for all entries, or counted first.
  const uint64_t room = lists_all_entries(entries, executor.arena().has_budget())
                            ? entries
                            : static_cast<uint64_t>(executor.reduce(entries, LoadCount<uint8_t>{flags.data}));
  Span<uint64_t> places = executor.template allocate<uint64_t>(room);
  Tally<uint64_t> *const found = executor.template take_counts<Tally<uint64_t>>();
  // No brick may have a number beyond those that there will be memory for: stages would read and write what is at it.
  Tally<uint64_t> most{room};
  executor.foresee(name, found, most, &most);
  do_in_turn(
      executor, Scan{entries, LoadCount<uint8_t>{flags.data}, Span<int32_t>{table.data, entries + 1}},
      ForEach{entries, FillBrickTable{lattice, flags.data, table.data, entries, places.data, most.count, found}});
  const uint32_t count = checked_brick_count(executor.expect(name, found, Tally<uint64_t>{room}).count);
  return {lattice, places.data, table.data, count, found};
}

template <class Executor, class Items>
BrickSet sort_bricks(Executor &executor, const Items &items, const Lattice &lattice, Span<uint64_t> first,
                     uint64_t visits) {
  const SortedBricks memory(executor, visits);
  const Span<uint64_t> keys = memory.keys, places = memory.places;
  const Span<uint32_t> unused = memory.unused;
  for_rows_of_bricks<Executor>(items, [&](const RowRange &rows, uint64_t steps) {
    executor.for_each(items.size(), ListBricks<Items>{items, first.data, keys.data, rows}, steps);
  });
  executor.for_each(visits, NumberItems{unused.data});
  executor.sort_by_key(keys, unused);
  const uint32_t count = checked_brick_count(executor.compact(visits, IsFirstOfEqual{keys.data}, places));
  executor.for_each(count, GatherPlaces{lattice, keys.data, places.data});
  return {lattice, places.data, nullptr, count};
}

// The set of all bricks that the items visit. A table with an entry per brick of the box while that is the smaller way:
// a stray atom far away makes the box large, a fine spacing makes the visits many. name: of the set, among those of a
// frame. listed: visits, if they were.
template <class Executor, class Items>
BrickSet collect_bricks(Executor &executor, const Items &items, const Lattice &lattice, const char *name,
                        uint64_t *listed = nullptr) {
  if (listed) *listed = 0;
  const size_t n = items.size();
  const uint64_t entries = lattice.table_size();
  if (entries <= kSmallTable) return flag_bricks(executor, items, lattice, name);
  // To count the visits may take long. Often it is clear without that they are too many to be listed.
  const double fewest = executor.reduce(n, FewestBricks<Items>{items}) * static_cast<double>(kVisitBytes);
  if (entries <= kMaxDenseCells && static_cast<double>(entries * kDenseEntryBytes) <= fewest)
    return flag_bricks(executor, items, lattice, name);
  if (entries > kMaxDenseCells && fewest > static_cast<double>(executor.arena().available()))
    throw MemoryRefused("the work needs at least " + describe_bytes(static_cast<uint64_t>(fewest)) +
                        " for the bricks of the SES grid, but " + describe_bytes(executor.arena().available()) +
                        " are available: use a larger spacing");
  const auto before = executor.arena().mark();
  Span<uint64_t> first = executor.template allocate<uint64_t>(n + 1);
  const auto mark = executor.arena().mark();
  const Span<uint64_t> counts = executor.template allocate<uint64_t>(n);
  for_rows_of_bricks<Executor>(items, [&](const RowRange &rows, uint64_t steps) {
    executor.for_each(n, CountBricks<Items>{items, counts.data, rows}, steps);
  });
  executor.exclusive_scan(n, LoadCount<uint64_t>{counts.data}, first);
  executor.arena().rewind(mark);
  const uint64_t visits = executor.fetch(first.data + n);
  if (entries <= kMaxDenseCells && entries * kDenseEntryBytes <= visits * kVisitBytes) {
    executor.arena().rewind(before);
    return flag_bricks(executor, items, lattice, name);
  }
  if (listed) *listed = visits;
  return sort_bricks(executor, items, lattice, first, visits);
}

struct NumberAllBricks {
  Lattice lattice;
  uint64_t *places;
  int32_t *table;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    places[i] = pack_place(lattice.brick_at(i));
    table[i] = static_cast<int32_t>(i);
  }
};

// The set of all bricks of a small box.
template <class Executor>
BrickSet all_bricks(Executor &executor, const Lattice &lattice) {
  const size_t count = static_cast<size_t>(lattice.table_size());
  const Span<uint64_t> places = executor.template allocate<uint64_t>(count);
  const Span<int32_t> table = executor.template allocate<int32_t>(count);
  executor.for_each(count, NumberAllBricks{lattice, places.data, table.data});
  return {lattice, places.data, table.data, static_cast<uint32_t>(count)};
}

// What is known of a set before it is collected; 0: not known.
struct ExpectedBricks {
  uint64_t count, visits, entries;
};
template <class Items>
ExpectedBricks expected_bricks(const WorkFacts &facts, const Items &) {
  return {static_cast<uint64_t>(facts.size.bricks), facts.brick_visits, facts.brick_entries};
}

// As many as there are known to be; where it is not known whether their table is dense, what would be smaller.
template <class Executor, class Items>
BrickSet collect_bricks(CountingExecutor<Executor> &executor, const Items &items, const Lattice &lattice, const char *,
                        uint64_t * = nullptr) {
  const ExpectedBricks expected = expected_bricks(executor.facts(), items);
  const uint64_t count = expected.count, entries = lattice.table_size();
  constexpr uint64_t kVisitsPerBrick = 4;
  const uint64_t visits = expected.visits ? expected.visits : kVisitsPerBrick * count;
  static const int32_t some_table = 0;
  BrickSet set{lattice, nullptr, nullptr, static_cast<uint32_t>(std::min<uint64_t>(count, kMaxBricks))};
  if (expected.visits == 0 && entries <= kMaxDenseCells &&
      (entries <= kSmallTable || entries * kDenseEntryBytes <= visits * kVisitBytes || expected.entries > 0)) {
    FlaggedBricks(executor, entries);
    executor.template allocate<uint64_t>(lists_all_entries(entries, executor.arena().has_budget()) ? entries : count);
    executor.template take_counts<Tally<uint64_t>>();
    executor.exclusive_scan(entries, 0, Span<int32_t>{});
    set.table = &some_table;
  } else {
    executor.template allocate<uint64_t>(items.size() + 1);
    const auto mark = executor.arena().mark();
    executor.template allocate<uint64_t>(items.size());
    executor.exclusive_scan(items.size(), 0, Span<uint64_t>{});
    executor.arena().rewind(mark);
    SortedBricks(executor, visits);
    executor.sort_by_key(Span<uint64_t>{nullptr, visits}, Span<uint32_t>{nullptr, visits});
  }
  return set;
}

template <class Executor>
BrickSet find_bricks(Executor &executor, const FeatureView &features, const Lattice &lattice,
                     uint64_t *listed = nullptr) {
  return collect_bricks(executor, FeatureBricks{features, lattice}, lattice, "bricks", listed);
}

}  // namespace quickses
