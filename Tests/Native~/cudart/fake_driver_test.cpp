// SPDX-License-Identifier: MIT
// The library with drivers that do not do (fake_driver.cpp): what is wrong is said, and the CPU takes over. CTest puts
// one of them in the place of NVIDIA's and says in QUICKSES_FAKE_DRIVER which.
#include "capi/capi_fixture.h"
#include "cudart/fake_driver_functions.h"
#include "quickses/quickses_gpu.h"

#include <cstdio>
#include <cstdlib>
#include <thread>

namespace {

using namespace capi_fixture;
using namespace fake_driver;

qses_status create(qses_backend backend, qses_context **context, int device = 0) {
  qses_context_options options;
  qses_context_options_init(&options);
  options.backend = backend;
  options.threads = 2;
  options.device = device;
  return qses_context_create(&options, context);
}

void expect_the_cpu_takes_over(const std::string &reason) {
  qses_context *context = nullptr;
  ASSERT_EQ(create(QSES_BACKEND_AUTO, &context), QSES_OK) << qses_last_error();
  qses_backend backend{};
  qses_backend_description description = empty_description();
  ASSERT_EQ(qses_context_info(context, &backend, &description), QSES_OK);
  EXPECT_EQ(backend, QSES_BACKEND_CPU);
  EXPECT_NE(std::string(description.reason).find(reason), std::string::npos) << description.reason;
  set_atoms(context, water());
  EXPECT_EQ(qses_compute(context, nullptr, nullptr), QSES_OK) << qses_last_error();
  const Surface surface = copy_surface(context);
  EXPECT_EQ(mesh_checks::manifold_fault(surface.mesh), "");
  EXPECT_GT(surface.report.area, 30);
  qses_context_destroy(context);
}

void expect_refused(const std::string &reason) {
  qses_backend_description description = empty_description();
  ASSERT_EQ(qses_backend_info(QSES_BACKEND_CUDA, &description), QSES_OK);
  EXPECT_FALSE(description.available);
  EXPECT_EQ(std::string(description.reason), reason);
  uint32_t count = 7;
  EXPECT_EQ(qses_device_count(&count), QSES_OK);
  EXPECT_EQ(count, 0u);
  qses_context *context = nullptr;
  expect_error(create(QSES_BACKEND_CUDA, &context), QSES_BACKEND_UNAVAILABLE, {reason.c_str()});
  EXPECT_EQ(context, nullptr);
  expect_error(qses_gpu_check_graphics(QSES_GRAPHICS_OPENGL), QSES_BACKEND_UNAVAILABLE, {"OpenGL", reason.c_str()});
  expect_the_cpu_takes_over(reason);
}

TEST(FakeDriver, NoneIsInstalled) {
  REQUIRE_DRIVER("none");
#if !defined(_WIN32)
  if (dlopen(kLibrary, RTLD_NOW)) GTEST_SKIP() << "skipped: there is a driver on this machine";
#endif
  expect_refused(std::string("no NVIDIA driver is installed (") + kLibrary + " was not found)");
}

TEST(FakeDriver, NoDevice) {
  REQUIRE_DRIVER("no_device");
  expect_refused("no CUDA device is present, or none is visible to this process");
}

TEST(FakeDriver, TooOld) {
  REQUIRE_DRIVER("too_old");
  const std::string needed = std::to_string(tell_driver("fake_driver_toolkit") / 1000) + ".0";
  expect_refused("the NVIDIA driver serves CUDA 10.2, but this library needs " + needed + ": update the driver");
}

TEST(FakeDriver, LacksAFunction) {
  REQUIRE_DRIVER("incomplete");
  expect_refused(std::string("the NVIDIA driver (") + kLibrary +
                 ") lacks the function cuEventSynchronize: install the driver again");
}

TEST(FakeDriver, Stub) {
  REQUIRE_DRIVER("stub");
  expect_refused(std::string("the ") + kLibrary +
                 " that was found is the CUDA Toolkit's stub, not an NVIDIA driver: take it off the loader's path");
}

// ---- a driver whose calls fail, from any one of them on -------------------------------------------------------------

#if defined(_WIN32)
constexpr int kStep = 3;  // Wine takes long for it: errors share the calls
#else
constexpr int kStep = 1;
#endif

// Allowed is success, or one of these errors with a sentence.
void expect_said(qses_status status) {
  if (status == QSES_OK) return;
  EXPECT_TRUE(status == QSES_DEVICE_ERROR || status == QSES_OUT_OF_MEMORY || status == QSES_BACKEND_UNAVAILABLE)
      << status;
  EXPECT_NE(std::string(qses_last_error()), "");
}

// All that asks something of the driver. Kernels that do nothing find no surface.
bool use_everything() {
  qses_context *context = nullptr;
  const qses_status created = create(QSES_BACKEND_CUDA, &context);
  expect_said(created);
  if (created != QSES_OK) {
    EXPECT_EQ(context, nullptr);
    return false;
  }
  const Atoms atoms = water();
  qses_mesh mesh = empty_mesh();
  qses_size_estimate estimate;
  qses_size_estimate_init(&estimate);
  qses_progress progress;
  qses_progress_init(&progress);
  const auto is_good_job = [](const qses_progress &p) {
    if (p.state == QSES_JOB_FINISHED) return true;
    EXPECT_EQ(p.state, QSES_JOB_FAILED);
    EXPECT_TRUE(p.status == QSES_DEVICE_ERROR || p.status == QSES_OUT_OF_MEMORY) << p.status;
    EXPECT_NE(std::string(p.message), "");
    return false;
  };
  const auto is_good = [](qses_status status) {
    expect_said(status);
    return status == QSES_OK;
  };
  const auto run_job = [&] {
    return is_good(qses_begin(context, nullptr)) && is_good(qses_wait(context, -1, nullptr)) &&
           is_good(qses_poll(context, &progress)) && is_good_job(progress) && is_good(qses_collect(context, &mesh));
  };
  bool good = is_good(qses_set_atoms(context, atoms.positions.data(), 0, atoms.radii.data(), atoms.size())) &&
              is_good(qses_compute(context, nullptr, nullptr)) && is_good(qses_estimate(context, nullptr, &estimate));
  // From the third one on the levels are made beside each other, where they take little time, and then their kernels
  // handed over as graphs.
  for (int k = 0; k < 6 && good; ++k) good = run_job();
  qses_context_destroy(context);
  return good;
}

// The oldest that serves, which knows no kernels that are sent ahead, no graphs of them and no ids of contexts; and its
// GPU sees pages of the process at other addresses.
TEST(FakeDriver, OlderOnesServeAsWell) {
  REQUIRE_DRIVER("older");
  EXPECT_TRUE(use_everything());
  EXPECT_EQ(tell_driver("fake_driver_graphs_launched"), 0);
  EXPECT_EQ(tell_driver("fake_driver_registrations"), 0) << "in vain";
}

// Nor is any made a thread's for longer than a call.
TEST(FakeDriver, DevicesThatAreNotAskedForAreLeftAlone) {
  REQUIRE_DRIVER("three_devices");
  qses_context *context = nullptr;
  const auto on_a_new_thread = [&](const auto &call) {
    std::thread([&] {
      call();
      EXPECT_EQ(tell_driver("fake_driver_has_context"), 0);
    }).join();
  };
  on_a_new_thread([&] { EXPECT_EQ(create(QSES_BACKEND_CUDA, &context, 1), QSES_OK) << qses_last_error(); });
  ASSERT_NE(context, nullptr);
  on_a_new_thread([&] { set_atoms(context, water()); });
  on_a_new_thread([&] { EXPECT_EQ(qses_compute(context, nullptr, nullptr), QSES_OK) << qses_last_error(); });
  on_a_new_thread([&] { qses_context_destroy(context); });
  EXPECT_EQ(tell_driver("fake_driver_retained", 1), 1);
  EXPECT_EQ(tell_driver("fake_driver_retained", 0) + tell_driver("fake_driver_retained", 2), 0);
}

TEST(FakeDriver, NoDeviceWaitsForTheKernelsOfAnother) {
  REQUIRE_DRIVER("three_devices");
  tell_driver("fake_driver_hold", 1);
  qses_context *slow = nullptr, *context = nullptr;
  std::thread maker([&] { EXPECT_EQ(create(QSES_BACKEND_CUDA, &slow, 0), QSES_OK) << qses_last_error(); });
  EXPECT_TRUE(tell_driver("fake_driver_wait_for_compiling"));
  EXPECT_EQ(create(QSES_BACKEND_CUDA, &context, 2), QSES_OK) << qses_last_error();
  set_atoms(context, water());
  EXPECT_EQ(qses_compute(context, nullptr, nullptr), QSES_OK) << qses_last_error();
  tell_driver("fake_driver_hold", 0);
  maker.join();
  qses_context_destroy(context);
  qses_context_destroy(slow);
}

class FailingDriver : public testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    REQUIRE_DRIVER("failing");
    qses_backend_description description = empty_description();
    ASSERT_EQ(qses_backend_info(QSES_BACKEND_CUDA, &description), QSES_OK);  // loads it
    ASSERT_TRUE(description.available) << description.reason;
    EXPECT_EQ(std::string(description.device), "Fake GPU");
    is_loaded_ = true;
  }
  void TearDown() override {
    if (is_loaded_) fail_after(-1, 0);
  }

 private:
  bool is_loaded_ = false;
};

// On a GPU newer than the library the driver compiles the kernels: who makes the first context waits, nobody else does,
// and qses_backend_info tells.
class CompilingDriver : public FailingDriver {};

TEST_P(CompilingDriver, IsToldAndWaitedForByOneOnly) {
  const auto describe = [](qses_backend backend) {
    qses_backend_description description = empty_description();
    EXPECT_EQ(qses_backend_info(backend, &description), QSES_OK);
    return description;
  };
  EXPECT_EQ(describe(QSES_BACKEND_CUDA).preparing, 0);
  tell_driver("fake_driver_hold", 1);
  qses_context *context = nullptr;
  std::thread maker([&] { EXPECT_EQ(create(QSES_BACKEND_CUDA, &context), QSES_OK) << qses_last_error(); });
  EXPECT_TRUE(tell_driver("fake_driver_wait_for_compiling")) << "the kernels were there already";
  for (const qses_backend backend : {QSES_BACKEND_CUDA, QSES_BACKEND_AUTO}) {
    const qses_backend_description meanwhile = describe(backend);
    EXPECT_EQ(meanwhile.available, 1);
    EXPECT_EQ(meanwhile.preparing, 1);
    EXPECT_STREQ(meanwhile.device, "Fake GPU");
    EXPECT_NE(std::string(meanwhile.reason).find("the driver compiles them"), std::string::npos) << meanwhile.reason;
  }
  EXPECT_EQ(describe(QSES_BACKEND_CPU).preparing, 0);
  uint32_t devices = 0;
  EXPECT_EQ(qses_device_count(&devices), QSES_OK);
  EXPECT_EQ(devices, 1u);

  tell_driver("fake_driver_hold", 0);
  maker.join();
  EXPECT_EQ(describe(QSES_BACKEND_CUDA).preparing, 0);
  EXPECT_STREQ(describe(QSES_BACKEND_CUDA).reason, "");
  qses_backend_description of_context = empty_description();
  EXPECT_EQ(qses_context_info(context, nullptr, &of_context), QSES_OK);
  EXPECT_EQ(of_context.preparing, 0);
  qses_context_destroy(context);
}
INSTANTIATE_TEST_SUITE_P(First, CompilingDriver, testing::Values(0));  // before the kernels are there

// Errors that a process may survive; negative: of one call only.
TEST_P(FailingDriver, EveryCallMayFailAndTheNextMayNot) {
  const int handles = tell_driver("fake_driver_handles");
  fail_after(-1, 0);
  ASSERT_TRUE(use_everything());
  const int calls = fail_after(-1, 0);
  ASSERT_GT(calls, 100);
  for (int k = 0; k < 50 && tell_driver("fake_driver_graphs_launched") == 0; ++k) ASSERT_TRUE(use_everything());
  EXPECT_GT(tell_driver("fake_driver_graphs_launched"), 0);
  EXPECT_GT(tell_driver("fake_driver_registrations"), 0);
  EXPECT_EQ(tell_driver("fake_driver_handles"), handles);
  int failed = 0;
  for (int good = std::abs(GetParam()) % kStep; good < calls; good += kStep) {
    SCOPED_TRACE(good);
    fail_after(good, GetParam());
    failed += use_everything() ? 0 : 1;
    fail_after(-1, 0);
    ASSERT_FALSE(HasFailure());
  }
  // An allocation that is refused once is tried again, and some calls end what is over.
  EXPECT_GT(failed, calls / kStep / 8);
  EXPECT_TRUE(use_everything());
  if (GetParam() < 0) return;
  fail_after(0, GetParam());
  expect_the_cpu_takes_over("the fake driver was told to fail");
}
INSTANTIATE_TEST_SUITE_P(Errors, FailingDriver, testing::Values(-2, 2, 46, -201, -999));  // cudaError_t

// Others may have all of a GPU's memory: who leaves the choice to the library gets a context all the same.
class FullDevice : public FailingDriver {};

TEST_P(FullDevice, IsLeftToOthersWhereNoneIsAskedFor) {
  qses_context *context = nullptr;
  ASSERT_EQ(create(QSES_BACKEND_CUDA, &context), QSES_OK) << qses_last_error();  // what is done but once in a process
  qses_context_destroy(context);
  fail_after(-1, 0);
  ASSERT_EQ(create(QSES_BACKEND_CUDA, &context), QSES_OK) << qses_last_error();
  const int calls = fail_after(-1, 0);
  qses_context_destroy(context);
  int on_the_cpu = 0;
  for (int good = 0; good < calls; ++good) {
    SCOPED_TRACE(good);
    fail_after(good, GetParam());
    const qses_status cuda = create(QSES_BACKEND_CUDA, &context);
    qses_context_destroy(context);
    fail_after(good, GetParam());
    ASSERT_EQ(create(QSES_BACKEND_AUTO, &context), QSES_OK) << qses_last_error();
    fail_after(-1, 0);
    qses_backend backend{};
    qses_backend_description description = empty_description();
    ASSERT_EQ(qses_context_info(context, &backend, &description), QSES_OK);
    if (cuda != QSES_OK) {
      EXPECT_EQ(backend, QSES_BACKEND_CPU);
    }
    EXPECT_EQ(std::string(description.reason).empty(), backend == QSES_BACKEND_CUDA) << description.reason;
    EXPECT_EQ(description.available, 1);
    on_the_cpu += backend == QSES_BACKEND_CPU ? 1 : 0;
    set_atoms(context, water());
    EXPECT_EQ(qses_compute(context, nullptr, nullptr), QSES_OK) << qses_last_error();
    qses_context_destroy(context);
  }
  EXPECT_GT(on_the_cpu, 0);
}
INSTANTIATE_TEST_SUITE_P(Errors, FullDevice, testing::Values(2, 46));

// The device is lost: Windows ended a kernel (702), the driver was restarted under the process (719), or other code in
// it has reset the device (709); 999 is what Windows' drivers call most of them.
class LostDevice : public FailingDriver {};

TEST_P(LostDevice, IsSaidForGoodAndTheCpuTakesOver) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  ASSERT_TRUE(use_everything());  // loads kernels, which is done once in each of the processes
  fail_after(-1, 0);
  ASSERT_TRUE(use_everything());
  const int calls = fail_after(-1, 0);
  for (int good = 1; good < calls; good += 1 + kStep * calls / 12) {
    SCOPED_TRACE(good);
    EXPECT_EXIT(
        {
          fail_after(good, GetParam());
          const bool survived = use_everything();
          // How many calls there are depends on time, too: nothing may have failed.
          if (tell_driver("fake_driver_calls") <= good) {
            EXPECT_TRUE(survived);
            std::_Exit(HasFailure() ? 1 : 0);
          }
          qses_backend_description description = empty_description();
          qses_backend_info(QSES_BACKEND_CUDA, &description);
          EXPECT_FALSE(survived && description.available);
          fail_after(-1, 0);  // nobody asks the device again
          qses_context *context = nullptr;
          expect_error(create(QSES_BACKEND_CUDA, &context), QSES_BACKEND_UNAVAILABLE, {"does not recover"});
          expect_the_cpu_takes_over("does not recover");
          std::_Exit(HasFailure() ? 1 : 0);
        },
        testing::ExitedWithCode(0), "");
  }
}
INSTANTIATE_TEST_SUITE_P(Errors, LostDevice, testing::Values(702, 709, 719, 999));

// Other code resets the device and goes on with it: every call would succeed, but with handles that are gone.
class ResetDevice : public FailingDriver {};

TEST_P(ResetDevice, IsFoundBeforeTheDriverIsGivenWhatIsGone) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(
      {
        qses_context *context = nullptr;
        EXPECT_EQ(create(QSES_BACKEND_CUDA, &context), QSES_OK);
        set_atoms(context, water());
        for (int k = 0; k < 3; ++k) EXPECT_EQ(qses_compute(context, nullptr, nullptr), QSES_OK) << qses_last_error();
        for (int k = 0; k < 300 && tell_driver("fake_driver_graphs_launched") == 0; ++k) {
          EXPECT_EQ(qses_begin(context, nullptr), QSES_OK) << qses_last_error();
          EXPECT_EQ(qses_wait(context, -1, nullptr), QSES_OK) << qses_last_error();
        }
        EXPECT_GT(tell_driver("fake_driver_graphs_launched"), 0);
        const int handles = tell_driver("fake_driver_handles");
        tell_driver("fake_driver_reset");
        for (int k = 0; k < GetParam(); ++k)
          expect_error(qses_compute(context, nullptr, nullptr), QSES_DEVICE_ERROR, {"does not recover"});
        qses_context_destroy(context);
        EXPECT_EQ(tell_driver("fake_driver_handles"), handles) << "the driver was given one that is gone";
        expect_error(create(QSES_BACKEND_CUDA, &context), QSES_BACKEND_UNAVAILABLE, {"does not recover"});
        expect_the_cpu_takes_over("does not recover");
        std::_Exit(HasFailure() ? 1 : 0);
      },
      testing::ExitedWithCode(0), "");
}
INSTANTIATE_TEST_SUITE_P(Surfaces, ResetDevice, testing::Values(0, 1, 2));  // tried after it

}  // namespace
