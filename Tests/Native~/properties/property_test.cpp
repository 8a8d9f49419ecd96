// SPDX-License-Identifier: MIT
// Random sets of atoms of every degenerate kind: no input may crash, every mesh must be closed and where the exact
// surface is, and the same one in whatever form it is asked for. Faults are shrunk and printed; keep them in
// property_regressions.h.
//   QUICKSES_PROPERTY_SETS        number of sets; default 2000
//   QUICKSES_PROPERTY_SEED        the first of their seeds; default 1. A seed gives the same set everywhere
//   QUICKSES_PROPERTY_FAMILY      only sets of this family
//   QUICKSES_PROPERTY_SHRUNK      how many faults are shrunk at most; default 20
//   QUICKSES_PROPERTY_PROCESSES   how many processes compute at a time; default 1. 0: this one (for memory checkers)
#include "properties/property_regressions.h"
#include "properties/property_shrink.h"

#include <gtest/gtest.h>

namespace {

using namespace properties;

#ifdef QUICKSES_PROPERTY_DEFAULT_SETS  // of builds with sanitizers, which are slow
constexpr uint64_t kDefaultSets = QUICKSES_PROPERTY_DEFAULT_SETS;
#else
constexpr uint64_t kDefaultSets = 2000;
#endif

Runner &runner() {
  static Runner runner(static_cast<unsigned>(number_from_environment("QUICKSES_PROPERTY_PROCESSES", 1)));
  return runner;
}

// What came out per family.
struct Tally {
  size_t sets = 0, vertices = 0, off = 0, coarse = 0, faults[static_cast<int>(Fault::kCount)] = {};
  uint64_t grown = 0, unplaced = 0;
  double worst = 0, worst_coarse = 0, longest_edge = 0, milliseconds = 0, slowest = 0;
  uint64_t worst_seed = 0, slowest_seed = 0;

  // Everything that is counted of one case.
  void add(const Case &c, const Verdict &v) {
    ++sets;
    vertices += v.vertices;
    grown += v.border_bricks > 0 ? 1 : 0;
    unplaced += v.unplaced;
    milliseconds += v.milliseconds;
    if (v.milliseconds > slowest) slowest = v.milliseconds, slowest_seed = c.seed;
    ++faults[static_cast<int>(v.fault)];
    longest_edge = std::max(longest_edge, v.edge);
    if (v.coarse) {
      ++coarse;
      worst_coarse = std::max(worst_coarse, v.error / static_cast<double>(c.settings.spacing));
    } else {
      off += v.error > 0.02 ? 1 : 0;
      if (v.error > worst) worst = v.error, worst_seed = c.seed;
    }
  }

  std::string line() const {
    char text[320];
    int used = std::snprintf(
        text, sizeof text,
        "%6zu sets %9zu vertices %6.1f ms each; worst %.2g Å (seed %llu), %zu above 0.02; longest edge %.1f", sets,
        vertices, sets ? milliseconds / static_cast<double>(sets) : 0, worst,
        static_cast<unsigned long long>(worst_seed), off, longest_edge);
    if (coarse)
      used += std::snprintf(text + used, sizeof text - size_t(used), "; %zu coarse, worst %.2g spacings", coarse,
                            worst_coarse);
    std::string out = std::string(text) + ";";
    if (grown > 0) out += " bricks added in " + std::to_string(grown) + " sets;";
    if (unplaced > 0) out += " " + std::to_string(unplaced) + " vertices without a feature;";
    for (int k = 1; k < static_cast<int>(Fault::kCount); ++k)
      if (faults[k]) out += " " + std::to_string(faults[k]) + " " + name_of(static_cast<Fault>(k)) + ",";
    if (sets == faults[0]) out += " no faults";
    return out;
  }
};

TEST(Properties, HoldForRandomSets) {
  const uint64_t sets = number_from_environment("QUICKSES_PROPERTY_SETS", kDefaultSets);
  const char *family = std::getenv("QUICKSES_PROPERTY_FAMILY");
  std::map<std::string, Tally> tallies;
  Tally all;
  struct Failed {
    Case c;
    Verdict verdict;
  };
  std::vector<Failed> failures;
  uint64_t seed = number_from_environment("QUICKSES_PROPERTY_SEED", 1), done = 0;
  while (done < sets) {
    std::vector<Case> cases;
    for (; cases.size() < runner().batch() && done + cases.size() < sets; ++seed)
      if (!family || !*family || std::string(family) == family_of(seed).name) cases.push_back(make_case(seed));
    const std::vector<Verdict> verdicts = runner().run(cases);
    for (size_t i = 0; i < cases.size(); ++i) {
      tallies[cases[i].family].add(cases[i], verdicts[i]);
      all.add(cases[i], verdicts[i]);
      if (!verdicts[i].good()) failures.push_back({cases[i], verdicts[i]});
    }
    done += cases.size();
  }

  // The first two of each family and kind are shrunk.
  std::map<std::pair<std::string, Fault>, int> seen;
  uint64_t to_shrink = number_from_environment("QUICKSES_PROPERTY_SHRUNK", 20);
  for (Failed &f : failures) {
    std::string input = "";
    if (++seen[{f.c.family, f.verdict.fault}] <= 2 && to_shrink > 0) {
      --to_shrink;
      input = "\n  " + row_of(Shrinker(runner()).shrink(f.c, f.verdict));
    }
    ADD_FAILURE() << f.c.family << ", seed " << f.c.seed << ": " << name_of(f.verdict.fault) << ": "
                  << f.verdict.sentence << input;
  }
  for (const auto &t : tallies) std::printf("property %-13s %s\n", t.first.c_str(), t.second.line().c_str());
  std::printf("property %-13s %s; slowest %.0f ms (seed %llu)\n", "all", all.line().c_str(), all.slowest,
              static_cast<unsigned long long>(all.slowest_seed));
}

// Atoms of the default radii as a file with three decimals has them, whose inflated spheres touch: two by two, along
// axes and aside, also a step of float off. Area and volume are those of the closed form.
TEST(Tangent, StandardRadiiWithThreeDecimals) {
  std::vector<Case> cases;
  for (qses_surface surface : {kSes, kSas, kVdw})
    for (double a : kStandardRadii)
      for (double b : kStandardRadii)
        for (const Point &way : {Point{1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0.6, -0.8, 0}, {0, 0.6, 0.8}}) {
          Case c;
          c.seed = cases.size() + 1;
          c.settings = surface_fixture::settings(0.5, 1.4, surface);
          c.settings.components = 1;
          const double d = a + b + (surface == kVdw ? 0 : 2.8), x = -8.516, y = 7.755, z = -44.339;
          const int steps[] = {0, 0, 0, 1, -1, 3, -40};
          c.atoms.add(x, y, z, a).add(x + d * way.x, y + d * way.y, z + d * way.z, b);
          c.atoms.radii[1] = stepped(c.atoms.radii[1], steps[cases.size() % 7]);
          cases.push_back(c);
        }
  const std::vector<Verdict> verdicts = runner().run(cases);
  for (size_t i = 0; i < cases.size(); ++i)
    EXPECT_TRUE(verdicts[i].good()) << name_of(verdicts[i].fault) << ": " << verdicts[i].sentence << "\n  "
                                    << row_of(cases[i]);
}

class Regressions : public testing::TestWithParam<Regression> {};

TEST_P(Regressions, Hold) {
  const Case c = case_of(GetParam());
  const Verdict v = runner().run(c);
  EXPECT_TRUE(v.good()) << name_of(v.fault) << ": " << v.sentence;
}

INSTANTIATE_TEST_SUITE_P(Inputs, Regressions, testing::ValuesIn(regressions()),
                         [](const testing::TestParamInfo<Regression> &info) { return info.param.name; });

}  // namespace
