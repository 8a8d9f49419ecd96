// SPDX-License-Identifier: MIT
// A cancel that comes when the mesh is finished takes nothing back: the call succeeds, and so does the job.
#include "jobs/surface_job.h"
#include "parallel/error.h"
#include "surface/surface_fixture.h"

#include <gtest/gtest.h>

#include <future>

using namespace surface_fixture;

namespace {

// Cancels from another thread at the last moment at which the callback hears of the computation.
struct CancelAtTheEnd {
  qses_context *context;
  int cancels = 0;
  static void progress(void *user_data, double fraction) {
    auto *self = static_cast<CancelAtTheEnd *>(user_data);
    if (fraction < 1.0) return;
    std::async(std::launch::async, [&] { expect_ok(qses_cancel(self->context)); }).get();
    ++self->cancels;
  }
};

TEST(LateCancel, LeavesWhatComputeHasFinished) {
  const Context context;
  set_atoms(context, cluster(50, 1));
  CancelAtTheEnd at_the_end{context};
  expect_ok(qses_set_progress_callback(context, CancelAtTheEnd::progress, &at_the_end));
  const qses_settings s = settings(1.0);
  qses_mesh mesh;
  qses_mesh_init(&mesh);
  EXPECT_EQ(qses_compute(context, &s, &mesh), QSES_OK) << qses_last_error();
  EXPECT_EQ(at_the_end.cancels, 1);
  EXPECT_EQ(mesh_checks::manifold_fault(copy_surface(context).mesh), "");
  EXPECT_GT(mesh.vertex_count, 0u);
  EXPECT_EQ(qses_collect(context, &mesh), QSES_NOTHING_NEW);
}

TEST(LateCancel, LeavesAJobFinished) {
  const Context context;
  set_atoms(context, cluster(50, 1));
  CancelAtTheEnd at_the_end{context};
  expect_ok(qses_set_progress_callback(context, CancelAtTheEnd::progress, &at_the_end));
  expect_ok(qses_begin(context, nullptr));
  expect_ok(qses_wait(context, -1, nullptr));
  EXPECT_EQ(at_the_end.cancels, 1);
  qses_progress progress;
  qses_progress_init(&progress);
  expect_ok(qses_poll(context, &progress));
  EXPECT_EQ(progress.state, QSES_JOB_FINISHED);
  EXPECT_EQ(progress.levels_finished, progress.level_count);
  qses_mesh mesh;
  qses_mesh_init(&mesh);
  expect_ok(qses_collect(context, &mesh));
  EXPECT_EQ(mesh.level, mesh.level_count - 1);
}

// An engine that is told to stop when some of the levels are finished, and heeds it.
class StoppingEngine : public quickses::SurfaceEngine {
 public:
  quickses::SurfaceJob *job = nullptr;
  size_t finish_first = 0;

  std::shared_ptr<quickses::AtomSet> make_atoms(size_t) override { return std::make_shared<quickses::AtomSet>(); }
  void compute(const quickses::AtomSet &, const quickses::Appearance &, const qses_settings &,
               quickses::Span<const float> spacings, quickses::LevelSink &sink) override {
    for (size_t k = 0; k < std::min(spacings.size, finish_first); ++k) {
      sink.give_back();
      quickses::FinishedMesh mesh{};
      qses_mesh_init(&mesh.on_host);
      qses_report_init(&mesh.report);
      sink.finished(std::move(mesh));
    }
    job->cancel();
    EXPECT_TRUE(sink.stop_flag());
    throw quickses::Cancelled();
  }
  qses_size_estimate estimate(const quickses::AtomSet &, const quickses::Appearance &, const qses_settings &,
                              const std::atomic<bool> &) override {
    return {};
  }
  void enable_stage_times(bool) override {}
  void set_progress(std::function<void(double)>) override {}
};

struct StoppedJob {
  StoppedJob(size_t finish_first) {
    auto engine = std::make_unique<StoppingEngine>();
    StoppingEngine &stopping = *engine;
    job = std::make_unique<quickses::SurfaceJob>(std::move(engine));
    stopping.job = job.get();
    stopping.finish_first = finish_first;
    request.atoms = job->engine().make_atoms(0);
    request.appearance = std::make_shared<quickses::Appearance>();
    request.settings = settings();
  }
  std::unique_ptr<quickses::SurfaceJob> job;
  quickses::SurfaceRequest request;
};

TEST(LateCancel, OfAComputeWithItsMeshFinished) {
  StoppedJob stopped(1);
  stopped.request.ladder.add(0.5f);
  EXPECT_NO_THROW(stopped.job->compute(stopped.request));
  EXPECT_NE(stopped.job->held(), nullptr);
  EXPECT_FALSE(stopped.job->collect());
  EXPECT_EQ(stopped.job->progress().state, QSES_JOB_FINISHED);
}

TEST(LateCancel, OfAComputeBefore) {
  StoppedJob stopped(0);
  stopped.request.ladder.add(0.5f);
  EXPECT_THROW(stopped.job->compute(stopped.request), quickses::Cancelled);
  EXPECT_EQ(stopped.job->held(), nullptr);
  EXPECT_FALSE(stopped.job->collect());
  EXPECT_EQ(stopped.job->progress().state, QSES_JOB_CANCELLED);
}

TEST(LateCancel, OfAJob) {
  for (size_t finished : {0u, 1u, 2u}) {
    StoppedJob stopped(finished);
    stopped.request.ladder.add(1.f);
    stopped.request.ladder.add(0.5f);
    stopped.job->begin(stopped.request);
    EXPECT_TRUE(stopped.job->wait(-1));
    const qses_progress progress = stopped.job->progress();
    EXPECT_EQ(progress.state, finished == 2 ? QSES_JOB_FINISHED : QSES_JOB_CANCELLED);
    EXPECT_EQ(progress.fraction, finished == 2 ? 1.f : 0.f);
    EXPECT_EQ(stopped.job->collect(), finished > 0);
  }
}

}  // namespace
