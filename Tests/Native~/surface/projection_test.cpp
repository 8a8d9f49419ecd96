// SPDX-License-Identifier: MIT
// The rounds of a projection, stepped as the loops of both back ends do, among arcs at random.
#include "surface/stages/projection.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace {

using namespace quickses;

constexpr float kProbe = 1.4f;

struct Everything {
  int atoms, arcs;
  int atom_count() const { return atoms; }
  uint32_t atom(int k) const { return static_cast<uint32_t>(k); }
  int arc_count() const { return arcs; }
  uint32_t arc(int k) const { return static_cast<uint32_t>(k); }
};

// Small full circles near the origin, and an atom whose sphere is exposed all over, or one that all of this is deep in.
struct Scene {
  std::vector<Arc> arcs;
  Sphere atom{glm::vec3(0.f), 50.f};
  CapRange no_caps{0, 0};
  std::mt19937 random;

  Scene(unsigned seed, bool with_exposed_atom) : random(seed) {
    const int count = 1 + static_cast<int>(random() % 8);
    for (int k = 0; k < count; ++k) {
      const glm::vec3 middle = direction();
      const glm::vec3 side = glm::normalize(glm::cross(middle, direction()));
      arcs.push_back({point(1.8f), uniform(0.01f, 0.8f), middle, -1.f, side, 0.f});
    }
    if (with_exposed_atom) atom = {direction() * uniform(1.5f, 3.f), 3.f};
  }

  float uniform(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); }
  glm::vec3 point(float reach) {
    const float x = uniform(-reach, reach), y = uniform(-reach, reach);
    return {x, y, uniform(-reach, reach)};
  }
  glm::vec3 direction() { return glm::normalize(point(1.f) + glm::vec3(1e-3f)); }

  FeatureView view() const {
    FeatureView f{};
    f.atoms.items = &atom;
    f.atoms.count = 1;
    f.cap_ranges = &no_caps;
    f.arcs = arcs.data();
    f.parameters = {kProbe, kProbe, 1.5f, atom.radius};
    return f;
  }
  Everything candidates() const { return {1, static_cast<int>(arcs.size())}; }

  // Of a point to the nearest place of the probe on an arc, in double precision; arcs are full circles here.
  double distance(const Vec3<float> &x) const {
    double least = 1e30;
    for (const Arc &arc : arcs) {
      const Vec3<float> y = nearest_on_arc(arc, x).position;
      least =
          std::min(least, std::hypot(double(y.x) - double(x.x), double(y.y) - double(x.y), double(y.z) - double(x.z)));
    }
    return least;
  }
};

struct Outcome {
  Projection projection;
  int steps = 1;
};

Outcome project(const Scene &scene, const Vec3<float> &start) {
  const FeatureView f = scene.view();
  const Everything all = scene.candidates();
  const Vec3<float> up(0.f, 0.f, 1.f);
  if (starts_outside(f.parameters, deepest_atom(f, all, start)))
    return {{{start, up, up, QSES_PATCH_REENTRANT, false}, ProjectionState::kOnEdge, 0}};
  Outcome o{project_on_arc(f, nearest_arc(f, all, start), start)};
  while (o.projection.state == ProjectionState::kReproject) {
    o.projection = reproject(f, all, nearest_arc(f, all, o.projection.point.position), o.projection);
    if (++o.steps > 100) break;
  }
  return o;
}

TEST(Projection, EndsAfterTenRoundsAndNoProbeCoversAPlacedVertex) {
  std::array<int, kMaxProjections + 1> placed{}, given_up{};
  int crests = 0;
  for (unsigned seed = 0; seed < 20000; ++seed) {
    Scene scene(seed, false);
    const Outcome o = project(scene, Vec3<float>(scene.point(0.8f)));
    ASSERT_NE(o.projection.state, ProjectionState::kReproject) << seed;
    ASSERT_LE(o.steps, 10) << seed;
    ASSERT_TRUE(o.projection.rounds == o.steps || o.projection.rounds == o.steps + 1) << seed;
    const bool is_placed = o.projection.state == ProjectionState::kPlaced;
    ++(is_placed ? placed : given_up)[static_cast<size_t>(o.steps)];
    if (!is_placed) continue;
    ASSERT_TRUE(o.projection.point.placed) << seed;
    EXPECT_NEAR(scene.distance(o.projection.point.position), double(kProbe), 2e-4) << "seed " << seed;
    const SurfacePoint &s = o.projection.point;
    // Each normal leads to a probe that touches the vertex: on a crest to one of two.
    for (const Vec3<float> &n : {s.normal, s.second_normal}) {
      EXPECT_NEAR(length_squared(n), 1.f, 1e-4f) << seed;
      EXPECT_LT(scene.distance(s.position + n * kProbe), 2e-4) << seed;
    }
    if (!s.is_crest()) continue;
    ++crests;
    EXPECT_GT(length_squared(s.normal - s.second_normal), 0.99f * kSameSheet * kSameSheet) << seed;
  }
  for (int rounds = 1; rounds <= 10; ++rounds) EXPECT_GT(placed[static_cast<size_t>(rounds)], 0) << rounds;
  EXPECT_GT(crests, 1000);
  EXPECT_GT(given_up[10], 0);  // probes on all sides
}

TEST(Projection, AVertexThatLeftAProbeIsNotPlacedOverAContactPatch) {
  int beside = 0, on_patch = 0;
  for (unsigned seed = 0; seed < 20000; ++seed) {
    Scene scene(seed, true);
    const Outcome o = project(scene, Vec3<float>(scene.point(0.8f)));
    ASSERT_LE(o.steps, 10) << seed;
    if (o.steps < 3 || o.projection.state != ProjectionState::kPlaced) continue;
    const SurfacePoint &s = o.projection.point;
    const double depth =
        double(scene.atom.radius) - std::sqrt(double(length_squared(s.position - Vec3<float>(scene.atom.center))));
    EXPECT_GE(depth, double(kProbe) - 2e-4) << seed;
    ++(s.patch == QSES_PATCH_CONTACT ? on_patch : beside);
  }
  EXPECT_GT(beside, 0);
  EXPECT_GT(on_patch, 0);
}

// Where no ball is, a probe may be anywhere, and the way along an arc would lead off.
TEST(Projection, OutsideOfAllBallsTheEdgeDecides) {
  Scene scene(1, true);
  scene.arcs.assign(1, {glm::vec3(0.f), 1.f, glm::vec3(1, 0, 0), -1.f, glm::vec3(0, 1, 0), 0.f});
  scene.atom = {glm::vec3(0.f, 0.f, 20.f), 3.f};
  for (const Vec3<float> &start : {Vec3<float>(1.8f, 0.f, 0.f), {0.6f, 0.f, 0.8f}})
    EXPECT_EQ(project(scene, start).projection.state, ProjectionState::kOnEdge);
  scene.atom = {glm::vec3(0.f), 50.f};
  EXPECT_EQ(project(scene, Vec3<float>(0.6f, 0.f, 0.8f)).projection.state, ProjectionState::kPlaced);
  const SurfaceParameters ses{kProbe, kProbe, 0.5f, 3.f}, sas{kProbe, 0.f, 0.5f, 3.f};
  EXPECT_TRUE(starts_outside(ses, {0, -0.01f}));
  EXPECT_FALSE(starts_outside(ses, {0, 0.f}));     // within rounding of where the probe may be
  EXPECT_FALSE(starts_outside(sas, {0, -0.01f}));  // half of all starts of the balls themselves
}

TEST(Projection, WithoutAnArcTheEdgeDecides) {
  Scene scene(1, false);
  const FeatureView f = scene.view();
  EXPECT_EQ(project_on_arc(f, NearestArc(), Vec3<float>(0.f, 0.f, 0.f)).state, ProjectionState::kOnEdge);
}

TEST(Projection, OntoAnAtomTheWayInIsShort) {
  const SurfaceParameters p{kProbe, kProbe, 0.5f, 3.f};
  const Sphere ball{glm::vec3(0.f), 3.f};
  for (float out = -0.9f; out < 0.9f; out += 0.01f) {  // of the surface, which is at 1.6
    const Vec3<float> x(0.f, 1.6f + out, 0.f);
    const Projection v = project_on_atom(p, ball, ball_depth(ball, x), x);
    if (std::abs(out - 0.5f) < 1e-3f) continue;  // a spacing
    EXPECT_EQ(v.state, out < 0.5f ? ProjectionState::kPlaced : ProjectionState::kOnEdge) << out;
    EXPECT_NEAR(v.point.position.y, 1.6f, 1e-5f) << out;
  }
}

// Where the probe may be itself, the place there tells nothing of the direction.
TEST(Projection, OntoAnAtomFromItsInflatedSphere) {
  const SurfaceParameters p{kProbe, kProbe, 2.f, 3.f};
  const Sphere ball{glm::vec3(16.f, -3.f, 0.5f), 3.f};
  const Vec3<float> center(ball.center);
  for (const Vec3<float> &way : {Vec3<float>(0.f, -1.f, 0.f), {0.6f, 0.8f, 0.f}, {-0.48f, 0.64f, 0.6f}})
    for (float off : {0.f, 1e-6f, -1e-6f, 1e-5f, -1e-4f}) {
      const Vec3<float> x = center + way * (ball.radius + off);
      const Projection v = project_on_atom(p, ball, ball_depth(ball, x), x);
      ASSERT_EQ(v.state, ProjectionState::kPlaced) << off;
      const Vec3<float> aside = v.point.position - (center + way * (ball.radius - kProbe));
      EXPECT_LT(length_squared(aside), 1e-10f) << off;
      EXPECT_LT(length_squared(v.point.normal - way), 1e-10f) << off;
    }
}

}  // namespace
