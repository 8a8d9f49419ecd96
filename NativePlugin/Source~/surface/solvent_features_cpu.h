// SPDX-License-Identifier: MIT
// CPU driver of the solvent features: chunks of atoms per thread, results collected in order afterwards.
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

// Features of the atoms of one chunk, appended to the thread's staging.
struct FindChunkFeatures {
  const CpuKernels *kernels;
  const NeighborGridView *atoms;
  const SurfaceParameters *parameters;
  CapRange *cap_ranges;
  uint8_t *exposed;
  FeatureChunk *chunks;
  void operator()(SoloTeam, FeatureStaging &s, size_t chunk) const {
    FeatureChunk &c = chunks[chunk];
    c = {&s, s.cap_count, 0, s.arc_count, 0};
    const size_t end = std::min<size_t>(atoms->count, (chunk + 1) * kAtomsPerChunk);
    for (size_t i = chunk * kAtomsPerChunk; i < end; ++i) {
      if (s.caps.size() < s.cap_count + 256) s.caps.resize(std::max(2 * s.caps.size(), s.cap_count + 1024));
      if (s.arcs.size() < s.arc_count + 256) s.arcs.resize(std::max(2 * s.arcs.size(), s.arc_count + 1024));
      AtomFeatures found;
      for (;;) {
        const int cap_room = static_cast<int>(std::min<size_t>(s.caps.size() - s.cap_count, 1u << 30));
        const int64_t arc_room = static_cast<int64_t>(s.arcs.size() - s.arc_count);
        found = kernels->find_atom_features(*atoms, *parameters, static_cast<uint32_t>(i), s.scratch(),
                                            s.caps.data() + s.cap_count, cap_room, s.arcs.data() + s.arc_count,
                                            arc_room, exposed);
        if (found.neighbors_needed > 0)
          s.capacity = found.neighbors_needed + found.neighbors_needed / 2;
        else if (found.cap_count > cap_room)
          s.caps.resize(s.cap_count + static_cast<size_t>(found.cap_count));
        else if (found.arc_count > arc_room)
          s.arcs.resize(s.arc_count + static_cast<size_t>(found.arc_count));
        else
          break;
      }
      cap_ranges[i] = {static_cast<uint32_t>(s.cap_count - c.first_cap), found.cap_count};
      s.cap_count += static_cast<size_t>(found.cap_count);
      s.arc_count += static_cast<size_t>(found.arc_count);
    }
    c.cap_count = s.cap_count - c.first_cap;
    c.arc_count = s.arc_count - c.first_arc;
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

inline SolventFeatures find_solvent_features(CpuExecutor &executor, const NeighborGridView &atoms,
                                             const SurfaceParameters &parameters) {
  const size_t n = atoms.count, chunks = (n + kAtomsPerChunk - 1) / kAtomsPerChunk;
  SolventFeatures f;
  f.cap_ranges = executor.allocate<CapRange>(n);
  f.exposed = executor.allocate<uint8_t>(n + 8);
  executor.fill(f.exposed, 0);
  Span<FeatureChunk> table = executor.allocate<FeatureChunk>(chunks);
  for (auto &s : executor.scratches<FeatureStaging>()) s->cap_count = s->arc_count = 0;
  executor.for_each_brick<FeatureStaging>(
      chunks,
      FindChunkFeatures{&executor.kernels(), &atoms, &parameters, f.cap_ranges.data, f.exposed.data, table.data}, 1);
  Span<uint64_t> cap_base = executor.allocate<uint64_t>(chunks + 1), arc_base = executor.allocate<uint64_t>(chunks + 1);
  executor.exclusive_scan(chunks, LoadChunkCaps{table.data}, cap_base);
  executor.exclusive_scan(chunks, LoadChunkArcs{table.data}, arc_base);
  f.caps = executor.allocate<Cap>(cap_base[chunks]);
  f.arcs = executor.allocate<Arc>(arc_base[chunks]);
  executor.for_each(chunks, CollectChunk{table.data, cap_base.data, arc_base.data, n, f.exposed.data, f.cap_ranges.data,
                                         f.caps.data, f.arcs.data});
  return f;
}

}  // namespace quickses
