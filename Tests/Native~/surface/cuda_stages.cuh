// SPDX-License-Identifier: MIT
// For tests: the stages of the exact surface on the GPU, called one by one, with everything they make brought to the
// host. And a brute force that knows nothing of grids, rows or warps.
#pragma once

#include "surface/cuda/cuda_backend.cuh"
#include "surface/methods/exact_surface.h"

#include "parallel/cuda_stage_timer.cuh"
#include "surface/stages/atoms.h"

#include <cmath>
#include <vector>

namespace quickses {
namespace test {

struct Molecule {
  std::vector<Sphere> atoms;  // van der Waals radii
};

struct StageOptions {
  float probe = 1.4f, depth = 1.4f, spacing = 0.5f;
  bool relax = true;
  uint32_t bricks_per_slice = 0;  // 0: all at once
};

// Copies on the host. Spheres are inflated and in the centred frame.
struct StageResult {
  StageOptions options;
  Lattice lattice{};
  std::vector<Sphere> atoms;  // in grid order
  std::vector<uint32_t> order;
  std::vector<CapRange> cap_ranges;
  std::vector<Cap> caps;
  std::vector<Arc> arcs;  // in the order they were found
  std::vector<uint64_t> bricks;
  std::vector<uint64_t> signs;
  std::vector<float> positions, normals;
  std::vector<uint32_t> owners, indices;
  std::vector<uint8_t> patches;
  MeshCounts counts{};
};

// The table on the device.
class DeviceTable {
 public:
  explicit DeviceTable(CudaExecutor &executor) : memory_(DeviceMemory::acquire(sizeof(MarchingCubesTable))) {
    auto *table = static_cast<MarchingCubesTable *>(memory_);
    executor.upload(table, &marching_cubes_table(), 1);
    executor.wait();
    view = {table->triangle_count, table->edges, table->ring};
  }
  ~DeviceTable() { DeviceMemory::release(memory_); }
  DeviceTable(const DeviceTable &) = delete;
  TableView view{};

 private:
  void *memory_;
};

template <class T>
std::vector<T> to_host(CudaExecutor &executor, const T *source, size_t n) {
  std::vector<T> host(n);
  executor.download(host.data(), source, n);
  executor.wait();
  return host;
}

// What the timed part leaves on the device.
struct DeviceStages {
  SurfaceParameters parameters{};
  Lattice lattice{};
  NeighborGridView grid{};
  SolventFeatures found{};
  FeatureView features{};
  BrickSet bricks{};
  Span<uint64_t> signs{};
  MeshLayout layout{};
  MeshCounts counts{};
  MeshView mesh{};
};

// host_atoms: page-locked or not.
inline DeviceStages run_device_stages(CudaExecutor &executor, const DeviceTable &table, CudaStageTimer &timer,
                                      const Sphere *host_atoms, size_t n, const AtomBounds &bounds,
                                      const StageOptions &options) {
  DeviceStages s;
  executor.arena().reset();
  timer.reset();
  s.parameters = {options.probe, options.depth, options.spacing, bounds.radii.largest + options.probe};
  const SurfaceParameters &p = s.parameters;
  timer.begin("neighbor_grid");
  Lattice lattice = center_lattice(bounds, options.spacing);
  const glm::vec3 low = to_glm(lattice.from_caller(&bounds.low.x)), high = to_glm(lattice.from_caller(&bounds.high.x));
  s.lattice = lattice = layout_lattice(lattice, low, high, p.max_radius);
  Span<Sphere> given = executor.allocate<Sphere>(n);
  executor.upload(given.data, host_atoms, n);
  s.grid = build_neighbor_grid(executor, "crowded cell of atoms", n, layout_cells(low, high, p.max_radius), [&] {
    return CenteredAtomAt{given.data, lattice.center_x, lattice.center_y, lattice.center_z, 1.f, p.probe};
  });
  remove_contained_atoms(executor, s.grid, p.max_radius);
  timer.begin("solvent_features");
  using B = Backend<CudaExecutor>;
  CudaRooms rooms;
  B::find_solvent_features(executor, s.grid, p, kMemoryPlans[0], rooms, &s.found);
  timer.begin("arc_grid");
  FeatureView f{};
  f.atoms = s.grid;
  f.cap_ranges = s.found.cap_ranges.data;
  f.caps = s.found.caps.data;
  f.parameters = p;
  f.max_arc_bound = p.max_arc_bound() + 1e-3f;
  const size_t arcs = s.found.arcs.size;
  if (arcs > 0) {
    const glm::vec3 reach(p.max_radius);
    const Span<Arc> sorted = executor.allocate<Arc>(arcs);
    f.arc_bounds = build_neighbor_grid(
        executor, "crowded cell of arcs", arcs, layout_cells(low - reach, high + reach, kArcCellEdge),
        [&] {
          return ArcBoundAt{s.found.arcs.data, nullptr};
        },
        BringArc{s.found.arcs.data, sorted.data});
    f.arcs = sorted.data;
  }
  s.features = f;
  timer.begin("bricks");
  s.bricks = find_bricks(executor, f, lattice);
  timer.begin("exact_ses");
  const uint32_t count = s.bricks.count;
  const uint32_t per_slice = options.bricks_per_slice ? options.bricks_per_slice : count;
  s.signs = executor.allocate<uint64_t>(size_t(count) * kLeavesPerBrick);
  CudaCandidates shared;
  for (uint32_t first = 0; first < count; first += per_slice) {
    const BrickRange slice{first, std::min(count, first + per_slice)};
    CudaCandidates own;
    B::evaluate_signs(executor, {f, s.bricks, slice, rooms, per_slice >= count ? shared : own}, s.signs.data);
  }
  timer.begin("marching_cubes");
  s.counts = lay_out_mesh(executor, s.bricks, s.signs.data, table.view.triangle_count, &s.layout);
  s.mesh = {
      executor.allocate<float>(s.counts.vertices * 3).data,     executor.allocate<float>(s.counts.vertices * 3).data,
      executor.allocate<uint32_t>(s.counts.vertices).data,      executor.allocate<uint8_t>(s.counts.vertices).data,
      executor.allocate<uint32_t>(s.counts.triangles * 3).data, false};
  timer.begin("projection");
  const VertexStarts starts{options.relax, nullptr, table.view.ring, &s.layout.totals->unplaced};
  for (uint32_t first = 0; first < count; first += per_slice) {
    const BrickRange slice{first, std::min(count, first + per_slice)};
    CudaCandidates own;
    B::emit_vertices(executor, {f, s.bricks, slice, rooms, per_slice >= count ? shared : own},
                     {s.layout, slice_sizes(executor, s.bricks, s.layout, slice), starts, s.mesh});
  }
  timer.begin("triangles");
  for (uint32_t first = 0; first < count; first += per_slice)
    B::emit_triangles(executor, s.bricks, s.layout, {first, std::min(count, first + per_slice)}, table.view, s.mesh);
  timer.end();
  return s;
}

inline AtomBounds bounds_of(const Molecule &molecule) {
  AtomBounds b{glm::vec3(1e30f), glm::vec3(-1e30f), {}};
  for (const Sphere &a : molecule.atoms) {
    b.low = glm::min(b.low, a.center);
    b.high = glm::max(b.high, a.center);
    b.radii.largest = std::max(b.radii.largest, a.radius);
  }
  return b;
}

inline StageResult run_stages(CudaExecutor &executor, const Molecule &molecule, const StageOptions &options) {
  const DeviceTable table(executor);
  CudaStageTimer timer(executor);
  const DeviceStages s = run_device_stages(executor, table, timer, molecule.atoms.data(), molecule.atoms.size(),
                                           bounds_of(molecule), options);
  StageResult r;
  r.options = options;
  r.lattice = s.lattice;
  r.atoms = to_host(executor, s.grid.items, s.grid.count);
  r.order = to_host(executor, s.grid.order, s.grid.count);
  r.cap_ranges = to_host(executor, s.found.cap_ranges.data, s.grid.count);
  r.caps = to_host(executor, s.found.caps.data, s.found.caps.size);
  r.arcs = to_host(executor, s.found.arcs.data, s.found.arcs.size);
  r.bricks = to_host(executor, s.bricks.places, s.bricks.count);
  r.signs = to_host(executor, s.signs.data, s.signs.size);
  r.counts = s.counts;
  r.positions = to_host(executor, s.mesh.positions, s.counts.vertices * 3);
  r.normals = to_host(executor, s.mesh.normals, s.counts.vertices * 3);
  r.owners = to_host(executor, s.mesh.owners, s.counts.vertices);
  r.patches = to_host(executor, s.mesh.patches, s.counts.vertices);
  r.indices = to_host(executor, s.mesh.indices, s.counts.triangles * 3);
  return r;
}

// ---- brute force -----------------------------------------------------------------------------------------------

struct Point {
  double x, y, z;
};
inline Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Point operator*(Point a, double s) { return {a.x * s, a.y * s, a.z * s}; }
inline double dot(Point a, Point b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline double length(Point a) { return std::sqrt(dot(a, a)); }
inline Point cross(Point a, Point b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline Point to_point(const glm::vec3 &v) { return {v.x, v.y, v.z}; }

// An exposed stretch of the circle of two atoms, from all pairs and all third atoms, in double.
struct ExactArc {
  Point center, e1, e2;
  double radius, begin, end;  // radians, end > begin
  Point at(double angle) const { return center + (e1 * std::cos(angle) + e2 * std::sin(angle)) * radius; }
};

// The boundary of a union of balls, from all its atoms.
class ExactBoundary {
 public:
  explicit ExactBoundary(const std::vector<Sphere> &spheres) {
    for (size_t i = 0; i < spheres.size(); ++i) {
      bool inside_another = spheres[i].center.x > 0.5f * kFarAway;
      for (size_t j = 0; j < spheres.size() && !inside_another; ++j) {
        const double d = length(to_point(spheres[i].center) - to_point(spheres[j].center));
        inside_another = j != i &&
                         (spheres[j].radius > spheres[i].radius || (spheres[j].radius == spheres[i].radius && j < i)) &&
                         d <= double(spheres[j].radius) - spheres[i].radius + 1e-5;
      }
      if (!inside_another) balls_.push_back({to_point(spheres[i].center), spheres[i].radius});
    }
    find_arcs();
  }

  const std::vector<ExactArc> &arcs() const { return arcs_; }

  // How deep a point is in the ball it is deepest in; negative outside.
  double depth(Point x) const {
    double best = -1e30;
    for (const Ball &b : balls_) best = std::max(best, b.radius - length(x - b.center));
    return best;
  }

  // Distance from a point inside the union to its boundary, up to a limit.
  double distance(Point x, double limit) const {
    double best = limit;
    for (const Ball &b : balls_) {
      const Point d = x - b.center;
      const double l = length(d), to_sphere = std::fabs(b.radius - l);
      if (to_sphere >= best || l == 0) continue;
      if (depth(b.center + d * (b.radius / l)) < 1e-5) best = to_sphere;
    }
    for (const ExactArc &a : arcs_) {
      if (length(x - a.center) > best + a.radius) continue;
      const Point t = x - a.center;
      double angle = std::atan2(dot(t, a.e2), dot(t, a.e1));
      while (angle < a.begin) angle += 2 * kPi;
      if (angle <= a.end) best = std::min(best, length(x - a.at(angle)));
      best = std::min({best, length(x - a.at(a.begin)), length(x - a.at(a.end))});
    }
    return best;
  }

 private:
  static constexpr double kPi = 3.14159265358979323846;
  struct Ball {
    Point center;
    double radius;
  };

  void find_arcs() {
    for (size_t i = 0; i < balls_.size(); ++i)
      for (size_t j = i + 1; j < balls_.size(); ++j) {
        const Point axis = balls_[j].center - balls_[i].center;
        const double d = length(axis), ri = balls_[i].radius, rj = balls_[j].radius;
        if (d >= ri + rj || d <= std::fabs(ri - rj)) continue;
        const Point n = axis * (1 / d);
        const double along = (d * d + ri * ri - rj * rj) / (2 * d), radius2 = ri * ri - along * along;
        if (radius2 <= 1e-12) continue;
        const Point other = std::fabs(n.x) < 0.7 ? Point{1, 0, 0} : Point{0, 1, 0};
        Point e1 = cross(n, other);
        e1 = e1 * (1 / length(e1));
        add_exposed({balls_[i].center + n * along, e1, cross(n, e1), std::sqrt(radius2), 0, 0}, i, j);
      }
  }

  void add_exposed(ExactArc circle, size_t i, size_t j) {
    std::vector<std::pair<double, double>> covered;
    for (size_t k = 0; k < balls_.size(); ++k) {
      if (k == i || k == j) continue;
      // |center + r (cos e1 + sin e2) - c|^2 < R^2  <=>  a cos + b sin > c
      const Point t = balls_[k].center - circle.center;
      const double a = 2 * circle.radius * dot(t, circle.e1), b = 2 * circle.radius * dot(t, circle.e2);
      const double c = dot(t, t) + circle.radius * circle.radius - balls_[k].radius * balls_[k].radius;
      const double l = std::hypot(a, b);
      if (c >= l) continue;
      if (c <= -l) return;
      const double middle = std::atan2(b, a), half = std::acos(c / l);
      double begin = middle - half;
      while (begin < 0) begin += 2 * kPi;
      covered.push_back({begin, begin + 2 * half});
      if (begin + 2 * half > 2 * kPi) covered.push_back({begin - 2 * kPi, begin + 2 * half - 2 * kPi});
    }
    if (covered.empty()) {
      circle.begin = 0;
      circle.end = 2 * kPi;
      arcs_.push_back(circle);
      return;
    }
    std::sort(covered.begin(), covered.end());
    // Gaps from the first covered stretch on, once around.
    const double start = covered.front().first < 0 ? 0 : covered.front().first;
    double reach = covered.front().second;
    for (const auto &stretch : covered) {
      if (stretch.first > reach && stretch.first <= start + 2 * kPi) add_gap(circle, reach, stretch.first);
      reach = std::max(reach, stretch.second);
    }
    if (reach < start + 2 * kPi) add_gap(circle, reach, start + 2 * kPi);
  }

  void add_gap(ExactArc arc, double begin, double end) {
    arc.begin = begin;
    arc.end = end;
    arcs_.push_back(arc);
  }

  std::vector<Ball> balls_;
  std::vector<ExactArc> arcs_;
};

}  // namespace test
}  // namespace quickses
