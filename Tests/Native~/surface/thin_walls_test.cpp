// SPDX-License-Identifier: MIT
// Walls thinner than the spacing against a brute force: every lattice edge, in double precision.
#include "surface/exact_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <tuple>

namespace {

using namespace exact_fixture;
using surface_fixture::Atoms;
using surface_fixture::cluster;
using surface_fixture::settings;

using Place = std::tuple<int, int, int>;  // of a lattice point

// The bits of the active bricks' words that are set.
std::set<Place> points_of(const BrickSet &bricks, const std::vector<uint64_t> &words) {
  std::set<Place> points;
  for (uint32_t b = 0; b < bricks.count; ++b) {
    const glm::ivec3 first = bricks.lattice.first_point(bricks.place(b));
    for (int leaf = 0; leaf < kLeavesPerBrick; ++leaf)
      for (uint64_t w = words[size_t(b) * kLeavesPerBrick + size_t(leaf)]; w; w &= w - 1) {
        const glm::ivec3 p = first + brick_point(leaf, lowest_bit64(w));
        points.insert({p.x, p.y, p.z});
      }
  }
  return points;
}

std::vector<uint64_t> marks_of(ExactRun &run, const FeatureView &features, const BrickSet &bricks,
                               const std::vector<uint64_t> &signs, uint32_t per_slice) {
  std::vector<uint64_t> marks(signs.size(), 0);
  for (uint32_t first = 0; first < bricks.count; first += per_slice)
    mark_thin_walls(run.executor, features, bricks, {first, std::min(bricks.count, first + per_slice)}, signs.data(),
                    marks.data());
  return marks;
}

// The rule of candidates, a point at a time.
template <class Inside>
bool is_candidate(const Inside &inside, const glm::ivec3 &a, const glm::ivec3 &b) {
  if (inside(a) || inside(b)) return false;
  for (int k = 0; k < kNeighborhood; ++k) {
    const glm::ivec3 c = a + neighbor_step(k), away = glm::abs(c - b);
    if (std::max({away.x, away.y, away.z}) <= 1 && inside(c)) return true;
  }
  return false;
}

TEST(Words, TellTheirNthBit) {
  for (const uint64_t word :
       {~uint64_t(0), uint64_t(1), uint64_t(1) << 63, uint64_t(0x8000000180000001), uint64_t(0x123456789abcdef0)}) {
    int n = 0;
    for (int bit = 0; bit < 64; ++bit)
      if (word >> bit & 1) {
        EXPECT_EQ(nth_bit64(word, n++), bit) << word;
      }
    EXPECT_EQ(n, popcount64(word));
  }
}

TEST(WallCandidates, AreThoseOfTheRule) {
  std::mt19937_64 random(5);
  for (int round = 0; round < 60; ++round) {
    LeafNeighborhood words;
    for (uint64_t &w : words.at) {
      w = random();
      for (int k = 0; k < round % 5; ++k) w &= random();
      if (round % 7 == 6) w = 0;
    }
    const auto inside = [&](const glm::ivec3 &p) {  // from -4 to 7
      const int place = kOwnPlace + (p.x >> 2) + 3 * (p.y >> 2) + 9 * (p.z >> 2);
      return (words.at[place] >> leaf_bit(p.x & 3, p.y & 3, p.z & 3) & 1) != 0;
    };
    uint64_t edges[kWallSteps] = {};
    const bool found = find_wall_candidates(words, edges);
    bool any = false;
    for (int k = 0; k < kWallSteps; ++k)
      for (int bit = 0; bit < 64; ++bit) {
        const glm::ivec3 a(bit & 3, bit >> 2 & 3, bit >> 4);
        const bool expected = is_candidate(inside, a, a + wall_step(k));
        any = any || expected;
        ASSERT_EQ(found && (edges[k] >> bit & 1), expected) << "round " << round << " step " << k << " bit " << bit;
      }
    ASSERT_EQ(found, any);
  }
}

// What is sure about an edge between two points: nothing is within the boundary farther than the probe's radius, or
// something is, by more than rounding and more than a step.
enum class Edge { kOpen, kUnsure, kWall };
Edge judge(const exact_reference::Boundary &boundary, double probe, const Point &a, const Point &b) {
  constexpr double kLeast = 2e-3;  // on either side
  const Point ab = b - a;
  const double all = length(ab);
  Edge edge = Edge::kOpen;
  for (double s = 0; s <= all;) {  // distances change no faster than places
    const double distance = boundary.nearest(a + (s / all) * ab).distance;
    if (distance >= probe + kLeast) return Edge::kWall;
    if (distance > probe - kLeast) edge = Edge::kUnsure;
    s += std::max(probe - distance, kLeast);
  }
  return edge;
}

void check_marks(const Atoms &atoms, const qses_settings &s, size_t *walls) {
  for (const CpuKernels *kernels : usable_cpu_kernels()) {
    SCOPED_TRACE(testing::Message() << kernels->name << ", " << atoms.size() << " atoms, spacing " << s.spacing
                                    << ", probe " << s.probe_radius);
    ExactRun run(atoms, s, 2, *kernels);
    const FeatureView features = run.features();
    const BrickSet bricks = find_bricks(run.executor, features, run.lattice);
    const std::vector<uint64_t> signs = run.signs(features, bricks);
    const std::vector<uint64_t> marks = marks_of(run, features, bricks, signs, bricks.count);
    for (uint32_t per_slice : {1u, 3u}) ASSERT_EQ(marks_of(run, features, bricks, signs, per_slice), marks);
    for (size_t k = 0; k < signs.size(); ++k) ASSERT_EQ(signs[k] & marks[k], 0u) << "an inside point is marked";

    const double h = static_cast<double>(s.spacing), probe = static_cast<double>(s.probe_radius);
    const exact_reference::Boundary boundary(atoms, probe);
    const std::set<Place> inside_points = points_of(bricks, signs), marked = points_of(bricks, marks);
    const auto inside = [&](const glm::ivec3 &p) { return inside_points.count({p.x, p.y, p.z}) > 0; };
    const auto position = [&](const glm::ivec3 &p) { return run.to_caller(h * p.x, h * p.y, h * p.z); };
    std::map<Place, double> distances;
    const auto distance = [&](const glm::ivec3 &p) {
      const auto [found, is_new] = distances.insert({{p.x, p.y, p.z}, 0});
      if (is_new) found->second = boundary.nearest(position(p)).distance;
      return found->second;
    };
    std::set<Place> starts, explained;
    for (const Place &at : inside_points)
      for (int dz = -2; dz <= 2; ++dz)
        for (int dy = -2; dy <= 2; ++dy)
          for (int dx = -2; dx <= 2; ++dx)
            starts.insert({std::get<0>(at) + dx, std::get<1>(at) + dy, std::get<2>(at) + dz});
    size_t missed = 0;
    for (const Place &at : starts) {
      const glm::ivec3 a(std::get<0>(at), std::get<1>(at), std::get<2>(at));
      for (int k = 0; k < kWallSteps; ++k) {
        const glm::ivec3 b = a + wall_step(k);
        if (!is_candidate(inside, a, b)) continue;
        const double da = distance(a), db = distance(b);
        if (da + db + h * static_cast<double>(wall_step_length(k)) < 2 * probe - 1e-2) continue;  // sure to be open
        const Edge edge = judge(boundary, probe, position(a), position(b));
        if (edge == Edge::kOpen) continue;
        const Place pa{a.x, a.y, a.z}, pb{b.x, b.y, b.z};
        if (da > db - 1e-3) explained.insert(pa);
        if (db > da - 1e-3) explained.insert(pb);
        if (edge != Edge::kWall) continue;
        ++*walls;
        const bool is_marked = (da > db - 1e-3 && marked.count(pa)) || (db > da - 1e-3 && marked.count(pb));
        // A sign that rounding decides may be another one here.
        if (!is_marked && std::max(da, db) < probe - 1e-3 && ++missed < 4)
          ADD_FAILURE() << "the wall between " << a.x << " " << a.y << " " << a.z << " and step " << k << ": " << da
                        << ", " << db;
      }
    }
    EXPECT_EQ(missed, 0u);
    size_t needless = 0;
    for (const Place &p : marked) needless += explained.count(p) ? 0 : 1;
    EXPECT_EQ(needless, 0u) << "of " << marked.size() << " marked points have no edge through a wall";
  }
}

// An edge through balls on a line: what the walk takes for solid, against the intervals themselves.
TEST(WallWalks, FindWhatNoBallCovers) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> along(0.f, 1.f);
  int walls = 0, open = 0;
  for (int round = 0; round < 20000; ++round) {
    struct Interval {
      float from, to;
    };
    std::vector<Interval> balls = {{-1.f, 0.2f * along(random)}, {1.f - 0.2f * along(random), 2.f}};
    const int more = round % 5;
    for (int k = 0; k < more; ++k) {
      const float middle = along(random), half = 1.5f * along(random) / static_cast<float>(more);
      balls.push_back({middle - half, middle + half});
    }
    // The widest gap.
    std::vector<Interval> sorted = balls;
    std::sort(sorted.begin(), sorted.end(), [](const Interval &a, const Interval &b) { return a.from < b.from; });
    float gap = 0.f, covered = sorted[0].to;
    for (const Interval &ball : sorted) {
      gap = std::max(gap, ball.from - covered);
      covered = std::max(covered, ball.to);
    }
    WallWalk walk{balls[0].to, balls[1].from};
    bool solid = false;
    int looks = 0;
    for (; looks < kMostWallLooks && !walk.is_open() && !solid; ++looks) {
      const float at = walk.next(looks);
      const Interval *ball = nullptr;
      for (const Interval &b : balls)
        if (b.from <= at && at <= b.to) ball = &b;
      if (ball)
        walk.open(ball->from, ball->to);
      else
        solid = true;
    }
    SCOPED_TRACE(testing::Message() << "round " << round << ", gap " << gap);
    if (gap > 1.01f * kWallStep) {
      EXPECT_TRUE(solid);
      ++walls;
    } else if (gap == 0.f) {
      EXPECT_FALSE(solid);
      EXPECT_TRUE(walk.is_open());
      EXPECT_LE(looks, static_cast<int>(balls.size()) + kMiddleLooks);
      ++open;
    }
  }
  EXPECT_GT(walls, 1000);
  EXPECT_GT(open, 1000);
}

TEST(ThinWalls, AreFoundAndNothingElse) {
  size_t walls = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    check_marks(cluster(24, seed), settings(0.5), &walls);
    check_marks(cluster(12, 40 + seed), settings(0.9), &walls);
  }
  EXPECT_GT(walls, 100u);
}

TEST(ThinWalls, OfOtherProbesAndLooseAtoms) {
  size_t walls = 0;
  Atoms loose;
  std::mt19937 random(77);
  std::uniform_real_distribution<double> along(-5, 5);
  for (int k = 0; k < 14; ++k) loose.add(along(random), along(random), along(random), 1.0 + 0.1 * (k % 9));
  for (float probe : {0.7f, 2.5f}) {
    qses_settings s = settings(0.6);
    s.probe_radius = probe;
    check_marks(loose, s, &walls);
  }
  // The spacing is longer than the probe: points may lie outside of all inflated balls, and next to inside ones.
  qses_settings s = settings(1.3);
  s.probe_radius = 0.8f;
  check_marks(cluster(30, 9), s, &walls);
  EXPECT_GT(walls, 30u);
}

// A neck between two atoms that is thinner than the spacing: one piece wherever the lattice is.
TEST(ThinWalls, HoldANeckTogether) {
  const double atom = 1.7, probe = static_cast<double>(1.4f), h = 0.5, neck = 0.22;
  const double apart = 2 * std::sqrt((atom + probe) * (atom + probe) - (probe + neck) * (probe + neck));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(0, 1);
  for (int k = 0; k < 60; ++k) {
    // The lattice is anchored to the middle of the bounds of the atoms: a third one, far away, moves it.
    Atoms atoms;
    atoms.add(0, 0, 0, atom).add(k % 2 ? apart : apart * 0.6, 0, k % 2 ? 0 : apart * 0.8, atom);
    atoms.add(20 + part(random), 21 + part(random), 22 + part(random), 1.5);
    ExactRun run(atoms, settings(h));
    const mesh_checks::Mesh mesh = run.mesh();
    ASSERT_EQ(mesh_checks::manifold_fault(mesh), "");
    EXPECT_EQ(mesh_checks::piece_count(mesh), 2u) << "lattice " << k;
  }
}

TEST(ThinWalls, MeshesAreClosedAndTheSameOnThreadsAndSlices) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const Atoms atoms = cluster(60, 300 + seed);
    std::vector<float> positions;
    for (unsigned threads : {1u, 2u, 3u})
      for (uint32_t slice : {0u, 16u}) {
        qses_settings s = settings(seed % 2 ? 0.5 : 0.35);
        s.slice_size = slice;
        ExactRun run(atoms, s, threads);
        const mesh_checks::Mesh mesh = run.mesh();
        ASSERT_EQ(mesh_checks::manifold_fault(mesh), "");
        EXPECT_EQ(run.report.border_bricks, 0u) << "what is marked lies in the set of bricks";
        EXPECT_EQ(run.report.unplaced_vertices, 0u);
        if (positions.empty()) positions = mesh.positions;
        EXPECT_EQ(mesh.positions, positions) << threads << " threads, slices " << slice;
      }
  }
}

// Where no probe rolls there is nothing to mend, and no stage.
TEST(ThinWalls, AreOfSolventExcludedSurfacesOnly) {
  for (const qses_surface surface : {QSES_SURFACE_SES, QSES_SURFACE_SAS, QSES_SURFACE_VDW}) {
    qses_settings s = settings(0.6);
    s.surface = surface;
    ExactRun run(cluster(20, 8), s);
    run.mesh();
    EXPECT_EQ(run.parameters.has_thin_walls(), surface == QSES_SURFACE_SES);
  }
}

}  // namespace
