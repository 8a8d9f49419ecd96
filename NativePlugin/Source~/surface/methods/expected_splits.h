// SPDX-License-Identifier: MIT
// What splits of creases will find of a mesh, before anybody knows: room is left for it, and estimates count on it.
#pragma once

#include "surface/methods/level_work.h"

namespace quickses {

struct ArcSums {
  double spindle_turns, length;  // as in WorkFacts
  QSES_HOST_DEVICE void operator+=(const ArcSums &other) {
    spindle_turns += other.spindle_turns;
    length += other.length;
  }
};

struct SumArcs {
  const Sphere *bounds;  // of which some may be no items
  const Arc *arcs;
  float probe;
  QSES_HOST_DEVICE ArcSums operator()(size_t i) const {
    if (is_no_item(bounds[i])) return {0, 0};
    const Arc arc = load(arcs + i);
    const double half = static_cast<double>(atan2(arc.sin_half, arc.cos_half)),
                 radius = static_cast<double>(arc.radius);
    return {arc.radius < probe ? half * (1 / 3.14159265358979) : 0, 2 * half * radius};
  }
};

// Waits.
template <class Work>
void sum_arcs(Work &work) {
  auto &executor = work.executor;
  const NeighborGridView &bounds = work.features.arc_bounds;
  ArcSums sums =
      executor.template reduce<ArcSums>(bounds.count, SumArcs{bounds.items, work.features.arcs, work.parameters.probe});
  if constexpr (std::decay_t<decltype(executor)>::kCounts)
    sums = {executor.facts().spindle_turns, executor.facts().arc_length};
  work.facts->spindle_turns = sums.spindle_turns;
  work.facts->arc_length = sums.length;
}

// Numbers for a vertex of the mesh before splits. Measured with proteins, their alpha carbons alone, and random atoms
// from 20 to 500 Å³ each, at spacings from .25 to 2 Å, with probes from .3 to 6 Å; generously. Of flat or regular
// molecules through which probes meet from both sides it is a guess.
struct ExpectedSplits {
  double added;  // vertices, and as large a part of the triangles, once some are merged again
  double near;   // triangles beside creases, of which a vertex has two
  double crest;  // vertices on creases

  double room_part() const { return 1.2 * added; }                           // as long as nothing is merged
  double near_part(int round) const { return 1 - std::exp(-round * near); }  // of the triangles, from round 1 on
  double hard_part() const { return 1 - std::exp(-crest); }                  // of the vertices, once per side
};
inline double exponent_of_part(double part) { return -std::log1p(-std::min(part, 0.999)); }

// From the arcs alone.
template <class Work>
ExpectedSplits predict_splits(const Work &work) {
  const WorkFacts &facts = *work.facts;
  const SurfaceParameters &parameters = work.parameters;
  const double vertices = std::max(1.0, facts.size.vertices);
  if (parameters.is_of_balls()) {
    const double creases = 1.2 * std::sqrt(static_cast<double>(facts.arcs) / vertices);
    return {std::min(1.0, creases), creases, std::min(1.0, creases)};
  }
  const double h = static_cast<double>(parameters.spacing), probe = static_cast<double>(parameters.probe),
               ball = std::max(h / 1.5, static_cast<double>(parameters.max_radius) - probe);
  // Sharp at any spacing: a torus that would go through its own axis ends there in two points, each with as many edges
  // around it whatever their length; and creases of probes, along which edges are counted, begin at many of them.
  const double tips = facts.spindle_turns / vertices, along = 4 * probe / h;
  // Sharp for a coarse mesh: grooves along arcs, as narrow as the probe, and balls, as far as no torus covers them.
  const double arcs = facts.arc_length / (h * vertices);
  const double grooves = 1.15 * arcs * (1 - std::exp(-0.6 * (h / probe) * (h / probe)));
  const double balls = std::max(0.0, 2.7 * (h / ball - 0.57)) * std::max(0.0, 1 - 1.7 * arcs * probe / h);
  return {std::max(balls, std::min(1.3, 1 - std::exp(-33 * tips) + grooves + balls)),
          (33 + along) * tips + grooves + balls, (20 + along) * tips + 0.7 * grooves + std::log1p(balls)};
}

// With what is known of a mesh like it.
template <class Work>
ExpectedSplits expected_splits(const Work &work) {
  ExpectedSplits expected = predict_splits(work);
  const FoundSplits &found = work.facts->found;
  expected.added = std::max(expected.added, found.added);
  expected.near = std::max(expected.near, found.near);
  expected.crest = std::max(expected.crest, found.crest);
  return expected;
}

// Room for so many vertices or triangles, and for those that splits of creases add behind them.
template <class Work>
size_t with_spare_room(const Work &work, size_t n) {
  if (!work.will_be_split) return n;
  return n + static_cast<size_t>(expected_splits(work).room_part() * static_cast<double>(n));
}

}  // namespace quickses
