// SPDX-License-Identifier: MIT
// From the fourth frame of a trajectory on no memory of the GPU and no page-locked memory is asked for. What the driver
// does inside is its own business and not seen here.
#include "io/trajectory_frames.h"

#include "parallel/cuda_memory.h"
#include "surface/engine.h"

#include <gtest/gtest.h>

using namespace surface_fixture;
using quickses::cuda_memory_requests;

namespace {

template <class Frame>
void expect_no_request(const Frame &frame) {
  if (!quickses::describe_cuda_device(0).available) GTEST_SKIP() << "no CUDA device";
  // What else the machine does has no say in whether levels are made beside each other, each with memory of its own.
  quickses::short_ladder = 1e9;
  const Context context(0, 0, QSES_BACKEND_CUDA);
  const Atoms atoms = crambin();
  set_atoms(context, atoms);
  Trajectory trajectory(atoms);
  const auto before = cuda_memory_requests();
  for (int k = 0; k < 3; ++k) frame(context, trajectory.next());
  const auto warm = cuda_memory_requests();
  EXPECT_GT(warm.device, before.device);  // they are counted
  EXPECT_GT(warm.pinned, before.pinned);
  for (int k = 0; k < 30; ++k) frame(context, trajectory.next());
  const auto after = cuda_memory_requests();
  EXPECT_EQ(after.device, warm.device);
  EXPECT_EQ(after.pinned, warm.pinned);
}

// The work of a first computation takes its memory at once, or in one more piece; and there are the tables.
TEST(CudaAllocations, FewInAFirstComputation) {
  if (!quickses::describe_cuda_device(0).available) GTEST_SKIP() << "no CUDA device";
  const Context context(0, 0, QSES_BACKEND_CUDA);
  set_atoms(context, crambin());
  qses_settings s = settings();
  s.delivery = QSES_DELIVERY_NONE;
  const auto before = cuda_memory_requests();
  expect_ok(qses_compute(context, &s, nullptr));
  EXPECT_LE(cuda_memory_requests().device, before.device + 3);
}

TEST(CudaAllocations, NoneInJobsOverATrajectory) {
  expect_no_request([](qses_context *context, const std::vector<float> &positions) {
    set_positions(context, positions);
    begin_and_collect(context, settings());
  });
}

TEST(CudaAllocations, NoneInComputeOverATrajectory) {
  expect_no_request([](qses_context *context, const std::vector<float> &positions) {
    set_positions(context, positions);
    qses_settings s = settings();
    s.relaxation_steps = 3;
    s.patch_types = 1;
    expect_ok(qses_compute(context, &s, nullptr));
  });
}

TEST(CudaAllocations, NoneWithComponents) {
  expect_no_request([](qses_context *context, const std::vector<float> &positions) {
    set_positions(context, positions);
    qses_settings s = settings();
    s.components = 1;
    begin_and_collect(context, s);
  });
}

TEST(CudaAllocations, NoneInFramesThatAreKept) {
  for (const qses_delivery delivery : {QSES_DELIVERY_HOST, QSES_DELIVERY_DEVICE, QSES_DELIVERY_BOTH}) {
    SCOPED_TRACE(delivery);
    qses_kept_mesh *kept[2] = {};
    for (qses_kept_mesh *&one : kept) expect_ok(qses_kept_mesh_create(&one));
    int frame = 0;
    expect_no_request([&](qses_context *context, const std::vector<float> &positions) {
      set_positions(context, positions);
      qses_settings s = settings();
      s.pickable = 1;
      s.delivery = delivery;
      begin_and_collect(context, s);
      expect_ok(qses_keep(context, kept[frame++ % 2]));
    });
    for (qses_kept_mesh *one : kept) qses_kept_mesh_destroy(one);
  }
}

TEST(CudaAllocations, NoneWithTheGridMethod) {
  expect_no_request([](qses_context *context, const std::vector<float> &positions) {
    set_positions(context, positions);
    qses_settings s = settings();
    s.method = QSES_METHOD_GRID;
    begin_and_collect(context, s);
  });
}

}  // namespace
