// SPDX-License-Identifier: MIT
// CPU kernel: the features near a place, eight at a time.
#include "parallel/pack.h"
#include "surface/cpu/cpu_arc_projection.h"
#include "surface/cpu/cpu_kernels.h"

namespace quickses {
namespace QSES_CPU_ISA {
namespace {

struct PackedBall {
  Vec3<Pack> center;
  Pack radius;
};

PackedArc load_arcs(const LocalColumns &c, int k) {
  const auto column = [&](int n) { return load_wide(c.arc_columns[n] + k); };
  return {{column(0), column(1), column(2)},  column(3), {column(4), column(5), column(6)}, column(7),
          {column(8), column(9), column(10)}, column(11)};
}
void store_arc(LocalColumns *c, int k, const Arc &arc) {
  const float values[LocalColumns::kArcColumns] = {arc.center.x, arc.center.y, arc.center.z, arc.radius,
                                                   arc.middle.x, arc.middle.y, arc.middle.z, arc.cos_half,
                                                   arc.side.x,   arc.side.y,   arc.side.z,   arc.sin_half};
  for (int n = 0; n < LocalColumns::kArcColumns; ++n) c->arc_columns[n][k] = values[n];
}

// Calls use(first, ball of each lane, lanes) for all items in the box, until one returns false, or there are too many.
template <class Use>
QSES_FN bool for_each_met(const NeighborGridView &grid, const CellBox &box, uint32_t *met, const Use &use) {
  return grid.for_each_run(box, [&](const ItemRun &run) {
    *met += run.end - run.begin;
    if (*met > LocalReach::kMostMet) return false;
    for (uint32_t i = run.begin; i < run.end; i += kPackSize) {
      PackedBall balls;
      load_columns(&grid.items[i].center.x, &balls.center.x, &balls.center.y, &balls.center.z, &balls.radius);
      const uint32_t lanes = first_lanes(run.end - i);
      if (!use(i, balls, lanes)) return false;
    }
    return true;
  });
}

}  // namespace

bool gather_local_features(const FeatureView &f, const Vec3<float> &place, float around, LocalColumns *out) {
  const LocalReach reach(f, place, around);
  const Vec3<Pack> x{Pack(place.x), Pack(place.y), Pack(place.z)};
  uint32_t met = 0, met_again = 0;
  out->atom_number = out->arc_number = 0;
  const CellBox atom_box = reach.box(f.atoms, reach.atom_reach);
  Pack deepest(-kFarAway);
  const bool few_met = for_each_met(f.atoms, atom_box, &met, [&](uint32_t, const PackedBall &balls, uint32_t lanes) {
    deepest = maximum(deepest, select(lane_mask(lanes), ball_depth(balls, x), Pack(-kFarAway)));
    return true;
  });
  if (!few_met) return false;
  const Pack least(horizontal_maximum(deepest) - reach.slack);
  const bool atoms_fit =
      for_each_met(f.atoms, atom_box, &met_again, [&](uint32_t i, const PackedBall &balls, uint32_t lanes) {
        const uint32_t near = lanes & lane_bits(ball_depth(balls, x) >= least);
        if (out->atom_number + popcount64(near) > LocalReach::kMostAtoms) return false;
        out->atom_number += store_lane_numbers(reinterpret_cast<int32_t *>(out->atoms) + out->atom_number, near,
                                               static_cast<int32_t>(i));
        return true;
      });
  if (!atoms_fit) return false;
  const bool arcs_fit =
      f.arc_bounds.count == 0 || for_each_met(f.arc_bounds, reach.box(f.arc_bounds, reach.arc_reach), &met,
                                              [&](uint32_t i, const PackedBall &bounds, uint32_t lanes) {
                                                uint32_t near = lanes & lane_bits(reach.meets(bounds, x));
                                                for (; near; near &= near - 1) {
                                                  const uint32_t a = i + static_cast<uint32_t>(lowest_bit32(near));
                                                  const Arc arc = load(f.arcs + a);
                                                  if (!reach.is_near(arc)) continue;
                                                  if (out->arc_number == LocalReach::kMostArcs) return false;
                                                  store_arc(out, out->arc_number, arc);
                                                  out->arcs[out->arc_number++] = a;
                                                }
                                                return true;
                                              });
  if (!arcs_fit) return false;
  const glm::vec3 zero(0.f);
  for (int k = 0; k < kWideLanes; ++k)
    store_arc(out, out->arc_number + k, {glm::vec3(1e6f), 0.f, zero, 0.f, zero, 0.f});  // farther than all others
  return true;
}

NearestArc nearest_local_arc(const LocalColumns &c, const Vec3<float> &place) {
  const Vec3<WidePack> x{WidePack(place.x), WidePack(place.y), WidePack(place.z)};
  WidePack best(kFarAway), second(kFarAway), number(0.f);
  for (int k = 0; k < c.arc_number; k += kWideLanes) {
    const WidePack distance2 = arc_distance2(load_arcs(c, k), x);
    const WideMask nearer = distance2 < best;
    second = minimum(second, select(nearer, best, distance2));
    number = select(nearer, WidePack(static_cast<float>(k)), number);
    best = select(nearer, distance2, best);
  }
  float lane_best[kWideLanes], lane_second[kWideLanes], lane_number[kWideLanes];
  store_pack(lane_best, best);
  store_pack(lane_second, second);
  store_pack(lane_number, number);
  NearestArc nearest;
  for (int lane = 0; lane < kWideLanes; ++lane) {
    if (!(lane_best[lane] < kFarAway)) continue;
    nearest.offer(static_cast<int>(c.arcs[static_cast<int>(lane_number[lane]) + lane]), lane_best[lane]);
    nearest.second2 = minimum(nearest.second2, lane_second[lane]);
  }
  return nearest;
}

}  // namespace QSES_CPU_ISA
}  // namespace quickses
