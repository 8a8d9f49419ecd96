// SPDX-License-Identifier: MIT
// A fault of the GPU ends CUDA for the process. What the header promises then: contexts with CUDA say so again and
// again, their last meshes stay and can be kept, they can be destroyed, and contexts on the CPU live on. Each fault has
// a process of its own.
#include "capi/capi_fixture.h"

#include "parallel/cuda_memory.h"

#include <cuda_runtime.h>

#include <cstdio>
#include <cstdlib>
#include <thread>

namespace {

using namespace capi_fixture;

constexpr const char *kSentence = "the GPU met a fault that CUDA does not recover from before the process ends";

__global__ void write_to(int *address) { *address = 1; }
__global__ void give_up() { __trap(); }

void wrong_address() { write_to<<<1, 1>>>(reinterpret_cast<int *>(16)); }
void trap() { give_up<<<1, 1>>>(); }

// In the process of a death test its assertions are not heard of.
void demand(bool holds, const char *what) {
  if (holds) return;
  std::fprintf(stderr, "not so: %s (%s)\n", what, qses_last_error());
  std::_Exit(1);
}
#define DEMAND(condition) demand(condition, #condition)

bool says_so(qses_status status) {
  return status == QSES_DEVICE_ERROR && std::string(qses_last_error()).find(kSentence) == 0;
}

qses_status create(qses_backend backend, qses_context **context) {
  qses_context_options options;
  qses_context_options_init(&options);
  options.backend = backend;
  return qses_context_create(&options, context);
}

// The context that meets the fault first.
void check_computes(qses_context *context) {
  for (int again = 0; again < 2; ++again) {
    DEMAND(says_so(qses_compute(context, nullptr, nullptr)));
    qses_size_estimate estimate;
    qses_size_estimate_init(&estimate);
    DEMAND(says_so(qses_estimate(context, nullptr, &estimate)));
    const Atoms atoms = cluster(200, 1);  // as many as the context has
    DEMAND(says_so(qses_set_atoms(context, atoms.positions.data(), 0, atoms.radii.data(), atoms.size())));
    DEMAND(says_so(qses_set_positions(context, atoms.positions.data(), 0, atoms.size())));
  }
}

void check_job(qses_context *context) {
  DEMAND(qses_begin(context, nullptr) == QSES_OK);
  DEMAND(qses_wait(context, -1, nullptr) == QSES_OK);
  qses_progress progress;
  qses_progress_init(&progress);
  DEMAND(qses_poll(context, &progress) == QSES_OK);
  DEMAND(progress.state == QSES_JOB_FAILED && progress.status == QSES_DEVICE_ERROR);
  DEMAND(std::string(progress.message).find(kSentence) == 0);
  qses_mesh mesh = empty_mesh();
  DEMAND(qses_collect(context, &mesh) == QSES_NOTHING_NEW);
  DEMAND(qses_cancel(context) == QSES_OK);
}

void check_new_contexts() {
  qses_backend_description description = empty_description();
  DEMAND(qses_backend_info(QSES_BACKEND_CUDA, &description) == QSES_OK);
  DEMAND(!description.available && std::string(description.reason).find(kSentence) == 0);
  qses_context *context = nullptr;
  DEMAND(create(QSES_BACKEND_CUDA, &context) == QSES_BACKEND_UNAVAILABLE && !context);
  DEMAND(create(QSES_BACKEND_AUTO, &context) == QSES_OK);
  qses_backend backend = QSES_BACKEND_AUTO;
  DEMAND(qses_context_info(context, &backend, nullptr) == QSES_OK && backend == QSES_BACKEND_CPU);
  qses_context_destroy(context);
}

[[noreturn]] void meet(void (*cause)()) {
  qses_context *first = nullptr, *second = nullptr, *cpu = nullptr;
  const Atoms atoms = cluster(200, 1);
  for (qses_context **context : {&first, &second, &cpu}) {
    DEMAND(create(context == &cpu ? QSES_BACKEND_CPU : QSES_BACKEND_CUDA, context) == QSES_OK);
    set_atoms(*context, atoms);
    DEMAND(qses_compute(*context, nullptr, nullptr) == QSES_OK);
  }
  const Surface before = copy_surface(first), on_cpu = copy_surface(cpu);
  qses_kept_mesh *kept[2] = {};
  for (qses_kept_mesh *&one : kept) DEMAND(qses_kept_mesh_create(&one) == QSES_OK);
  DEMAND(qses_keep(second, kept[0]) == QSES_OK);

  cause();
  DEMAND(cudaStreamSynchronize(nullptr) != cudaSuccess);

  check_computes(first);
  check_job(second);
  check_computes(second);
  check_new_contexts();
  const Surface after = copy_surface(first);
  DEMAND(after.mesh.positions == before.mesh.positions && after.mesh.indices == before.mesh.indices);
  DEMAND(qses_compute(cpu, nullptr, nullptr) == QSES_OK);
  DEMAND(copy_surface(cpu).mesh.positions == on_cpu.mesh.positions);
  DEMAND(qses_keep(first, kept[1]) == QSES_OK);
  for (qses_context *context : {first, second, cpu}) qses_context_destroy(context);
  for (qses_kept_mesh *one : kept) {
    qses_mesh mesh = empty_mesh();
    DEMAND(qses_kept_mesh_view(one, &mesh) == QSES_OK && mesh.vertex_count == before.vertex_count());
    DEMAND(std::memcmp(mesh.positions, before.mesh.positions.data(), 12 * size_t(mesh.vertex_count)) == 0);
    std::thread([one] { qses_kept_mesh_destroy(one); }).join();
  }
  std::exit(0);
}

// Also without a GPU: from the report of a fault on CUDA is not asked any more.
[[noreturn]] void report_a_fault() {
  const auto refused = [](auto call) {
    try {
      call();
    } catch (const quickses::Error &e) {
      return e.status() == QSES_DEVICE_ERROR && std::string(e.what()).find(kSentence) == 0;
    }
    return false;
  };
  DEMAND(refused([] { quickses::check_cuda(cudaErrorIllegalAddress, "cudaStreamSynchronize"); }));
  DEMAND(refused([] { quickses::check_cuda(cudaErrorMemoryAllocation, "cudaMalloc"); }));  // whatever it says later
  DEMAND(refused([] { const quickses::DeviceGuard guard(0); }));
  check_new_contexts();
  std::exit(0);
}

class DeviceFault : public testing::Test {
 protected:
  // The other process begins anew, without this one's CUDA.
  void SetUp() override { testing::FLAGS_gtest_death_test_style = "threadsafe"; }
};
#define REQUIRE_DEVICE() \
  if (!quickses::describe_cuda_device(0).available) GTEST_SKIP() << "no CUDA device"

TEST_F(DeviceFault, OfAWrongAddress) {
  REQUIRE_DEVICE();
  EXPECT_EXIT(meet(wrong_address), testing::ExitedWithCode(0), "");
}

TEST_F(DeviceFault, OfATrap) {
  REQUIRE_DEVICE();
  EXPECT_EXIT(meet(trap), testing::ExitedWithCode(0), "");
}

TEST_F(DeviceFault, IsRemembered) { EXPECT_EXIT(report_a_fault(), testing::ExitedWithCode(0), ""); }

}  // namespace
