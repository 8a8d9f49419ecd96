// SPDX-License-Identifier: MIT
// The driver compiles the kernels for a GPU that is newer than the library: who makes the first context waits, nobody
// else does, and qses_backend_info tells. With slow_driver.cpp as the driver.
#include <quickses/quickses.h>

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <future>
#include <string>

namespace {

qses_backend_description describe(qses_backend backend) {
  qses_backend_description description;
  qses_backend_description_init(&description);
  EXPECT_EQ(qses_backend_info(backend, &description), QSES_OK);
  return description;
}

TEST(SlowDriver, IsToldAndWaitedForByOneOnly) {
  void *const driver = dlopen("libcuda.so.1", RTLD_NOW);
  ASSERT_TRUE(driver);
  const auto wait = reinterpret_cast<void (*)()>(dlsym(driver, "slow_driver_wait"));
  const auto go_on = reinterpret_cast<void (*)()>(dlsym(driver, "slow_driver_go_on"));
  ASSERT_TRUE(wait && go_on) << "this is another driver";

  EXPECT_TRUE(describe(QSES_BACKEND_CUDA).available);
  EXPECT_EQ(describe(QSES_BACKEND_CUDA).preparing, 0);
  std::future<qses_context *> making = std::async(std::launch::async, [] {
    qses_context_options options;
    qses_context_options_init(&options);
    options.backend = QSES_BACKEND_CUDA;
    qses_context *context = nullptr;
    EXPECT_EQ(qses_context_create(&options, &context), QSES_OK) << qses_last_error();
    return context;
  });
  wait();
  for (const qses_backend backend : {QSES_BACKEND_CUDA, QSES_BACKEND_AUTO}) {
    const qses_backend_description meanwhile = describe(backend);
    EXPECT_EQ(meanwhile.available, 1);
    EXPECT_EQ(meanwhile.preparing, 1);
    EXPECT_STREQ(meanwhile.device, "Slow GPU");
    EXPECT_NE(std::string(meanwhile.reason).find("the driver compiles them"), std::string::npos) << meanwhile.reason;
  }
  EXPECT_EQ(describe(QSES_BACKEND_CPU).preparing, 0);
  uint32_t devices = 0;
  EXPECT_EQ(qses_device_count(&devices), QSES_OK);
  EXPECT_EQ(devices, 1u);

  go_on();
  qses_context *const context = making.get();
  EXPECT_EQ(describe(QSES_BACKEND_CUDA).preparing, 0);
  EXPECT_STREQ(describe(QSES_BACKEND_CUDA).reason, "");
  qses_backend_description of_context;
  qses_backend_description_init(&of_context);
  EXPECT_EQ(qses_context_info(context, nullptr, &of_context), QSES_OK);
  EXPECT_EQ(of_context.preparing, 0);
  qses_context_destroy(context);
}

}  // namespace
