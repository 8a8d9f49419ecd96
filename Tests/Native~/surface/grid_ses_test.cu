// SPDX-License-Identifier: MIT
// The voxel method, relaxation and measures on the GPU against the same functions in plain loops.
#include "parallel/cuda_executor.cuh"
#include "parallel/serial_executor.h"
#include "surface/grid_fixture.h"
#include "surface/stages/components.h"

#include <gtest/gtest.h>

namespace {

using namespace grid_fixture;
using SerialRun = GridRunOn<SerialExecutor>;

bool no_device() {
  int count = 0;
  return cudaGetDeviceCount(&count) != cudaSuccess || count == 0;
}

template <class T>
Span<T> to_device(CudaExecutor &executor, const T *host, size_t n) {
  const Span<T> span = executor.allocate<T>(n);
  executor.upload(span.data, host, n);
  return span;
}
template <class T>
std::vector<T> to_host(CudaExecutor &executor, const T *device, size_t n) {
  std::vector<T> host(n);
  executor.download(host.data(), device, n);
  executor.wait();
  return host;
}

void expect_near(const std::vector<float> &a, const std::vector<float> &b, float tolerance, const char *what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  for (size_t k = 0; k < a.size(); ++k) ASSERT_NEAR(a[k], b[k], tolerance) << what << " " << k;
}

void compare(const std::vector<Atom> &atoms, float probe, float spacing) {
  SCOPED_TRACE(testing::Message() << atoms.size() << " atoms, probe " << probe << ", spacing " << spacing);
  SerialRun serial(atoms, probe, spacing);
  mesh_checks::Mesh expected = serial.mesh();
  const BrickSet &host_bricks = serial.field.bricks;
  const size_t words = size_t(host_bricks.count) * kLeavesPerBrick;

  const DeviceGuard guard(0);
  CudaExecutor executor(0);
  const Span<Sphere> spheres = to_device(executor, serial.spheres.data(), serial.spheres.size());
  const NeighborGridView grid = build_neighbor_grid(executor, spheres, serial.field.atoms.cells);
  const BrickSet bricks = collect_ball_bricks(executor, grid, serial.parameters.max_radius, serial.lattice);
  ASSERT_EQ(bricks.count, host_bricks.count);
  EXPECT_EQ(to_host(executor, bricks.places, bricks.count),
            std::vector<uint64_t>(host_bricks.places, host_bricks.places + host_bricks.count));

  // The GPU may round a multiplication and an addition at once: of points as near to a ball as that, none may differ
  // here by luck of the numbers chosen, but not many.
  GridField field = classify_grid_points(executor, grid, serial.parameters, bricks);
  const std::vector<uint64_t> outside = to_host(executor, field.outside, words);
  int different = 0;
  for (size_t w = 0; w < words; ++w) different += popcount64(outside[w] ^ serial.field.outside[w]);
  EXPECT_LE(different, 2);

  // From here on both start from the same classes, and integers must agree.
  field.outside = to_device(executor, serial.field.outside, words).data;
  const Span<uint64_t> signs = executor.allocate<uint64_t>(words);
  for (const BrickRange &range : serial.slices(100)) evaluate_grid_signs(executor, field, range, signs.data);
  EXPECT_EQ(to_host(executor, signs.data, words), serial.signs);
  constexpr size_t kCorners = 9 * 9 * 9;
  const Span<int32_t> distances = executor.allocate<int32_t>(kCorners * bricks.count);
  std::vector<int32_t> host_distances(kCorners * bricks.count);
  executor.for_each_brick<DistanceScratch<9>>(bricks.count, StoreDistances<9>{field, 0, distances.data});
  serial.executor.for_each_brick<DistanceScratch<9>>(bricks.count,
                                                     StoreDistances<9>{serial.field, 0, host_distances.data()});
  EXPECT_EQ(to_host(executor, distances.data, host_distances.size()), host_distances);

  MeshLayout layout{};
  const Span<uint8_t> table = to_device(executor, marching_cubes_table().triangle_count, kCellCases);
  const MeshCounts counts = lay_out_mesh(executor, bricks, signs.data, table.data, &layout);
  ASSERT_EQ(counts.vertices, serial.counts.vertices);
  ASSERT_EQ(counts.triangles, serial.counts.triangles);
  const size_t values = 3 * counts.vertices;
  const MeshView view = {executor.allocate<float>(values).data,
                         executor.allocate<float>(values).data,
                         executor.allocate<uint32_t>(counts.vertices).data,
                         nullptr,
                         to_device(executor, expected.indices.data(), expected.indices.size()).data,
                         false};
  for (const BrickRange &range : serial.slices(100)) emit_grid_vertices(executor, field, layout, range, view);
  find_grid_owners(executor, field, view, counts.vertices);
  expect_near(to_host(executor, view.positions, values), expected.positions, 2e-6f * spacing + 1e-5f, "position");
  const std::vector<uint32_t> owners = to_host(executor, view.owners, counts.vertices);
  size_t other_owners = 0;
  for (size_t v = 0; v < owners.size(); ++v) {
    ASSERT_LT(owners[v], atoms.size());
    other_owners += owners[v] != expected.owners[v] ? 1 : 0;
  }
  EXPECT_LE(other_owners, owners.size() / 1000);

  executor.upload(view.positions, expected.positions.data(), values);
  executor.upload(view.normals, expected.normals.data(), values);
  smooth_laplacian(executor, view, counts, spacing, 3, ring_sums(executor, counts));
  smooth_laplacian(serial.executor, serial.view(expected), serial.counts, spacing, 3,
                   ring_sums(serial.executor, serial.counts));
  expect_near(to_host(executor, view.positions, values), expected.positions, 1e-5f, "smoothed position");
  executor.upload(view.positions, expected.positions.data(), values);
  compute_normals(executor, view, counts, spacing, ring_sums(executor, counts));
  compute_normals(serial.executor, serial.view(expected), serial.counts, spacing,
                  ring_sums(serial.executor, serial.counts));
  expect_near(to_host(executor, view.normals, values), expected.normals, 1e-3f, "normal");
  executor.upload(view.normals, expected.normals.data(), values);

  const Span<glm::vec3> starts = executor.allocate<glm::vec3>(counts.vertices);
  std::vector<glm::vec3> host_starts(counts.vertices);
  tangential_starts(executor, bricks, layout, view, counts, ring_sums(executor, counts), starts.data);
  tangential_starts(serial.executor, host_bricks, serial.layout, serial.view(expected), serial.counts,
                    ring_sums(serial.executor, serial.counts), host_starts.data());
  const std::vector<glm::vec3> device_starts = to_host(executor, starts.data, counts.vertices);
  for (size_t v = 0; v < host_starts.size(); ++v)
    for (int d = 0; d < 3; ++d) ASSERT_NEAR(device_starts[v][d], host_starts[v][d], 1e-5f) << v;

  const double middle[3] = {};
  const Measures found = sum_mesh(executor, measured_sums(view, counts, true, middle, nullptr), nullptr);
  const Measures plain =
      sum_mesh(serial.executor, measured_sums(serial.view(expected), serial.counts, true, middle, nullptr), nullptr);
  EXPECT_NEAR(found.sums.area, plain.sums.area, 1e-9 * plain.sums.area);
  EXPECT_NEAR(found.sums.volume, plain.sums.volume, 1e-9 * plain.sums.volume);
  EXPECT_NEAR(found.sums.flat_area, plain.sums.flat_area, 1e-9 * plain.sums.area);
  EXPECT_NEAR(found.sums.flat_volume, plain.sums.flat_volume, 1e-9 * plain.sums.volume);
  for (int d = 0; d < 3; ++d) {
    EXPECT_EQ(found.bounds.min[d], plain.bounds.min[d]);
    EXPECT_EQ(found.bounds.max[d], plain.bounds.max[d]);
  }

  ComponentMemory memory, serial_memory;
  const MeshComponents all = find_components(executor, view, counts, spacing, true, memory);
  const Span<const qses_component> pieces = all.list;
  ASSERT_EQ(pieces.size, mesh_checks::piece_count(expected));
  double area = 0, volume = 0;
  for (const qses_component &piece : pieces) {
    area += piece.area;
    volume += piece.volume;
    EXPECT_EQ(piece.is_cavity != 0, piece.volume < 0);
  }
  EXPECT_NEAR(area, plain.sums.area, 1e-12 * plain.sums.area);
  EXPECT_NEAR(volume, plain.sums.volume, 1e-12 * plain.sums.volume);
  // Of the same triangles the CPU finds the same numbers, to the last bit.
  const MeshComponents all_on_host =
      find_components(serial.executor, serial.view(expected), serial.counts, spacing, true, serial_memory);
  const Span<const qses_component> on_host = all_on_host.list;
  EXPECT_EQ(all.total.sums.area, all_on_host.total.sums.area);
  EXPECT_EQ(all.total.sums.volume, all_on_host.total.sums.volume);
  EXPECT_EQ(all.total.sums.flat_area, all_on_host.total.sums.flat_area);
  EXPECT_EQ(all.total.sums.flat_volume, all_on_host.total.sums.flat_volume);
  for (int d = 0; d < 3; ++d) {
    EXPECT_EQ(all.total.bounds.min[d], found.bounds.min[d]);
    EXPECT_EQ(all.total.bounds.max[d], found.bounds.max[d]);
  }
  ASSERT_EQ(on_host.size, pieces.size);
  for (size_t k = 0; k < pieces.size; ++k) {
    EXPECT_EQ(pieces[k].triangles, on_host[k].triangles);
    EXPECT_EQ(pieces[k].area, on_host[k].area);
    EXPECT_EQ(pieces[k].volume, on_host[k].volume);
  }
}

TEST(GridSesCuda, AgreesWithPlainLoops) {
  if (no_device()) GTEST_SKIP() << "skipped: no CUDA device";
  compare({{0.31, -0.17, 0.23, 1.7}}, 1.4f, 0.35f);
  const std::vector<Atom> cluster = random_cluster(200, 21);
  for (float spacing : {0.7f, 0.35f, 0.5f, 1.0f}) compare(cluster, 1.4f, spacing);
  compare(random_cluster(20, 22), 4.1f, 0.5f);
  compare(random_cluster(5, 23), 10.f, 0.5f);
}

TEST(GridSesCuda, AStrayAtomMakesTheBricksSparse) {
  if (no_device()) GTEST_SKIP() << "skipped: no CUDA device";
  std::vector<Atom> atoms = random_cluster(20, 24);
  atoms.push_back({20000.0, -20000.0, 15000.0, 1.7});
  compare(atoms, 1.4f, 0.5f);
}

}  // namespace
