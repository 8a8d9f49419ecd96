// SPDX-License-Identifier: MIT
// The graphics event with a driver whose calls fail, one after the other: every failure is a status with a sentence,
// what is said to be there is there, and the next event works again. Part of fake_graphics_test.
#include "cudart/fake_graphics_fixture.h"

#include <tuple>

namespace {

using namespace fake_driver;

void expect_said(qses_status status, const std::string &sentence) {
  EXPECT_TRUE(status == QSES_DEVICE_ERROR || status == QSES_OUT_OF_MEMORY || status == QSES_BACKEND_UNAVAILABLE)
      << status;
  EXPECT_NE(sentence, "");
}

// Two surfaces that are drawn three times, the third time in other buffers, and end.
class Scene {
 public:
  explicit Scene(qses_graphics api) : api_(api) {}

  // Whether all went well. events_that_failed: of one of the two or of both.
  bool draw_all() {
    events_that_failed = 0;
    DrawnSurface plain(api_, 1), painted(api_, 3, true);
    paint_and_hide(painted);
    draw_both(plain, plain_mesh_, painted, look_mesh_);
    qses_gpu_target_set_look(painted.target(), nullptr);
    draw_both(plain, other_mesh_, painted, painted_mesh_);
    plain.make_buffers(11);
    painted.make_buffers(13);
    draw_both(plain, plain_mesh_, painted, painted_mesh_);
    calls_before_end = tell_driver("fake_driver_calls");
    plain.destroy();
    painted.destroy();
    draw();
    return events_that_failed == 0;
  }

  // Has as many marks made as are ever needed: each mesh holds the one of its last event, and the next is another one.
  void draw_each_mesh() const {
    const DrawnSurface surface(api_, 1);
    for (const HandMadeMesh *mesh : {&plain_mesh_, &other_mesh_, &painted_mesh_, &look_mesh_, &plain_mesh_}) {
      expect_ok(surface.submit(*mesh));
      draw();
      surface.expect_shows(*mesh);
    }
  }

  const HandMadeMesh &a_mesh() const { return plain_mesh_; }

  int events_that_failed = 0, calls_before_end = 0;
  static constexpr int kRegistrations = 2 * (2 + 5);

 private:
  void draw_both(const DrawnSurface &plain, const HandMadeMesh &of_plain, const DrawnSurface &painted,
                 const HandMadeMesh &of_painted) {
    const bool has_plain = submit(plain, of_plain), has_painted = submit(painted, of_painted);
    const int32_t event = draw();
    const bool plain_went = has_plain && went(plain, event), painted_went = has_painted && went(painted, event);
    if (plain_went) plain.expect_shows(of_plain);
    if (painted_went && &of_painted != &look_mesh_) painted.expect_shows(of_painted);
    if (!plain_went || !painted_went) ++events_that_failed;
  }
  static bool submit(const DrawnSurface &surface, const HandMadeMesh &mesh) {
    const qses_status status = surface.submit(mesh);
    if (status != QSES_OK) expect_said(status, qses_last_error());
    return status == QSES_OK;
  }
  static bool went(const DrawnSurface &surface, int32_t event) {
    const qses_gpu_status status = surface.status();
    EXPECT_EQ(status.done, event);
    EXPECT_EQ(status.waiting, 0u);
    if (status.status != QSES_OK) expect_said(status.status, status.message);
    return status.status == QSES_OK;
  }

  const qses_graphics api_;
  // Painted by a look: by kernels, which do nothing here.
  const HandMadeMesh plain_mesh_{1}, other_mesh_{60}, painted_mesh_{30, 8, 8, 0, true}, look_mesh_{90, 8, 8, 0, true};
};

class FailingGraphics : public GraphicsTest<std::tuple<qses_graphics, int>> {
 protected:
  qses_graphics api() const override { return std::get<0>(GetParam()); }
  int error() const { return std::get<1>(GetParam()); }
};

std::string name_of(const testing::TestParamInfo<std::tuple<qses_graphics, int>> &info) {
  const int error = std::get<1>(info.param);
  return std::string(std::get<0>(info.param) == QSES_GRAPHICS_OPENGL ? "OpenGL" : "Direct3D11") +
         (error < 0 ? "Once" : "FromThenOn") + std::to_string(std::abs(error));
}

TEST_P(FailingGraphics, EveryCallMayFailAndTheNextEventWorks) {
  Scene scene(api());
  scene.draw_each_mesh();
  ASSERT_TRUE(scene.draw_all());
  fail_after(-1, 0);
  ASSERT_TRUE(scene.draw_all());
  const int count = fail_after(-1, 0), end = scene.calls_before_end;
  int there_were = tell_driver("fake_driver_handles"), failed = 0, left = 0;
  for (int good = 0; good < count; ++good) {
    SCOPED_TRACE(good);
    fail_after(good, error());
    failed += scene.draw_all() ? 0 : 1;
    EXPECT_LE(scene.events_that_failed, error() < 0 ? 1 : 3) << "one call is of one event";
    stop_failing();
    EXPECT_TRUE(scene.draw_all());
    // What a look needs stays where the driver refuses to end it.
    const int there_are = tell_driver("fake_driver_handles");
    EXPECT_LE(there_are - there_were, error() < 0 && good < end ? 0 : 1);
    there_were = there_are;
    left += tell_driver("fake_graphics_drop_registered");
    ASSERT_FALSE(HasFailure());
  }
  // Where the call fails that comes before the one that unregisters, that buffer stays registered.
  if (error() < 0) {
    EXPECT_LE(left, Scene::kRegistrations);
  }
  EXPECT_GT(failed, error() < 0 ? count / 4 : count / 2);  // some calls only end or measure something
}
// cudaError_t; negative: of one call only.
INSTANTIATE_TEST_SUITE_P(Errors, FailingGraphics,
                         testing::Combine(testing::ValuesIn(graphics_apis()), testing::Values(-2, -205, -999, 2, 304)),
                         name_of);

class EndOfATarget : public GraphicsTestOfApi {};
INSTANTIATE_TEST_SUITE_P(Apis, EndOfATarget, testing::ValuesIn(graphics_apis()), name_of_api);

TEST_P(EndOfATarget, IsLeftToTheNextEventWhereTheDriverRefusesIt) {
  const HandMadeMesh mesh(1);
  DrawnSurface surface(api(), 1);
  expect_ok(surface.submit(mesh));
  draw();
  surface.destroy();
  fail_after(0, 304);
  EXPECT_GT(draw(), 0);
  stop_failing();
  EXPECT_EQ(tell_driver("fake_graphics_registered"), 2);
  EXPECT_GT(draw(), 0);
  EXPECT_EQ(tell_driver("fake_graphics_registered"), 0);
  EXPECT_EQ(draw(), 0);
}

// What the thread that draws has of its own, on a device that nothing was drawn on before.
class FirstGraphicsEvent : public GraphicsTestOfApi {};
INSTANTIATE_TEST_SUITE_P(Apis, FirstGraphicsEvent, testing::Values(QSES_GRAPHICS_OPENGL));

TEST_P(FirstGraphicsEvent, MayFailInEveryCall) {
  HandMadeMesh mesh(1, 5, 4, 2);
  draw_on(2);
  const int there_were = tell_driver("fake_driver_handles");
  int failed = 0;
  {
    const DrawnSurface surface(api(), 1);
    for (;; ++failed) {
      expect_ok(surface.submit(mesh));
      fail_after(failed, -999);
      draw();
      if (fail_after(-1, 0) <= failed) break;  // there were no more calls
      stop_failing();
      if (surface.status().status != QSES_OK) expect_said(surface.status().status, surface.status().message);
      ASSERT_LT(failed, 1000);
    }
    for (int k = 0; k < 3; ++k) {
      surface.expect_status(QSES_OK, {});
      surface.expect_shows(mesh);
      expect_ok(surface.submit(mesh));
      draw();
    }
  }
  EXPECT_GT(failed, 10);
  draw();
  EXPECT_EQ(tell_driver("fake_driver_handles"), there_were + 5)
      << "needed are a stream, two events that measure time, and two that mark the ends of copies in turn";
}

// The device is lost (as in LostDevice of fake_driver_test.cpp): that is said in every event from then on, and nothing
// is handed back to the driver, which may crash.
class LostGraphics : public FailingGraphics {};

TEST_P(LostGraphics, IsSaidForGood) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  Scene scene(api());
  scene.draw_each_mesh();
  ASSERT_TRUE(scene.draw_all());
  fail_after(-1, 0);
  ASSERT_TRUE(scene.draw_all());
  const int count = fail_after(-1, 0), end = scene.calls_before_end;
  for (int good = 0; good < count; good += 1 + count / 12) {
    SCOPED_TRACE(good);
    EXPECT_EXIT(
        {
          Scene lost(api());
          lost.draw_each_mesh();
          EXPECT_TRUE(lost.draw_all());
          calls();
          fail_after(good, error());
          const bool survived = lost.draw_all();
          EXPECT_EQ(survived, good >= end);
          EXPECT_FALSE(lost.draw_all());
          const DrawnSurface surface(api(), 1);
          expect_ok(surface.submit(lost.a_mesh()));
          draw();
          surface.expect_status(QSES_DEVICE_ERROR, {"does not recover"});
          int handed_back = 0;
          for (const std::string &call : calls())
            if (call.find("Unregister") == 0 && call.find(" = ") != std::string::npos) ++handed_back;
          EXPECT_LE(handed_back, 1) << "which found that the device is lost";
          std::_Exit(HasFailure() ? 1 : 0);
        },
        testing::ExitedWithCode(0), "");
  }
}
INSTANTIATE_TEST_SUITE_P(Errors, LostGraphics,
                         testing::Combine(testing::ValuesIn(graphics_apis()), testing::Values(702, 719, 999)), name_of);

}  // namespace
