// SPDX-License-Identifier: MIT
// GPU: where the vertices of a leaf start, and their candidates: the atoms and arcs that can decide about them, a short
// list of numbers per leaf, so that a thread per vertex has little to look at.
#pragma once

#include "surface/cuda/deepest_atoms_cuda.cuh"

namespace quickses {
namespace gpu {

struct VertexCounts {
  uint32_t open;
  Tally<uint32_t> unfinished, on_edges;
};

struct VertexJob {
  FeatureView features;
  BrickSet bricks;
  MeshLayout layout;
  CandidateReach reach;
  CandidateView view;
  VertexStarts starts;
  bool halved;    // the starts are in the mesh already
  MeshView mesh;  // its positions hold the starts, in the centred frame, until they are projected
  BrickRange slice;
  uint32_t first, count;  // vertices of the slice
  uint32_t first_leaf;    // in layout.vertex_leaves: of the slice, whose leaves have a list each
  uint32_t *list_of;      // per vertex: number of its leaf's list, or kRowCandidates and the leaf's slot
  uint32_t *lists;        // list_words each
  uint32_t list_words;
  uint32_t *open;        // vertices that no contact patch has
  uint32_t *unfinished;  // those to be reprojected
  uint32_t *on_edges;    // those to be placed on their edges, of which some were unfinished before
  VertexCounts *counts;  // of these lists
};

// The list of a leaf: word 0 has the number of atoms in its lower and of arcs in its upper half, then they follow. If
// they are too many those of the row are used.
constexpr uint32_t kRowCandidates = 0x80000000u;
// Room for so many is needed where spacings are wide: then there is much to look at for each vertex.
constexpr uint32_t kLongList = 256;

// The vertices there are, of those that there is room for.
__device__ __forceinline__ uint32_t vertex_count(const VertexJob &job) {
  if (!job.layout.has_room()) return 0;
  const uint32_t total = job.layout.totals->vertices, behind = total > job.first ? total - job.first : 0;
  return behind < job.count ? behind : job.count;
}
constexpr int kLeafWarps = 4;
constexpr int kMostLeafVertices = kAxes * 64;

// The candidates of one vertex.
struct ListedCandidates {
  const uint32_t *atoms;
  const uint32_t *arcs;
  int atom_total, arc_total;
  __device__ __forceinline__ int atom_count() const { return atom_total; }
  __device__ __forceinline__ int arc_count() const { return arc_total; }
  __device__ __forceinline__ uint32_t atom(int k) const { return __ldg(atoms + k); }
  __device__ __forceinline__ uint32_t arc(int k) const { return __ldg(arcs + k); }
};

__device__ __forceinline__ ListedCandidates row_candidates(const CandidateView &view, uint32_t slot) {
  const CandidateRow row = view.row_of(slot);
  return {row.atoms, row.arcs, static_cast<int>(row.atom_count), static_cast<int>(row.arc_count)};
}

__device__ __forceinline__ ListedCandidates vertex_candidates(const VertexJob &job, uint32_t k) {
  const uint32_t number = job.list_of[k];
  if (number & kRowCandidates) return row_candidates(job.view, number & ~kRowCandidates);
  const uint32_t *list = job.lists + static_cast<size_t>(number) * job.list_words;
  const uint32_t head = __ldg(list);
  const int atoms = static_cast<int>(head & 0xffff);
  return {list + 1, list + 1 + atoms, atoms, static_cast<int>(head >> 16)};
}

__device__ __forceinline__ Vec3<float> stored_start(const VertexJob &job, uint32_t vertex) {
  return load_vec3(job.mesh.position(vertex));
}
__device__ __forceinline__ void store_start(const VertexJob &job, uint32_t vertex, const Vec3<float> &x) {
  store_vec3(job.mesh.position(vertex), x);
}

// A leaf of the slice that owns vertices, and the edges they are on.
struct VertexLeaf {
  uint32_t brick;  // of the set
  int leaf;
  glm::ivec3 place;   // of the brick
  glm::ivec3 origin;  // first point of the leaf, counted from the brick's
  uint32_t first;     // vertex
  int count;
};

// By teams of so many lanes, one for each of leaves whose numbers follow each other. A team whose number there is not
// has the first one's leaf without vertices; false if no team has any. edges: 64 * axis + bit of the lower point, in
// the order of the vertices.
template <int kLanes>
__device__ __forceinline__ bool open_leaf(const VertexJob &job, size_t number, size_t end, VertexLeaf *out,
                                          uint8_t *edges) {
  if (!job.layout.has_room()) return false;
  const bool is_there = number < end && job.first_leaf + number < job.layout.totals->leaves;
  if (!holds_for_any_team<kLanes>(is_there)) return false;
  const int rank = rank_in_team<kLanes>();
  const size_t known = is_there ? number : number - static_cast<size_t>(lane_id() / kLanes);
  const uint32_t slot = job.layout.vertex_leaves[job.first_leaf + known];
  out->brick = slot / kLeavesPerBrick;
  out->leaf = static_cast<int>(slot % kLeavesPerBrick);
  const size_t k = (static_cast<size_t>(out->brick) * kLeavesPerBrick + static_cast<size_t>(out->leaf)) * kAxes;
  uint64_t masks[kAxes];
#pragma unroll
  for (int axis = 0; axis < kAxes; ++axis)
    masks[axis] = is_there ? job.layout.crossing[k + static_cast<size_t>(axis)] : 0;
  out->count = 0;
#pragma unroll
  for (int axis = 0; axis < kAxes; ++axis) {
#pragma unroll
    for (int first = 0; first < 64; first += kLanes) {
      const int bit = rank + first;
      if (masks[axis] >> bit & 1)
        edges[out->count + popcount64(masks[axis] & ((uint64_t(1) << bit) - 1))] =
            static_cast<uint8_t>(axis << 6 | bit);
    }
    out->count += popcount64(masks[axis]);
  }
  __syncwarp();
  out->first = job.layout.base[out->brick].vertices + job.layout.vertex_rank[k];
  out->place = job.bricks.place(out->brick);
  out->origin = brick_point(out->leaf, 0);
  return true;
}

// Signs of the points of a leaf and one further on every side: row (y + 1) + 6 (z + 1), bit x + 1.
constexpr int kWindowRows = 36;
struct SignWindow {
  uint64_t words[27];  // of the leaf and its neighbours, x fastest
  uint8_t rows[kWindowRows];
};
template <int kLanes>
__device__ __forceinline__ void fill_window(const VertexJob &job, const VertexLeaf &leaf, SignWindow *window) {
  const int rank = rank_in_team<kLanes>();
#pragma unroll
  for (int k = rank; k < 27; k += kLanes) {
    const int x = leaf.origin.x + 4 * (k % 3 - 1), y = leaf.origin.y + 4 * (k / 3 % 3 - 1),
              z = leaf.origin.z + 4 * (k / 9 - 1);
    int b = static_cast<int>(leaf.brick);
    if ((x | y | z) & ~7) {
      b = job.bricks.find(leaf.place + glm::ivec3(x >> 3, y >> 3, z >> 3));
      if (b < 0) b = static_cast<int>(leaf.brick);  // no cell with a sign change reaches there: any sign will do
    }
    window->words[k] =
        job.layout.signs[static_cast<size_t>(b) * kLeavesPerBrick + static_cast<size_t>(leaf_of(x & 7, y & 7, z & 7))];
  }
  __syncwarp();
  for (int r = rank; r < kWindowRows; r += kLanes) {
    const int y = r % 6 - 1, z = r / 6 - 1, row = leaf_bit(0, y & 3, z & 3);
    const uint64_t *const words = window->words + 3 * ((y >> 2) + 1) + 9 * ((z >> 2) + 1);
    window->rows[r] =
        static_cast<uint8_t>((words[0] >> (row + 3) & 1) | (words[1] >> row & 15) << 1 | (words[2] >> row & 1) << 5);
  }
  __syncwarp();
}

// By a block: starts and candidates of the leaves that own vertices from the first on, so many lanes for each.
template <int kLanes>
__device__ __forceinline__ void prepare_vertices_of(const VertexJob &job, size_t first, size_t last) {
  constexpr int kTeams = kLeafWarps * kWarp / kLanes;
  __shared__ uint8_t edge_memory[kTeams][kMostLeafVertices];
  __shared__ SignWindow window_memory[kTeams];
  const int team = static_cast<int>(threadIdx.x) / kLanes, rank = rank_in_team<kLanes>();
  const unsigned lanes = lanes_of_team<kLanes>();
  const size_t number = first + static_cast<uint32_t>(team);
  const uint8_t *const edges = edge_memory[team];
  VertexLeaf leaf;
  if (!open_leaf<kLanes>(job, number, last, &leaf, edge_memory[team])) return;
  const Lattice &lattice = job.bricks.lattice;
  const bool ring = job.starts.relax && !job.halved && !job.starts.moved;
  if (ring) fill_window<kLanes>(job, leaf, &window_memory[team]);

  Vec3<float> low(kFarAway, kFarAway, kFarAway), high(-kFarAway, -kFarAway, -kFarAway);
  const uint64_t word =
      job.layout.signs[static_cast<size_t>(leaf.brick) * kLeavesPerBrick + static_cast<size_t>(leaf.leaf)];
  const glm::ivec3 origin = lattice.first_point(leaf.place) + leaf.origin;
  for (int k = rank; k < leaf.count; k += kLanes) {
    const uint32_t vertex = leaf.first + static_cast<uint32_t>(k);
    Vec3<float> x(0.f, 0.f, 0.f);
    if (job.starts.moved) {
      x = Vec3<float>(job.starts.moved[vertex]);
    } else if (job.halved) {
      x = stored_start(job, vertex);
    } else {
      const int axis = edges[k] >> 6, bit = edges[k] & 63, px = bit & 3, py = bit >> 2 & 3, pz = bit >> 4;
      Vec3<float> move(0.f, 0.f, 0.f);
      if (ring) {
        const uint8_t *const row = window_memory[team].rows + (py + 1) + 6 * (pz + 1);
        ring_displacement(edge_ring_of_rows(row, 6, px + 1, axis, job.starts.ring), &move.x, &move.y, &move.z);
      }
      const float along = vertex_start(word >> bit & 1);
      move.x += axis == 0 ? along : 0.f;
      move.y += axis == 1 ? along : 0.f;
      move.z += axis == 2 ? along : 0.f;
      x = lattice.position(origin.x + px, origin.y + py, origin.z + pz) + move * lattice.spacing;
    }
    store_start(job, vertex, x);
    low = {fminf(low.x, x.x), fminf(low.y, x.y), fminf(low.z, x.z)};
    high = {fmaxf(high.x, x.x), fmaxf(high.y, x.y), fmaxf(high.z, x.z)};
  }
  __syncwarp();
  low = {-warp_maximum<kLanes>(-low.x), -warp_maximum<kLanes>(-low.y), -warp_maximum<kLanes>(-low.z)};
  high = {warp_maximum<kLanes>(high.x), warp_maximum<kLanes>(high.y), warp_maximum<kLanes>(high.z)};
  const Vec3<float> center = (low + high) * 0.5f, half = (high - low) * 0.5f;

  const FeatureView &f = job.features;
  const uint32_t slot = job.view.slot_of(leaf.brick, leaf.leaf);
  ListedCandidates all = row_candidates(job.view, slot);
  if (leaf.count == 0) all.atom_total = all.arc_total = 0;
  // The numbers of some arcs are asked for ahead, of the first ones before the atoms are looked at.
  const auto arc_number = [&](int k0) { return k0 + rank < all.arc_total ? all.arc(k0 + rank) : 0; };
  constexpr int kAhead = kLanes == kWarp ? 4 : 2;
  uint32_t ahead[kAhead];
#pragma unroll
  for (int c = 0; c < kAhead; ++c) ahead[c] = arc_number(c * kLanes);
  const int room = static_cast<int>(job.list_words);
  uint32_t *const list = job.lists + number * job.list_words;
  int listed = 1;  // word 0 is for the numbers
  const auto put = [&](bool chosen, uint32_t item) {
    const int at = append_place(chosen, &listed, lanes);
    if (chosen && at < room) list[at] = item;
  };
  // What can be deepest at a start, or at its projection.
  const float move = kStartReach * job.reach.spacing;
  choose_deepest_atoms<kLanes>(
      f, static_cast<uint32_t>(all.atom_total), [&](uint32_t k) { return all.atom(static_cast<int>(k)); }, center,
      {half.x + move, half.y + move, half.z + move}, kNoDepth, job.reach.slack,
      [&](bool chosen, const Sphere &, uint32_t atom) { put(chosen, atom); });
  const int atoms = listed - 1;
  const float radius = square_root(length_squared(half)), limit = job.reach.start_reach;
  for (int k0 = 0; holds_for_any_team<kLanes>(k0 < all.arc_total); k0 += kAhead * kLanes) {
    uint32_t arc[kAhead];
    bool keep[kAhead];
#pragma unroll
    for (int c = 0; c < kAhead; ++c) {
      arc[c] = ahead[c];
      keep[c] = k0 + c * kLanes + rank < all.arc_total;
      if (!keep[c]) continue;
      const Sphere ball = load(f.arc_bounds.items + arc[c]);
      const float near = ball.radius + limit;
      const Vec3<float> d(fmaxf(0.f, absolute(ball.center.x - center.x) - half.x),
                          fmaxf(0.f, absolute(ball.center.y - center.y) - half.y),
                          fmaxf(0.f, absolute(ball.center.z - center.z) - half.z));
      keep[c] = length_squared(d) <= near * near;
    }
#pragma unroll
    for (int c = 0; c < kAhead; ++c) ahead[c] = arc_number(k0 + (kAhead + c) * kLanes);
#pragma unroll
    for (int c = 0; c < kAhead; ++c) {
      if (keep[c]) keep[c] = arc_distance2(load(f.arcs + arc[c]), center) <= (limit + radius) * (limit + radius);
      put(keep[c], arc[c]);
    }
  }
  if (leaf.count == 0) return;
  const bool fits = listed <= room;
  if (fits && rank == 0) list[0] = static_cast<uint32_t>(atoms) | static_cast<uint32_t>(listed - 1 - atoms) << 16;
  for (int k = rank; k < leaf.count; k += kLanes)
    job.list_of[leaf.first - job.first + static_cast<uint32_t>(k)] =
        fits ? static_cast<uint32_t>(number) : kRowCandidates | slot;
}

// Half a warp for each leaf, since most have no more than 20 vertices.
constexpr int kHalfWarp = kWarp / 2;
static __global__ __launch_bounds__(kLeafWarps *kWarp,
                                    blocks_at_once(kLeafWarps *kWarp,
                                                   10)) void prepare_vertices_kernel(QueuedItems queued,
                                                                                     VertexJob job) {
  const LaunchItems leaves = queued.in_turn();
  constexpr size_t kLeaves = kLeafWarps * kWarp / kHalfWarp;
  prepare_vertices_of<kHalfWarp>(job, leaves.first + blockIdx.x * kLeaves, leaves.last);
}

}  // namespace gpu
}  // namespace quickses
