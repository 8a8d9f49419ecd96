// SPDX-License-Identifier: MIT
// CPU kernel: the vertices that one brick owns, placed exactly on the surface a pack at a time.
#include "surface/cpu/cpu_arc_projection.h"
#include "surface/cpu/cpu_brick_signs.h"
#include "surface/cpu/cpu_candidates.h"
#include "surface/stages/edge_placement.h"

#include <new>

namespace quickses {
namespace QSES_CPU_ISA {
namespace {

constexpr int kMaxBrickVertices = kBrickPoints * kAxes;
constexpr PointPlaces<CellCases::kRow, CellCases::kLayer> kCellPlaces;

// Vertices of a brick on their way to the surface.
struct Points {
  alignas(32) float x[kMaxBrickVertices + kWideLanes], y[kMaxBrickVertices + kWideLanes],
      z[kMaxBrickVertices + kWideLanes];
};

// The candidates of the brick for the functions that work on single points.
struct AllCandidates {
  const BrickCandidates &c;
  int atom_count() const { return c.atom_count; }
  uint32_t atom(int k) const { return static_cast<uint32_t>(c.atom_index[k]); }
  int arc_count() const { return c.arc_count; }
  uint32_t arc(int k) const { return static_cast<uint32_t>(c.arc_index[k]); }
};

// Those that decide about points near a place: as numbers in the columns.
struct NearCandidates {
  const BrickCandidates *all;
  int atoms, arcs;
  int atom_count() const { return atoms; }
  uint32_t atom(int k) const { return static_cast<uint32_t>(all->atom_index[all->near_list[k]]); }
  int arc_count() const { return arcs; }
  uint32_t arc(int k) const { return static_cast<uint32_t>(all->arc_index[all->arc_list[k]]); }
};
auto near_of(const FeatureView &f, const BrickCandidates &c) {
  return [&](const Vec3<float> &place, float reach) {
    const PackBox box(place, place);
    return NearCandidates{&c, choose_balls(c.atoms, c.atom_count, box, reach, c.near_list),
                          choose_balls(c.arcs, c.arc_count, box, f.parameters.depth + reach, c.arc_list)};
  };
}

// Where the sign changes on their edges.
void start_by_halving(const FeatureView &f, const BrickSet &bricks, const MeshLayout &layout, uint32_t brick, int n,
                      const BrickCandidates &c, Points *p) {
  for (int v = 0; v < n; ++v) {
    const LatticeEdge edge = edge_of_vertex(layout, brick, layout.base[brick].vertices + static_cast<uint32_t>(v));
    const Vec3<float> start =
        find_sign_change(f, near_of(f, c), ends_of_edge(bricks, layout, brick, edge), kStartHalvings);
    p->x[v] = start.x, p->y[v] = start.y, p->z[v] = start.z;
  }
}

// Where the brick's vertices start, in the order of their numbers: on their edges, or relaxed from there. Not inlined:
// the stack of what comes after it shall not hold its arrays.
[[gnu::noinline]] void start_vertices(const BrickSet &bricks, const MeshLayout &layout, uint32_t brick,
                                      const VertexStarts &starts, Points *p) {
  const Lattice &lattice = bricks.lattice;
  const glm::ivec3 first = lattice.first_point(bricks.place(brick));
  const float h = lattice.spacing, along[2] = {vertex_start(false) * h, vertex_start(true) * h};
  CellCases cases;
  {
    SignRows rows;
    read_sign_rows(find_near_words(bricks, layout.signs, brick), &rows);
    read_cell_cases(rows, &cases);
  }
  uint64_t rings[kMaxBrickVertices + kWideLanes];
  int n = 0;
  for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf) {
    const glm::ivec3 corner = brick_point(leaf, 0);
    Vec3<float> places[kLeafEdge];
    for (int k = 0; k < kLeafEdge; ++k)
      places[k] = lattice.position(first.x + corner.x + k, first.y + corner.y + k, first.z + corner.z + k);
    const uint8_t *const leaf_cases = cases.at(corner.x, corner.y, corner.z);
    const uint64_t *const crossing =
        layout.crossing + (static_cast<size_t>(brick) * kLeavesPerBrick + static_cast<size_t>(leaf)) * kAxes;
#pragma GCC unroll 3
    for (int axis = 0; axis < kAxes; ++axis) {
      // To the cells around an edge, from that of its first point: a step along the other two axes, lower axis first.
      constexpr int kCellSteps[kAxes] = {1, CellCases::kRow, CellCases::kLayer};
      const int second_step = kCellSteps[axis == 0 ? 1 : 0], third_step = kCellSteps[axis == 2 ? 1 : 2];
      for (uint64_t w = crossing[axis]; w; w &= w - 1, ++n) {
        const int bit = lowest_bit64(w);
        const uint8_t *const own = leaf_cases + kCellPlaces.of_bit[bit];
        const float move = along[*own & 1];  // by the sign of its first point
        p->x[n] = places[bit & 3].x + (axis == 0 ? move : 0.f);
        p->y[n] = places[bit >> 2 & 3].y + (axis == 1 ? move : 0.f);
        p->z[n] = places[bit >> 4].z + (axis == 2 ? move : 0.f);
        if (starts.relax)
          rings[n] = edge_ring_of_cells(
              [&](int second, int third) { return own[second * second_step + third * third_step]; }, axis, starts.ring);
      }
    }
  }
  if (!starts.relax) return;
  for (int v = n; v < n + kWideLanes; ++v) rings[v] = rings[n - 1];
  for (int g = 0; g < n; g += kWideLanes)
    for (int v = g; v < g + kWideLanes; ++v) {
      float mx, my, mz;
      ring_displacement(rings[v], &mx, &my, &mz);
      p->x[v] += mx * h, p->y[v] += my * h, p->z[v] += mz * h;
    }
}

QSES_FN void fill_up(Points *p, int n) {
  for (int k = n; k < n + kWideLanes; ++k) p->x[k] = p->x[n - 1], p->y[k] = p->y[n - 1], p->z[k] = p->z[n - 1];
}

// One brick's vertices in the making: where each one is now, and what is known of it.
struct Work {
  Points place, normal, second_normal;
  int32_t owner[kMaxBrickVertices + kWideLanes];  // place in the grid
  uint8_t patch[kMaxBrickVertices + kWideLanes];
  bool placed[kMaxBrickVertices + kWideLanes];
  Points open;  // those whose radial projection is not exposed
  int32_t open_number[kMaxBrickVertices + kWideLanes];
  uint8_t rounds[kMaxBrickVertices + kWideLanes];  // of those that are reprojected

  // Whether a vertex lies on the sphere of one probe, after one round.
  bool is_plain(int v) const {
    return rounds[v] == 1 && normal.x[v] == second_normal.x[v] && normal.y[v] == second_normal.y[v] &&
           normal.z[v] == second_normal.z[v];
  }
  SurfacePoint point(int v) const {
    return {{place.x[v], place.y[v], place.z[v]},
            {normal.x[v], normal.y[v], normal.z[v]},
            {second_normal.x[v], second_normal.y[v], second_normal.z[v]},
            static_cast<qses_patch>(patch[v]),
            placed[v]};
  }
  void set_point(int v, const SurfacePoint &s) {
    place.x[v] = s.position.x, place.y[v] = s.position.y, place.z[v] = s.position.z;
    normal.x[v] = s.normal.x, normal.y[v] = s.normal.y, normal.z[v] = s.normal.z;
    second_normal.x[v] = s.second_normal.x, second_normal.y[v] = s.second_normal.y;
    second_normal.z[v] = s.second_normal.z;
    patch[v] = static_cast<uint8_t>(s.patch);
    placed[v] = s.placed;
  }
};
static_assert(sizeof(Work) <= BrickScratch::kVertexBytes, "the scratch of a thread has room for it");

// The rule of starts_outside(), for those of the points in `lanes` that are in no exposed ball: most are in one.
uint32_t starts_outside(const SurfaceParameters &s, const BrickCandidates &c, const PackBox &box,
                        const Vec3<WidePack> &p, const Deepest &of_exposed, uint32_t lanes) {
  const float least = s.least_depth();
  const uint32_t of_none =
      lanes & lane_bits((of_exposed.number < WidePack(0.f)) | (of_exposed.depth <= WidePack(least)));
  if (s.depth == 0.f || of_none == 0) return 0;
  return of_none & lane_bits(are_outside_balls(c, box, p, least, -least));
}

// Vertices on the convex part: projected radially on their deepest atom. The others are packed into w->open, but for
// those that start outside.
int project_contact(const FeatureView &f, const BrickCandidates &c, float spacing, int n, Work *w) {
  const float depth = f.parameters.depth;
  const float reach = kStartReach * spacing - depth;
  fill_up(&w->place, n);
  int open = 0;
  for (int g = 0; g < n; g += kWideLanes) {
    if (c.arc_count > kManyArcs) look_for_stop();
    const Vec3<WidePack> p = load_points(w->place.x + g, w->place.y + g, w->place.z + g);
    const uint32_t used = first_wide_lanes(static_cast<uint32_t>(n - g));
    const PackBox box = box_around(p);
    const auto deepest_within = [&](float distance) {
      const int near = choose_balls(c.exposed, c.exposed_count, box, distance, c.near_list);
      return deepest_ball(c.exposed, c.near_list, near, p, -distance);
    };
    Deepest deepest = deepest_within(reach);
    // What starts beyond its reach, as where a wall's end stands for solid farther away, has no place on an arc if it
    // is before an exposed part.
    if (reach < 0.f && (used & lane_bits(deepest.number < WidePack(0.f))) != 0) deepest = deepest_within(0.f);
    Vec3<WidePack> place = p, normal = p;
    uint32_t done = 0;
    const WidePack way_in = WidePack(depth) - deepest.depth;
    const uint32_t trusted = lane_bits(is_short_move(f.parameters, way_in, way_in * way_in));
    const uint32_t outside = starts_outside(f.parameters, c, box, p, deepest, used), within = used & ~outside;
    for (uint32_t l = outside; l; l &= l - 1) w->placed[g + lowest_bit32(l)] = false;
    for_exposed_projections(f, c, p, deepest, within, [&](const Sphere &atom_ball, uint32_t atom, uint32_t exposed) {
      done |= exposed;
      const WideMask here = wide_mask(exposed);
      const Vec3<WidePack> outward = sphere_normal(atom_ball, p);
      const Vec3<WidePack> on = Vec3<WidePack>(atom_ball.center) + outward * WidePack(atom_ball.radius - depth);
      place = {select(here, on.x, place.x), select(here, on.y, place.y), select(here, on.z, place.z)};
      normal = {select(here, outward.x, normal.x), select(here, outward.y, normal.y),
                select(here, outward.z, normal.z)};
      for (uint32_t l = exposed; l; l &= l - 1) {
        w->owner[g + lowest_bit32(l)] = static_cast<int32_t>(atom);
        w->patch[g + lowest_bit32(l)] = QSES_PATCH_CONTACT;
        w->placed[g + lowest_bit32(l)] = (trusted >> lowest_bit32(l) & 1) != 0;
      }
    });
    const uint32_t left = within & ~done;
    const WideMask mask = wide_mask(done);
    store_pack(w->place.x + g, select(mask, place.x, p.x));
    store_pack(w->place.y + g, select(mask, place.y, p.y));
    store_pack(w->place.z + g, select(mask, place.z, p.z));
    store_pack(w->normal.x + g, normal.x);
    store_pack(w->normal.y + g, normal.y);
    store_pack(w->normal.z + g, normal.z);
    store_pack(w->second_normal.x + g, normal.x);
    store_pack(w->second_normal.y + g, normal.y);
    store_pack(w->second_normal.z + g, normal.z);
    store_lanes(w->open.x + open, left, p.x);
    store_lanes(w->open.y + open, left, p.y);
    store_lanes(w->open.z + open, left, p.z);
    open += store_wide_numbers(w->open_number + open, left, g);
  }
  return open;
}

// Vertices on the saddle and concave parts: projected from the nearest arc, and again while another probe may cover
// them.
void project_reentrant(const FeatureView &f, const BrickCandidates &c, int open, Work *w) {
  const float depth = f.parameters.depth;
  for (int rounds = 0; open > 0; ++rounds) {
    fill_up(&w->open, open);
    int covered = 0;
    for (int g = 0; g < open; g += kWideLanes) {
      if (c.arc_count > kManyArcs) look_for_stop();
      const Vec3<WidePack> p = load_points(w->open.x + g, w->open.y + g, w->open.z + g);
      const PackBox box = box_around(p);
      const float reach = rounds > 0 ? depth + 1e-3f : start_reach(f.parameters);
      const int arcs = choose_balls(c.arcs, c.arc_count, box, reach, c.arc_list);
      WidePack best(kFarAway), second(kFarAway), number(-1.f);
      for (int k = 0; k < arcs; ++k) {
        const WidePack d2 = arc_distance2(f.arcs[c.arc_index[c.arc_list[k]]], p);
        const WideMask nearer = d2 < best;
        second = minimum(second, maximum(d2, best));
        best = select(nearer, d2, best);
        number = select(nearer, WidePack(static_cast<float>(k)), number);
      }
      // What is farther from a point than that is another point's, and in round 0 decides nothing (start_reach()).
      const WidePack reach2(reach * reach);
      number = select(best <= reach2, number, WidePack(-1.f));
      second = select(second <= reach2, second, WidePack(kFarAway));
      alignas(32) float nearest2[kWideLanes], seconds2[kWideLanes], numbers[kWideLanes];
      store_pack(nearest2, best);
      store_pack(seconds2, second);
      store_pack(numbers, number);
      const int used = open - g < kWideLanes ? open - g : kWideLanes;
      const auto arc_of = [&](int l) { return c.arc_index[c.arc_list[static_cast<int>(numbers[l])]]; };
      const auto go_on = [&](int v, const Vec3<float> &x, int after) {
        w->rounds[v] = static_cast<uint8_t>(after);
        w->open_number[covered] = v;
        w->open.x[covered] = x.x, w->open.y[covered] = x.y, w->open.z[covered] = x.z;
        ++covered;
      };
      // What can be done for all lanes at once, and which lanes that is.
      uint32_t together = lane_bits(WidePack(0.f) <= number);
      PackedProjection projected{};
      alignas(32) float point[6][kWideLanes];
      if (together) {
        const PackedArc arcs_of_lanes =
            load_arcs([&](int l) { return f.arcs + (numbers[l] < 0.f ? c.arc_index[c.arc_list[0]] : arc_of(l)); });
        if (rounds == 0) {
          projected = project_on_arcs(f.parameters, arcs_of_lanes, second, p);
          together &= ~projected.lost;
        } else {
          uint32_t plain = 0;
          for (int l = 0; l < used; ++l) plain |= static_cast<uint32_t>(w->is_plain(w->open_number[g + l])) << l;
          projected = keep_on_arcs(f.parameters, arcs_of_lanes, p, plain);
          together &= projected.placed;
        }
        store_pack(point[0], projected.point.position.x);
        store_pack(point[1], projected.point.position.y);
        store_pack(point[2], projected.point.position.z);
        store_pack(point[3], projected.point.normal.x);
        store_pack(point[4], projected.point.normal.y);
        store_pack(point[5], projected.point.normal.z);
      }
      for (int l = 0; l < used; ++l) {
        const int v = w->open_number[g + l];
        w->owner[v] = -1;
        if (together >> l & 1) {
          const Vec3<float> x(point[0][l], point[1][l], point[2][l]), normal(point[3][l], point[4][l], point[5][l]);
          const bool is_placed = (projected.placed >> l & 1) != 0, goes_on = (projected.reprojected >> l & 1) != 0;
          w->set_point(v, {x, normal, normal, projected.at_end >> l & 1 ? QSES_PATCH_REENTRANT : QSES_PATCH_TOROIDAL,
                           is_placed || goes_on});
          if (goes_on) go_on(v, x, projected.from_afar >> l & 1 ? 2 : 1);
          continue;
        }
        const NearestArc nearest{numbers[l] < 0.f ? -1 : arc_of(l), nearest2[l], seconds2[l]};
        const Projection projection =
            rounds == 0
                ? project_on_arc(f, nearest, {w->open.x[g + l], w->open.y[g + l], w->open.z[g + l]})
                : reproject(f, AllCandidates{c}, nearest, {w->point(v), ProjectionState::kReproject, w->rounds[v]});
        w->set_point(v, projection.point);
        w->placed[v] = projection.state != ProjectionState::kOnEdge;
        if (projection.state == ProjectionState::kReproject) go_on(v, projection.point.position, projection.rounds);
      }
    }
    open = covered;
  }
}

// What is left: vertices near no feature, and those that probes on all sides push to and fro.
void place_on_edges(const FeatureView &f, const BrickSet &bricks, const MeshLayout &layout, uint32_t brick,
                    const BrickCandidates &c, int n, Work *w) {
  for (int v = 0; v < n; ++v) {
    if (w->placed[v]) continue;
    const LatticeEdge edge = edge_of_vertex(layout, brick, layout.base[brick].vertices + static_cast<uint32_t>(v));
    const CutEdge ends = ends_of_edge(bricks, layout, brick, edge);
    w->set_point(v, place_on_edge(f, near_of(f, c), ends));
    w->owner[v] = -1;
  }
}

// Owners of the vertices that lie on no single atom.
void find_owners(const FeatureView &f, const BrickCandidates &c, int n, Work *w) {
  int open = 0;
  for (int v = 0; v < n; ++v) {
    w->open.x[open] = w->place.x[v], w->open.y[open] = w->place.y[v], w->open.z[open] = w->place.z[v];
    w->open_number[open] = v;
    open += w->owner[v] < 0 ? 1 : 0;
  }
  if (open == 0) return;
  constexpr float kRounding = 1e-3f;
  fill_up(&w->open, open);
  for (int g = 0; g < open; g += kWideLanes) {
    const Vec3<WidePack> p = load_points(w->open.x + g, w->open.y + g, w->open.z + g);
    const PackBox box = box_around(p);
    const int near = choose_balls(c.atoms, c.atom_count, box, kRounding, c.near_list);
    const Deepest deepest = deepest_ball(c.atoms, c.near_list, near, p, -kRounding);
    alignas(32) float number[kWideLanes];
    store_pack(number, deepest.number);
    for (int l = 0; l < kWideLanes && g + l < open; ++l) {
      const int v = w->open_number[g + l];
      if (number[l] >= 0.f)
        w->owner[v] = c.atom_index[static_cast<int>(number[l])];
      else  // outside of all of them
        w->owner[v] = static_cast<int32_t>(
            nearest_atom(f, AllCandidates{c}, Vec3<float>(w->place.x[v], w->place.y[v], w->place.z[v])));
    }
  }
}

void write_vertices(const FeatureView &f, const Lattice &lattice, const VertexStarts &starts, const MeshView &mesh,
                    uint32_t base, int n, const Work &w) {
  uint32_t unplaced = 0;
  for (int v = 0; v < n; ++v) {
    const SurfacePoint s = w.point(v);
    unplaced += s.placed ? 0 : 1;
    write_vertex(f, lattice, mesh, base + static_cast<uint32_t>(v), static_cast<uint32_t>(w.owner[v]), s);
  }
  if (unplaced > 0) atomic_add(starts.unplaced, unplaced);
}

}  // namespace

BrickNeeds emit_brick_vertices(const FeatureView &f, const BrickSet &bricks, const MeshLayout &layout, uint32_t brick,
                               const VertexStarts &starts, const BrickScratch &scratch, const MeshView &mesh) {
  const uint32_t base = layout.base[brick].vertices;
  const int n = static_cast<int>(layout.base[brick + 1].vertices - layout.base[brick].vertices);
  if (n == 0) return {0, 0};
  const Lattice &lattice = bricks.lattice;
  const float h = lattice.spacing, overhang = kStartOverhang * h;
  const glm::ivec3 first = lattice.first_point(bricks.place(brick));
  const Vec3<float> low = lattice.position(first.x, first.y, first.z) - Vec3<float>(overhang, overhang, overhang);
  const BrickCandidates c =
      gather_candidates(f, low, 7.f * h + 2.f * overhang, kStartReach * h, start_reach(f.parameters), scratch);
  if (c.needs.atoms || c.needs.arcs) return c.needs;
  Work &w = *new (scratch.vertex_memory) Work;
  if (starts.moved) {
    for (int v = 0; v < n; ++v) {
      const glm::vec3 p = starts.moved[base + static_cast<uint32_t>(v)];
      w.place.x[v] = p.x, w.place.y[v] = p.y, w.place.z[v] = p.z;
    }
  } else if (starts_by_halving(f.parameters)) {
    start_by_halving(f, bricks, layout, brick, n, c, &w.place);
  } else {
    start_vertices(bricks, layout, brick, starts, &w.place);
  }
  const int open = project_contact(f, c, h, n, &w);
  project_reentrant(f, c, open, &w);
  place_on_edges(f, bricks, layout, brick, c, n, &w);
  find_owners(f, c, n, &w);
  write_vertices(f, lattice, starts, mesh, base, n, w);
  return {0, 0};
}

}  // namespace QSES_CPU_ISA
}  // namespace quickses
