// SPDX-License-Identifier: MIT
// Which component each vertex is of, where components are, the mesh without cavities, and the atoms that line them: all
// against plain loops over the whole mesh.
#include "capi/capi_fixture.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <set>

namespace {

using namespace capi_fixture;

// Atoms all over a sphere: a closed shell.
Atoms &add_shell(Atoms &atoms, double x, double y, double z, int count, double radius) {
  const double kPi = std::acos(-1.0);
  for (int i = 0; i < count; ++i) {
    const double up = 1 - (2 * i + 1) / static_cast<double>(count), turn = kPi * (3 - std::sqrt(5.0)) * i;
    const double r = radius * std::sqrt(1 - up * up);
    atoms.add(x + r * std::cos(turn), y + r * std::sin(turn), z + radius * up, 1.7);
  }
  return atoms;
}

// Two hollow shells, one with an atom within its cavity, and an atom apart.
Atoms hollow() {
  Atoms atoms;
  add_shell(atoms, 30, -20, 10, 700, 7);
  add_shell(atoms, 0, 2, 5, 500, 6);
  return atoms.add(30.4, -19.8, 10.3, 1.9).add(15, 15, 15, 1.5);
}

struct Whole {
  std::vector<float> positions;
  std::vector<uint32_t> owners, indices, ids;
  std::vector<qses_component> components;
};

Whole copy(const qses_mesh &m) {
  Whole w;
  const uint32_t stride = m.vertex_bytes ? m.vertex_bytes : 12;
  w.positions.resize(3 * size_t(m.vertex_count));
  for (size_t v = 0; v < m.vertex_count; ++v)
    std::memcpy(&w.positions[3 * v], reinterpret_cast<const char *>(m.positions) + v * stride, 12);
  if (m.vertex_count > 0) {
    w.owners.assign(m.owners, m.owners + m.vertex_count);
    w.indices.assign(m.indices, m.indices + 3 * size_t(m.triangle_count));
  }
  if (m.component_ids) w.ids.assign(m.component_ids, m.component_ids + m.vertex_count);
  w.components.assign(m.components, m.components + m.component_count);
  return w;
}

// Components in the order of their first vertices, by joining the corners of triangles.
std::vector<uint32_t> joined(const Whole &w) {
  std::vector<uint32_t> parent(w.positions.size() / 3);
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (size_t k = 0; k < w.indices.size(); k += 3)
    for (size_t c = 1; c < 3; ++c) parent[root(w.indices[k])] = root(w.indices[k + c]);
  std::vector<uint32_t> number(parent.size(), ~0u), ids;
  uint32_t count = 0;
  for (uint32_t v = 0; v < parent.size(); ++v) {
    uint32_t &n = number[root(v)];
    if (n == ~0u) n = count++;
    ids.push_back(n);
  }
  return ids;
}

// Box to the last bit, centre by tetrahedra over the first vertex of the box.
void expect_places(const Whole &w, const std::vector<uint32_t> &ids, bool reversed) {
  for (uint32_t k = 0; k < w.components.size(); ++k) {
    const qses_component &c = w.components[k];
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t v = 0; v < ids.size(); ++v)
      for (size_t d = 0; d < 3 && ids[v] == k; ++d) {
        low[d] = std::min(low[d], w.positions[3 * v + d]);
        high[d] = std::max(high[d], w.positions[3 * v + d]);
      }
    double volume = 0, moment[3] = {0, 0, 0};
    uint64_t triangles = 0;
    for (size_t t = 0; t < w.indices.size(); t += 3) {
      if (ids[w.indices[t]] != k) continue;
      ++triangles;
      double p[3][3];
      for (size_t corner = 0; corner < 3; ++corner)
        for (size_t d = 0; d < 3; ++d)
          p[corner][d] =
              static_cast<double>(w.positions[3 * size_t(w.indices[t + corner]) + d]) - static_cast<double>(low[d]);
      const double v =
          (p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) - p[0][1] * (p[1][0] * p[2][2] - p[1][2] * p[2][0]) +
           p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0])) /
          6;
      volume += v;
      for (size_t d = 0; d < 3; ++d) moment[d] += v * (p[0][d] + p[1][d] + p[2][d]) / 4;
    }
    EXPECT_EQ(c.triangles, triangles);
    const bool is_hollow = (reversed ? -volume : volume) < 0;
    if (std::fabs(volume) > 1e-4)
      EXPECT_EQ(c.is_cavity != 0, is_hollow) << k;
    else  // it may be a speck that is turned inside out
      EXPECT_TRUE(is_hollow || !c.is_cavity) << k;
    double center[3];
    bool is_within = true;  // else the volume is next to nothing, and the centre is that of the box
    for (size_t d = 0; d < 3; ++d) {
      center[d] = static_cast<double>(low[d]) + moment[d] / volume;
      is_within = is_within && center[d] >= low[d] && center[d] <= high[d];
    }
    for (size_t d = 0; d < 3; ++d) {
      EXPECT_EQ(c.bounds_min[d], low[d]) << k;
      EXPECT_EQ(c.bounds_max[d], high[d]) << k;
      EXPECT_NEAR(c.center[d], is_within ? center[d] : 0.5 * (low[d] + high[d]), 1e-4) << k;
    }
    EXPECT_TRUE(is_within || std::fabs(volume) < 0.1) << volume;
  }
}

// What should stay of a mesh.
Whole filtered(const Whole &whole, const std::vector<uint8_t> &visible) {
  Whole out;
  out.components = whole.components;
  std::vector<uint32_t> number(whole.owners.size(), ~0u), kept;
  for (size_t t = 0; t < whole.indices.size(); t += 3) {
    bool stays = !whole.components[whole.ids[whole.indices[t]]].is_cavity;
    for (size_t c = 0; c < 3; ++c) stays = stays && visible[whole.owners[whole.indices[t + c]]];
    for (size_t c = 0; c < 3 && stays; ++c) {
      kept.push_back(whole.indices[t + c]);
      number[kept.back()] = 0;
    }
  }
  for (size_t v = 0; v < number.size(); ++v) {
    if (number[v] == ~0u) continue;
    number[v] = static_cast<uint32_t>(out.owners.size());
    out.positions.insert(out.positions.end(), &whole.positions[3 * v], &whole.positions[3 * v] + 3);
    out.owners.push_back(whole.owners[v]);
    out.ids.push_back(whole.ids[v]);
  }
  for (const uint32_t v : kept) out.indices.push_back(number[v]);
  return out;
}

void expect_equal(const Whole &a, const Whole &b) {
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.owners, b.owners);
  EXPECT_EQ(a.indices, b.indices);
  EXPECT_EQ(a.ids, b.ids);
  ASSERT_EQ(a.components.size(), b.components.size());
  for (size_t k = 0; k < a.components.size(); ++k)
    EXPECT_EQ(std::memcmp(&a.components[k], &b.components[k], sizeof(qses_component)), 0) << k;
}

qses_settings with_ids(qses_settings s) {
  s.component_ids = 1;
  return s;
}

TEST(ComponentIds, AreThoseOfConnectedPieces) {
  const Context context;
  const Atoms shells = hollow(), protein = crambin(), random = cluster(1500, 4);
  for (const Atoms *atoms : {&shells, &protein, &random}) {
    set_atoms(context, *atoms);
    for (int kind = 0; kind < 8; ++kind) {
      qses_settings s =
          with_ids(settings(kind % 2 ? 0.5 : 0.8, 1.4, static_cast<qses_surface>(kind == 7 ? 0 : kind % 3)));
      s.vertex_layout = static_cast<qses_vertex_layout>(kind % 3);
      s.winding = kind % 2 ? QSES_WINDING_REVERSED : QSES_WINDING_OUTWARD;
      if (kind == 7) s.method = QSES_METHOD_GRID;
      const qses_mesh m = compute_view(context, s);
      ASSERT_NE(m.component_ids, nullptr);
      const Whole w = copy(m);
      EXPECT_EQ(w.ids, joined(w));
      expect_places(w, w.ids, kind % 2 != 0);
    }
  }
}

TEST(ComponentIds, OnlyIfAskedFor) {
  const Context context;
  set_atoms(context, water());
  qses_settings s = settings();
  EXPECT_EQ(compute_view(context, s).component_ids, nullptr);
  s.components = 1;
  EXPECT_EQ(compute_view(context, s).component_ids, nullptr);
  s = settings();
  s.outer_only = 1;
  qses_mesh m = compute_view(context, s);
  EXPECT_EQ(m.component_ids, nullptr);
  EXPECT_EQ(m.component_count, 1u);
  m = compute_view(context, with_ids(settings()));
  EXPECT_EQ(m.component_count, 1u);
  ASSERT_NE(m.component_ids, nullptr);
  EXPECT_EQ(std::count(m.component_ids, m.component_ids + m.vertex_count, 0u), m.vertex_count);
  expect_ok(qses_set_atoms(context, nullptr, 0, nullptr, 0));
  m = compute_view(context, with_ids(settings()));
  EXPECT_EQ(m.component_count, 0u);
  EXPECT_EQ(m.component_ids, nullptr);
}

TEST(Components, OfASphereAreCentredOnIt) {
  const Context context;
  set_atoms(context, Atoms().add(-500.5, 300.25, 12, 2));
  for (const double spacing : {0.2, 2.0, 5.0}) {
    const qses_mesh m = compute_view(context, with_ids(settings(spacing)));
    for (uint32_t k = 0; k < m.component_count; ++k) {
      EXPECT_NEAR(m.components[k].center[0], -500.5, spacing < 1 ? 2e-3 : 2);
      EXPECT_NEAR(m.components[k].center[1], 300.25, spacing < 1 ? 2e-3 : 2);
      EXPECT_NEAR(m.components[k].center[2], 12, spacing < 1 ? 2e-3 : 2);
    }
  }
}

TEST(OuterOnly, DropsCavitiesAndNothingElse) {
  const Context context;
  const Atoms atoms = hollow();
  set_atoms(context, atoms);
  std::vector<uint8_t> all(atoms.size(), 1), some = all;
  for (size_t i = 0; i < some.size(); i += 3) some[i] = 0;
  for (int kind = 0; kind < 12; ++kind) {
    qses_settings s = with_ids(settings(kind % 2 ? 0.5 : 0.7));
    s.vertex_layout = static_cast<qses_vertex_layout>(kind % 3);
    s.winding = kind % 5 == 1 ? QSES_WINDING_REVERSED : QSES_WINDING_OUTWARD;
    if (kind % 4 == 3) s.method = QSES_METHOD_GRID;
    expect_ok(qses_set_visible(context, nullptr, atoms.size()));
    const Whole whole = copy(compute_view(context, s));
    const qses_report before = report_of(context);
    EXPECT_EQ(std::count_if(whole.components.begin(), whole.components.end(), [](auto &c) { return c.is_cavity; }), 2);
    ASSERT_EQ(whole.components.size(), 6u);  // two shells, their cavities, the atom in one of them, the atom apart
    const std::vector<uint8_t> &visible = kind < 6 ? all : some;
    expect_ok(qses_set_visible(context, visible.data(), visible.size()));
    s.outer_only = 1;
    const Whole expected = filtered(whole, visible);
    expect_equal(copy(compute_view(context, s)), expected);
    const qses_report report = report_of(context);
    EXPECT_EQ(report.area, before.area);
    EXPECT_EQ(report.volume, before.volume);
    EXPECT_EQ(report.hidden_vertices, whole.owners.size() - expected.owners.size());
    EXPECT_EQ(report.hidden_triangles, (whole.indices.size() - expected.indices.size()) / 3);
    if (kind >= 6) continue;
    if (s.vertex_layout == QSES_VERTICES_SEPARATE) {
      const Surface surface = copy_surface(context);
      EXPECT_EQ(mesh_checks::manifold_fault(surface.mesh), "");
      EXPECT_EQ(mesh_checks::piece_count(surface.mesh), whole.components.size() - 2);
    }
    // The numbers do not come with the mesh unless they are asked for; the rest is the same.
    s.component_ids = 0;
    Whole without = copy(compute_view(context, s));
    EXPECT_TRUE(without.ids.empty());
    without.ids = expected.ids;
    expect_equal(without, expected);
  }
}

// Slices, threads and budgets up to a mesh that is made in pieces: the same bytes.
TEST(OuterOnly, IsTheSameWithThreadsSlicesAndBudgets) {
  const Atoms atoms = hollow();
  std::vector<uint8_t> visible(atoms.size(), 1);
  std::fill_n(visible.begin(), 400, uint8_t(0));
  for (const bool masked : {false, true})
    for (const qses_method method : {QSES_METHOD_EXACT, QSES_METHOD_GRID}) {
      const auto prepare = [&](qses_context *context) {
        set_atoms(context, atoms);
        if (masked) expect_ok(qses_set_visible(context, visible.data(), visible.size()));
      };
      const Context unbounded;
      prepare(unbounded);
      qses_settings s = with_ids(settings(0.3));
      s.method = method;
      s.outer_only = 1;
      const Whole expected = copy(compute_view(unbounded, s));
      ASSERT_GT(expected.ids.size(), 0u);
      const qses_size_estimate e = estimate_of(unbounded, s);
      qses_settings sliced = s;
      sliced.slice_size = 16;
      expect_equal(copy(compute_view(unbounded, sliced)), expected);
      for (const unsigned threads : {1u, 3u}) {
        const Context other(threads);
        prepare(other);
        expect_equal(copy(compute_view(other, s)), expected);
      }
      for (const uint64_t more : {uint64_t(0), e.mesh_bytes / 2, 2 * e.mesh_bytes}) {
        const Context tight(2, e.smallest_budget + more);
        prepare(tight);
        expect_equal(copy(compute_view(tight, s)), expected);
        EXPECT_LE(report_of(tight).work_bytes_peak, e.smallest_budget + more);
      }
    }
}

TEST(ComponentAtoms, AreTheOwnersOfItsVertices) {
  const Context context;
  const Atoms atoms = hollow();
  set_atoms(context, atoms);
  const qses_mesh m = compute_view(context, with_ids(settings()));
  std::vector<std::set<uint32_t>> expected(m.component_count);
  for (uint32_t v = 0; v < m.vertex_count; ++v) expected[m.component_ids[v]].insert(m.owners[v]);
  std::vector<uint32_t> starts(m.component_count + 1, 77);
  expect_ok(qses_component_atoms(&m, starts.data(), nullptr, 0));
  std::vector<uint32_t> found(starts.back(), 77), again(m.component_count + 1);
  expect_error(qses_component_atoms(&m, starts.data(), found.data(), found.size() - 1), QSES_INVALID_ARGUMENT,
               {"room", std::to_string(found.size()).c_str()});
  EXPECT_EQ(found[0], 77u);
  expect_ok(qses_component_atoms(&m, again.data(), found.data(), found.size()));
  EXPECT_EQ(again, starts);
  EXPECT_EQ(starts[0], 0u);
  for (uint32_t k = 0; k < m.component_count; ++k)
    EXPECT_EQ(std::vector<uint32_t>(found.begin() + starts[k], found.begin() + starts[k + 1]),
              std::vector<uint32_t>(expected[k].begin(), expected[k].end()));
}

TEST(ComponentAtoms, RefuseWhatHasNoIds) {
  const Context context;
  set_atoms(context, water());
  qses_mesh m = compute_view(context, settings());
  uint32_t starts[8] = {9, 9, 9, 9, 9, 9, 9, 9};
  expect_error(qses_component_atoms(&m, starts, nullptr, 0), QSES_INVALID_ARGUMENT, {"component_ids"});
  expect_error(qses_component_atoms(nullptr, starts, nullptr, 0), QSES_INVALID_ARGUMENT, {"mesh"});
  expect_error(qses_component_atoms(&m, nullptr, nullptr, 0), QSES_INVALID_ARGUMENT, {"starts"});
  m.struct_size = 0;
  expect_error(qses_component_atoms(&m, starts, nullptr, 0), QSES_INVALID_ARGUMENT, {"struct_size"});
  EXPECT_EQ(starts[0], 9u);
  const qses_mesh nothing = empty_mesh();
  expect_ok(qses_component_atoms(&nothing, starts, nullptr, 0));
  EXPECT_EQ(starts[0], 0u);
}

TEST(ComponentAtoms, RefuseWhatHasNoOwners) {
  const Context context;
  set_atoms(context, crambin());
  qses_settings s = settings(1);
  s.component_ids = s.without_owners = 1;
  const qses_mesh mesh = compute_view(context, s);
  ASSERT_NE(mesh.component_ids, nullptr);
  std::vector<uint32_t> starts(mesh.component_count + 1);
  expect_error(qses_component_atoms(&mesh, starts.data(), nullptr, 0), QSES_INVALID_ARGUMENT, {"without_owners"});
}

}  // namespace
