// SPDX-License-Identifier: MIT
// How large a mesh will be, without making it: lattice edges that change sign are counted, on the lattice itself if
// that is cheap, else on two coarser ones. Vertices times spacing squared come near a straight line over the spacing.
#pragma once

#include "surface/methods/exact_surface.h"
#include "surface/methods/gaussian_surface.h"
#include "surface/methods/grid_surface.h"
#include "surface/methods/size_check.h"

namespace quickses {

// Bricks that are counted without a thought, and pairs of a brick and an arc that comes near it.
constexpr double kCheapBricks = 32768, kCheapPairs = 64 * kCheapBricks;

// Part of the table of bricks that inflated balls fill at most: none reaches the bricks at its border.
constexpr double kFilledBox = 0.8;
// Part of the sum of the balls that they fill together, where they overlap as atoms do.
constexpr double kFilledBalls = 0.8;

// Å² of surface and arcs per atom, if nothing else is known. Without a probe hardly an atom is buried.
inline double usual_area(const SurfaceParameters &parameters) { return parameters.probe > 0 ? 10 : 15; }
inline double usual_arcs(const SurfaceParameters &parameters) { return parameters.probe > 0 ? 4 : 6; }

// Counts at the spacing of the work. Gives up all memory it takes.
template <class Work>
SurfaceSize count_size(Work &work, WorkFacts *facts) {
  auto &executor = work.executor;
  using Executor = std::remove_reference_t<decltype(executor)>;
  const auto mark = executor.arena().mark();
  const auto count = [&](const BrickSet &bricks, const auto &evaluate) {
    facts->brick_entries = bricks.table_entries();
    Span<uint64_t> signs = executor.template allocate<uint64_t>(size_t(bricks.count) * kLeavesPerBrick);
    evaluate(bricks, signs.data);
    MeshLayout layout{};
    const MeshCounts counts = lay_out_mesh(executor, bricks, signs.data, work.table.triangle_count, &layout);
    executor.arena().rewind(mark);
    return SurfaceSize{static_cast<double>(bricks.count), static_cast<double>(counts.vertices),
                       static_cast<double>(counts.triangles), static_cast<double>(layout.leaf_total)};
  };
  const auto find_ball_bricks = [&] {
    return collect_ball_bricks(executor, work.atoms, work.parameters.max_radius, work.lattice, &facts->brick_visits);
  };
  if (work.settings.surface == QSES_SURFACE_GAUSSIAN)
    return count(find_ball_bricks(), [&](const BrickSet &bricks, uint64_t *signs) {
      const auto at_once = [&](const auto &work_on) { work_on(BrickRange{0, bricks.count}); };
      if (bricks.count > 0) evaluate_density_signs(work, bricks, at_once, signs);
    });
  if (work.settings.method == QSES_METHOD_GRID) {
    const GridParameters parameters =
        make_grid_parameters(work.parameters.probe, work.parameters.spacing, work.parameters.max_radius);
    return count(find_ball_bricks(), [&](const BrickSet &bricks, uint64_t *signs) {
      if (bricks.count == 0) return;
      const GridField field = classify_grid_points(executor, work.atoms, parameters, bricks);
      evaluate_grid_signs(executor, field, BrickRange{0, bricks.count}, signs);
    });
  }
  return count(find_bricks(executor, work.features, work.lattice, &facts->brick_visits),
               [&](const BrickSet &bricks, uint64_t *signs) {
                 if (bricks.count == 0) return;
                 for_each_slice(work, bricks.count, sign_slice(work, bricks), 0, 0, [&](BrickRange slice) {
                   Candidates<Executor> own{};
                   Backend<Executor>::evaluate_signs(executor, {work.features, bricks, slice, work.rooms, own}, signs);
                 });
                 if (work.parameters.has_thin_walls()) mend_thin_walls(work, bricks, nullptr, signs);
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
// the probe, the more there are. An arc reaches as many bricks as a ball that is larger than the probe by so much.
constexpr double kArcReach = 1.15;
inline double guess_pairs(const WorkFacts &facts, const SurfaceParameters &parameters, bool exact, double spacing) {
  return exact ? static_cast<double>(facts.arcs) *
                     bricks_of_ball(kArcReach * static_cast<double>(parameters.depth), spacing)
               : static_cast<double>(facts.atoms) * bricks_of_ball(static_cast<double>(parameters.max_radius), spacing);
}

// Whether counting at a spacing takes next to no time.
template <class Work>
bool is_cheap_to_count(const Work &work, double spacing) {
  const double atoms = static_cast<double>(work.facts->atoms);
  if (guess_bricks(atoms, usual_area(work.parameters) * atoms, spacing) > kCheapBricks) return false;
  const bool exact = is_exact(work.settings);
  const double pairs = guess_pairs(*work.facts, work.parameters, exact, spacing), brick = spacing * kBrickEdge;
  if (exact) return pairs <= kCheapPairs;
  double box = 1;
  for (int d = 0; d < 3; ++d)
    box *= (static_cast<double>(work.high[d] - work.low[d]) + 2.0 * static_cast<double>(work.parameters.max_radius)) /
           brick;
  return std::min(pairs, box) <= kCheapBricks;
}

// Of the mesh at the spacing of the work.
template <class Work>
SurfaceSize estimate_size(const Work &wanted) {
  const double spacing = static_cast<double>(wanted.parameters.spacing);
  const auto count_at = [&](double h, WorkFacts *facts) {
    Work work = wanted;
    work.enter_level(static_cast<float>(h));
    return count_size(work, facts);
  };
  double h = spacing;
  while (!is_cheap_to_count(wanted, h) && 2 * h < 2) h *= 2;
  if (h == spacing) return count_at(h, wanted.facts);
  WorkFacts unused;
  const SurfaceSize fine = count_at(h, &unused), coarse = count_at(2 * h, &unused);
  wanted.facts->brick_entries = wanted.facts->brick_visits = 0;
  SurfaceSize size = extrapolate(fine, h, coarse, 2 * h, spacing);
  // Bricks of large probes fill space and follow no such line; to find them takes much less than their signs.
  const uint64_t entries = wanted.lattice.table_size(), room = wanted.executor.arena().available();
  if (is_exact(wanted.settings) && guess_pairs(*wanted.facts, wanted.parameters, true, spacing) <= 64 * kCheapPairs &&
      entries <= kMaxDenseCells && (kDenseEntryBytes + sizeof(uint64_t)) * entries <= room / 2) {
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
template <class Work>
uint64_t count_kept_caps(const Work &work) {
  return static_cast<uint64_t>(
      work.executor.reduce(work.features.atoms.count, CountKeptCaps{work.features.cap_ranges}));
}

// What was not counted before the work ended, guessed generously. most_bricks: of the table.
inline void guess_unknown(const SurfaceParameters &parameters, bool exact, double most_bricks, WorkFacts *facts) {
  const double atoms = static_cast<double>(facts->atoms), h = static_cast<double>(parameters.spacing),
               area = usual_area(parameters) * atoms;
  if (!facts->knows_arcs) {
    // Larger spheres have more neighbours.
    const double wide = std::max(1.0, static_cast<double>(parameters.max_radius) / 3.2);
    facts->caps = static_cast<uint64_t>(18 * atoms * std::min(wide * wide, atoms / 18 + 1));
    facts->arcs = static_cast<uint64_t>(usual_arcs(parameters) * atoms * wide);
  }
  if (facts->arc_length == 0) {
    facts->spindle_turns = 0.025 * static_cast<double>(facts->arcs);
    facts->arc_length = 2 * static_cast<double>(facts->arcs);
  }
  if (facts->size.bricks == 0) {
    const double pairs = guess_pairs(*facts, parameters, exact, h);
    facts->size.bricks =
        std::max(1.2 * guess_bricks(atoms, area, h) + 64,
                 exact ? std::min(pairs, most_bricks) : std::min(kFilledBalls * pairs, kFilledBox * most_bricks));
  }
  if (facts->size.vertices == 0) {
    facts->size.vertices = kVerticesPerCell * area / (h * h);
    facts->size.triangles = 2 * facts->size.vertices;
    facts->size.leaves = facts->size.vertices / kVerticesPerLeaf;
  }
}

}  // namespace quickses
