// SPDX-License-Identifier: MIT
// While the driver compiles the kernels of a GPU, which a function that waits stands in for here, nobody else waits.
#include "parallel/cuda_preparation.h"

#include <gtest/gtest.h>

#include <future>
#include <stdexcept>

namespace quickses {
namespace {

CudaDevice some_gpu() {
  CudaDevice device;
  device.available = true;
  device.name = "a GPU";
  device.total_memory = 5;
  return device;
}

TEST(CudaPreparation, IsTold) {
  CudaPreparations preparations;
  preparations.remember(1, some_gpu());
  CudaDevice known;
  EXPECT_FALSE(preparations.is_preparing(1, &known));

  std::promise<void> has_begun, may_end;
  std::future<void> loading = std::async(std::launch::async, [&] {
    preparations.prepare(1, [&] {
      has_begun.set_value();
      may_end.get_future().wait();
    });
  });
  has_begun.get_future().wait();
  EXPECT_FALSE(preparations.is_preparing(0, &known));
  ASSERT_TRUE(preparations.is_preparing(1, &known));
  EXPECT_TRUE(known.available);
  EXPECT_TRUE(known.preparing);
  EXPECT_EQ(known.name, "a GPU");
  EXPECT_EQ(known.total_memory, 5u);
  EXPECT_NE(known.reason.find("the driver compiles them"), std::string::npos);
  EXPECT_LT(known.reason.size(), 256u);  // qses_backend_description.reason

  may_end.set_value();
  loading.get();
  EXPECT_FALSE(preparations.is_preparing(1, &known));
}

TEST(CudaPreparation, IsDoneOncePerDevice) {
  CudaPreparations preparations;
  int loads = 0;
  preparations.prepare(0, [&] { ++loads; });
  preparations.prepare(0, [&] { ++loads; });
  EXPECT_EQ(loads, 1);
  preparations.prepare(1, [&] { ++loads; });
  EXPECT_EQ(loads, 2);
}

TEST(CudaPreparation, IsTriedAgainAfterAnError) {
  CudaPreparations preparations;
  preparations.remember(0, some_gpu());
  EXPECT_THROW(preparations.prepare(0, [] { throw std::runtime_error("no"); }), std::runtime_error);
  CudaDevice known;
  EXPECT_FALSE(preparations.is_preparing(0, &known));
  int loads = 0;
  preparations.prepare(0, [&] { ++loads; });
  EXPECT_EQ(loads, 1);
}

}  // namespace
}  // namespace quickses
