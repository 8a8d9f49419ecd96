// SPDX-License-Identifier: MIT
// What the CPU's threads keep for themselves while they work.
#include "surface/exact_fixture.h"

#include <gtest/gtest.h>

using namespace surface_fixture;
using exact_fixture::ExactRun;

namespace {

// Whichever thread meets the most crowded atom or brick: the first surface takes all that the same one needs again, so
// that a budget can be kept to from the second one on.
TEST(CpuScratch, DoesNotGrowWithTheSameSurfaceAgain) {
  for (const double probe : {1.4, 12.0})
    for (const unsigned threads : {1u, 2u, 16u}) {
      SCOPED_TRACE(testing::Message() << "probe " << probe << ", " << threads << " threads");
      ExactRun run(crambin(), settings(0.6, probe), threads);
      run.mesh();
      const uint64_t bytes = run.executor.scratch_bytes();
      EXPECT_GT(bytes, threads * sizeof(quickses::BrickColumns));
      for (int again = 0; again < 4; ++again) {
        run.mesh();
        EXPECT_EQ(run.executor.scratch_bytes(), bytes);
      }
    }
}

TEST(CpuScratch, OfUsualAtomsStaysWithinItsAllowance) {
  ExactRun run(crambin(), settings(0.5), 4);
  run.mesh();
  EXPECT_LE(run.executor.scratch_bytes(), run.executor.scratch_allowance());
}

}  // namespace
