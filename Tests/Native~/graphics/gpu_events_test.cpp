// SPDX-License-Identifier: MIT
// Events that come late, not at all, or without what they need; and what goes before its event.
#include "graphics/graphics_fixture.h"

#include <chrono>
#include <thread>

using namespace graphics_fixture;

namespace {

constexpr size_t kMostMeshes = 2;
static_assert(QSES_GPU_MAX_WAITING == kMostMeshes, "the tests below submit as many as may wait");

// A molecule in some frames, each with its ordinary mesh.
class GpuEvents : public Graphics {
 protected:
  void SetUp() override {
    Graphics::SetUp();
    if (!drawing_) return;
    context_ = std::make_unique<CudaContext>();
    const CudaContext other;
    for (unsigned frame = 0; frame < 4; ++frame) {
      frames_.push_back(frame_of(cluster(200, 6), frame));
      expected_.push_back(host_mesh(other, frames_.back(), interleaved()));
      kept_.push_back(std::make_unique<Kept>());
      keep_on_device(*context_, frames_.back(), interleaved(), *kept_.back());
    }
    make_buffers();
    target_ = std::make_unique<Target>();
  }
  void TearDown() override {
    target_ = nullptr;
    if (drawing_) buffers_.end();
    Graphics::TearDown();
  }
  void make_buffers() { buffers_.make(60000, 400000); }
  int32_t submit(size_t frame) { return target_->submit(*kept_[frame], buffers_); }
  qses_status try_submit(size_t frame, int32_t *event = nullptr) {
    return qses_gpu_target_submit(*target_, *kept_[frame], &buffers_.told, event);
  }
  void expect_frame(size_t frame) { expect_holds(buffers_, expected_[frame]); }
  // Longer than the library waits for an event where no test tells it to.
  static void lose_patience() {
    LongGpuPatience::end();
    std::this_thread::sleep_for(std::chrono::milliseconds(QSES_GPU_PATIENCE_MS + 100));
  }
  void expect_works(size_t frame) {
    submit(frame);
    run_next_event();
    expect_done(*target_);
    expect_frame(frame);
  }

  std::vector<Atoms> frames_;
  std::vector<HostMesh> expected_;
  std::unique_ptr<CudaContext> context_;
  std::vector<std::unique_ptr<Kept>> kept_;
  SurfaceBuffers buffers_;
  std::unique_ptr<Target> target_;
};

TEST_F(GpuEvents, DoWhatWasSubmittedBeforeThem) {
  const int32_t first = submit(0);
  EXPECT_EQ(next_event(), first);
  const int32_t second = submit(1);
  EXPECT_NE(second, first);
  EXPECT_EQ(next_event(), second);
  run_event(first);
  expect_frame(0);
  EXPECT_EQ(target_->status().done, first);
  EXPECT_EQ(target_->status().submitted, second);
  EXPECT_EQ(target_->status().waiting, 1u);
  run_event(second);
  expect_frame(1);
  expect_done(*target_);
}

TEST_F(GpuEvents, DroppedOnesAreMadeUpForByTheNext) {
  const int32_t first = submit(0);
  next_event();
  const int32_t second = submit(1);
  next_event();
  run_event(second);
  expect_frame(1);
  expect_done(*target_);
  run_event(first);  // too late: nothing is left for it
  expect_frame(1);
  EXPECT_EQ(target_->status().done, second);
  EXPECT_EQ(next_event(), 0);
}

TEST_F(GpuEvents, TakeTheNewestMesh) {
  const int32_t first = submit(0);
  EXPECT_EQ(submit(2), first);
  EXPECT_EQ(target_->status().waiting, 2u);
  run_next_event();
  expect_frame(2);
  expect_done(*target_);
}

TEST_F(GpuEvents, SoManyMeshesMayWait) {
  submit(0);
  next_event();
  const int32_t second = submit(1);
  for (int round = 0; round < 3; ++round) {
    int32_t untouched = 77;
    expect_error(try_submit(2, &untouched), QSES_BUSY, {"wait"});
    EXPECT_EQ(untouched, 77);
    EXPECT_EQ(target_->status().waiting, kMostMeshes);
  }
  const Target other;  // has room of its own
  SurfaceBuffers others;
  others.make(60000, 400000);
  other.submit(*kept_[3], others);
  EXPECT_EQ(next_event(), second);
  run_event(second);
  expect_frame(1);
  expect_holds(others, expected_[3]);
  expect_works(2);
}

TEST_F(GpuEvents, MeshesAreLetGoWhenNoneComes) {
  submit(0);
  next_event();
  const int32_t last = submit(1);
  next_event();
  lose_patience();
  EXPECT_TRUE(target_->status().stopped);
  EXPECT_EQ(target_->status().waiting, 0u);
  expect_error(try_submit(2), QSES_BUSY, {"wait"});
  run_event(last);  // of which nothing is left
  EXPECT_TRUE(buffers_.are_untouched());
  EXPECT_FALSE(target_->status().stopped);
  EXPECT_EQ(target_->status().done, 0);
  expect_works(2);
}

TEST_F(GpuEvents, MemoryThatWaitedInVainIsTakenAgain) {
  const CudaContext context(uint64_t(48) << 20);
  const qses_settings s = on_device(interleaved(0.5));
  set_atoms(context, frames_[0]);
  std::vector<std::unique_ptr<Kept>> kept;
  const size_t room = keep_until_refused(context, s, &kept);
  ASSERT_GT(room, kMostMeshes);
  kept.resize(kMostMeshes);
  for (const auto &mesh : kept) target_->submit(*mesh, buffers_);
  kept.clear();
  EXPECT_LT(keep_until_refused(context, s, &kept), room);
  kept.clear();
  lose_patience();
  EXPECT_TRUE(target_->status().stopped);
  EXPECT_EQ(keep_until_refused(context, s, &kept), room);
}

TEST_F(GpuEvents, ThereAreSomeToTryWith) {
  submit(0);
  next_event();
  lose_patience();
  const int32_t one = next_event(), another = next_event();
  EXPECT_NE(one, 0);
  EXPECT_NE(another, 0);
  EXPECT_NE(one, another);
  EXPECT_TRUE(target_->status().stopped);
  run_event(another);
  EXPECT_FALSE(target_->status().stopped);
  EXPECT_TRUE(buffers_.are_untouched());
  EXPECT_EQ(next_event(), 0);
  expect_works(1);
}

TEST_F(GpuEvents, ThatNobodyAskedForDoNothing) {
  for (const int32_t number : {0, 1, -1, 1000000}) run_event(number);
  EXPECT_EQ(next_event(), 0);
  EXPECT_TRUE(buffers_.are_untouched());
  expect_works(0);
}

// ---- what goes before its event

TEST_F(GpuEvents, OutliveContextAndKeptMesh) {
  const int32_t event = submit(0);
  context_ = nullptr;
  kept_.clear();
  EXPECT_EQ(next_event(), event);
  run_event(event);
  expect_done(*target_);
  expect_frame(0);
}

TEST_F(GpuEvents, OutliveWhatIsKeptInstead) {
  submit(0);
  keep_on_device(*context_, frames_[1], interleaved(), *kept_[0]);
  qses_kept_mesh_clear(*kept_[1]);
  run_next_event();
  expect_done(*target_);
  expect_frame(0);
}

TEST_F(GpuEvents, OfTargetsThatEndedDoNothing) {
  const int32_t event = submit(0);
  target_ = nullptr;
  next_event();
  run_event(event);
  EXPECT_TRUE(buffers_.are_untouched());
  // The same after buffers were made known, and with one that goes on.
  target_ = std::make_unique<Target>();
  const Target other;
  SurfaceBuffers others;
  others.make(60000, 400000);
  expect_works(1);
  submit(0);
  other.submit(*kept_[2], others);
  target_ = nullptr;
  run_next_event();
  expect_frame(1);
  expect_done(other);
  expect_holds(others, expected_[2]);
}

// As a surface that is switched off and on again: the buffers stay, and CUDA knows them of the target before.
TEST_F(GpuEvents, OfATargetAfterAnotherOne) {
  for (const size_t frame : {0u, 1u, 2u}) {
    expect_works(frame);
    target_ = std::make_unique<Target>();
  }
  expect_works(3);
}

// Its memory is not written to, however much is computed meanwhile.
TEST_F(GpuEvents, AMeshThatWaitsStaysAsItWas) {
  const qses_settings s = on_device(interleaved());
  for (const bool with_jobs : {false, true}) {
    submit(0);
    const Kept kept;
    for (unsigned frame = 10; frame < 40; ++frame) {
      set_atoms(*context_, frame_of(frames_[0], frame));
      if (with_jobs) {
        expect_ok(qses_begin(*context_, &s));
        expect_ok(qses_wait(*context_, -1, nullptr));
        qses_mesh mesh = empty_mesh();
        expect_ok(qses_collect(*context_, &mesh));
      } else {
        expect_ok(qses_compute(*context_, &s, nullptr));
      }
      expect_ok(qses_keep(*context_, frame % 2 ? static_cast<qses_kept_mesh *>(kept) : *kept_[0]));
    }
    run_next_event();
    expect_done(*target_);
    expect_frame(0);
    keep_on_device(*context_, frames_[0], interleaved(), *kept_[0]);
  }
}

// The copy is queued behind what OpenGL draws; the next computation into the same memory waits for it on the GPU.
TEST_F(GpuEvents, AMeshThatIsBeingCopiedIsNotWrittenTo) {
  for (unsigned round = 0; round < 30; ++round) {
    const size_t frame = round % 2;
    keep_on_device(*context_, frames_[frame], interleaved(), *kept_[0]);
    submit(0);
    run_next_event();
    for (unsigned k = 0; k < 3; ++k) keep_on_device(*context_, frames_[2], interleaved(), *kept_[0]);
    expect_done(*target_);
    expect_frame(frame);
  }
}

// ---- without OpenGL

TEST_F(GpuEvents, WithoutACurrentContextFail) {
  submit(0);
  const int32_t event = next_event();
  std::thread([event] { run_event(event); }).join();
  expect_failed(*target_);
  EXPECT_TRUE(buffers_.are_untouched());
  expect_works(1);
  // The same with buffers that were made known by a good event.
  submit(2);
  const int32_t another = next_event();
  std::thread([another] { run_event(another); }).join();
  expect_failed(*target_);
  expect_works(3);
}

TEST_F(GpuEvents, OfALostContextFail) {
  for (const bool was_known : {false, true}) {
    if (was_known) expect_works(0);
    submit(1);
    lose_context();
    run_next_event();
    expect_failed(*target_);
    buffers_.forget();
    make_context();
    make_buffers();
    expect_works(2);
  }
}

TEST_F(GpuEvents, GoOnInAnotherContext) {
  for (size_t frame = 0; frame < 4; ++frame) {
    expect_works(frame);
    if (frame % 2) buffers_.end();  // orderly, or with the context
    lose_context();
    buffers_.forget();
    make_context();
    make_buffers();
  }
  expect_works(0);
}

TEST_F(GpuEvents, LetGoOfTargetsWhoseContextIsLost) {
  expect_works(0);
  target_ = nullptr;
  lose_context();
  buffers_.forget();
  run_next_event();  // without one
  make_context();
  make_buffers();
  target_ = std::make_unique<Target>();
  expect_works(1);
}

}  // namespace
