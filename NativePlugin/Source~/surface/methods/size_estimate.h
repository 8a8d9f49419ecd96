// SPDX-License-Identifier: MIT
// How large a mesh will be, without making it: lattice edges that change sign are counted, on the lattice itself if
// that is cheap, else on two coarser ones. Vertices times spacing squared come near a straight line over the spacing.
#pragma once

#include "surface/memory/memory_plan.h"
#include "surface/methods/grid_surface.h"
#include "surface/methods/size_check.h"

namespace quickses {

// Bricks that are counted without a thought, and pairs of a brick and an arc that comes near it.
constexpr double kCheapBricks = 32768, kCheapPairs = 64 * kCheapBricks;

// Part of the table of bricks that inflated balls fill at most: none reaches the bricks at its border.
constexpr double kFilledBox = 0.8;
// Part of the sum of the balls that they fill together, where they overlap as atoms do.
constexpr double kFilledBalls = 0.8;

// Å² of surface per atom, if nothing else is known.
constexpr double kUsualArea = 10;

// Counts at the spacing of the run. Gives up all memory it takes.
template <class R>
SurfaceSize count_size(R &run, uint64_t *brick_entries) {
  auto &executor = run.executor;
  using Executor = std::remove_reference_t<decltype(executor)>;
  const auto mark = executor.arena().mark();
  const auto count = [&](const BrickSet &bricks, const auto &evaluate) {
    *brick_entries = bricks.table ? bricks.lattice.table_size() : 0;
    Span<uint64_t> signs = executor.template allocate<uint64_t>(size_t(bricks.count) * kLeavesPerBrick);
    evaluate(bricks, signs.data);
    MeshLayout layout{};
    const MeshCounts counts = lay_out_mesh(executor, bricks, signs.data, run.table.triangle_count, &layout);
    executor.arena().rewind(mark);
    return SurfaceSize{static_cast<double>(bricks.count), static_cast<double>(counts.vertices),
                       static_cast<double>(counts.triangles), static_cast<double>(layout.leaf_total)};
  };
  const auto in_slices = [&](const BrickSet &bricks, double bytes_per_brick, const auto &work) {
    const uint32_t fitting = bricks_that_fit(run, bricks.count, static_cast<uint64_t>(bytes_per_brick) + 1);
    for_each_slice(run, bricks.count, Slicing{false, fitting}, 0, 0, work);
  };
  if (run.settings.method == QSES_METHOD_GRID) {
    const GridParameters parameters =
        make_grid_parameters(run.parameters.probe, run.parameters.spacing, run.parameters.max_radius);
    return count(find_grid_bricks(executor, run.atoms, parameters, run.lattice),
                 [&](const BrickSet &bricks, uint64_t *signs) {
                   if (bricks.count == 0) return;
                   const GridField field = classify_grid_points(executor, run.atoms, parameters, bricks);
                   in_slices(bricks, 0, [&](BrickRange slice) { evaluate_grid_signs(executor, field, slice, signs); });
                 });
  }
  return count(find_bricks(executor, run.features, run.lattice), [&](const BrickSet &bricks, uint64_t *signs) {
    if (bricks.count == 0) return;
    in_slices(bricks, CandidatesOf<Executor>::sign_bytes(run.parameters, candidate_counts(run)), [&](BrickRange slice) {
      Candidates<Executor> own{};
      evaluate_signs(executor, run.features, bricks, slice, own, signs);
    });
  });
}

// What the values at two spacings give at a finer one. In units of area, vertices follow a straight line over the
// spacing, bricks one over its inverse: many hold no surface, but fill the balls of probes.
inline SurfaceSize extrapolate(const SurfaceSize &fine, double fine_spacing, const SurfaceSize &coarse,
                               double coarse_spacing, double spacing) {
  const auto at = [&](double f, double c, double power) {
    const double u = f * fine_spacing * fine_spacing, v = c * coarse_spacing * coarse_spacing;
    const double x = std::pow(fine_spacing, power), y = std::pow(coarse_spacing, power);
    const double value = u + (v - u) / (y - x) * (std::pow(spacing, power) - x);
    return std::max(0.0, value) / (spacing * spacing);
  };
  return {at(fine.bricks, coarse.bricks, -1), at(fine.vertices, coarse.vertices, 1),
          at(fine.triangles, coarse.triangles, 1), at(fine.leaves, coarse.leaves, 1)};
}

// Bricks of one ball.
inline double bricks_of_ball(double radius, double spacing) {
  const double bricks = radius / (spacing * kBrickEdge);
  return 4.0 / 3.0 * 3.14159265358979 * bricks * bricks * bricks;
}

// Pairs of a brick and an arc within whose reach it lies, or an inflated ball that the grid method fills. The larger
// the probe, the more there are.
inline double guess_pairs(const WorkFacts &facts, const SurfaceParameters &parameters, bool exact, double spacing) {
  return exact ? static_cast<double>(facts.arcs) * bricks_of_ball(static_cast<double>(parameters.depth), spacing)
               : static_cast<double>(facts.atoms) * bricks_of_ball(static_cast<double>(parameters.max_radius), spacing);
}

// Whether counting at a spacing takes next to no time.
template <class R>
bool is_cheap_to_count(const R &run, double spacing) {
  const double atoms = static_cast<double>(run.facts->atoms);
  if (guess_bricks(atoms, kUsualArea * atoms, spacing) > kCheapBricks) return false;
  const bool exact = run.settings.method == QSES_METHOD_EXACT;
  const double pairs = guess_pairs(*run.facts, run.parameters, exact, spacing), brick = spacing * kBrickEdge;
  if (exact) return pairs <= kCheapPairs;
  double box = 1;
  for (int d = 0; d < 3; ++d)
    box *=
        (static_cast<double>(run.high[d] - run.low[d]) + 2.0 * static_cast<double>(run.parameters.max_radius)) / brick;
  return std::min(pairs, box) <= kCheapBricks;
}

// Of the mesh at the spacing of the run.
template <class R>
SurfaceSize estimate_size(const R &wanted) {
  const double spacing = static_cast<double>(wanted.parameters.spacing);
  const auto count_at = [&](double h, uint64_t *entries) {
    R run = wanted;
    run.parameters.spacing = run.lattice.spacing = static_cast<float>(h);
    run.features.parameters = run.parameters;
    run.lattice = layout_lattice(run.lattice, run.low, run.high, run.parameters.max_radius);
    return count_size(run, entries);
  };
  double h = spacing;
  while (!is_cheap_to_count(wanted, h) && 2 * h < 2) h *= 2;
  if (h == spacing) return count_at(h, &wanted.facts->brick_entries);
  uint64_t unused = 0;
  const SurfaceSize fine = count_at(h, &unused), coarse = count_at(2 * h, &unused);
  wanted.facts->brick_entries = wanted.lattice.table_size() <= kMaxDenseCells ? wanted.lattice.table_size() : 0;
  SurfaceSize size = extrapolate(fine, h, coarse, 2 * h, spacing);
  // Bricks of large probes fill space and follow no such line; to find them takes much less than their signs.
  const uint64_t entries = wanted.lattice.table_size(), room = wanted.executor.arena().available();
  if (wanted.settings.method == QSES_METHOD_EXACT &&
      guess_pairs(*wanted.facts, wanted.parameters, true, spacing) <= 64 * kCheapPairs && entries <= kMaxDenseCells &&
      (kDenseEntryBytes + sizeof(uint64_t)) * entries <= room / 2) {
    const auto mark = wanted.executor.arena().mark();
    size.bricks = static_cast<double>(find_bricks(wanted.executor, wanted.features, wanted.lattice).count);
    wanted.executor.arena().rewind(mark);
  }
  return size;
}

struct CountKeptCaps {
  const CapRange *ranges;
  QSES_HOST_DEVICE double operator()(size_t i) const { return ranges[i].count == kBuriedAtom ? 0 : ranges[i].count; }
};

// Caps of exposed atoms.
template <class R>
uint64_t count_kept_caps(const R &run) {
  return static_cast<uint64_t>(run.executor.reduce(run.features.atoms.count, CountKeptCaps{run.features.cap_ranges}));
}

// The least that the work would have taken, where it ended before all was counted: the rest is guessed generously.
// most_bricks: of the table.
template <class Executor>
double least_of_unfinished(WorkFacts facts, const WorkKind &kind, double most_bricks) {
  const double atoms = static_cast<double>(facts.atoms), h = static_cast<double>(kind.parameters.spacing);
  if (facts.arcs == 0) {
    // Larger spheres have more neighbours.
    const double wide = std::max(1.0, static_cast<double>(kind.parameters.max_radius) / 3.2);
    facts.caps = static_cast<uint64_t>(18 * atoms * std::min(wide * wide, atoms / 18 + 1));
    facts.arcs = static_cast<uint64_t>(4 * atoms * wide);
    facts.arc_cells = facts.atom_cells;
  }
  if (facts.size.bricks == 0) {
    const double pairs = guess_pairs(facts, kind.parameters, kind.exact, h);
    facts.size.bricks =
        std::max(1.2 * guess_bricks(atoms, kUsualArea * atoms, h) + 64,
                 kind.exact ? std::min(pairs, most_bricks) : std::min(kFilledBalls * pairs, kFilledBox * most_bricks));
  }
  if (facts.size.vertices == 0) {
    facts.size.vertices = kVerticesPerCell * kUsualArea * atoms / (h * h);
    facts.size.triangles = 2 * facts.size.vertices;
    facts.size.leaves = facts.size.vertices / kVerticesPerLeaf;
  }
  return 1.1 * MemoryPlan<Executor>(facts, kind).least();
}

}  // namespace quickses
