// SPDX-License-Identifier: MIT
// Meshes with vertices on creases whose short edges merge, for tests.
#pragma once

#include "surface/surface_checks.h"

#include "surface/cpu/cpu_backend.h"

#include "parallel/cpu_stage_timer.h"
#include "surface/methods/crease_merges.h"

namespace edge_merge_fixture {

using namespace quickses;
using namespace surface_checks;

constexpr float kSpacing = 0.5f;

struct CreasedSurface {
  mesh_checks::Mesh mesh;
  std::vector<float> second_normals;
  std::vector<uint8_t> on_crease;
};

// What merges need of a run of the method.
struct MergeWork {
  struct Memory {
    template <class T, class Executor>
    Span<T> allocate_where_mesh_is(Executor &executor, const MeshMemoryView &, size_t n) {
      return executor.template allocate<T>(n);
    }
  };
  CpuExecutor executor;
  Memory memory;
  SurfaceParameters parameters{};
  Lattice lattice{};
  explicit MergeWork(unsigned threads) : executor(threads) {
    parameters.probe = parameters.depth = 1.4f;
    parameters.spacing = lattice.spacing = kSpacing;
  }
};

inline mesh_checks::Mesh merged(CreasedSurface from, size_t *merges, unsigned threads = 1) {
  MergeWork work(threads);
  mesh_checks::Mesh &mesh = from.mesh;
  mesh.owners.assign(mesh.vertex_count(), 0);
  std::vector<uint8_t> near(mesh.triangle_count());
  MeshView view;
  view.positions = mesh.positions.data();
  view.normals = mesh.normals.data();
  view.second_normals = from.second_normals.data();
  view.owners = mesh.owners.data();
  view.indices = mesh.indices.data();
  GrowingMesh growing{};
  growing.whole.vertices = mesh.vertex_count();
  growing.whole.triangles = mesh.triangle_count();
  growing.view = {view, nullptr, from.on_crease.data(), near.data()};
  *merges = 0;
  const KeptParts kept = merge_at_creases(work, growing, merges);
  mesh_checks::Mesh out;
  out.positions.resize(3 * (mesh.vertex_count() - *merges));
  out.normals.resize(out.positions.size());
  out.owners.resize(out.vertex_count());
  out.indices.resize(3 * (mesh.triangle_count() - 2 * *merges));
  MeshView to;
  to.positions = out.positions.data();
  to.normals = out.normals.data();
  to.owners = out.owners.data();
  to.indices = out.indices.data();
  keep_parts(work.executor, view, mesh.vertex_count(), mesh.triangle_count(), kept, to);
  return out;
}

// Vertices of a surface moved about, some of them on creases, so that much is folded.
inline CreasedSurface random_folds(unsigned seed, float most) {
  std::mt19937 random(seed);
  std::normal_distribution<float> moves(0.f, most);
  // Not by what the environment says: of the GPU's vertices, other choices hang on the last digit.
  const Surface surface = compute(Context(1, 0, QSES_BACKEND_CPU), cluster(4 + seed, seed), settings(0.5));
  CreasedSurface s{surface.mesh, surface.mesh.normals, std::vector<uint8_t>(surface.vertex_count(), 0)};
  for (size_t v = 0; v < surface.vertex_count(); ++v) {
    s.on_crease[v] = random() % 3 == 0;
    if (s.on_crease[v]) s.second_normals[3 * v] *= -1;
    for (size_t k = 0; k < 3; ++k) s.mesh.positions[3 * v + k] += moves(random);
  }
  return s;
}

}  // namespace edge_merge_fixture
