// SPDX-License-Identifier: MIT
// Which edges merge, and in which round, against the rule told once more: all of it anew in each round, in double
// precision. Meshes of which a choice hangs on digits that single precision may lack are left out.
#include "surface/edge_merge_fixture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

namespace {

using namespace edge_merge_fixture;
using exact_reference::cross;
using exact_reference::dot;
using exact_reference::length;

constexpr double kH = static_cast<double>(kSpacing);

class Rule {
 public:
  explicit Rule(const CreasedSurface &s) : surface_(s) {
    for (size_t t = 0; t < s.mesh.triangle_count(); ++t)
      triangles_.push_back({s.mesh.indices[3 * t], s.mesh.indices[3 * t + 1], s.mesh.indices[3 * t + 2]});
    is_gone_.assign(triangles_.size(), false);
    around_.resize(s.mesh.vertex_count());
    for (uint32_t t = 0; t < triangles_.size(); ++t)
      for (uint32_t v : triangles_[t]) around_[v].insert(t);
    for (const auto &all : around_) degrees_.push_back(all.size());
    const size_t most = triangles_.size() / kPoorPart + 64;
    for (uint32_t t = 0; t < triangles_.size() && poor_.size() < most; ++t) {
      const Triangle &c = triangles_[t];
      if ((s.on_crease[c[0]] || s.on_crease[c[1]] || s.on_crease[c[2]]) &&
          exceeds(static_cast<double>(kPoorQuality), quality(c)))
        poor_.push_back(t);
    }
    for (uint32_t t : poor_)
      for (uint32_t v : shortest_edge(triangles_[t])) ends_.insert(v);
  }

  mesh_checks::Mesh merged() {
    for (int round = 0; round < kMergeRounds; ++round) merge_once();
    mesh_checks::Mesh out;
    std::vector<uint32_t> number(around_.size(), 0);
    for (uint32_t v = 0; v < around_.size(); ++v) {
      if (dropped_.count(v)) continue;
      number[v] = static_cast<uint32_t>(out.vertex_count());
      for (size_t k = 0; k < 3; ++k) out.positions.push_back(surface_.mesh.positions[3 * v + k]);
    }
    for (size_t t = 0; t < triangles_.size(); ++t)
      for (uint32_t v : triangles_[t])
        if (!is_gone_[t]) out.indices.push_back(number[v]);
    return out;
  }

  bool hangs_on_digits() const { return hangs_on_digits_; }

 private:
  using Triangle = std::array<uint32_t, 3>;
  using Edge = std::array<uint32_t, 2>;
  struct Merge {
    double gain;
    uint32_t leaving, staying;
  };

  static bool is_same_edge(const Merge &a, const Merge &b) {
    return std::minmax(a.leaving, a.staying) == std::minmax(b.leaving, b.staying);
  }
  // a > b, where rounding does not decide.
  bool exceeds(double a, double b) const {
    hangs_on_digits_ |= a != b && std::abs(a - b) < 3e-5;
    return a > b;
  }
  Point position(uint32_t v) const { return point(surface_.mesh.position(v)); }
  std::array<Point, 2> normals(uint32_t v) const {
    const auto load = [&](const std::vector<float> &n) {
      return Point{n[3 * size_t(v)], n[3 * size_t(v) + 1], n[3 * size_t(v) + 2]};
    };
    return {load(surface_.mesh.normals), load(surface_.second_normals)};
  }

  double quality(const Triangle &t) const {
    const Point x[3] = {position(t[0]), position(t[1]), position(t[2])}, normal = cross(x[1] - x[0], x[2] - x[0]);
    if (!(dot(normal, normal) > 1e-20)) return -8;
    double facing = 0.5, slim = 0;
    for (size_t k = 0; k < 3; ++k) {
      const Point a = x[(k + 1) % 3] - x[k], b = x[(k + 2) % 3] - x[k];
      slim = std::max(slim, dot(a, b) / (length(a) * length(b)) - static_cast<double>(kSlimCosine));
      const auto n = normals(t[k]);
      facing = std::min(facing, std::max(dot(normal, n[0]), dot(normal, n[1])) / length(normal));
    }
    return facing - 8 * slim;
  }
  Edge shortest_edge(const Triangle &t) const {
    size_t best = 0;
    const auto length_of = [&](size_t k) { return length(position(t[(k + 1) % 3]) - position(t[k])); };
    for (size_t k : {1u, 2u})
      if (exceeds(length_of(best), length_of(k))) best = k;
    return {t[best], t[(best + 1) % 3]};
  }
  double sagitta(uint32_t a, uint32_t b) const {
    double least = 1e9;
    for (const Point &m : normals(a))
      for (const Point &n : normals(b)) least = std::min(least, std::abs(dot(m - n, position(b) - position(a))) / 8);
    return least;
  }
  std::set<uint32_t> neighbors(uint32_t v) const {
    std::set<uint32_t> all;
    for (uint32_t t : around_[v]) all.insert(triangles_[t].begin(), triangles_[t].end());
    all.erase(v);
    return all;
  }
  static bool has(const Triangle &t, uint32_t v) { return std::find(t.begin(), t.end(), v) != t.end(); }

  // By how much the least quality around the edge grows; 0: the end may not go.
  double gain(uint32_t leaving, uint32_t staying) const {
    if (surface_.on_crease[leaving] && !surface_.on_crease[staying]) return 0;
    double before = 0.5, after = 0.5;
    for (uint32_t v : {leaving, staying})
      for (uint32_t t : around_[v]) {
        before = std::min(before, quality(triangles_[t]));
        if (has(triangles_[t], leaving) && has(triangles_[t], staying)) continue;
        Triangle then = triangles_[t];
        std::replace(then.begin(), then.end(), leaving, staying);
        after = std::min(after, quality(then));
        if (v == staying) continue;
        for (uint32_t u : triangles_[t])
          if (u != leaving && exceeds(sagitta(staying, u), std::max(sagitta(leaving, u), 0.1 * kH))) return 0;
      }
    return std::max(0.0, after - before);
  }

  bool find_merge(size_t i, Merge *merge) const {
    const uint32_t number = poor_[i];
    if (is_gone_[number]) return false;
    const Edge edge = shortest_edge(triangles_[number]);
    for (uint32_t v : edge)
      if (!ends_.count(v) || degrees_[v] > kMostAround) return false;
    if (exceeds(length(position(edge[1]) - position(edge[0])), static_cast<double>(kLongestMerge) * kH)) return false;
    const std::set<uint32_t> first = neighbors(edge[0]), second = neighbors(edge[1]);
    const auto common = std::count_if(first.begin(), first.end(), [&](uint32_t v) { return second.count(v) > 0; });
    if (common != 2 || (first.size() == 3 && second.size() == 3))
      return false;  // closed by two triangles, or not at all
    const double gains[2] = {gain(edge[0], edge[1]), gain(edge[1], edge[0])};
    const size_t leaving = exceeds(gains[1], gains[0]) ? 1 : 0;
    *merge = {gains[leaving], edge[leaving], edge[1 - leaving]};
    return exceeds(merge->gain, static_cast<double>(kLeastMergeGain));
  }

  void merge_once() {
    std::map<size_t, Merge> wanted;
    std::map<uint32_t, size_t> best;  // of a triangle, the merge that concerns it
    for (size_t i = 0; i < poor_.size(); ++i) {
      Merge merge{};
      if (!find_merge(i, &merge)) continue;
      wanted[i] = merge;
      for (uint32_t v : {merge.leaving, merge.staying})
        for (uint32_t t : around_[v]) {
          const auto known = best.emplace(t, i).first;
          const Merge &other = wanted[known->second];
          // Two edges may gain as much as each other, by the same triangle.
          hangs_on_digits_ |= merge.gain == other.gain && !is_same_edge(merge, other);
          if (exceeds(merge.gain, other.gain)) known->second = i;
        }
    }
    for (const auto &[i, merge] : wanted) {
      bool wins = true;
      for (uint32_t v : {merge.leaving, merge.staying})
        for (uint32_t t : around_[v]) wins &= best[t] == i;
      if (wins) merges_.push_back(merge);
    }
    for (const Merge &merge : merges_) apply(merge);
    merges_.clear();
  }

  void apply(const Merge &merge) {
    for (uint32_t t : std::set<uint32_t>(around_[merge.leaving])) {
      Triangle &c = triangles_[t];
      if (has(c, merge.staying)) {
        is_gone_[t] = true;
        for (uint32_t v : c) around_[v].erase(t);
        continue;
      }
      std::replace(c.begin(), c.end(), merge.leaving, merge.staying);
      around_[merge.staying].insert(t);
      ++degrees_[merge.staying];
    }
    around_[merge.leaving].clear();
    dropped_.insert(merge.leaving);
  }

  const CreasedSurface &surface_;
  std::vector<Triangle> triangles_;
  std::vector<bool> is_gone_;
  std::vector<std::set<uint32_t>> around_;
  std::vector<size_t> degrees_;  // with triangles that are gone
  std::vector<uint32_t> poor_;
  std::set<uint32_t> ends_, dropped_;
  std::vector<Merge> merges_;
  mutable bool hangs_on_digits_ = false;
};

// A vertex within every so many triangles, around which are three.
void put_vertices_within(CreasedSurface *s, unsigned seed, size_t every) {
  std::mt19937 random(seed);
  std::normal_distribution<float> moves(0.f, 0.05f);
  const size_t triangles = s->mesh.triangle_count();
  for (size_t t = random() % every; t < triangles; t += every) {
    const uint32_t v = static_cast<uint32_t>(s->mesh.vertex_count());
    const uint32_t c[3] = {s->mesh.indices[3 * t], s->mesh.indices[3 * t + 1], s->mesh.indices[3 * t + 2]};
    for (size_t d = 0; d < 3; ++d) {
      const auto at = [&](size_t k) { return s->mesh.positions[3 * size_t(c[k]) + d]; };
      s->mesh.positions.push_back((at(0) + at(1) + at(2)) / 3 + moves(random));
      s->mesh.normals.push_back(s->mesh.normals[3 * size_t(c[0]) + d]);
      s->second_normals.push_back(s->second_normals[3 * size_t(c[0]) + d]);
    }
    s->on_crease.push_back(s->on_crease[c[0]]);
    s->mesh.indices[3 * t + 2] = v;
    for (uint32_t corner : {c[1], c[2], v, c[2], c[0], v}) s->mesh.indices.push_back(corner);
  }
}

// Small tetrahedra beside the surface, with both sides of a crease at each vertex.
void add_tetrahedra(CreasedSurface *s, unsigned seed, int count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1, 1);
  for (int k = 0; k < count; ++k) {
    const uint32_t first = static_cast<uint32_t>(s->mesh.vertex_count());
    for (int corner = 0; corner < 4; ++corner) {
      for (int d = 0; d < 3; ++d)
        s->mesh.positions.push_back((d == 0 ? 100.f + 3.f * float(k) : 0.f) + 0.2f * unit(random));
      for (float n : {0.f, 0.f, 1.f}) s->mesh.normals.push_back(n), s->second_normals.push_back(-n);
      s->on_crease.push_back(1);
    }
    for (uint32_t corner : {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}) s->mesh.indices.push_back(first + corner);
  }
}

void expect_as_the_rule_says(const CreasedSurface &s, size_t *all) {
  size_t merges = 0;
  Rule rule(s);
  const mesh_checks::Mesh mesh = merged(s, &merges), expected = rule.merged();
  EXPECT_EQ(mesh_checks::manifold_fault(mesh), "");
  if (rule.hangs_on_digits()) return;
  EXPECT_TRUE(mesh.positions == expected.positions);
  EXPECT_TRUE(mesh.indices == expected.indices);
  *all += merges;
}

TEST(EdgeMergeRounds, AreThoseOfTheRule) {
  size_t merges = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    expect_as_the_rule_says(random_folds(seed, 0.04f * static_cast<float>(seed % 6 + 1)), &merges);
  }
  EXPECT_GT(merges, 200u);
}

// Some vertices come to be around which there are more triangles than may be known.
TEST(EdgeMergeRounds, OfVerticesWithFewTrianglesAndWithMany) {
  size_t merges = 0;
  for (unsigned seed = 1; seed <= 31; ++seed) {
    SCOPED_TRACE(seed);
    CreasedSurface s = random_folds(seed, 0.03f * static_cast<float>(seed % 6 + 1));
    for (unsigned k = 0; k <= seed % 4; ++k) put_vertices_within(&s, seed + k, 1 + (seed + k) % 3);
    expect_as_the_rule_says(s, &merges);
  }
  EXPECT_GT(merges, 200u);
}

TEST(EdgeMergeRounds, OfTrianglesWithoutArea) {
  size_t merges = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    CreasedSurface s = random_folds(seed, 0.02f);
    for (size_t t = seed % 7; t < s.mesh.triangle_count(); t += 23)
      for (size_t d = 0; d < 3; ++d)
        s.mesh.positions[3 * s.mesh.indices[3 * t] + d] = s.mesh.positions[3 * s.mesh.indices[3 * t + 1] + d];
    expect_as_the_rule_says(s, &merges);
  }
  EXPECT_GT(merges, 50u);
}

TEST(EdgeMergeRounds, LeaveTetrahedraAlone) {
  size_t merges = 0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    CreasedSurface s = random_folds(seed, 0.1f);
    add_tetrahedra(&s, seed, 60);
    expect_as_the_rule_says(s, &merges);
  }
  EXPECT_GT(merges, 50u);
}

}  // namespace
