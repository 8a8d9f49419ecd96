// SPDX-License-Identifier: MIT
// A frame is what it is by itself, whatever the frames before it were like: on the GPU it may go on with what was
// counted in them (parallel/anticipation.h), which may be too little, or far too much.
#include "surface/exact_fixture.h"
#include "surface/surface_checks.h"

#include <iterator>

namespace {

using namespace surface_checks;

void expect_same(const Surface &a, const Surface &b) {
  expect_same_bytes(a, b);
  EXPECT_EQ(a.report.brick_count, b.report.brick_count);
  EXPECT_EQ(a.report.mesh_bytes, b.report.mesh_bytes);
  EXPECT_EQ(a.report.unplaced_vertices, b.report.unplaced_vertices);
  EXPECT_EQ(a.report.attempts, b.report.attempts);
}

// Breathing, then bursting apart, collapsing to almost a point, and as at first.
std::vector<Atoms> frames_of(const Atoms &atoms) {
  std::vector<Atoms> frames;
  for (double factor : {1.0, 1.0, 1.004, 0.997, 1.02, 1.0, 2.5, 2.5, 2.49, 6.0, 1.0, 0.02, 0.02, 1.0, 1.0, 40.0, 1.0})
    frames.push_back(scaled(atoms, factor));
  for (int k = 0; k < 4; ++k) frames.push_back(turned(atoms, 30.0 * k, -7.0 * k, 0));
  return frames;
}

void expect_each_as_by_itself(const std::vector<Atoms> &frames, const qses_settings &s) {
  const Context context;
  for (size_t k = 0; k < frames.size(); ++k) {
    SCOPED_TRACE("frame " + std::to_string(k));
    expect_same(compute(context, frames[k], s), compute(frames[k], s));
  }
}

TEST(FollowingFrames, OfASmallMolecule) { expect_each_as_by_itself(frames_of(cluster(60, 3)), settings()); }

TEST(FollowingFrames, OfALargerMolecule) { expect_each_as_by_itself(frames_of(cluster(3000, 4)), settings()); }

TEST(FollowingFrames, WithSomeMoreSteps) {
  const Atoms molecule = cluster(300, 5);
  using Change = void (*)(qses_settings *);
  const Change changes[] = {
      [](qses_settings *s) { s->surface = QSES_SURFACE_SAS; },
      [](qses_settings *s) { s->surface = QSES_SURFACE_VDW; },
      [](qses_settings *s) { s->relaxation_steps = 3; },
      [](qses_settings *s) { s->creases = 1; },
      [](qses_settings *s) { s->hard_edges = 1; },
      [](qses_settings *s) { s->components = s->component_ids = 1; },
      [](qses_settings *s) { s->pickable = 1; },
      [](qses_settings *s) { s->vertex_layout = QSES_VERTICES_INTERLEAVED; },
      [](qses_settings *s) { s->slice_size = 40; },
      [](qses_settings *s) { s->method = QSES_METHOD_GRID; },
      [](qses_settings *s) { s->spacing = 2.f; },
  };
  for (size_t k = 0; k < std::size(changes); ++k) {
    SCOPED_TRACE("change " + std::to_string(k));
    qses_settings s = settings();
    changes[k](&s);
    expect_each_as_by_itself(frames_of(molecule), s);
  }
}

// What is learnt of one surface must not be taken for another one's.
TEST(FollowingFrames, OfManyKindsInTurn) {
  const Context context;
  const Atoms molecules[] = {cluster(200, 6), cluster(200, 7), cluster(900, 8), Atoms().add(1, 2, 3, 1.7)};
  for (int round = 0; round < 3; ++round)
    for (const Atoms &atoms : molecules)
      for (const double spacing : {0.5, 1.0, 0.35})
        for (const double probe : {1.4, 0.7}) {
          const qses_settings s = settings(spacing, probe);
          expect_same(compute(context, atoms, s), compute(atoms, s));
        }
}

// Atoms by themselves, in the middle of bricks in one frame and where eight of them meet in another: there are far more
// bricks then, but hardly more vertices.
Atoms loose_atoms(double shift) {
  Atoms atoms;
  atoms.add(-80, -80, -80, 1.7).add(80, 80, 80, 1.7);  // the same box in all frames
  for (int k = 0; k < 512; ++k)
    atoms.add(shift + 16 * (k % 8) - 56, shift + 16 * (k / 8 % 8) - 56, shift + 16 * (k / 64) - 56, 1.7);
  return atoms;
}

TEST(FollowingFrames, WithMoreBricksButNotMoreVertices) {
  std::vector<Atoms> frames;
  for (const double shift : {0.0, 0.1, 2.0, 2.0, 0.2, 0.0, 2.1, 0.0}) frames.push_back(loose_atoms(shift));
  const Surface few = compute(frames[0], settings()), many = compute(frames[2], settings());
  ASSERT_GT(many.report.brick_count, few.report.brick_count / 5 * 6) << "nothing would be tested";
  ASSERT_LT(many.vertex_count(), few.vertex_count() / 50 * 51) << "nothing would be tested";
  expect_each_as_by_itself(frames, settings());
}

// As many bricks and triangles, but seven times as many of these in the first bricks, or a seventh: those that a GPU
// has sent by then. Of the balls in the middle of a brick there is one in each, of the others an eighth.
TEST(FollowingFrames, WithMoreOrLessInTheFirstBricks) {
  const auto middles_first = [](bool first) {
    Atoms atoms;
    for (int k = 0; k < 14 * 14 * 8; ++k) {
      const int layer = k / (14 * 14);
      const double shift = (layer < 4) == first ? 2 : 0;
      atoms.add(8 * (k % 14) + shift, 8 * (k / 14 % 14) + shift, 8 * layer + shift, 0.7);
    }
    return atoms;
  };
  std::vector<Atoms> frames;
  for (bool first : {true, true, false, false, true, true, false}) frames.push_back(middles_first(first));
  const Surface surface = compute(frames[0], settings(0.5, 0.3));
  EXPECT_EQ(surface.report.brick_count, 14 * 14 * 4 * (1 + 8)) << "not what is tested here";
  expect_each_as_by_itself(frames, settings(0.5, 0.3));
}

// A circle around two large balls that many small ones cut: on the GPU its intervals are in memory.
TEST(FollowingFrames, WithCirclesInManyPieces) {
  Atoms atoms;
  atoms.add(0, 0, -1, 3.2).add(0, 0, 1, 3.2);
  for (int k = 0; k < 12; ++k) atoms.add(5.5 * std::cos(0.5236 * k), 5.5 * std::sin(0.5236 * k), 0.1, 0.3);
  expect_each_as_by_itself(std::vector<Atoms>(10, atoms), settings(0.5, 0.3));
}

// Levels, some of which a job before has made of atoms that are much the same.
TEST(FollowingFrames, OfLadders) {
  const std::vector<Atoms> frames = frames_of(cluster(400, 9));
  const Context context;
  for (size_t k = 0; k < frames.size(); ++k) {
    SCOPED_TRACE("frame " + std::to_string(k));
    qses_settings s = settings();
    s.level_count = k % 3;
    s.levels[0] = 2.f;
    s.levels[1] = 1.f;
    expect_same(finest_of_job(context, frames[k], s), finest_of_job(Context(), frames[k], s));
  }
}

}  // namespace
