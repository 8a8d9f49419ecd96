// SPDX-License-Identifier: MIT
// The exact surface of a large mesh that goes from a GPU to the host: slab by slab, so that the first triangles and
// vertices are on the bus while signs of the others are found. For frames of which the one before told how large the
// mesh will be; each step goes as far as what it reads is final, and signs no farther ahead than that takes. The mesh
// is that of exact_surface.h, byte for byte.
#pragma once

#include "surface/methods/closed_layout.h"
#include "surface/stages/thin_walls.h"

#include <algorithm>
#include <optional>

namespace quickses {

// Runs of bricks in linear order. The numbers of two bricks that are next to each other differ by `near` at most, and a
// slab is wider than what each of its steps must stay behind the one before (final_bricks).
struct Slabs {
  uint32_t count = 0, bricks = 0, near = 0;
  MeshTotals room{};  // of the whole mesh, as it is foreseen
  // What bricks are final for: signs, which those of the slabs behind may mark; to be counted, which takes the signs
  // around; and to be emitted, which takes the counts around.
  enum Step : uint32_t { kSigns = 1, kCounts = 2, kEmission = 3 };

  uint32_t end(uint32_t slab) const { return static_cast<uint32_t>(uint64_t(bricks) * (slab + 1) / count); }
  BrickRange range(uint32_t slab) const { return {slab > 0 ? end(slab - 1) : 0, end(slab)}; }
  // Walls of a slab take the signs around.
  uint32_t signs_end(uint32_t slab) const { return slab + 1 == count ? bricks : end(slab) + near; }
  BrickRange signs(uint32_t slab) const { return {slab > 0 ? signs_end(slab - 1) : 0, signs_end(slab)}; }
  // How many bricks are, when walls of so many slabs are found.
  uint32_t final_bricks(uint32_t slabs, Step step) const {
    return slabs == count ? bricks : slabs == 0 ? 0 : end(slabs - 1) - step * near;
  }
  BrickRange newly_final(uint32_t slabs, Step step) const {
    return {final_bricks(slabs - 1, step), final_bricks(slabs, step)};
  }
};

// count 0: such a surface is made as a whole.
template <class Work>
Slabs slabs_of(const Work &work, const BrickSet &bricks) {
  // Each slab has kernels that wait for their last few items, which costs the more, the fewer vertices it has.
  constexpr uint32_t kMost = 8, kWorthASlab = 400000, kWorthIt = 1000000;
  Slabs slabs;
  const bool goes_out_as_made = work.parameters.has_thin_walls() && work.paints_early() && !work.settings.occlusion &&
                                !work.will_be_split && work.settings.relaxation_steps <= 1;
  if (!goes_out_as_made || !work.memory.goes_to_host() || !work.plan.single_slice || !bricks.table || !bricks.found ||
      !work.executor.foresee("mesh", bricks.found, MeshTotals{}, &slabs.room) || !fits_bases(bricks.count))
    return slabs;
  slabs.bricks = bricks.count;
  slabs.near = slabs.room.near;
  if (slabs.room.vertices < kWorthIt) return slabs;
  slabs.count =
      std::min({kMost, slabs.room.vertices / kWorthASlab, slabs.bricks / ((Slabs::kEmission + 1) * slabs.near)});
  if (slabs.count < 2) slabs.count = 0;
  return slabs;
}

// What the bricks own that come before one of them is told by one thread more of the last step of counting: a launch of
// its own takes three microseconds for each slab.
struct CountAndTell {
  CountBorderChanges count;
  size_t bricks;
  const BrickTotals *before;
  BrickTotals *out;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    if (i < bricks)
      count(i);
    else
      *out = *before;
  }
};

template <class Work>
MeshMemoryView build_in_slabs(Work &work, const BrickSet &bricks, const Slabs &slabs) {
  auto &executor = work.executor;
  using Executor = std::remove_reference_t<decltype(executor)>;
  using B = Backend<Executor>;
  const size_t leaves = size_t(bricks.count) * kLeavesPerBrick;
  const Span<uint64_t> signs = executor.template allocate<uint64_t>(leaves);
  const Span<uint64_t> marks = executor.template allocate_zeros<uint64_t>(leaves);
  MeshLayout layout{};
  allocate_layout(executor, bricks.count, signs.data, &layout);
  layout.vertex_total = slabs.room.vertices;
  layout.triangle_total = slabs.room.triangles;
  layout.leaf_total = slabs.room.leaves;
  layout.near = slabs.near;
  MeshMemoryView mesh = begin_mesh(work, MeshCounts{slabs.room.vertices, slabs.room.triangles});
  work.memory.begin_to_send(mesh);
  mesh.is_brought = true;

  const auto end_of_mesh = executor.arena().mark();
  const Span<BrickTotals> owned = executor.template allocate<BrickTotals>(bricks.count);
  BrickTotals *const told = executor.template take_counts<BrickTotals>();
  const VertexStarts starts{work.settings.relaxation_steps > 0, nullptr, work.table.ring, &layout.totals->unplaced};
  Candidates<Executor> candidates{};
  candidates.open(executor, work.parameters, {0, bricks.count});
  // Those that walls of a slab ask for, which look to both sides.
  candidates.keep_deciders(executor, bricks.count / slabs.count + 1 + 2 * slabs.near);
  const auto vertex_words = [&](size_t vertices, size_t leaves) {
    return Candidates<Executor>::vertex_words(work.parameters, vertices, leaves);
  };
  // For one run of bricks after the other, of which the last is the widest; few are much fuller than the mean.
  const uint32_t widest = slabs.newly_final(slabs.count, Slabs::kEmission).size();
  Span<uint32_t> vertex_room = executor.template allocate<uint32_t>(
      vertex_words(slabs.room.vertices, slabs.room.leaves) / bricks.count * (widest + widest / 8));
  const auto turn_to_slab = [&](uint32_t slab) {
    executor.turn_counts_to(work.parameters.spacing, slabs.count << 8 | (slab + 1));
  };

  const auto work_on = [&](BrickRange slice) {
    return typename B::Slice{work.features, bricks, slice, work.rooms, candidates};
  };
  const auto find_signs = [&](uint32_t slab) {
    work.timer.begin("exact_ses");
    turn_to_slab(slab);
    B::gather_candidates(executor, work_on(slabs.signs(slab)), signs.data);
    B::evaluate_signs(executor, work_on(slabs.signs(slab)), signs.data);
  };
  const auto find_walls = [&](uint32_t slab) {
    work.timer.begin("thin_walls");
    turn_to_slab(slab);
    B::mark_thin_walls(executor, work_on(slabs.range(slab)), signs.data, marks.data);
  };
  // When walls of so many slabs are found. What is emitted then is told of.
  const auto lay_out = [&](uint32_t found) {
    work.timer.begin("marching_cubes");
    const BrickRange final_signs = slabs.newly_final(found, Slabs::kSigns),
                     emitted = slabs.newly_final(found, Slabs::kEmission);
    const size_t first_leaf = size_t(final_signs.first) * kLeavesPerBrick;
    executor.for_each(size_t(final_signs.size()) * kLeavesPerBrick,
                      AddMarks{marks.data + first_leaf, signs.data + first_leaf});
    count_cells(executor, bricks, layout, work.table.triangle_count, owned.data,
                slabs.newly_final(found, Slabs::kCounts));
    executor.for_each(emitted.size() + size_t(1),
                      CountAndTell{{bricks, layout, emitted.first, slabs.final_bricks(found, Slabs::kCounts)},
                                   emitted.size(),
                                   layout.base + emitted.last,
                                   told});
    if (found == slabs.count) {
      executor.turn_counts_to(work.parameters.spacing);
      executor.expect("mesh", layout.totals, MeshTotals{});
    }
    B::emit_triangles(executor, bricks, layout, emitted, work.table, mesh.view);
    executor.send_all_counts();
  };

  // Beside the slabs that follow, from which it gets nothing; so it is a part of the time of their stages.
  BrickTotals done{};
  std::optional<typename B::SecondStream> second(std::in_place, executor);
  const auto place_vertices = [&](uint32_t found, const BrickTotals &end) {
    turn_to_slab(found - 1);
    const SliceSizes sizes = sizes_between(done, end);
    const size_t words = vertex_words(sizes.vertices, sizes.leaves);
    if (words > vertex_room.size) {
      vertex_room = executor.template allocate<uint32_t>(words);
      second->follow();
    }
    candidates.vertex_room = vertex_room;
    second->queue([&] {
      const BrickRange emitted = slabs.newly_final(found, Slabs::kEmission);
      B::emit_vertices(executor, work_on(emitted), VertexWork{layout, sizes, starts, mesh.view});
      const MeshView part = view_from(mesh.view, sizes.first_vertex, 0);
      paint(work, part, sizes.vertices);
      work.memory.send_vertices(executor, part, sizes.vertices);
    });
  };
  // What was told. Waits for it; the GPU has the next slab to work on meanwhile.
  const auto deliver = [&](uint32_t found) {
    executor.hand_over();
    work.attend_to_others();
    executor.verify_counts();
    // Where there is more than was foreseen no more is emitted, and the last look at the counts will throw.
    if (!slabs.room.covers(executor.verified(layout.totals))) return;
    const BrickTotals now = executor.verified(told);
    work.memory.send_triangles(view_from(mesh.view, 0, done.triangles), now.triangles - done.triangles);
    place_vertices(found, now);
    done = now;
    work.progress.report(0.85 * found / slabs.count);
  };
  for (uint32_t slab = 0; slab < slabs.count; ++slab) {
    find_signs(slab);
    if (slab > 0) deliver(slab);
    find_walls(slab);
    lay_out(slab + 1);
  }
  deliver(slabs.count);
  work.timer.begin("projection");
  second.reset();
  executor.turn_counts_to(work.parameters.spacing);

  narrow_mesh(&mesh, done.vertices, done.triangles);
  note_size(work, executor.verified(bricks.found).count, {done.vertices, done.triangles}, done.leaves);
  work.report->slice_count = slabs.count;
  executor.arena().rewind(end_of_mesh);
  mesh.unplaced = starts.unplaced;
  return mesh;
}

}  // namespace quickses
