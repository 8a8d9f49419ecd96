// SPDX-License-Identifier: MIT
// Runs the exact method stage by stage on the CPU, for tests of its stages.
#pragma once

#include "surface/exact_reference.h"

#include "surface/cpu/cpu_backend.h"

#include "parallel/cpu_stage_timer.h"
#include "surface/methods/exact_surface.h"
#include "surface/stages/atoms.h"

namespace exact_fixture {

using namespace quickses;
using exact_reference::Point;

struct ExactRun {
  qses_settings settings;
  CpuKernelExecutor executor;
  CpuStageTimer timer;
  MeshMemory<CpuKernelExecutor> memory;
  ComponentFinder components{1};
  LearntRooms<CpuKernelExecutor> rooms;
  Progress progress;
  SurfaceParameters parameters{};
  Lattice lattice{};
  glm::vec3 low{}, high{};
  NeighborGridView atoms{};
  qses_report report{};
  WorkFacts work{}, *facts = &work;
  MemoryPlan plan = kMemoryPlans[0];

  // Up to the neighbour grid.
  ExactRun(const surface_fixture::Atoms &given, const qses_settings &s, unsigned threads = 2,
           const CpuKernels &kernels = cpu_kernels())
      : settings(s), executor(threads, kernels), timer(executor), memory(executor) {
    AtomBounds bounds{glm::vec3(1e9f), glm::vec3(-1e9f), {}};
    float largest = 0.f;
    Span<Sphere> raw = executor.allocate<Sphere>(given.size());
    for (size_t i = 0; i < given.size(); ++i) {
      const float *p = &given.positions[3 * i];
      raw[i] = {glm::vec3(p[0], p[1], p[2]), given.radii[i]};
      bounds.low = glm::min(bounds.low, raw[i].center);
      bounds.high = glm::max(bounds.high, raw[i].center);
      largest = std::max(largest, raw[i].radius);
    }
    const bool vdw = s.surface == QSES_SURFACE_VDW;
    parameters.probe = vdw ? 0.f : s.probe_radius;
    parameters.depth = s.surface == QSES_SURFACE_SES ? s.probe_radius : 0.f;
    parameters.spacing = s.spacing;
    parameters.max_radius = largest + parameters.probe;
    lattice = center_lattice(bounds, s.spacing);
    low = to_glm(lattice.from_caller(&bounds.low.x));
    high = to_glm(lattice.from_caller(&bounds.high.x));
    lattice = layout_lattice(lattice, low, high, parameters.max_radius);
    atoms = build_neighbor_grid(
        executor, "crowded cell of atoms", given.size(), layout_cells(low, high, parameters.max_radius), [&] {
          return CenteredAtomAt{raw.data, lattice.center_x, lattice.center_y, lattice.center_z, 1.f, parameters.probe};
        });
    remove_contained_atoms(executor, atoms, parameters.max_radius);
  }

  FeatureView features() { return arrange_features(*this, list_features(*this)); }

  std::vector<uint64_t> signs(const FeatureView &f, const BrickSet &bricks) {
    std::vector<uint64_t> words(size_t(bricks.count) * kLeavesPerBrick);
    evaluate_signs(executor, f, bricks, BrickRange{0, bricks.count}, words.data());
    return words;
  }

  // The whole method; with features of one's own, the rest of it.
  mesh_checks::Mesh mesh() { return mesh(features()); }
  mesh_checks::Mesh mesh(const FeatureView &features) {
    const MarchingCubesTable &table = marching_cubes_table();
    const TableView view{table.triangle_count, table.edges, table.ring};
    PreparedFrame frame;
    frame.parameters = parameters;
    frame.lattice = lattice;
    frame.low = low;
    frame.high = high;
    frame.atoms = atoms;
    frame.features = features;
    frame.shape = frame.made_shape = shape_of(settings, false);
    LevelWork<CpuKernelExecutor, CpuStageTimer> level{frame,    executor, timer,    memory, components, rooms,
                                                      progress, view,     settings, plan,   facts,      &report};
    const MeshMemoryView built = build_exact_surface(level);
    mesh_checks::Mesh m;
    m.positions.assign(built.view.positions, built.view.positions + 3 * built.vertices);
    m.normals.assign(built.view.normals, built.view.normals + 3 * built.vertices);
    m.owners.assign(built.view.owners, built.view.owners + built.vertices);
    m.indices.assign(built.view.indices, built.view.indices + 3 * built.triangles);
    report.unplaced_vertices = built.unplaced ? *built.unplaced : 0;
    return m;
  }

  Point to_caller(double x, double y, double z) const {
    return {x + lattice.center_x, y + lattice.center_y, z + lattice.center_z};
  }
};

inline Point point(const glm::vec3 &v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

}  // namespace exact_fixture
