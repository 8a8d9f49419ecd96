// SPDX-License-Identifier: MIT
// Runs the voxel method step by step, for tests of its stages.
#pragma once

#include "surface/mesh_checks.h"

#include "surface/methods/grid_owners.h"
#include "surface/methods/grid_ses.h"
#include "surface/stages/measure.h"
#include "surface/stages/relaxation.h"

#include <array>
#include <cmath>
#include <fstream>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace grid_fixture {

using namespace quickses;

// Room for the steps that sum around vertices.
template <class Executor>
Span<RingSum> ring_sums(Executor &executor, const MeshCounts &counts) {
  return executor.template allocate<RingSum>(counts.vertices);
}

// Stores the squared distances of the first N x N x N points of bricks first, first + 1, ...
template <int N>
struct StoreDistances {
  GridField field;
  uint32_t first;
  int32_t *distances;
  template <class Team>
  QSES_HOST_DEVICE void operator()(const Team &team, DistanceScratch<N> &scratch, size_t i) const {
    find_distances<N>(field, first + static_cast<uint32_t>(i), team, scratch, kNoneInReach);
    constexpr int kPoints = N * N * N;
    for (int k = team.rank(); k < kPoints; k += team.size())
      distances[i * kPoints + static_cast<size_t>(k)] = scratch.nearest[k];
    team.sync();
  }
};

// The same by rows, of the 9 x 9 x 9 corners.
struct StoreRowDistances {
  GridField field;
  int32_t *distances;
  template <class Team>
  QSES_HOST_DEVICE void operator()(const Team &team, NearRows &scratch, size_t i) const {
    constexpr int kEdge = kBrickEdge + 1, kPoints = kEdge * kEdge * kEdge;
    const NearCube cube{kEdge, field.parameters.reach};
    find_near_rows(field, static_cast<uint32_t>(i), cube, team, scratch);
    for (int k = team.rank(); k < kPoints; k += team.size())
      distances[i * kPoints + static_cast<size_t>(k)] =
          nearest_outside(scratch, cube, glm::ivec3(k % kEdge, k / kEdge % kEdge, k / kEdge / kEdge), kNoneInReach - 1);
    team.sync();
  }
};

struct Atom {
  double x, y, z, r;
};

// Atoms that overlap their neighbours about as much as those of a molecule.
inline std::vector<Atom> random_cluster(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<Atom> atoms = {{0.1, -0.2, 0.3, 1.7}};
  const double radii[] = {1.2, 1.52, 1.55, 1.7, 1.8};
  while (static_cast<int>(atoms.size()) < count) {
    const Atom &from = atoms[random() % atoms.size()];
    double d[3] = {unit(random), unit(random), unit(random)};
    const double length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    if (length < 0.1 || length > 1) continue;
    const Atom next = {from.x + 1.5 * d[0] / length, from.y + 1.5 * d[1] / length, from.z + 1.5 * d[2] / length,
                       radii[random() % 5]};
    bool free = true;
    for (const Atom &a : atoms) free = free && std::hypot(a.x - next.x, a.y - next.y, a.z - next.z) > 1.3;
    if (free) atoms.push_back(next);
  }
  return atoms;
}

inline std::vector<Atom> read_pdb_atoms(const std::string &path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("can't open " + path);
  std::vector<Atom> atoms;
  for (std::string line; std::getline(file, line);) {
    if (line.compare(0, 4, "ATOM") != 0) continue;
    const char element = line.at(13);
    const double r = element == 'O' ? 1.52 : element == 'N' ? 1.55 : element == 'C' ? 1.7 : 1.8;
    atoms.push_back({std::stod(line.substr(30, 8)), std::stod(line.substr(38, 8)), std::stod(line.substr(46, 8)), r});
  }
  return atoms;
}

// The executor's memory is host memory.
template <class Executor>
struct GridRunOn {
  Executor executor;
  std::vector<Sphere> spheres;  // centred frame, inflated
  Lattice lattice{};
  GridParameters parameters{};
  GridField field{};
  std::vector<uint64_t> signs;
  MeshLayout layout{};
  MeshCounts counts{};

  // slice: bricks per slice, 0 for all at once.
  GridRunOn(const std::vector<Atom> &atoms, float probe, float spacing, uint32_t slice = 0, unsigned threads = 2)
      : executor(threads) {
    const double brick = static_cast<double>(spacing) * kBrickEdge;
    lattice.spacing = spacing;
    lattice.center_x = std::round(atoms[0].x / brick) * brick;
    lattice.center_y = std::round(atoms[0].y / brick) * brick;
    lattice.center_z = std::round(atoms[0].z / brick) * brick;
    float max_radius = 0;
    glm::vec3 low(1e9f), high(-1e9f);
    for (const Atom &a : atoms) {
      const glm::vec3 c(static_cast<float>(a.x - lattice.center_x), static_cast<float>(a.y - lattice.center_y),
                        static_cast<float>(a.z - lattice.center_z));
      spheres.push_back({c, static_cast<float>(a.r) + probe});
      max_radius = std::max(max_radius, spheres.back().radius);
      low = glm::min(low, c);
      high = glm::max(high, c);
    }
    parameters = make_grid_parameters(probe, spacing, max_radius);
    lattice = layout_lattice(lattice, low, high, max_radius);
    const NeighborGridView grid = build_neighbor_grid(executor, Span<Sphere>{spheres.data(), spheres.size()},
                                                      layout_cells(low, high, max_radius));
    const BrickSet bricks = collect_ball_bricks(executor, grid, parameters.max_radius, lattice);
    field = classify_grid_points(executor, grid, parameters, bricks);
    signs.assign(size_t(bricks.count) * kLeavesPerBrick, ~uint64_t(0));
    for (const BrickRange &range : slices(slice)) evaluate_grid_signs(executor, field, range, signs.data());
    counts = lay_out_mesh(executor, bricks, signs.data(), marching_cubes_table().triangle_count, &layout);
  }

  std::vector<BrickRange> slices(uint32_t slice) const {
    std::vector<BrickRange> ranges;
    const uint32_t n = field.bricks.count, step = slice ? slice : n;
    for (uint32_t first = 0; first < n; first += step) ranges.push_back({first, std::min(n, first + step)});
    return ranges;
  }

  MeshView view(mesh_checks::Mesh &mesh) const {
    return {mesh.positions.data(), mesh.normals.data(), mesh.owners.data(), nullptr, mesh.indices.data(), false};
  }

  mesh_checks::Mesh mesh(uint32_t slice = 0) {
    mesh_checks::Mesh m;
    m.positions.assign(3 * counts.vertices, NAN);
    m.normals.assign(3 * counts.vertices, NAN);
    m.owners.assign(counts.vertices, ~uint32_t(0));
    m.indices.assign(3 * counts.triangles, ~uint32_t(0));
    for (const BrickRange &range : slices(slice)) emit_grid_vertices(executor, field, layout, range, view(m));
    find_grid_owners(executor, field, view(m), counts.vertices);
    emit_triangles(m);
    return m;
  }

  // Plain and slow: every cell asks for the vertices of its edges.
  void emit_triangles(mesh_checks::Mesh &m) const {
    const MarchingCubesTable &table = marching_cubes_table();
    size_t next = 0;
    for (uint32_t b = 0; b < field.bricks.count; ++b)
      for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf) {
        const LeafWords corners = cell_corners(leaf_words(upper_bricks(field.bricks, b), signs.data(), leaf));
        for (int bit = 0; bit < 64; ++bit) {
          const int code = cell_case(corners, bit);
          for (int k = 0; k < 3 * table.triangle_count[code]; ++k)
            m.indices.at(next++) = vertex_of_edge(static_cast<int>(b), leaf, bit, table.edges[code][k]);
        }
      }
    if (next != m.indices.size()) throw std::logic_error("the count of triangles is wrong");
  }

  uint32_t vertex_of_edge(int brick, int leaf, int bit, int edge) const {
    int p[3] = {(leaf & 1) * 4 + (bit & 3) + edge_origin_x(edge),
                (leaf >> 1 & 1) * 4 + (bit >> 2 & 3) + edge_origin_y(edge),
                (leaf >> 2) * 4 + (bit >> 4) + edge_origin_z(edge)};
    glm::ivec3 place = field.bricks.place(brick);
    for (int d = 0; d < 3; ++d)
      if (p[d] == kBrickEdge) {
        p[d] = 0;
        ++place[d];
      }
    const int owner = field.bricks.find(place);
    if (owner < 0) throw std::logic_error("a cell of the surface has a corner in an inactive brick");
    return vertex_number(layout, owner, leaf_of(p[0], p[1], p[2]), edge_axis(edge),
                         leaf_bit(p[0] & 3, p[1] & 3, p[2] & 3));
  }
};

}  // namespace grid_fixture
