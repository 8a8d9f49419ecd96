// SPDX-License-Identifier: MIT
// CPU kernel: the walls thinner than the spacing that edges of one brick pass through. Edges are sorted out in bulk: by
// signs, all leaves at once, then by probes near them, a pack at a time; few are left to be walked.
#include "surface/cpu/cpu_arc_projection.h"
#include "surface/cpu/cpu_brick_edges.h"
#include "surface/cpu/cpu_candidates.h"
#include "surface/cpu/cpu_leaf_bits.h"

#include <cstring>
#include <new>

namespace quickses {
namespace QSES_CPU_ISA {
namespace {

// Places of the points of a brick and one more on every side: x + 1, y + 1 and z + 1 in four bits each.
constexpr int kPlaces = 16 * 16 * (kBrickEdge + 2), kMostPoints = 10 * 10 * 10;
constexpr int kMostEdges = kBrickPoints * kWallSteps;
constexpr int kMostWalks = 128;  // edges walked together

constexpr PointPlaces<16, 256> kPlacesFromFirst;
constexpr int kFirstPlace = kPlacesFromFirst.of(1, 1, 1);
QSES_FN int place_of(int leaf, int bit) {
  return kFirstPlace + kPlacesFromFirst.of_leaf(leaf) + kPlacesFromFirst.of_bit[bit];
}
QSES_FN glm::ivec3 point_of(int place) { return glm::ivec3((place & 15) - 1, (place >> 4 & 15) - 1, (place >> 8) - 1); }
struct StepPlaces {
  int at[kWallSteps];  // what a step adds
};
QSES_FN StepPlaces make_step_places() {
  StepPlaces places;
  for (int k = 0; k < kWallSteps; ++k) {
    const glm::ivec3 s = wall_step(k);
    places.at[k] = kPlacesFromFirst.of(s.x, s.y, s.z);
  }
  return places;
}

// Points and the probes nearest to them.
template <int kRoom>
struct ProbedPoints {
  alignas(32) float x[kRoom], y[kRoom], z[kRoom], center_x[kRoom], center_y[kRoom], center_z[kRoom], distance[kRoom];
  QSES_FN void set(int k, const Vec3<float> &v) { x[k] = v.x, y[k] = v.y, z[k] = v.z; }
  QSES_FN Vec3<float> point(int k) const { return {x[k], y[k], z[k]}; }
  QSES_FN NearestProbe probe(int k) const { return {{center_x[k], center_y[k], center_z[k]}, distance[k]}; }
};

// An edge that may be a wall: the numbers of its ends, the place of the first one, and the step.
struct Edge {
  uint16_t first, second, place, step;
};
struct Walk {
  Edge edge;
  WallWalk state;
};

struct WallWork {
  ProbedPoints<kMostPoints + 2 * kWideLanes> ends;
  ProbedPoints<kMostWalks + kWideLanes> walked;
  CoveredNeighbors covered;
  int16_t number[kPlaces];  // of the points in ends, by place; -1: none
  Walk walks[kMostWalks];
  Edge edges[kMostEdges];
};

struct WallField {
  const FeatureView &f;
  const BrickCandidates &c;
  float slack;     // as for signs
  bool looks_out;  // points may lie outside all balls
};

constexpr int kGroup = 64;  // points whose probes are found together

// The rule of nearest_probe(), for the points from begin to end, which are at most a group. There is room for a
// pack more.
template <int kRoom>
void find_probes(const WallField &field, ProbedPoints<kRoom> &points, int begin, int end) {
  const FeatureView &f = field.f;
  const BrickCandidates &c = field.c;
  const float depth = f.parameters.depth;
  alignas(32) float number[kWideLanes], open_x[kGroup + kWideLanes], open_y[kGroup + kWideLanes],
      open_z[kGroup + kWideLanes];
  int32_t open_number[kGroup + kWideLanes];
  int open = 0;
  for (int k = end; k < end + ((begin - end) & (kWideLanes - 1)); ++k) points.set(k, points.point(end - 1));
  for (int g = begin; g < end; g += kWideLanes) {
    if (c.arc_count > kManyArcs) look_for_stop();
    const Vec3<WidePack> p = load_points(points.x + g, points.y + g, points.z + g);
    uint32_t lanes = first_wide_lanes(static_cast<uint32_t>(end - g));
    const PackBox box = box_around(p);
    Vec3<WidePack> center = p;
    WidePack distance(kFarAway);
    if (field.looks_out) {
      const WideMask outside = are_outside_balls(c, box, p, f.parameters.least_depth(), field.slack);
      distance = select(outside, WidePack(0.f), distance);
      lanes &= ~lane_bits(outside);
    }
    const int near = choose_balls(c.exposed, c.exposed_count, box, field.slack, c.near_list);
    const Deepest deepest = deepest_ball(c.exposed, c.near_list, near, p, -field.slack);
    for_exposed_projections(f, c, p, deepest, lanes, [&](const Sphere &atom_ball, uint32_t, uint32_t exposed) {
      lanes &= ~exposed;
      const WideMask here = wide_mask(exposed);
      const Vec3<WidePack> atom(atom_ball.center);
      const Vec3<WidePack> on =
          atom + (p - atom) * (WidePack(atom_ball.radius) / offset_length(atom_ball, deepest.depth));
      center = {select(here, on.x, center.x), select(here, on.y, center.y), select(here, on.z, center.z)};
      distance = select(here, deepest.depth, distance);
    });
    store_pack(points.center_x + g, center.x);
    store_pack(points.center_y + g, center.y);
    store_pack(points.center_z + g, center.z);
    store_pack(points.distance + g, distance);
    store_lanes(open_x + open, lanes, p.x);
    store_lanes(open_y + open, lanes, p.y);
    store_lanes(open_z + open, lanes, p.z);
    open += store_wide_numbers(open_number + open, lanes, g);
  }
  for (int k = open; k < open + (-open & (kWideLanes - 1)); ++k)
    open_x[k] = open_x[open - 1], open_y[k] = open_y[open - 1], open_z[k] = open_z[open - 1];
  for (int g = 0; g < open; g += kWideLanes) {
    const Vec3<WidePack> p = load_points(open_x + g, open_y + g, open_z + g);
    const PackBox box = box_around(p);
    const int arcs = choose_balls(c.arcs, c.arc_count, box, depth, c.arc_list);
    if (arcs == 0) continue;
    WidePack nearest(kFarAway), place(0.f), k_pack(0.f);
    for (int k = 0; k < arcs; ++k) {
      const WidePack d2 = arc_distance2(f.arcs[c.arc_index[c.arc_list[k]]], p);
      const WideMask nearer = d2 < nearest;
      nearest = select(nearer, d2, nearest);
      place = select(nearer, k_pack, place);
      k_pack = k_pack + WidePack(1.f);
    }
    store_pack(number, place);
    const PackedArc nearest_arcs =
        load_arcs([&](int l) { return f.arcs + c.arc_index[c.arc_list[static_cast<int>(number[l])]]; });
    const Vec3<WidePack> on = boundary_on_arcs(nearest_arcs, p).position;
    alignas(32) float x[kWideLanes], y[kWideLanes], z[kWideLanes], distance[kWideLanes];
    store_pack(x, on.x);
    store_pack(y, on.y);
    store_pack(z, on.z);
    store_pack(distance, square_root(maximum(nearest, WidePack(0.f))));
    for (int l = 0; l < kWideLanes && g + l < open; ++l) {
      const int k = open_number[g + l];
      points.center_x[k] = x[l], points.center_y[k] = y[l], points.center_z[k] = z[l];
      points.distance[k] = distance[l];
    }
  }
}
template <int kRoom>
void find_all_probes(const WallField &field, ProbedPoints<kRoom> &points, int begin, int end) {
  for (; begin < end; begin += kGroup) find_probes(field, points, begin, begin + kGroup < end ? begin + kGroup : end);
}

// Walks the edges, and marks an end of those that are walls.
void walk_edges(const WallField &field, const BrickSet &bricks, uint32_t brick, int count, WallWork &w,
                uint64_t *marks) {
  const SurfaceParameters &p = field.f.parameters;
  for (int look = 0; count > 0 && look < kMostWallLooks; ++look) {
    for (int q = 0; q < count; ++q) {
      const Walk &walk = w.walks[q];
      w.walked.set(q, w.ends.point(walk.edge.first) + wall_direction(walk.edge.step) * walk.state.next(look));
    }
    find_all_probes(field, w.walked, 0, count);
    int left = 0;
    for (int q = 0; q < count; ++q) {
      Walk walk = w.walks[q];
      const NearestProbe probe = w.walked.probe(q);
      if (probe.distance > p.depth) {
        const bool first = marks_first_end(w.ends.probe(walk.edge.first), w.ends.probe(walk.edge.second));
        const glm::ivec3 at = point_of(walk.edge.place);
        mark_wall(bricks, brick, first ? at : at + wall_step(walk.edge.step), marks);
        continue;
      }
      walk_through(p, probe, w.walked.point(q), walk.edge.step, walk.state.next(look), &walk.state);
      if (!walk.state.is_open()) w.walks[left++] = walk;
    }
    count = left;
  }
}

// Which of the points around them the probes of the points from 0 to count cover, by what no walk would contradict.
void find_covered(const SurfaceParameters &p, int count, WallWork *w) {
  const float clear = p.depth - kWallStep;
  for (int g = 0; g < count; g += kWideLanes) {
    const Vec3<WidePack> from_probe = load_points(w->ends.x + g, w->ends.y + g, w->ends.z + g) -
                                      load_points(w->ends.center_x + g, w->ends.center_y + g, w->ends.center_z + g);
    const WideMask solid = load_wide(w->ends.distance + g) > WidePack(p.depth);
    const WidePack radius2 = select(solid, WidePack(-kFarAway), WidePack(clear * clear));
    look_around(p.spacing, from_probe, radius2, [&](int step, const WidePack &along, const WidePack &left) {
      w->covered.set(w->covered.by_step[step], g, along < left);
      w->covered.set(w->covered.by_step[kWallSteps + step], g, -along < left);
    });
    w->covered.set(w->covered.solid, g, solid);
  }
  w->covered.end(count);
}

}  // namespace

BrickNeeds mark_brick_walls(const FeatureView &f, const BrickSet &bricks, uint32_t brick, const uint64_t *signs,
                            const BrickScratch &scratch, uint64_t *marks) {
  BrickEdges edges;
  if (!edges.find_candidates(bricks, signs, brick)) return {0, 0};

  const SurfaceParameters &p = f.parameters;
  const Lattice &lattice = bricks.lattice;
  const float h = lattice.spacing;
  const glm::ivec3 first = lattice.first_point(bricks.place(brick));
  const Vec3<float> low = lattice.position(first.x - 1, first.y - 1, first.z - 1);
  const float slack = more_than_rounding(low);
  const BrickCandidates c = gather_candidates(f, low, 9.f * h, 1.1f * slack, p.depth + slack, scratch);
  if (c.needs.atoms || c.needs.arcs) return c.needs;
  const WallField field{f, c, slack, p.depth - kRoot3 * h < 0.01f * p.depth};

  static_assert(sizeof(WallWork) <= BrickScratch::kVertexBytes, "the scratch of a thread has room for it");
  WallWork &w = *new (scratch.vertex_memory) WallWork;
  const BrickStarts starts = edges.choose_starts();
  for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf)
    list_points<LeafSteps>(lattice, first + brick_point(leaf, 0), starts.words[leaf], w.ends.x + starts.first[leaf],
                           w.ends.y + starts.first[leaf], w.ends.z + starts.first[leaf]);
  int count = starts.count;
  find_all_probes(field, w.ends, 0, count);
  find_covered(p, count, &w);
  edges.leave_out_covered(starts, w.covered);

  // Those that are left: by the probes nearest to both ends, and then by those between them.
  std::memset(w.number, 0xff, sizeof w.number);
  for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf) {
    int16_t number = static_cast<int16_t>(starts.first[leaf]);
    for (uint64_t rest = starts.words[leaf]; rest; rest &= rest - 1)
      w.number[place_of(leaf, lowest_bit64(rest))] = number++;
  }
  Vec3<float> along[kBrickEdge + 2];
  for (int k = 0; k < kBrickEdge + 2; ++k)
    along[k] = lattice.position(first.x + k - 1, first.y + k - 1, first.z + k - 1);
  const auto number_at = [&](int place) {
    const int16_t known = w.number[place];
    // Behind the last one, for want of a branch.
    w.ends.set(count, {along[place & 15].x, along[place >> 4 & 15].y, along[place >> 8].z});
    const bool is_new = known < 0;
    const int16_t number = is_new ? static_cast<int16_t>(count) : known;
    count += is_new ? 1 : 0;
    w.number[place] = number;
    return static_cast<uint16_t>(number);
  };
  const StepPlaces steps = make_step_places();
  int edge_count = 0;
  edges.for_each([&](int step, int leaf, int bit) {
    const int place = place_of(leaf, bit);
    w.edges[edge_count++] = {number_at(place), number_at(place + steps.at[step]), static_cast<uint16_t>(place),
                             static_cast<uint16_t>(step)};
  });
  find_all_probes(field, w.ends, starts.count, count);
  int walks = 0;
  for (int q = 0; q < edge_count; ++q) {
    const Edge &edge = w.edges[q];
    const Vec3<float> a = w.ends.point(edge.first), b = w.ends.point(edge.second);
    const NearestProbe probe_a = w.ends.probe(edge.first), probe_b = w.ends.probe(edge.second);
    if (probe_covers(p, probe_a, b) | probe_covers(p, probe_b, a)) continue;
    const Walk walk{edge, begin_wall_walk(p, edge.step, a, probe_a, b, probe_b)};
    if (walk.state.is_open()) continue;
    w.walks[walks++] = walk;
    if (walks < kMostWalks) continue;
    walk_edges(field, bricks, brick, walks, w, marks);
    walks = 0;
  }
  walk_edges(field, bricks, brick, walks, w, marks);
  return {0, 0};
}

}  // namespace QSES_CPU_ISA
}  // namespace quickses
