// SPDX-License-Identifier: MIT
// CPU driver of the solvent features: chunks of atoms per thread, results collected in order afterwards. With little
// memory nothing is collected: a first pass only counts, a second one writes everything to its place.
#pragma once

#include "parallel/cpu_executor.h"
#include "surface/cpu_kernels.h"

namespace quickses {

constexpr size_t kAtomsPerChunk = 32;

// What one thread found, chunk after chunk. Kept between surfaces.
struct FeatureStaging {
  std::vector<float> memory;
  int capacity = 256;
  std::vector<Cap> caps;
  std::vector<Arc> arcs;
  size_t cap_count = 0, arc_count = 0;

  void forget() {
    std::vector<Cap>().swap(caps);
    std::vector<Arc>().swap(arcs);
  }
  AtomScratch scratch() {
    const size_t needed = AtomScratch::kColumns * (static_cast<size_t>(capacity) + 16) + 16;
    if (memory.size() < needed) memory.resize(needed);
    const uintptr_t start = reinterpret_cast<uintptr_t>(memory.data());
    return {memory.data() + (64 - start % 64) % 64 / sizeof(float), capacity};
  }
};

struct FeatureChunk {
  FeatureStaging *staging;
  size_t first_cap, cap_count, first_arc, arc_count;
};

// Finds the features of atom i, with as much room as they need. place_caps() and place_arcs() tell where it is, and how
// much, and are asked again after more room was made.
template <class Room>
AtomFeatures find_features_of(const CpuKernels &kernels, const NeighborGridView &atoms,
                              const SurfaceParameters &parameters, size_t i, FeatureStaging &s, uint8_t *exposed,
                              const Room &room) {
  for (;;) {
    const AtomFeatures found =
        kernels.find_atom_features(atoms, parameters, static_cast<uint32_t>(i), s.scratch(), room.caps(s),
                                   room.cap_room(s), room.arcs(s), room.arc_room(s), exposed);
    if (found.neighbors_needed > 0)
      s.capacity = found.neighbors_needed + found.neighbors_needed / 2;
    else if (found.cap_count > room.cap_room(s))
      s.caps.resize(s.cap_count + static_cast<size_t>(found.cap_count));
    else if (found.arc_count > room.arc_room(s))
      s.arcs.resize(s.arc_count + static_cast<size_t>(found.arc_count));
    else
      return found;
  }
}

// Behind what the thread has staged.
struct StagedRoom {
  static constexpr size_t kLeast = 256;
  static void open(FeatureStaging &s) {
    if (s.caps.size() < s.cap_count + kLeast) s.caps.resize(std::max(2 * s.caps.size(), s.cap_count + 4 * kLeast));
    if (s.arcs.size() < s.arc_count + kLeast) s.arcs.resize(std::max(2 * s.arcs.size(), s.arc_count + 4 * kLeast));
  }
  Cap *caps(FeatureStaging &s) const { return s.caps.data() + s.cap_count; }
  int cap_room(FeatureStaging &s) const {
    return static_cast<int>(std::min<size_t>(s.caps.size() - s.cap_count, 1u << 30));
  }
  Arc *arcs(FeatureStaging &s) const { return s.arcs.data() + s.arc_count; }
  int64_t arc_room(FeatureStaging &s) const { return static_cast<int64_t>(s.arcs.size() - s.arc_count); }
};

// Features of the atoms of one chunk, appended to the thread's staging, or, if they are only counted, over each other.
struct FindChunkFeatures {
  const CpuKernels *kernels;
  const NeighborGridView *atoms;
  const SurfaceParameters *parameters;
  CapRange *cap_ranges;
  uint8_t *exposed;
  FeatureChunk *chunks;
  bool count_only;
  void operator()(SoloTeam, FeatureStaging &s, size_t chunk) const {
    FeatureChunk &c = chunks[chunk];
    c = {&s, s.cap_count, 0, s.arc_count, 0};
    const size_t end = std::min<size_t>(atoms->count, (chunk + 1) * kAtomsPerChunk);
    for (size_t i = chunk * kAtomsPerChunk; i < end; ++i) {
      StagedRoom::open(s);
      const AtomFeatures found = find_features_of(*kernels, *atoms, *parameters, i, s, exposed, StagedRoom{});
      cap_ranges[i] = {static_cast<uint32_t>(c.cap_count), found.cap_count};
      c.cap_count += static_cast<size_t>(found.cap_count);
      c.arc_count += static_cast<size_t>(found.arc_count);
      if (count_only) continue;
      s.cap_count += static_cast<size_t>(found.cap_count);
      s.arc_count += static_cast<size_t>(found.arc_count);
    }
  }
};

// Copies what a chunk found to its place.
struct CollectChunk {
  const FeatureChunk *chunks;
  const uint64_t *cap_base, *arc_base;
  size_t atoms;
  const uint8_t *exposed;
  CapRange *cap_ranges;
  Cap *caps;
  Arc *arcs;
  void operator()(size_t chunk) const {
    const FeatureChunk &c = chunks[chunk];
    std::copy_n(c.staging->caps.data() + c.first_cap, c.cap_count, caps + cap_base[chunk]);
    std::copy_n(c.staging->arcs.data() + c.first_arc, c.arc_count, arcs + arc_base[chunk]);
    const size_t end = std::min(atoms, (chunk + 1) * kAtomsPerChunk);
    for (size_t i = chunk * kAtomsPerChunk; i < end; ++i) {
      cap_ranges[i].first += static_cast<uint32_t>(cap_base[chunk]);
      if (!exposed[i]) cap_ranges[i].count = kBuriedAtom;
    }
  }
};

struct LoadChunkCaps {
  const FeatureChunk *chunks;
  uint64_t operator()(size_t i) const { return chunks[i].cap_count; }
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
  int64_t arc_count;
  Cap *caps(FeatureStaging &s) const { return cap_place ? cap_place : s.caps.data(); }
  int cap_room(FeatureStaging &s) const { return cap_place ? cap_count : StagedRoom{}.cap_room(s); }
  Arc *arcs(FeatureStaging &) const { return arc_place; }
  int64_t arc_room(FeatureStaging &) const { return arc_count; }
};

// The second pass: features straight to their places.
struct PlaceChunkFeatures {
  const CpuKernels *kernels;
  const NeighborGridView *atoms;
  const SurfaceParameters *parameters;
  const uint64_t *cap_first, *arc_base;  // per atom, per chunk
  CapRange *cap_ranges;
  uint8_t *exposed;
  Cap *caps;
  Arc *arcs;
  void operator()(SoloTeam, FeatureStaging &s, size_t chunk) const {
    const size_t end = std::min<size_t>(atoms->count, (chunk + 1) * kAtomsPerChunk);
    uint64_t arc = arc_base[chunk];
    for (size_t i = chunk * kAtomsPerChunk; i < end; ++i) {
      StagedRoom::open(s);
      const bool open = exposed[i] != 0;
      const FinalRoom room{open ? caps + cap_first[i] : nullptr, cap_ranges[i].count, arcs + arc,
                           static_cast<int64_t>(arc_base[chunk + 1] - arc)};
      const AtomFeatures found = find_features_of(*kernels, *atoms, *parameters, i, s, exposed, room);
      cap_ranges[i] = {static_cast<uint32_t>(open ? cap_first[i] : 0), open ? found.cap_count : kBuriedAtom};
      arc += static_cast<uint64_t>(found.arc_count);
    }
  }
};

// Bytes per atom that staged and collected features take together, on proteins with hydrogens.
constexpr uint64_t kStagedAtomBytes = 2000;

inline void find_solvent_features(CpuExecutor &executor, const NeighborGridView &atoms,
                                  const SurfaceParameters &parameters, bool frugal, SolventFeatures *features) {
  const size_t n = atoms.count, chunks = (n + kAtomsPerChunk - 1) / kAtomsPerChunk;
  SolventFeatures &f = *features;
  f.cap_ranges = executor.allocate<CapRange>(n);
  f.exposed = executor.allocate<uint8_t>(n + 8);
  executor.fill(f.exposed, 0);
  const bool twice = frugal || executor.arena().available() < n * kStagedAtomBytes;
  Span<FeatureChunk> table = executor.allocate<FeatureChunk>(chunks);
  for (auto &s : executor.scratches<FeatureStaging>()) s->cap_count = s->arc_count = 0;
  executor.for_each_brick<FeatureStaging>(
      chunks,
      FindChunkFeatures{&executor.kernels(), &atoms, &parameters, f.cap_ranges.data, f.exposed.data, table.data, twice},
      1);
  Span<uint64_t> cap_base = executor.allocate<uint64_t>(chunks + 1), arc_base = executor.allocate<uint64_t>(chunks + 1);
  executor.exclusive_scan(chunks, LoadChunkCaps{table.data}, cap_base);
  executor.exclusive_scan(chunks, LoadChunkArcs{table.data}, arc_base);
  if (!twice) {
    f.caps = executor.allocate<Cap>(cap_base[chunks]);
    f.arcs = executor.allocate<Arc>(arc_base[chunks]);
    executor.for_each(chunks, CollectChunk{table.data, cap_base.data, arc_base.data, n, f.exposed.data,
                                           f.cap_ranges.data, f.caps.data, f.arcs.data});
    if (executor.arena().has_budget())  // which does not see what threads stage
      for (auto &s : executor.scratches<FeatureStaging>()) s->forget();
    return;
  }
  Span<uint64_t> cap_first = executor.allocate<uint64_t>(n + 1);
  executor.exclusive_scan(n, LoadExposedCaps{f.exposed.data, f.cap_ranges.data}, cap_first);
  f.caps.size = cap_first[n];
  f.arcs.size = arc_base[chunks];
  f.caps = executor.allocate<Cap>(cap_first[n]);
  f.arcs = executor.allocate<Arc>(arc_base[chunks]);
  executor.for_each_brick<FeatureStaging>(
      chunks,
      PlaceChunkFeatures{&executor.kernels(), &atoms, &parameters, cap_first.data, arc_base.data, f.cap_ranges.data,
                         f.exposed.data, f.caps.data, f.arcs.data},
      1);
}

}  // namespace quickses
