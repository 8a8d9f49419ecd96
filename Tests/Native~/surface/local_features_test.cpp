// SPDX-License-Identifier: MIT
// The features gathered near a place, by every CPU kernel, against the rule that both back ends follow.
#include "surface/exact_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>

namespace {

using namespace exact_fixture;
using surface_fixture::Atoms;
using surface_fixture::settings;

// However many atoms come before the deepest, in the order of the grid.
TEST(LocalFeatures, AreTheAtomsOfTheRuleUnlessTheyAreTooMany) {
  for (const CpuKernels *kernels : usable_cpu_kernels()) {
    SCOPED_TRACE(kernels->name);
    std::mt19937 random(41);
    std::uniform_real_distribution<double> along(0, 14), size(1.2, 1.8);
    Atoms atoms;
    for (int k = 0; k < 1100; ++k) atoms.add(along(random), along(random), along(random), size(random));
    ExactRun run(atoms, settings(), 2, *kernels);
    FeatureView features = run.features();
    features.arc_bounds.count = 0;  // which have a limit of their own
    const auto columns = std::make_unique<LocalColumns>();
    std::uniform_real_distribution<float> place(-6.f, 6.f), reach(0.2f, 1.5f);
    int gathered = 0, full = 0, refused = 0;
    for (int k = 0; k < 3000; ++k) {
      const Vec3<float> x(place(random), place(random), place(random));
      const float around = reach(random);
      float deepest = -kFarAway;
      for (uint32_t i = 0; i < features.atoms.count; ++i)
        deepest = std::max(deepest, ball_depth(features.atoms.items[i], x));
      const float least = deepest - LocalReach(features, x, around).slack;
      std::vector<uint32_t> expected;
      bool sure = least > -around;  // others are not looked for
      for (uint32_t i = 0; i < features.atoms.count; ++i) {
        const float depth = ball_depth(features.atoms.items[i], x);
        sure &= std::abs(depth - least) > 1e-5f;
        if (depth >= least) expected.push_back(i);
      }
      if (!sure) continue;
      const bool fits = expected.size() <= LocalReach::kMostAtoms;
      ASSERT_EQ(kernels->gather_local_features(features, x, around, columns.get()), fits) << expected.size();
      ++(fits ? gathered : refused);
      if (!fits) continue;
      full += expected.size() > LocalReach::kMostAtoms / 2 ? 1 : 0;
      std::vector<uint32_t> found(columns->atoms, columns->atoms + columns->atom_number);
      std::sort(found.begin(), found.end());
      ASSERT_EQ(found, expected);
    }
    EXPECT_GT(gathered, 100);
    EXPECT_GT(full, 100);
    EXPECT_GT(refused, 100);
  }
}

}  // namespace
