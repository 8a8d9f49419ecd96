// SPDX-License-Identifier: MIT
// CPU kernel: the vertices that one brick owns, placed exactly on the surface eight at a time.
#include "surface/cpu/cpu_candidates.h"
#include "surface/stages/edge_placement.h"

#include <new>

namespace quickses {
namespace QSES_CPU_ISA {
namespace {

constexpr int kMaxBrickVertices = kBrickPoints * kAxes;

// Vertices of a brick on their way to the surface.
struct Points {
  alignas(32) float x[kMaxBrickVertices + kPackSize], y[kMaxBrickVertices + kPackSize],
      z[kMaxBrickVertices + kPackSize];
};

// Signs of the lattice points of a brick and one more on every side: bit x + 1 of row_of(y, z).
struct SignRows {
  static constexpr int kSide = kBrickEdge + 2;
  uint16_t row[kSide * kSide];
  QSES_FN uint16_t *row_of(int y, int z) { return row + (z + 1) * kSide + (y + 1); }
};

SignRows read_sign_rows(const BrickSet &bricks, const uint64_t *signs, uint32_t brick) {
  const glm::ivec3 place = bricks.lattice.brick_at(bricks.linear[brick]);
  const uint64_t *near[27];
  for (int k = 0; k < 27; ++k) {
    const int found =
        k == 13 ? static_cast<int>(brick) : bricks.find(place + glm::ivec3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1));
    near[k] = found < 0 ? nullptr : signs + static_cast<size_t>(found) * kLeavesPerBrick;
  }
  const auto row_of = [](const uint64_t *words, int y, int z) {
    const int leaf = (y >> 2) * 2 + (z >> 2) * 4, shift = 4 * (y & 3) + 16 * (z & 3);
    return static_cast<uint32_t>((words[leaf] >> shift & 15) | (words[leaf + 1] >> shift & 15) << 4);
  };
  SignRows rows;
  for (int z = -1; z <= kBrickEdge; ++z)
    for (int y = -1; y <= kBrickEdge; ++y) {
      const int side = (z < 0 ? 0 : z < kBrickEdge ? 9 : 18) + (y < 0 ? 0 : y < kBrickEdge ? 3 : 6);
      // Where a brick is not active, no cell at it changes sign: its points are like the nearest ones here.
      const int cy = y < 0 ? 0 : y < kBrickEdge ? y : 7, cz = z < 0 ? 0 : z < kBrickEdge ? z : 7;
      const uint32_t own = near[side + 1] ? row_of(near[side + 1], y & 7, z & 7) : row_of(near[13], cy, cz);
      const uint32_t left = near[side] ? row_of(near[side], y & 7, z & 7) >> 7 : row_of(near[13], cy, cz) & 1;
      const uint32_t right = near[side + 2] ? row_of(near[side + 2], y & 7, z & 7) & 1 : row_of(near[13], cy, cz) >> 7;
      *rows.row_of(y, z) = static_cast<uint16_t>(left | own << 1 | right << 9);
    }
  return rows;
}

// The candidates of the brick for the functions that work on single points.
struct AllCandidates {
  const BrickCandidates &c;
  int atom_count() const { return c.atom_count; }
  uint32_t atom(int k) const { return static_cast<uint32_t>(c.atom_index[k]); }
  int arc_count() const { return c.arc_count; }
  uint32_t arc(int k) const { return static_cast<uint32_t>(c.arc_index[k]); }
};

// Where the brick's vertices start, in the order of their numbers. Returns how many there are.
int start_vertices(const FeatureView &f, const BrickSet &bricks, const MeshLayout &layout, uint32_t brick,
                   const VertexStarts &starts, const BrickCandidates &c, Points *p) {
  const Lattice &lattice = bricks.lattice;
  const glm::ivec3 first = lattice.first_point(lattice.brick_at(bricks.linear[brick]));
  const float h = lattice.spacing;
  const bool halve = starts_by_halving(f.parameters);
  SignRows rows = read_sign_rows(bricks, layout.signs, brick);
  int n = 0;
  for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf)
    for (int axis = 0; axis < kAxes; ++axis)
      for (uint64_t w = layout.crossing[(static_cast<size_t>(brick) * kLeavesPerBrick + static_cast<size_t>(leaf)) * 3 +
                                        static_cast<size_t>(axis)];
           w; w &= w - 1, ++n) {
        const int bit = lowest_bit64(w);
        const glm::ivec3 at = brick_point(leaf, bit);
        const Vec3<float> low = lattice.position(first.x + at.x, first.y + at.y, first.z + at.z);
        const uint16_t *const row = rows.row_of(at.y, at.z);
        Vec3<float> start = low;
        if (halve) {
          start = find_sign_change(f, AllCandidates{c}, ends_of_edge(bricks, layout, brick, {leaf, axis, bit}),
                                   kStartHalvings);
        } else {
          const float along = vertex_start(*row >> (at.x + 1) & 1) * h;
          start = {low.x + (axis == 0 ? along : 0.f), low.y + (axis == 1 ? along : 0.f),
                   low.z + (axis == 2 ? along : 0.f)};
          if (starts.relax) {
            float mx, my, mz;
            ring_displacement(edge_ring_of_rows(row, SignRows::kSide, at.x + 1, axis, starts.ring), &mx, &my, &mz);
            start = start + Vec3<float>(mx, my, mz) * h;
          }
        }
        p->x[n] = start.x, p->y[n] = start.y, p->z[n] = start.z;
      }
  return n;
}

QSES_FN void fill_up(Points *p, int n) {
  for (int k = n; k < n + kPackSize; ++k) p->x[k] = p->x[n - 1], p->y[k] = p->y[n - 1], p->z[k] = p->z[n - 1];
}

// One brick's vertices in the making: where each one is now, and what is known of it.
struct Work {
  Points place, normal, second_normal;
  int32_t owner[kMaxBrickVertices + kPackSize];  // place in the grid
  uint8_t patch[kMaxBrickVertices + kPackSize];
  bool placed[kMaxBrickVertices + kPackSize];
  Points open;  // those whose radial projection is not exposed
  int32_t open_number[kMaxBrickVertices + kPackSize];
  uint8_t rounds[kMaxBrickVertices + kPackSize];  // of those that are reprojected

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

// Vertices on the convex part: projected radially on their deepest atom. The others are packed into w->open.
int project_contact(const FeatureView &f, const BrickCandidates &c, float spacing, int n, Work *w) {
  const float depth = f.parameters.depth;
  fill_up(&w->place, n);
  int open = 0;
  for (int g = 0; g < n; g += kPackSize) {
    if (c.arc_count > kManyArcs) look_for_stop();
    const Vec3<Pack> p = load_points(w->place.x + g, w->place.y + g, w->place.z + g);
    const uint32_t used = n - g < kPackSize ? (1u << (n - g)) - 1 : kAllLanes;
    const PointBall ball = ball_around(p);
    const int near =
        choose_balls(c.exposed, c.exposed_count, ball.center, ball.radius + kStartReach * spacing - depth, c.near_list);
    const Deepest deepest = deepest_ball(c.exposed, c.near_list, near, p, -kFarAway);
    Vec3<Pack> place = p, normal = p;
    uint32_t done = 0;
    const Pack way_in = Pack(depth) - deepest.depth;
    const uint32_t trusted = lane_bits(is_short_move(f.parameters, way_in, way_in * way_in));
    for_exposed_projections(f, c, p, deepest, used, [&](const Sphere &atom_ball, uint32_t atom, uint32_t exposed) {
      done |= exposed;
      const PackMask here = lane_mask(exposed);
      const Vec3<Pack> outward = sphere_normal(atom_ball, p);
      const Vec3<Pack> on = Vec3<Pack>(atom_ball.center) + outward * Pack(atom_ball.radius - depth);
      place = {select(here, on.x, place.x), select(here, on.y, place.y), select(here, on.z, place.z)};
      normal = {select(here, outward.x, normal.x), select(here, outward.y, normal.y),
                select(here, outward.z, normal.z)};
      for (uint32_t l = exposed; l; l &= l - 1) {
        w->owner[g + lowest_bit32(l)] = static_cast<int32_t>(atom);
        w->patch[g + lowest_bit32(l)] = QSES_PATCH_CONTACT;
        w->placed[g + lowest_bit32(l)] = (trusted >> lowest_bit32(l) & 1) != 0;
      }
    });
    const uint32_t left = used & ~done;
    const PackMask mask = lane_mask(done);
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
    open += store_lane_numbers(w->open_number + open, left, g);
  }
  return open;
}

// Vertices on the saddle and concave parts: projected from the nearest arc, and again while another probe may cover
// them.
void project_reentrant(const FeatureView &f, const BrickCandidates &c, float spacing, int open, Work *w) {
  const float depth = f.parameters.depth;
  for (int rounds = 0; open > 0; ++rounds) {
    fill_up(&w->open, open);
    int covered = 0;
    for (int g = 0; g < open; g += kPackSize) {
      if (c.arc_count > kManyArcs) look_for_stop();
      const Vec3<Pack> p = load_points(w->open.x + g, w->open.y + g, w->open.z + g);
      const PointBall ball = ball_around(p);
      const float reach = depth + (rounds > 0 ? 1e-3f : kStartReach * spacing);
      const int arcs = choose_balls(c.arcs, c.arc_count, ball.center, ball.radius + reach, c.arc_list);
      Pack best(kFarAway), second(kFarAway), number(-1.f);
      for (int k = 0; k < arcs; ++k) {
        const Pack d2 = arc_distance2(f.arcs[c.arc_index[c.arc_list[k]]], p);
        const PackMask nearer = d2 < best;
        second = minimum(second, maximum(d2, best));
        best = select(nearer, d2, best);
        number = select(nearer, Pack(static_cast<float>(k)), number);
      }
      alignas(32) float nearest2[kPackSize], seconds2[kPackSize], numbers[kPackSize];
      store_pack(nearest2, best);
      store_pack(seconds2, second);
      store_pack(numbers, number);
      const int used = open - g < kPackSize ? open - g : kPackSize;
      for (int l = 0; l < used; ++l) {
        const int v = w->open_number[g + l], k = static_cast<int>(numbers[l]);
        const NearestArc nearest{k < 0 ? -1 : c.arc_index[c.arc_list[k]], nearest2[l], seconds2[l]};
        const Projection projection =
            rounds == 0
                ? project_on_arc(f, nearest, {w->open.x[g + l], w->open.y[g + l], w->open.z[g + l]})
                : reproject(f, AllCandidates{c}, nearest, {w->point(v), ProjectionState::kReproject, w->rounds[v]});
        w->set_point(v, projection.point);
        w->owner[v] = -1;
        w->placed[v] = projection.state != ProjectionState::kOnEdge;
        if (projection.state != ProjectionState::kReproject) continue;
        w->rounds[v] = static_cast<uint8_t>(projection.rounds);
        const Vec3<float> &x = projection.point.position;
        w->open_number[covered] = v;
        w->open.x[covered] = x.x, w->open.y[covered] = x.y, w->open.z[covered] = x.z;
        ++covered;
      }
    }
    open = covered;
  }
}

// Those of the brick's candidates that decide about one edge.
struct EdgeCandidates {
  const BrickCandidates &c;
  int atoms, arcs;
  int atom_count() const { return atoms; }
  uint32_t atom(int k) const { return static_cast<uint32_t>(c.atom_index[c.near_list[k]]); }
  int arc_count() const { return arcs; }
  uint32_t arc(int k) const { return static_cast<uint32_t>(c.arc_index[c.arc_list[k]]); }
};

// What is left: vertices near no feature, and those that probes on all sides push to and fro.
void place_on_edges(const FeatureView &f, const BrickSet &bricks, const MeshLayout &layout, uint32_t brick,
                    const BrickCandidates &c, int n, Work *w) {
  for (int v = 0; v < n; ++v) {
    if (w->placed[v]) continue;
    const LatticeEdge edge = edge_of_vertex(layout, brick, layout.vertex_base[brick] + static_cast<uint32_t>(v));
    const CutEdge ends = ends_of_edge(bricks, layout, brick, edge);
    const EdgeCandidates near{
        c, choose_balls(c.atoms, c.atom_count, ends.middle(), edge_reach(f.parameters), c.near_list),
        choose_balls(c.arcs, c.arc_count, ends.middle(), edge_arc_reach(f.parameters), c.arc_list)};
    w->set_point(v, place_on_edge(f, near, ends));
    w->owner[v] = -1;
  }
}

// Owners of the vertices that lie on no single atom.
void find_owners(const FeatureView &f, const BrickCandidates &c, int n, Work *w) {
  int open = 0;
  for (int v = 0; v < n; ++v)
    if (w->owner[v] < 0) {
      w->open.x[open] = w->place.x[v], w->open.y[open] = w->place.y[v], w->open.z[open] = w->place.z[v];
      w->open_number[open++] = v;
    }
  if (open == 0) return;
  fill_up(&w->open, open);
  for (int g = 0; g < open; g += kPackSize) {
    const Vec3<Pack> p = load_points(w->open.x + g, w->open.y + g, w->open.z + g);
    const PointBall ball = ball_around(p);
    const int near = choose_balls(c.atoms, c.atom_count, ball.center, ball.radius + 1e-3f, c.near_list);
    const Deepest deepest = deepest_ball(c.atoms, c.near_list, near, p, -kFarAway);
    alignas(32) float number[kPackSize];
    store_pack(number, deepest.number);
    for (int l = 0; l < kPackSize && g + l < open; ++l) {
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
    SurfacePoint s = w.point(v);
    unplaced += s.placed ? 0 : 1;
    const uint32_t owner = static_cast<uint32_t>(w.owner[v]), vertex = base + static_cast<uint32_t>(v);
    const glm::vec3 p = lattice.to_caller(s.position);
    store_vec3(mesh.position(vertex), Vec3<float>(p));
    settle_normals(f, owner, &s);
    store_normals(mesh, vertex, s.normal, s.second_normal);
    mesh.owner(vertex) = f.atoms.order[owner];
    if (mesh.patches) mesh.patch(vertex) = w.patch[v];
  }
  if (unplaced > 0) atomic_add(starts.unplaced, unplaced);
}

}  // namespace

BrickNeeds emit_brick_vertices(const FeatureView &f, const BrickSet &bricks, const MeshLayout &layout, uint32_t brick,
                               const VertexStarts &starts, const BrickScratch &scratch, const MeshView &mesh) {
  const uint32_t base = layout.vertex_base[brick];
  const int n = static_cast<int>(layout.vertex_base[brick + 1] - layout.vertex_base[brick]);
  if (n == 0) return {0, 0};
  const Lattice &lattice = bricks.lattice;
  const float h = lattice.spacing, overhang = kStartOverhang * h;
  const glm::ivec3 first = lattice.first_point(lattice.brick_at(bricks.linear[brick]));
  const Vec3<float> low = lattice.position(first.x, first.y, first.z) - Vec3<float>(overhang, overhang, overhang);
  const BrickCandidates c = gather_candidates(f, low, 7.f * h + 2.f * overhang, kStartReach * h,
                                              f.parameters.depth + kStartReach * h, scratch);
  if (c.needs.atoms || c.needs.arcs) return c.needs;
  Work &w = *new (scratch.vertex_memory) Work;
  if (starts.moved) {
    for (int v = 0; v < n; ++v) {
      const glm::vec3 p = starts.moved[base + static_cast<uint32_t>(v)];
      w.place.x[v] = p.x, w.place.y[v] = p.y, w.place.z[v] = p.z;
    }
  } else {
    start_vertices(f, bricks, layout, brick, starts, c, &w.place);
  }
  const int open = project_contact(f, c, h, n, &w);
  project_reentrant(f, c, h, open, &w);
  place_on_edges(f, bricks, layout, brick, c, n, &w);
  find_owners(f, c, n, &w);
  write_vertices(f, lattice, starts, mesh, base, n, w);
  return {0, 0};
}

}  // namespace QSES_CPU_ISA
}  // namespace quickses
