// SPDX-License-Identifier: MIT
// The ladder of memory plans where the GPU has little to give, since others have taken it; and what the GPU's stages
// learn.
#include "surface/surface_fixture.h"

#include "surface/cuda/cuda_backend.cuh"
#include "surface/engine.h"
#include "surface/stages/atoms.h"

#include <gtest/gtest.h>

#include <cstring>
#include <map>

using namespace surface_fixture;

namespace {

bool has_device() { return quickses::describe_cuda_device(0).available; }
#define REQUIRE_DEVICE() \
  if (!has_device()) GTEST_SKIP() << "no CUDA device"

// Takes memory of the device until no more than so much is free.
class OtherProcess {
 public:
  explicit OtherProcess(uint64_t left) {
    size_t free = 0, total = 0;
    for (uint64_t piece = uint64_t(1) << 36; piece >= uint64_t(1) << 21;) {
      quickses::check_cuda(cudaMemGetInfo(&free, &total), "cudaMemGetInfo");
      void *memory = nullptr;
      if (free < left + piece || cudaMalloc(&memory, piece) != cudaSuccess) {
        cudaGetLastError();
        piece /= 2;
        continue;
      }
      taken_.push_back(memory);
    }
  }
  ~OtherProcess() {
    for (void *memory : taken_) cudaFree(memory);
  }

 private:
  std::vector<void *> taken_;
};

Atoms block_of_crambins(int edge) {
  const Atoms one = crambin();
  Atoms all;
  for (int k = 0; k < edge * edge * edge; ++k) {
    const Atoms copy = shifted(one, 30.0 * (k % edge), 28.0 * (k / edge % edge), 36.0 * (k / edge / edge));
    for (size_t i = 0; i < copy.size(); ++i) {
      const auto c = copy.center(i);
      all.add(c[0], c[1], c[2], static_cast<double>(copy.radii[i]));
    }
  }
  return all;
}

void expect_same(const qses_mesh &mesh, const Surface &expected, const std::string &what) {
  ASSERT_EQ(mesh.vertex_count, expected.vertex_count()) << what;
  EXPECT_EQ(std::memcmp(mesh.positions, expected.mesh.positions.data(), 12 * size_t(mesh.vertex_count)), 0) << what;
  EXPECT_EQ(std::memcmp(mesh.indices, expected.mesh.indices.data(), 12 * size_t(mesh.triangle_count)), 0) << what;
}

// Without a budget: whatever the others leave, the surface is made, also in every later frame; and as fast as before
// when they are gone.
TEST(GpuMemoryLadder, MakesDoWithWhatOthersLeave) {
  REQUIRE_DEVICE();
  const Atoms atoms = block_of_crambins(8);  // 167,424 atoms; some 0.7 GiB at 0.5 Å
  Surface expected;
  uint64_t whole = 0, slices_of_last = 0;  // also where there is enough, a large mesh is made in parts once it is known
  {
    const Context context(0, 0, QSES_BACKEND_CUDA);
    expected = compute(context, atoms, settings(0.5));
    whole = report_of(context).work_bytes_peak;
    compute_view(context, settings(0.5));
    slices_of_last = report_of(context).slice_count;
  }
  int sliced = 0;
  for (const uint64_t percent : {130, 110, 100, 90, 70, 50, 40, 30}) {
    const std::string what = std::to_string(percent) + " % of " + std::to_string(whole) + " bytes";
    const Context context(0, 0, QSES_BACKEND_CUDA);
    set_atoms(context, atoms);
    {
      const OtherProcess others(whole / 100 * percent + (uint64_t(64) << 20));
      for (int frame = 0; frame < 3; ++frame) {
        qses_mesh mesh;
        qses_mesh_init(&mesh);
        const qses_settings s = settings(0.5);
        ASSERT_EQ(qses_compute(context, &s, &mesh), QSES_OK) << what << ": " << qses_last_error();
        expect_same(mesh, expected, what);
        if (frame > 0) {
          EXPECT_EQ(report_of(context).attempts, 1u) << what;
        }
        if (frame == 0 && report_of(context).slice_count > 1) ++sliced;
      }
    }
    // They are gone: all at once again, soon.
    for (int frame = 0; frame < 3; ++frame) compute_view(context, settings(0.5));
    EXPECT_EQ(report_of(context).slice_count, slices_of_last) << what;
    EXPECT_EQ(report_of(context).attempts, 1u) << what;
  }
  EXPECT_GT(sliced, 0) << "there was always enough: nothing was tested";
}

// Levels that would be made beside each other have memory of their own; where there is none, they come one by one.
TEST(GpuMemoryLadder, MakesTheLevelsOfALadderWithWhatOthersLeave) {
  REQUIRE_DEVICE();
  const double usual = quickses::short_ladder;
  quickses::short_ladder = 1e9;
  const Atoms atoms = block_of_crambins(2);
  const qses_settings s = settings(0.5);
  bool asked_for_more = false;
  const Surface expected = compute(Context(0, 0, QSES_BACKEND_CUDA), atoms, s);
  for (const uint64_t left : {0, 1, 2, 4, 8, 16, 32}) {
    const std::string what = std::to_string(left) + " MiB";
    const Context context(0, 0, QSES_BACKEND_CUDA);
    set_atoms(context, atoms);
    const auto expect_ladder = [&] {
      expect_ok(qses_begin(context, &s));
      expect_ok(qses_wait(context, -1, nullptr));
      qses_mesh mesh;
      qses_mesh_init(&mesh);
      ASSERT_EQ(qses_collect(context, &mesh), QSES_OK) << what;
      qses_progress progress;
      qses_progress_init(&progress);
      expect_ok(qses_poll(context, &progress));
      EXPECT_EQ(progress.state, QSES_JOB_FINISHED) << what << ": " << progress.message;
      expect_same(mesh, expected, what);
    };
    for (int frame = 0; frame < 2; ++frame) expect_ladder();
    {
      const OtherProcess others(left << 20);
      const uint64_t requests = quickses::cuda_memory_requests().device;
      for (int frame = 0; frame < 3; ++frame) expect_ladder();
      asked_for_more |= quickses::cuda_memory_requests().device > requests;
    }
    for (int frame = 0; frame < 3; ++frame) expect_ladder();
  }
  quickses::short_ladder = usual;
  EXPECT_TRUE(asked_for_more) << "there was always enough: nothing was tested";
}

// Counts launches by name.
class LaunchCounter : public quickses::CudaExecutor {
 public:
  using CudaExecutor::CudaExecutor;
  std::map<std::string, int> launches;
  template <class... Arguments>
  void launch(const char *name, const Arguments &...arguments) {
    ++launches[name];
    CudaExecutor::launch(name, arguments...);
  }
};

// Atoms with more neighbours than a warp's rows hold, and a circle with more intervals than the lanes that find them:
// the stage begins anew for the first frame only, and no frame after it goes on with too little.
TEST(GpuRooms, AreLearntOnce) {
  REQUIRE_DEVICE();
  using namespace quickses;
  LaunchCounter executor(0);
  const DeviceGuard guard(0);
  CudaRooms rooms;
  std::vector<Sphere> spheres;
  for (int x = 0; x < 7; ++x)
    for (int y = 0; y < 7; ++y)
      for (int z = 0; z < 7; ++z) spheres.push_back({glm::vec3(0.9f * x, 0.91f * y, 0.89f * z), 2.9f});
  spheres.push_back({glm::vec3(40.f, 0.f, -1.f), 3.2f});
  spheres.push_back({glm::vec3(40.f, 0.f, 1.f), 3.2f});
  for (int k = 0; k < 20; ++k)
    spheres.push_back({glm::vec3(40.f + 3.f * std::cos(0.31416f * k), 3.f * std::sin(0.31416f * k), 0.f), 0.3f});
  std::vector<size_t> arcs;
  for (int frame = 0; frame < 4; ++frame) {
    executor.arena().reset();
    executor.launches.clear();
    executor.open_counts(1);
    Span<Sphere> atoms = executor.allocate<Sphere>(spheres.size());
    executor.upload(atoms.data, spheres.data(), spheres.size());
    const NeighborGridView grid = build_neighbor_grid(
        executor, atoms, layout_cells(glm::vec3(-1.f, -4.f, -4.f), glm::vec3(45.f, 8.f, 8.f), 3.2f));
    SolventFeatures features;
    const SurfaceParameters parameters{1.4f, 1.4f, 0.5f, 3.2f};
    Backend<CudaExecutor>::find_solvent_features(executor, grid, parameters, kMemoryPlans[0], rooms, &features);
    executor.send_counts();
    executor.wait();
    EXPECT_NO_THROW(executor.verify_counts());
    arcs.push_back(features.arcs.size);
    if (frame == 0) {
      EXPECT_GT(executor.launches["find_caps"], 1) << "nothing had to be learnt";
    } else {
      EXPECT_EQ(executor.launches["find_caps"], 1) << "frame " << frame;
    }
    EXPECT_EQ(features.arcs.size, arcs.front());
  }
}

// Deep in a crowd atoms have no arcs, and are buried. In runs, arcs get room for as many as there may be, and give back
// what is too much; they must stay where they are, whatever blocks the arena has. And the caps are found once more.
TEST(GpuRooms, InRunsArcsStayWhereTheyAreAndBuriedAtomsAreTheSame) {
  REQUIRE_DEVICE();
  using namespace quickses;
  std::vector<Sphere> spheres;
  constexpr int kEdge = 48;
  for (int x = 0; x < kEdge; ++x)
    for (int y = 0; y < kEdge; ++y)
      for (int z = 0; z < kEdge; ++z) spheres.push_back({glm::vec3(1.9f * x, 1.91f * y, 1.89f * z), 3.1f});
  const uint32_t alone = static_cast<uint32_t>(spheres.size());
  spheres.push_back({glm::vec3(1.92f * kEdge + 8.f, 0.f, 0.f), 3.1f});
  const SurfaceParameters parameters{1.4f, 1.4f, 0.5f, 3.1f};
  struct Found {
    std::vector<Arc> arcs;
    std::vector<int32_t> caps;  // of each atom, or kBuriedAtom
  };
  const auto find_with = [&](const MemoryPlan &plan) {
    CudaExecutor executor(0);
    const DeviceGuard guard(0);
    CudaRooms rooms;
    Span<Sphere> atoms = executor.allocate<Sphere>(spheres.size());
    executor.upload(atoms.data, spheres.data(), spheres.size());
    const NeighborGridView grid =
        build_neighbor_grid(executor, atoms, layout_cells(glm::vec3(-1.f), glm::vec3(1.92f * kEdge + 9.f), 3.1f));
    SolventFeatures features;
    Backend<CudaExecutor>::find_solvent_features(executor, grid, parameters, plan, rooms, &features);
    // What comes behind the features may be written over.
    const Span<char> behind = executor.allocate<char>(size_t(1) << 20);
    executor.fill(behind, 0xff);
    Found found{std::vector<Arc>(features.arcs.size), std::vector<int32_t>(spheres.size())};
    executor.fetch_all(found.arcs.data(), features.arcs.data, found.arcs.size());
    std::vector<CapRange> ranges(spheres.size());
    std::vector<uint32_t> order(spheres.size());
    executor.fetch_all(ranges.data(), features.cap_ranges.data, ranges.size());
    executor.fetch_all(order.data(), grid.order, order.size());
    for (size_t k = 0; k < ranges.size(); ++k) found.caps[order[k]] = ranges[k].count;
    return found;
  };
  const Found expected = find_with(kMemoryPlans[0]);
  ASSERT_GT(expected.arcs.size(), 1000u);
  // No probe of 1.4 Å gets in between balls that are so near to each other: those within touch none.
  EXPECT_EQ(expected.caps[alone], 0);
  for (int x = 0; x < kEdge; ++x)
    for (int y = 0; y < kEdge; ++y)
      for (int z = 0; z < kEdge; ++z) {
        const auto is_within = [](int k) { return k > 1 && k < kEdge - 2; };
        const bool is_at_face = x == 0 || y == 0 || z == 0 || x == kEdge - 1 || y == kEdge - 1 || z == kEdge - 1;
        const int32_t caps = expected.caps[static_cast<size_t>((x * kEdge + y) * kEdge + z)];
        if (is_within(x) && is_within(y) && is_within(z)) ASSERT_EQ(caps, kBuriedAtom) << x << " " << y << " " << z;
        if (is_at_face) ASSERT_GT(caps, 0) << x << " " << y << " " << z;
      }
  for (const MemoryPlan &plan : kMemoryPlans) {
    if (!plan.low_memory) continue;
    const Found found = find_with(plan);
    ASSERT_EQ(found.arcs.size(), expected.arcs.size());
    EXPECT_EQ(std::memcmp(found.arcs.data(), expected.arcs.data(), found.arcs.size() * sizeof(Arc)), 0);
    EXPECT_EQ(found.caps, expected.caps);
  }
}

}  // namespace
