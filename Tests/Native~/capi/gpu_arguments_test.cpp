// SPDX-License-Identifier: MIT
// What quickses_gpu.h refuses, with a sentence that names what is wrong. No graphics API is needed for that.
#include "capi/device_mesh_fixture.h"

#include "quickses/quickses_gpu.h"

using namespace device_mesh_fixture;

namespace {

TEST(GpuArguments, TheVersionIsThatOfTheHeader) { EXPECT_EQ(qses_gpu_abi_version(), uint32_t(QSES_GPU_ABI_VERSION)); }

TEST(GpuArguments, NothingIsRefusedWithAWord) {
  expect_error(qses_gpu_target_create(nullptr), QSES_INVALID_ARGUMENT, {"target", "NULL"});
  expect_error(qses_gpu_target_set_look(nullptr, nullptr), QSES_INVALID_ARGUMENT, {"target", "NULL"});
  expect_error(qses_gpu_target_submit(nullptr, nullptr, nullptr, nullptr), QSES_INVALID_ARGUMENT, {"target", "NULL"});
  expect_error(qses_gpu_target_status(nullptr, nullptr), QSES_INVALID_ARGUMENT, {"target", "NULL"});
  expect_error(qses_gpu_next_event(nullptr), QSES_INVALID_ARGUMENT, {"event", "NULL"});
  qses_gpu_target_destroy(nullptr);
  qses_gpu_look_init(nullptr);
  qses_gpu_buffers_init(nullptr);
  qses_gpu_status_init(nullptr);
}

TEST(GpuArguments, WithoutTargetsThereIsNothingToDo) {
  int32_t event = 5;
  ASSERT_EQ(qses_gpu_next_event(&event), QSES_OK);
  EXPECT_EQ(event, 0);
  ASSERT_NE(qses_gpu_event_function(), nullptr);
  for (const int32_t number : {0, 1, -1}) qses_gpu_event_function()(number);
}

TEST(GpuArguments, GraphicsHaveNames) {
  for (const int32_t number : {-1, 0, 3, 1000}) {
    qses_graphics graphics;
    set_any(&graphics, number);
    expect_error(qses_gpu_check_graphics(graphics), QSES_INVALID_ARGUMENT,
                 {"graphics", std::to_string(number).c_str()});
  }
}

#if !defined(_WIN32)
TEST(GpuArguments, Direct3DIsForWindows) {
  expect_error(qses_gpu_check_graphics(QSES_GRAPHICS_D3D11), QSES_BACKEND_UNAVAILABLE, {});
}
#endif

// What this library and this machine can't do they say, both ways alike.
TEST(GpuArguments, WithoutADeviceThereAreNoGraphics) {
  if (has_device()) GTEST_SKIP() << "there is a CUDA device";
  expect_error(qses_gpu_check_graphics(QSES_GRAPHICS_OPENGL), QSES_BACKEND_UNAVAILABLE, {});
}

#if !defined(QUICKSES_HAS_CUDA)
TEST(GpuArguments, WithoutCudaThereAreNoTargets) {
  char nothing = 0;  // such a library does not look at what they are
  const auto some = [&nothing] { return reinterpret_cast<qses_gpu_target *>(&nothing); };
  qses_gpu_target *target = some();
  expect_error(qses_gpu_target_create(&target), QSES_BACKEND_UNAVAILABLE, {"without CUDA"});
  EXPECT_EQ(target, nullptr);
  qses_gpu_status status;
  qses_gpu_status_init(&status);
  expect_error(qses_gpu_target_status(some(), &status), QSES_BACKEND_UNAVAILABLE, {"without CUDA"});
  // What is wrong is named all the same.
  const Kept kept;
  qses_gpu_buffers buffers;
  qses_gpu_buffers_init(&buffers);
  const auto submit = [&](const qses_kept_mesh *mesh, const qses_gpu_buffers *given) {
    return qses_gpu_target_submit(some(), mesh, given, nullptr);
  };
  expect_error(submit(nullptr, &buffers), QSES_INVALID_ARGUMENT, {"kept", "NULL"});
  expect_error(submit(kept, nullptr), QSES_INVALID_ARGUMENT, {"buffers", "NULL"});
  expect_error(submit(kept, &buffers), QSES_BACKEND_UNAVAILABLE, {"without CUDA"});
  set_any(&buffers.graphics, 3);
  expect_error(submit(kept, &buffers), QSES_INVALID_ARGUMENT, {"buffers.graphics", "3"});
  expect_error(qses_gpu_target_status(some(), nullptr), QSES_INVALID_ARGUMENT, {"status", "NULL"});
}
#endif

class GpuTarget : public testing::Test {
 protected:
  void SetUp() override {
    REQUIRE_CUDA_DEVICE();
    expect_ok(qses_gpu_target_create(&target_));
    context_ = std::make_unique<CudaContext>();
    set_atoms(*context_, atoms_);
    kept_ = std::make_unique<Kept>();
    keep_on_device(*context_, interleaved(), *kept_);
    // Not looked at before an event.
    qses_gpu_buffers_init(&buffers_);
    buffers_.vertices = 1;
    buffers_.indices = 2;
    buffers_.vertex_capacity = kept_->view().vertex_count;
    buffers_.index_capacity = 3 * uint64_t(kept_->view().triangle_count);
  }
  void TearDown() override { qses_gpu_target_destroy(target_); }

  void expect_refused(qses_status status, std::initializer_list<const char *> words) {
    int32_t event = 99;
    expect_error(qses_gpu_target_submit(target_, *kept_, &buffers_, &event), status, words);
    EXPECT_EQ(event, 99);
    expect_nothing_waits();
  }
  void expect_nothing_waits() {
    const qses_gpu_status s = status();
    EXPECT_EQ(s.waiting, 0u);
    EXPECT_EQ(s.submitted, 0);
    EXPECT_EQ(s.status, QSES_OK);
  }
  qses_gpu_status status() const {
    qses_gpu_status status;
    qses_gpu_status_init(&status);
    expect_ok(qses_gpu_target_status(target_, &status));
    return status;
  }

  const Atoms atoms_ = cluster(60, 1);
  qses_gpu_target *target_ = nullptr;
  std::unique_ptr<CudaContext> context_;
  std::unique_ptr<Kept> kept_;
  qses_gpu_buffers buffers_{};
};

TEST_F(GpuTarget, StartsEmpty) {
  const qses_gpu_status s = status();
  EXPECT_EQ(s.struct_size, sizeof s);
  EXPECT_EQ(s.status, QSES_OK);
  EXPECT_STREQ(s.message, "");
  EXPECT_EQ(s.submitted, 0);
  EXPECT_EQ(s.done, 0);
  EXPECT_EQ(s.waiting, 0u);
  EXPECT_FALSE(s.stopped);
  EXPECT_EQ(s.registrations, 0u);
}

TEST_F(GpuTarget, NamesWhatIsMissing) {
  expect_error(qses_gpu_target_submit(target_, nullptr, &buffers_, nullptr), QSES_INVALID_ARGUMENT, {"kept", "NULL"});
  expect_error(qses_gpu_target_submit(target_, *kept_, nullptr, nullptr), QSES_INVALID_ARGUMENT, {"buffers", "NULL"});
  expect_error(qses_gpu_target_submit(nullptr, *kept_, &buffers_, nullptr), QSES_INVALID_ARGUMENT, {"target", "NULL"});
  expect_error(qses_gpu_target_status(target_, nullptr), QSES_INVALID_ARGUMENT, {"status", "NULL"});
  expect_nothing_waits();
}

TEST_F(GpuTarget, RefusesStructuresThatWereNotPrepared) {
  for (const uint32_t size : {0u, 4u, 30u, 5000u}) {
    buffers_.struct_size = size;
    expect_refused(QSES_INVALID_ARGUMENT, {"qses_gpu_buffers", "struct_size", std::to_string(size).c_str()});
    qses_gpu_look look;
    qses_gpu_look_init(&look);
    look.struct_size = size;
    expect_error(qses_gpu_target_set_look(target_, &look), QSES_INVALID_ARGUMENT, {"qses_gpu_look", "struct_size"});
    qses_gpu_status status;
    qses_gpu_status_init(&status);
    status.struct_size = size;
    expect_error(qses_gpu_target_status(target_, &status), QSES_INVALID_ARGUMENT, {"qses_gpu_status", "struct_size"});
  }
}

TEST_F(GpuTarget, TakesStructuresOfOtherReleases) {
  struct {
    qses_gpu_buffers known;
    uint64_t more;
  } longer = {buffers_, 0};
  longer.known.struct_size = sizeof longer;
  EXPECT_EQ(qses_gpu_target_submit(target_, *kept_, &longer.known, nullptr), QSES_OK) << qses_last_error();
  longer.more = 1;
  expect_error(qses_gpu_target_submit(target_, *kept_, &longer.known, nullptr), QSES_INVALID_ARGUMENT,
               {"qses_gpu_buffers"});
  qses_gpu_status shorter;
  qses_gpu_status_init(&shorter);
  shorter.struct_size = 16;
  shorter.waiting = 12345;
  ASSERT_EQ(qses_gpu_target_status(target_, &shorter), QSES_OK);
  EXPECT_GT(shorter.submitted, 0);
  EXPECT_EQ(shorter.waiting, 12345u);
}

TEST_F(GpuTarget, RefusesBuffers) {
  const qses_gpu_buffers good = buffers_;
  buffers_.vertices = 0;
  expect_refused(QSES_INVALID_ARGUMENT, {"buffers.vertices", "0"});
  buffers_ = good;
  buffers_.indices = 0;
  expect_refused(QSES_INVALID_ARGUMENT, {"buffers.indices", "0"});
  buffers_ = good;
  --buffers_.vertex_capacity;
  expect_refused(QSES_INVALID_ARGUMENT, {"buffers.vertex_capacity", std::to_string(buffers_.vertex_capacity).c_str(),
                                         std::to_string(good.vertex_capacity).c_str()});
  buffers_ = good;
  --buffers_.index_capacity;
  expect_refused(QSES_INVALID_ARGUMENT, {"buffers.index_capacity", std::to_string(buffers_.index_capacity).c_str(),
                                         std::to_string(good.index_capacity).c_str()});
  for (const int32_t number : {-1, 0, 3}) {
    buffers_ = good;
    set_any(&buffers_.graphics, number);
    expect_refused(QSES_INVALID_ARGUMENT, {"buffers.graphics", std::to_string(number).c_str()});
  }
#if !defined(_WIN32)
  buffers_ = good;
  buffers_.graphics = QSES_GRAPHICS_D3D11;
  expect_refused(QSES_BACKEND_UNAVAILABLE, {});
#endif
}

TEST_F(GpuTarget, RefusesMeshesThatAreNotThere) {
  qses_kept_mesh_clear(*kept_);
  expect_refused(QSES_NO_RESULT, {"kept"});
  compute_view(*context_, interleaved());
  expect_ok(qses_keep(*context_, *kept_));
  expect_refused(QSES_NO_RESULT, {"device", "settings.delivery"});
  const Context on_cpu(1, 0, QSES_BACKEND_CPU);
  set_atoms(on_cpu, atoms_);
  compute_view(on_cpu, interleaved());
  expect_ok(qses_keep(on_cpu, *kept_));
  expect_refused(QSES_NO_RESULT, {"device"});
}

TEST_F(GpuTarget, RefusesTheLayoutSeparate) {
  qses_settings s = interleaved();
  s.vertex_layout = QSES_VERTICES_SEPARATE;
  keep_on_device(*context_, s, *kept_);
  expect_refused(QSES_INVALID_ARGUMENT, {"vertex_layout", "INTERLEAVED"});
}

TEST_F(GpuTarget, RefusesALookOfOtherAtoms) {
  const std::vector<uint8_t> rgba(4 * (atoms_.size() + 1), 7);
  qses_gpu_look look;
  qses_gpu_look_init(&look);
  look.colors = rgba.data();
  look.atom_count = atoms_.size() + 1;
  expect_ok(qses_gpu_target_set_look(target_, &look));
  expect_refused(QSES_INVALID_ARGUMENT,
                 {"look", std::to_string(atoms_.size() + 1).c_str(), std::to_string(atoms_.size()).c_str()});
  // An error leaves the look as it is; none, or another one, ends it.
  look.struct_size = 0;
  EXPECT_EQ(qses_gpu_target_set_look(target_, &look), QSES_INVALID_ARGUMENT);
  expect_refused(QSES_INVALID_ARGUMENT, {"look"});
  expect_ok(qses_gpu_target_set_look(target_, nullptr));
  EXPECT_EQ(qses_gpu_target_submit(target_, *kept_, &buffers_, nullptr), QSES_OK) << qses_last_error();
}

TEST_F(GpuTarget, TakesMeshesThatAreOnBothSides) {
  qses_settings s = interleaved();
  s.delivery = QSES_DELIVERY_BOTH;
  compute_view(*context_, s);
  expect_ok(qses_keep(*context_, *kept_));
  int32_t event = 0;
  EXPECT_EQ(qses_gpu_target_submit(target_, *kept_, &buffers_, &event), QSES_OK) << qses_last_error();
  EXPECT_GT(event, 0);
  EXPECT_EQ(status().waiting, 1u);
  EXPECT_EQ(status().submitted, event);
}

}  // namespace
