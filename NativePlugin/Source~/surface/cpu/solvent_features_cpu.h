// SPDX-License-Identifier: MIT
// CPU driver of the solvent features: chunks of atoms per thread, pooled as they come and put in order afterwards. With
// little memory nothing is pooled: a first pass only counts, a second one writes everything to its place.
#pragma once

#include "parallel/atomics.h"
#include "parallel/growing_buffer.h"
#include "surface/cpu/cpu_kernel_executor.h"

namespace quickses {

// Atoms of one chunk: few enough that all threads get some of a small molecule.
constexpr size_t kMinAtomsPerChunk = 4, kMaxAtomsPerChunk = 32;

// Caps and arcs an atom is given room for at first.
constexpr size_t kRoomPerAtom = 256;

// What proteins have, generously. Where atoms have more, the first surface takes a second pass.
constexpr size_t kUsualCapsPerAtom = 32, kUsualArcsPerAtom = 6;

// Room of one thread for the features of one chunk. Kept between surfaces.
struct FeatureStaging {
  GrowingBuffer<HostMemory> memory;
  int capacity = 256;
  std::vector<Cap> caps;
  std::vector<Arc> arcs;
  std::vector<ArcAtoms> arc_atoms;  // as many, if they are wanted
  size_t cap_count = 0, arc_count = 0;
  size_t most_caps = 0, most_arcs = 0;  // of any chunk so far

  AtomScratch scratch() {
    grow_neighbors(capacity);
    return {static_cast<float *>(memory.data()), capacity};
  }
  // What is refused is not asked for again by atoms that need less.
  void grow_neighbors(int n) {
    memory.reserve(AtomScratch::kColumns * (static_cast<size_t>(n) + 16) * sizeof(float));
    capacity = n;
  }
  // At least n, and no more, which resize() alone would not keep to.
  template <class T>
  static void grow(std::vector<T> &items, size_t n) {
    if (items.size() >= n) return;
    items.reserve(n);
    items.resize(n);
  }
  void grow_arcs(size_t n, bool with_atoms) {
    grow(arcs, n);
    if (with_atoms) grow(arc_atoms, arcs.size());
  }
  // For the features of a chunk, with room for usual ones: which of its atoms are buried, and have none, changes from
  // frame to frame.
  void open(size_t atoms, bool with_arc_atoms) {
    cap_count = arc_count = 0;
    grow(caps, atoms * kUsualCapsPerAtom + kRoomPerAtom);
    grow_arcs(atoms * kUsualArcsPerAtom + kRoomPerAtom, with_arc_atoms);
  }
  uint64_t bytes() const {
    return memory.size() + sizeof(Cap) * caps.capacity() + sizeof(Arc) * arcs.capacity() +
           sizeof(ArcAtoms) * arc_atoms.capacity();
  }
  // As much room as another thread took, and some to spare beyond what it needed: who meets the largest atom differs
  // from surface to surface.
  void match(const FeatureStaging &other) {
    const auto with_spare_room = [](size_t size, size_t most) {
      return size < most + most / 4 + kRoomPerAtom ? most + most / 2 + kRoomPerAtom : size;
    };
    grow_neighbors(std::max(capacity, other.capacity));
    most_caps = std::max(most_caps, other.most_caps);
    most_arcs = std::max(most_arcs, other.most_arcs);
    grow(caps, with_spare_room(std::max(caps.size(), other.caps.size()), most_caps));
    grow_arcs(with_spare_room(std::max(arcs.size(), other.arcs.size()), most_arcs),
              !other.arc_atoms.empty() || !arc_atoms.empty());
  }
};

// What all threads found, chunk behind chunk in the order they were finished. What does not fit is only counted.
struct FeaturePool {
  Span<Cap> caps;
  Span<Arc> arcs;
  Span<ArcAtoms> arc_atoms;  // as many as arcs, if they are wanted
  std::atomic<size_t> cap_count{0}, arc_count{0};
  GrowingBuffer<HostMemory> own_caps, own_arcs, own_arc_atoms;

  void open(Span<Cap> cap_room, Span<Arc> arc_room, Span<ArcAtoms> arc_atom_room) {
    caps = cap_room;
    arcs = arc_room;
    arc_atoms = arc_atom_room;
    cap_count = arc_count = 0;
  }
  // In memory of its own, kept between surfaces: at least as much, and somewhat more than was needed last time.
  void open_own(size_t cap_room, size_t arc_room, bool with_arc_atoms) {
    cap_room = std::max(cap_room, cap_count + cap_count / 16);
    arc_room = std::max(arc_room, arc_count + arc_count / 16);
    Cap *const cap_place = static_cast<Cap *>(own_caps.reserve(cap_room * sizeof(Cap)));
    Arc *const arc_place = static_cast<Arc *>(own_arcs.reserve(arc_room * sizeof(Arc)));
    Span<ArcAtoms> atoms{nullptr, own_arcs.size() / sizeof(Arc)};
    if (with_arc_atoms) atoms.data = static_cast<ArcAtoms *>(own_arc_atoms.reserve(atoms.size * sizeof(ArcAtoms)));
    open({cap_place, own_caps.size() / sizeof(Cap)}, {arc_place, atoms.size}, atoms);
  }
  uint64_t bytes() const { return own_caps.size() + own_arcs.size() + own_arc_atoms.size(); }
  bool holds_all() const { return cap_count <= caps.size && arc_count <= arcs.size; }
};

// The places in the pool of what one chunk found.
struct FeatureChunk {
  size_t first_cap, cap_count, first_arc, arc_count;
};

// Finds the features of atom i, with as much room as they need. room tells where it is, and how much, and is asked
// again after more was made.
template <class Room>
AtomFeatures find_features_of(const CpuKernels &kernels, const NeighborGridView &atoms,
                              const SurfaceParameters &parameters, size_t i, FeatureStaging &s, uint8_t *exposed,
                              const Room &room) {
  for (;;) {
    const AtomFeatures found =
        kernels.find_atom_features(atoms, parameters, static_cast<uint32_t>(i), s.scratch(), room.caps(s),
                                   room.cap_room(s), room.arcs(s), room.arc_atoms(s), room.arc_room(s), exposed);
    if (found.neighbors_needed > 0)
      s.grow_neighbors(found.neighbors_needed + found.neighbors_needed / 2);
    else if (found.cap_count > room.cap_room(s))
      FeatureStaging::grow(s.caps, s.cap_count + 2 * static_cast<size_t>(found.cap_count));
    else if (found.arc_count > room.arc_room(s))
      s.grow_arcs(s.arc_count + 2 * static_cast<size_t>(found.arc_count), parameters.is_of_balls());
    else
      return found;
  }
}

// Behind what the thread has staged.
struct StagedRoom {
  bool with_arc_atoms;
  void open(FeatureStaging &s) const {
    if (s.caps.size() < s.cap_count + kRoomPerAtom) FeatureStaging::grow(s.caps, 2 * (s.cap_count + kRoomPerAtom));
    const size_t arcs = std::min(s.arcs.size(), with_arc_atoms ? s.arc_atoms.size() : ~size_t(0));
    if (arcs < s.arc_count + kRoomPerAtom) s.grow_arcs(2 * (s.arc_count + kRoomPerAtom), with_arc_atoms);
  }
  Cap *caps(FeatureStaging &s) const { return s.caps.data() + s.cap_count; }
  int cap_room(FeatureStaging &s) const {
    return static_cast<int>(std::min<size_t>(s.caps.size() - s.cap_count, 1u << 30));
  }
  Arc *arcs(FeatureStaging &s) const { return s.arcs.data() + s.arc_count; }
  ArcAtoms *arc_atoms(FeatureStaging &s) const { return with_arc_atoms ? s.arc_atoms.data() + s.arc_count : nullptr; }
  int64_t arc_room(FeatureStaging &s) const { return static_cast<int64_t>(s.arcs.size() - s.arc_count); }
};

// Features of the atoms of one chunk.
struct FindChunkFeatures {
  const CpuKernels *kernels;
  const NeighborGridView *atoms;
  const SurfaceParameters *parameters;
  size_t atoms_per_chunk;
  CapRange *cap_ranges;
  uint8_t *exposed;
  FeatureChunk *chunks;
  FeaturePool *pool;
  void operator()(SoloTeam, FeatureStaging &s, size_t chunk) const {
    const StagedRoom room{parameters->is_of_balls()};
    s.open(atoms_per_chunk, room.with_arc_atoms);
    const size_t end = std::min<size_t>(atoms->count, (chunk + 1) * atoms_per_chunk);
    for (size_t i = chunk * atoms_per_chunk; i < end; ++i) {
      room.open(s);
      const AtomFeatures found = find_features_of(*kernels, *atoms, *parameters, i, s, exposed, room);
      cap_ranges[i] = {static_cast<uint32_t>(s.cap_count), found.cap_count};
      s.cap_count += static_cast<size_t>(found.cap_count);
      s.arc_count += static_cast<size_t>(found.arc_count);
    }
    s.most_caps = std::max(s.most_caps, s.cap_count);
    s.most_arcs = std::max(s.most_arcs, s.arc_count);
    FeatureChunk &c = chunks[chunk];
    c = {pool->cap_count.fetch_add(s.cap_count), s.cap_count, pool->arc_count.fetch_add(s.arc_count), s.arc_count};
    if (c.first_cap + c.cap_count <= pool->caps.size && c.first_arc + c.arc_count <= pool->arcs.size) {
      std::copy_n(s.caps.data(), c.cap_count, pool->caps.data + c.first_cap);
      std::copy_n(s.arcs.data(), c.arc_count, pool->arcs.data + c.first_arc);
      if (room.with_arc_atoms) std::copy_n(s.arc_atoms.data(), c.arc_count, pool->arc_atoms.data + c.first_arc);
    }
  }
};

// Copies what a chunk found to its place; of buried atoms nothing.
struct CollectChunk {
  const FeatureChunk *chunks;
  const FeaturePool *pool;
  const uint64_t *cap_first, *arc_base;  // per atom, per chunk
  size_t atoms, atoms_per_chunk;
  const uint8_t *exposed;
  CapRange *cap_ranges;
  Cap *caps;
  Arc *arcs;
  ArcAtoms *arc_atoms;  // nullptr: not wanted
  void operator()(size_t chunk) const {
    const FeatureChunk &c = chunks[chunk];
    std::copy_n(pool->arcs.data + c.first_arc, c.arc_count, arcs + arc_base[chunk]);
    if (arc_atoms) std::copy_n(pool->arc_atoms.data + c.first_arc, c.arc_count, arc_atoms + arc_base[chunk]);
    const size_t end = std::min(atoms, (chunk + 1) * atoms_per_chunk);
    for (size_t i = chunk * atoms_per_chunk; i < end; ++i) {
      if (exposed[i])
        std::copy_n(pool->caps.data + c.first_cap + cap_ranges[i].first, cap_ranges[i].count, caps + cap_first[i]);
      else
        cap_ranges[i].count = kBuriedAtom;
      cap_ranges[i].first = static_cast<uint32_t>(cap_first[i]);
    }
  }
};

struct LoadChunkArcs {
  const FeatureChunk *chunks;
  uint64_t operator()(size_t i) const { return chunks[i].arc_count; }
};

// Places of the caps of exposed atoms; the others keep none.
struct LoadExposedCaps {
  const uint8_t *exposed;
  const CapRange *cap_ranges;
  uint64_t operator()(size_t i) const { return exposed[i] ? static_cast<uint64_t>(cap_ranges[i].count) : 0; }
};

// A place whose size is known; caps of buried atoms go where they are forgotten.
struct FinalRoom {
  Cap *cap_place;  // nullptr: buried
  int cap_count;
  Arc *arc_place;
  ArcAtoms *arc_atom_place;  // nullptr: not wanted
  int64_t arc_count;
  Cap *caps(FeatureStaging &s) const { return cap_place ? cap_place : s.caps.data(); }
  int cap_room(FeatureStaging &s) const { return cap_place ? cap_count : StagedRoom{false}.cap_room(s); }
  Arc *arcs(FeatureStaging &) const { return arc_place; }
  ArcAtoms *arc_atoms(FeatureStaging &) const { return arc_atom_place; }
  int64_t arc_room(FeatureStaging &) const { return arc_count; }
};

// The second pass: features straight to their places.
struct PlaceChunkFeatures {
  const CpuKernels *kernels;
  const NeighborGridView *atoms;
  const SurfaceParameters *parameters;
  size_t atoms_per_chunk;
  const uint64_t *cap_first, *arc_base;  // per atom, per chunk
  CapRange *cap_ranges;
  uint8_t *exposed;
  Cap *caps;
  Arc *arcs;
  ArcAtoms *arc_atoms;  // nullptr: not wanted
  void operator()(SoloTeam, FeatureStaging &s, size_t chunk) const {
    s.cap_count = s.arc_count = 0;
    const size_t end = std::min<size_t>(atoms->count, (chunk + 1) * atoms_per_chunk);
    uint64_t arc = arc_base[chunk];
    for (size_t i = chunk * atoms_per_chunk; i < end; ++i) {
      StagedRoom{false}.open(s);
      const bool open = atomic_load(&exposed[i]) != 0;  // others mark it once more meanwhile
      const FinalRoom room{open ? caps + cap_first[i] : nullptr, cap_ranges[i].count, arcs + arc,
                           arc_atoms ? arc_atoms + arc : nullptr, static_cast<int64_t>(arc_base[chunk + 1] - arc)};
      const AtomFeatures found = find_features_of(*kernels, *atoms, *parameters, i, s, exposed, room);
      cap_ranges[i] = {static_cast<uint32_t>(cap_first[i]), open ? found.cap_count : kBuriedAtom};
      arc += static_cast<uint64_t>(found.arc_count);
    }
  }
};

// What the stage keeps until the features are in their places. Room: whoever gives memory.
struct FeatureArrays {
  size_t atoms, atoms_per_chunk, chunks;
  Span<CapRange> cap_ranges;
  Span<uint8_t> exposed;
  Span<FeatureChunk> table;
  Span<uint64_t> cap_first, arc_base;  // per atom, per chunk; and the totals

  template <class Room>
  FeatureArrays(Room &room, size_t n, unsigned threads)
      : atoms(n),
        atoms_per_chunk(std::max(kMinAtomsPerChunk, std::min(kMaxAtomsPerChunk, n / (size_t(threads) * 8)))),
        chunks((n + atoms_per_chunk - 1) / atoms_per_chunk),
        cap_ranges(room.template allocate<CapRange>(n)),
        exposed(room.template allocate<uint8_t>(n)),
        table(room.template allocate<FeatureChunk>(chunks)),
        cap_first(room.template allocate<uint64_t>(n + 1)),
        arc_base(room.template allocate<uint64_t>(chunks + 1)) {}
};

// A pool in the arena: behind the places that the features will have, which are taken after it was given up.
struct PooledFeatures {
  Span<Cap> caps;
  Span<Arc> arcs;
  Span<ArcAtoms> arc_atoms{};
  template <class Room>
  PooledFeatures(Room &room, size_t atoms, bool with_arc_atoms) {
    const size_t cap_count = atoms * kUsualCapsPerAtom, arc_count = atoms * kUsualArcsPerAtom;
    const size_t arc_bytes = sizeof(Arc) + (with_arc_atoms ? sizeof(ArcAtoms) : 0);
    room.template allocate<char>(cap_count * sizeof(Cap) + arc_count * arc_bytes + 3 * kArenaUnit);
    caps = room.template allocate<Cap>(cap_count);
    arcs = room.template allocate<Arc>(arc_count);
    if (with_arc_atoms) arc_atoms = room.template allocate<ArcAtoms>(arc_count);
  }
};

// A pool for n atoms. With a budget it must not take more than that; with low memory nothing.
inline FeaturePool &open_pool(CpuKernelExecutor &executor, size_t n, bool with_arc_atoms, bool low_memory) {
  FeaturePool &pool = *executor.scratches<FeaturePool>().front();
  if (low_memory) {
    pool.open({}, {}, {});
  } else if (executor.arena().has_budget()) {
    const PooledFeatures room(executor, n, with_arc_atoms);
    pool.open(room.caps, room.arcs, room.arc_atoms);
  } else {
    pool.open_own(n * kUsualCapsPerAtom, n * kUsualArcsPerAtom, with_arc_atoms);
  }
  return pool;
}

inline void find_solvent_features(CpuKernelExecutor &executor, const NeighborGridView &atoms,
                                  const SurfaceParameters &parameters, bool low_memory, SolventFeatures *features) {
  const FeatureArrays a(executor, atoms.count, executor.threads());
  const auto mark = executor.arena().mark();
  const bool with_arc_atoms = parameters.is_of_balls();
  FeaturePool &pool = open_pool(executor, a.atoms, with_arc_atoms, low_memory);
  executor.fill(a.exposed, 0);
  executor.for_each_brick<FeatureStaging>(a.chunks,
                                          FindChunkFeatures{&executor.kernels(), &atoms, &parameters, a.atoms_per_chunk,
                                                            a.cap_ranges.data, a.exposed.data, a.table.data, &pool},
                                          1);
  executor.match_scratches<FeatureStaging>();
  executor.exclusive_scan(a.atoms, LoadExposedCaps{a.exposed.data, a.cap_ranges.data}, a.cap_first);
  executor.exclusive_scan(a.chunks, LoadChunkArcs{a.table.data}, a.arc_base);
  executor.arena().rewind(mark);
  SolventFeatures &f = *features;
  f.cap_ranges = a.cap_ranges;
  f.exposed = a.exposed;
  f.caps = executor.allocate<Cap>(a.cap_first[a.atoms]);
  f.arcs = executor.allocate<Arc>(a.arc_base[a.chunks]);
  if (with_arc_atoms) f.arc_atoms = executor.allocate<ArcAtoms>(f.arcs.size);
  if (pool.holds_all()) {
    executor.for_each(a.chunks,
                      CollectChunk{a.table.data, &pool, a.cap_first.data, a.arc_base.data, a.atoms, a.atoms_per_chunk,
                                   f.exposed.data, f.cap_ranges.data, f.caps.data, f.arcs.data, f.arc_atoms.data},
                      kMaxAtomsPerChunk * kPlainSteps);
    return;
  }
  // Next time they will fit; the room is taken now, so that this computation tells what later ones take.
  if (!low_memory && !executor.arena().has_budget()) pool.open_own(pool.cap_count, pool.arc_count, with_arc_atoms);
  executor.for_each_brick<FeatureStaging>(
      a.chunks,
      PlaceChunkFeatures{&executor.kernels(), &atoms, &parameters, a.atoms_per_chunk, a.cap_first.data, a.arc_base.data,
                         f.cap_ranges.data, f.exposed.data, f.caps.data, f.arcs.data, f.arc_atoms.data},
      1);
}

// Only counted.
inline void find_solvent_features(CountingExecutor<CpuKernelExecutor> &executor, const NeighborGridView &atoms,
                                  const SurfaceParameters &parameters, bool low_memory, SolventFeatures *features) {
  const FeatureArrays a(executor, atoms.count, executor.real().threads());
  const auto mark = executor.arena().mark();
  if (!low_memory && executor.arena().has_budget()) PooledFeatures(executor, a.atoms, parameters.is_of_balls());
  executor.exclusive_scan(a.atoms, 0, a.cap_first);
  executor.arena().rewind(mark);
  features->caps = executor.allocate<Cap>(executor.facts().caps);
  features->arcs = executor.allocate<Arc>(executor.facts().arcs);
  if (parameters.is_of_balls()) features->arc_atoms = executor.allocate<ArcAtoms>(features->arcs.size);
}

}  // namespace quickses
