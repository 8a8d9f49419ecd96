// SPDX-License-Identifier: MIT
// GPU driver of the solvent features: the caps (caps_cuda.cuh), then the arcs (arcs_cuda.cuh). Results are staged
// wherever there is room and then put in order; if a guess of their number was too small, all is done again with room
// for what was counted, which is remembered. With low memory the atoms are worked on in runs, and only the caps that
// later stages look at are kept.
#pragma once

#include "surface/cuda/arcs_cuda.cuh"
#include "surface/cuda/caps_cuda.cuh"

#include <algorithm>

namespace quickses {
namespace gpu {

// What one pass over a run of atoms reads and writes besides its results.
struct FeaturePass {
  NeighborGridView atoms;
  SurfaceParameters parameters;
  CapRange *cap_ranges;
  uint8_t *exposed;
  bool with_arc_atoms() const { return parameters.is_of_balls(); }
};

// One attempt at the caps and arcs of a run of atoms; returns what was counted, or is expected to be.
template <class E>
FeatureCounters find_run_features(E &executor, const FeaturePass &pass, AtomRun run, const FeatureRoom &room,
                                  FeatureCounters *counters, Cap *caps, Arc *arcs, ArcAtoms *arc_atoms,
                                  bool memory_is_short) {
  const auto mark = executor.arena().mark();
  const size_t n = run.size();
  Span<uint32_t> neighbors = executor.template allocate<uint32_t>(room.caps);
  Span<uint32_t> circle_count = executor.template allocate<uint32_t>(n);
  Span<uint32_t> circle_first = executor.template allocate<uint32_t>(n + 1);
  Span<uint32_t> long_atoms = executor.template allocate<uint32_t>(n);
  find_caps(executor,
            CapJob{pass.atoms, pass.parameters.max_radius, run, room, counters, pass.cap_ranges, caps, neighbors.data,
                   circle_count.data, pass.exposed, long_atoms.data},
            memory_is_short);
  executor.exclusive_scan(n, LoadCount<uint32_t>{circle_count.data}, circle_first);
  const ArcSearch search = find_arcs(
      executor,
      CircleJob{pass.atoms, run, pass.parameters.max_arc_bound(), room, counters, pass.cap_ranges, caps, neighbors.data,
                circle_first.data, pass.exposed, arcs, arc_atoms, pass.parameters.is_of_balls()},
      pass.parameters.max_radius);
  FeatureCounters found =
      room.intervals > 0 ? executor.fetch(counters) : executor.expect("features", counters, room.most());
  while (found.unfinished_circles > 0) {
    find_long_circle_arcs(executor, search);
    found = executor.fetch(counters);
    if (found.unfinished_circles > 0) continue;
    write_arcs(executor, search);
    found = executor.fetch(counters);
  }
  executor.arena().rewind(mark);
  return found;
}

// All atoms at once.
template <class E>
void find_all_features(E &executor, const FeaturePass &pass, CudaRooms &rooms, SolventFeatures *features) {
  const uint32_t n = pass.atoms.count;
  FeatureRoom room = FeatureRoom::guess(n);
  room.include(rooms.features);
  for (const auto start = executor.arena().mark();; executor.arena().rewind(start)) {
    features->caps = executor.template allocate<Cap>(room.caps);
    features->arcs = executor.template allocate<Arc>(room.arcs);
    if (pass.with_arc_atoms()) features->arc_atoms = executor.template allocate<ArcAtoms>(room.arcs);
    FeatureCounters *const counters = executor.template take_counts<FeatureCounters>();
    const FeatureCounters found =
        find_run_features(executor, pass, AtomRun{0, n}, room, counters, features->caps.data, features->arcs.data,
                          features->arc_atoms.data, executor.arena().has_budget());
    if (room.holds(found)) {
      features->caps.size = static_cast<size_t>(found.caps);
      features->arcs.size = static_cast<size_t>(found.arcs);
      features->arc_count = &counters->written_arcs;
      if (pass.with_arc_atoms()) features->arc_atoms.size = features->arcs.size;
      features->most_caps = found.longest_row;
      rooms.runs.include(FeatureRoom::of(found).scaled(2 * n, n));  // circles are counted at the earlier of two atoms
      return;
    }
    room.include(FeatureRoom::of(found));
    rooms.features.include(FeatureRoom::of(found).with_spare());
  }
}

struct CountExposedCaps {
  const uint8_t *exposed;
  const CapRange *cap_ranges;
  QSES_HOST_DEVICE double operator()(size_t i) const { return exposed[i] ? cap_ranges[i].count : 0; }
};

// Bytes that a run of atoms takes besides the arcs.
template <class E>
uint64_t run_bytes(E &executor, const FeaturePass &pass, uint32_t atoms, FeatureRoom room) {
  const WorkFacts none{};
  auto counted = counting(executor, none);
  counted.template allocate<Cap>(room.caps);
  find_run_features(counted, pass, AtomRun{0, atoms}, room, counted.template take_counts<FeatureCounters>(), nullptr,
                    nullptr, nullptr, true);
  return counted.arena().peak();
}

// Run after run. The caps of a run serve its circles only; in the end those of the exposed atoms are found once more.
template <class E>
void find_features_in_runs(E &executor, const FeaturePass &pass, const MemoryPlan &plan, CudaRooms &rooms,
                           SolventFeatures *features) {
  const uint32_t n = pass.atoms.count;
  auto &arena = executor.arena();
  const auto room_of = [&](uint32_t atoms) {
    FeatureRoom room = FeatureRoom::guess(atoms);
    room.include(rooms.features.scaled(atoms, n));
    room.include(rooms.runs.scaled(atoms, n));
    room.long_atoms = atoms;
    room.arcs = 0;
    return room;
  };
  const auto before_arcs = arena.mark();
  const auto allocate_arc_atoms = [&](size_t room) {
    if (pass.with_arc_atoms()) features->arc_atoms = executor.template allocate<ArcAtoms>(room);
  };
  const uint64_t arc_bytes = sizeof(Arc) + (pass.with_arc_atoms() ? sizeof(ArcAtoms) : 0);
  Span<Arc> arcs{};
  uint64_t arc_total = 0;
  for (bool is_done = false; !is_done;) {
    arena.rewind(before_arcs);
    // The work on a run gets a quarter of what there is at most, and the arcs what they are expected to need.
    uint32_t atoms_per_run = std::min(n, plan.most_atoms);
    const auto work_bytes = [&] { return run_bytes(executor, pass, atoms_per_run, room_of(atoms_per_run)); };
    while (atoms_per_run > kLeastRun && work_bytes() > arena.available() / 4)
      atoms_per_run = std::max(kLeastRun, atoms_per_run / 2);
    const uint64_t work = work_bytes() + 2 * kArenaUnit;  // both arrays of arcs are rounded up
    const uint64_t left = arena.available() > work ? (arena.available() - work) / arc_bytes : 0;
    const uint64_t expected = std::max({rooms.features.arcs, rooms.runs.arcs, FeatureRoom::guess(n).arcs});
    const size_t arc_room = E::kCounts ? features->arcs.size : static_cast<size_t>(std::min(left, expected));
    allocate_arc_atoms(arc_room);
    arcs = executor.template allocate<Arc>(arc_room);
    arc_total = 0;
    is_done = true;
    for (uint32_t first = 0; first < n && is_done;) {
      const AtomRun run{first, first + std::min(atoms_per_run, n - first)};
      FeatureRoom room = room_of(run.size());
      room.arcs = arcs.size > arc_total ? static_cast<size_t>(arcs.size - arc_total) : 0;
      const auto mark = arena.mark();
      Cap *const caps = executor.template allocate<Cap>(room.caps).data;
      FeatureCounters *const counters = executor.template take_counts<FeatureCounters>();
      ArcAtoms *const arc_atoms = pass.with_arc_atoms() ? features->arc_atoms.data + arc_total : nullptr;
      FeatureCounters found =
          find_run_features(executor, pass, run, room, counters, caps, arcs.data + arc_total, arc_atoms, true);
      arena.rewind(mark);
      arc_total += found.arcs;
      features->most_caps = std::max(features->most_caps, found.longest_row);
      found.arcs = 0;  // if they do not fit they are only counted from then on
      if (!room.holds(found)) {
        rooms.runs.include(FeatureRoom::of(found).with_spare().scaled(n, run.size()));
        is_done = false;
      }
      first = E::kCounts ? n : run.last;  // the first is as large as any
    }
    if (!is_done || arc_total <= arcs.size) continue;
    if (arc_total > left) throw MemoryRefused("the arcs of the atoms do not fit beside the work");
    rooms.runs.arcs = static_cast<size_t>(arc_total + arc_total / 16);
    is_done = false;
  }
  const uint64_t cap_total = static_cast<uint64_t>(executor.reduce(n, CountExposedCaps{pass.exposed, pass.cap_ranges}));
  if (!E::kCounts) {
    features->caps.size = static_cast<size_t>(cap_total);
    features->arcs.size = static_cast<size_t>(arc_total);
  }
  // What the arcs left of their room is given back, unless so few would have had their place in another block.
  const auto behind_arcs = arena.mark();
  const Span<ArcAtoms> arc_atoms = features->arc_atoms;
  arena.rewind(before_arcs);
  allocate_arc_atoms(arc_atoms.size);
  features->arcs = executor.template allocate<Arc>(features->arcs.size);
  if (features->arcs.data != arcs.data || features->arc_atoms.data != arc_atoms.data) {
    arena.rewind(behind_arcs);
    features->arcs.data = arcs.data;
    features->arc_atoms = arc_atoms;
  }
  features->caps = executor.template allocate<Cap>(features->caps.size);

  const auto mark = arena.mark();
  FeatureRoom room{};
  room.caps = features->caps.size;
  room.neighbors = std::max(rooms.features.neighbors, rooms.runs.neighbors);
  room.long_atoms = n;
  FeatureCounters *const counters = executor.template take_counts<FeatureCounters>();
  Span<uint32_t> long_atoms = executor.template allocate<uint32_t>(n);
  find_caps(executor,
            CapJob{pass.atoms, pass.parameters.max_radius, AtomRun{0, n}, room, counters, pass.cap_ranges,
                   features->caps.data, nullptr, nullptr, pass.exposed, long_atoms.data},
            true);
  arena.rewind(mark);
}

template <class E>
void find_solvent_features(E &executor, const NeighborGridView &atoms, const SurfaceParameters &parameters,
                           const MemoryPlan &plan, CudaRooms &rooms, SolventFeatures *features) {
  features->cap_ranges = executor.template allocate<CapRange>(atoms.count);
  if (atoms.count == 0) return;
  Span<uint8_t> exposed = executor.template allocate_zeros<uint8_t>(atoms.count);
  const FeaturePass pass{atoms, parameters, features->cap_ranges.data, exposed.data};
  if (plan.low_memory)
    find_features_in_runs(executor, pass, plan, rooms, features);
  else
    find_all_features(executor, pass, rooms, features);
}

}  // namespace gpu
}  // namespace quickses
