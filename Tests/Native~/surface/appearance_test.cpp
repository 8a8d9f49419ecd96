// SPDX-License-Identifier: MIT
// Colours, texture coordinates, hidden atoms and vertex layouts through the C API.
#include "surface/surface_fixture.h"

#include <gtest/gtest.h>

#include <cstring>
#include <numeric>

using namespace surface_fixture;

namespace {

// A mesh in memory of our own, attribute by attribute.
struct Copy {
  std::vector<float> positions, normals, texcoords;
  std::vector<uint32_t> colors, owners, indices;
  std::vector<uint8_t> patches;
  uint32_t vertices = 0, triangles = 0;
};

template <class T>
std::vector<T> gather(const void *first, size_t count, size_t per_vertex, size_t stride) {
  std::vector<T> out(count * per_vertex);
  if (!first) return {};
  if (!stride) stride = per_vertex * sizeof(T);
  for (size_t v = 0; v < count; ++v)
    std::memcpy(&out[v * per_vertex], static_cast<const char *>(first) + v * stride, per_vertex * sizeof(T));
  return out;
}

// Those of the compact layout.
std::vector<float> unpacked_normals(const qses_mesh &m) {
  std::vector<float> normals;
  for (uint32_t v = 0; v < m.vertex_count; ++v) {
    int8_t packed[4];
    std::memcpy(packed, reinterpret_cast<const char *>(m.positions) + size_t(m.vertex_bytes) * v + 12, sizeof packed);
    EXPECT_EQ(packed[3], 0);
    for (int d = 0; d < 3; ++d) normals.push_back(static_cast<float>(packed[d]) / 127.f);
  }
  return normals;
}

Copy copy(const qses_mesh &m) {
  Copy c;
  c.vertices = m.vertex_count;
  c.triangles = m.triangle_count;
  c.positions = gather<float>(m.positions, m.vertex_count, 3, m.vertex_bytes);
  c.normals = gather<float>(m.normals, m.vertex_count, 3, m.vertex_bytes);
  if (m.positions && !m.normals) c.normals = unpacked_normals(m);
  c.texcoords = gather<float>(m.texcoords, m.vertex_count, 2, 0);
  c.colors = gather<uint32_t>(m.colors, m.vertex_count, 1, 0);
  c.owners = gather<uint32_t>(m.owners, m.vertex_count, 1, 0);
  c.patches = gather<uint8_t>(m.patches, m.vertex_count, 1, 0);
  c.indices = gather<uint32_t>(m.indices, m.triangle_count, 3, 0);
  return c;
}

std::vector<uint32_t> some_colors(size_t n) {
  std::mt19937 random(7);
  std::vector<uint32_t> colors(n);
  for (uint32_t &c : colors) c = static_cast<uint32_t>(random());
  return colors;
}

const uint8_t *bytes(const std::vector<uint32_t> &colors) { return reinterpret_cast<const uint8_t *>(colors.data()); }

// What should stay of a mesh, found with plain loops.
Copy filtered(const Copy &whole, const std::vector<uint8_t> &visible) {
  std::vector<uint32_t> kept;
  std::vector<uint8_t> used(whole.vertices, 0);
  for (size_t t = 0; t < whole.triangles; ++t) {
    const uint32_t *corner = &whole.indices[3 * t];
    if (!visible[whole.owners[corner[0]]] || !visible[whole.owners[corner[1]]] || !visible[whole.owners[corner[2]]])
      continue;
    for (int k = 0; k < 3; ++k) {
      kept.push_back(corner[k]);
      used[corner[k]] = 1;
    }
  }
  Copy out;
  std::vector<uint32_t> number(whole.vertices);
  for (uint32_t v = 0; v < whole.vertices; ++v) {
    if (!used[v]) continue;
    number[v] = out.vertices++;
    for (int k = 0; k < 3; ++k) {
      out.positions.push_back(whole.positions[3 * size_t(v) + k]);
      out.normals.push_back(whole.normals[3 * size_t(v) + k]);
    }
    for (int k = 0; k < 2 && !whole.texcoords.empty(); ++k) out.texcoords.push_back(whole.texcoords[2 * size_t(v) + k]);
    if (!whole.colors.empty()) out.colors.push_back(whole.colors[v]);
    if (!whole.patches.empty()) out.patches.push_back(whole.patches[v]);
    out.owners.push_back(whole.owners[v]);
  }
  out.triangles = static_cast<uint32_t>(kept.size() / 3);
  for (uint32_t v : kept) out.indices.push_back(number[v]);
  return out;
}

void expect_equal(const Copy &a, const Copy &b) {
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.texcoords, b.texcoords);
  EXPECT_EQ(a.colors, b.colors);
  EXPECT_EQ(a.owners, b.owners);
  EXPECT_EQ(a.patches, b.patches);
  EXPECT_EQ(a.indices, b.indices);
}

qses_settings interleaved(bool texcoords) {
  qses_settings s = settings(0.6);
  s.vertex_layout = QSES_VERTICES_INTERLEAVED;
  s.texcoords = texcoords ? 1 : 0;
  return s;
}

}  // namespace

TEST(VertexLayout, InterleavedHasTheSameValues) {
  for (const qses_method method : {QSES_METHOD_EXACT, QSES_METHOD_GRID})
    for (const uint32_t steps : {0u, 1u, 3u}) {
      const Context context;
      set_atoms(context, crambin());
      qses_settings s = settings(0.6);
      s.method = method;
      s.relaxation_steps = steps;
      const Copy separate = copy(compute_view(context, s));
      for (const bool texcoords : {false, true}) {
        s = interleaved(texcoords);
        s.method = method;
        s.relaxation_steps = steps;
        const qses_mesh mesh = compute_view(context, s);
        ASSERT_EQ(mesh.vertex_bytes, 24u);
        EXPECT_EQ(mesh.normals, mesh.positions + 3);
        EXPECT_EQ(mesh.colors, nullptr);
        Copy found = copy(mesh);
        ASSERT_EQ(found.texcoords.size(), texcoords ? 2 * size_t(mesh.vertex_count) : 0);
        if (texcoords)
          for (size_t v = 0; v < mesh.vertex_count; ++v) {
            ASSERT_EQ(found.texcoords[2 * v], 1.f);
            ASSERT_EQ(found.texcoords[2 * v + 1], 0.f);
          }
        found.texcoords.clear();
        expect_equal(found, separate);
      }
      // The compact one: the same but for what rounding does to the normals.
      s.texcoords = 0;
      s.vertex_layout = QSES_VERTICES_COMPACT;
      const qses_mesh mesh = compute_view(context, s);
      ASSERT_EQ(mesh.vertex_bytes, 16u);
      EXPECT_EQ(mesh.normals, nullptr);
      Copy compact = copy(mesh);
      ASSERT_EQ(compact.normals.size(), separate.normals.size());
      for (size_t k = 0; k < compact.normals.size(); ++k)
        ASSERT_NEAR(compact.normals[k], separate.normals[k], 0.5 / 127 + 1e-6);
      compact.normals = separate.normals;
      expect_equal(compact, separate);
    }
}

TEST(VertexLayout, SeparateHasOnlyWhatIsAskedFor) {
  const Context context;
  set_atoms(context, crambin());
  qses_mesh mesh = compute_view(context, settings(0.8));
  EXPECT_EQ(mesh.colors, nullptr);
  EXPECT_EQ(mesh.texcoords, nullptr);
  EXPECT_EQ(mesh.vertex_bytes, 0u);
  qses_settings s = settings(0.8);
  s.texcoords = 1;
  mesh = compute_view(context, s);
  EXPECT_EQ(mesh.colors, nullptr);
  ASSERT_NE(mesh.texcoords, nullptr);
  EXPECT_EQ(mesh.texcoords[0], 1.f);
}

// Small meshes and large ones, which go to the host in other ways, levels of jobs, and meshes that were made anew.
TEST(WithoutOwners, AllElseIsTheSame) {
  using Change = void (*)(qses_settings *);
  const Change changes[] = {
      [](qses_settings *) {},
      [](qses_settings *s) { s->spacing = 2; },
      [](qses_settings *s) { s->spacing = 0.25f, s->texcoords = s->component_ids = s->pickable = 1; },
      [](qses_settings *s) { s->vertex_layout = QSES_VERTICES_COMPACT; },
      [](qses_settings *s) { s->vertex_layout = QSES_VERTICES_INTERLEAVED, s->patch_types = 1; },
      [](qses_settings *s) { s->creases = s->hard_edges = s->atom_areas = 1; },
      [](qses_settings *s) { s->method = QSES_METHOD_GRID, s->outer_only = 1; },
      [](qses_settings *s) { s->surface = QSES_SURFACE_GAUSSIAN, s->occlusion = 1; },
  };
  const Atoms atoms = crambin();
  const std::vector<uint32_t> colors = some_colors(atoms.size());
  std::vector<uint8_t> visible(atoms.size(), 1);
  std::fill(visible.begin(), visible.begin() + 50, uint8_t(0));
  for (bool some_hidden : {false, true})
    for (size_t k = 0; k < std::size(changes); ++k) {
      SCOPED_TRACE(testing::Message() << "change " << k << (some_hidden ? ", some hidden" : ""));
      const Context context;
      set_atoms(context, atoms);
      expect_ok(qses_set_colors(context, bytes(colors), atoms.size()));
      if (some_hidden) expect_ok(qses_set_visible(context, visible.data(), visible.size()));
      qses_settings with = settings(0.5), without = with;
      changes[k](&with);
      changes[k](&without);
      without.without_owners = 1;
      const auto mesh_of = [&](const qses_settings &s, bool as_job) {
        if (!as_job) return compute_view(context, s);
        expect_ok(qses_begin(context, &s));
        expect_ok(qses_wait(context, -1, nullptr));
        qses_mesh mesh;
        qses_mesh_init(&mesh);
        expect_ok(qses_collect(context, &mesh));
        return mesh;
      };
      for (int frame = 0; frame < 3; ++frame) {  // the first waits for counts, the others go on with them
        Copy expected = copy(mesh_of(with, frame == 2));
        const qses_report report = report_of(context);
        const qses_mesh mesh = mesh_of(without, frame == 2);
        EXPECT_EQ(mesh.owners, nullptr);
        ASSERT_EQ(expected.owners.size(), expected.vertices);
        expected.owners.clear();
        expect_equal(copy(mesh), expected);
        EXPECT_EQ(report_of(context).area, report.area);
        // On the CPU they are made where the mesh is.
        const uint64_t left = tested_backend() == QSES_BACKEND_CUDA ? 4 * uint64_t(expected.vertices) : 0;
        EXPECT_EQ(report_of(context).mesh_bytes, report.mesh_bytes - left);
      }
      qses_size_estimate more, less;
      qses_size_estimate_init(&more);
      qses_size_estimate_init(&less);
      expect_ok(qses_estimate(context, &with, &more));
      expect_ok(qses_estimate(context, &without, &less));
      EXPECT_EQ(less.vertices, more.vertices);
      EXPECT_EQ(less.mesh_bytes,
                more.mesh_bytes - (tested_backend() == QSES_BACKEND_CUDA ? 4 * uint64_t(more.vertices) : 0));
    }
}

TEST(WithoutOwners, WithinASmallBudget) {
  const Context unbounded;
  set_atoms(unbounded, crambin());
  qses_settings s = settings(0.25);
  const Copy with = copy(compute_view(unbounded, s));
  s.without_owners = 1;
  const qses_size_estimate e = estimate_of(unbounded, s);
  const Context context(2, e.smallest_budget);
  set_atoms(context, crambin());
  Copy without = copy(compute_view(context, s));
  EXPECT_TRUE(without.owners.empty());
  without.owners = with.owners;
  expect_equal(without, with);
}

TEST(VertexLayout, UnknownIsRefused) {
  const Context context;
  set_atoms(context, crambin());
  qses_settings s = settings(0.8);
  const int32_t unknown = 3;
  std::memcpy(&s.vertex_layout, &unknown, sizeof unknown);
  EXPECT_EQ(qses_compute(context, &s, nullptr), QSES_INVALID_ARGUMENT);
  EXPECT_NE(std::string(qses_last_error()).find("vertex_layout"), std::string::npos);
}

TEST(Colors, AreThoseOfTheOwners) {
  const Context context;
  const Atoms atoms = crambin();
  set_atoms(context, atoms);
  std::vector<uint32_t> colors = some_colors(atoms.size());
  std::vector<float> uv(2 * atoms.size());
  std::iota(uv.begin(), uv.end(), 0.5f);
  expect_ok(qses_set_colors(context, bytes(colors), atoms.size()));
  expect_ok(qses_set_texcoords(context, uv.data(), atoms.size()));
  const std::vector<uint32_t> before = colors;
  colors.assign(colors.size(), 0);  // the library has its own copy
  for (qses_settings s : {settings(0.6), interleaved(true)}) {
    s.texcoords = 1;
    const Copy c = copy(compute_view(context, s));
    ASSERT_EQ(c.colors.size(), c.vertices);
    for (size_t v = 0; v < c.vertices; ++v) {
      ASSERT_EQ(c.colors[v], before[c.owners[v]]);
      ASSERT_EQ(c.texcoords[2 * v], uv[2 * c.owners[v]]);
      ASSERT_EQ(c.texcoords[2 * v + 1], uv[2 * c.owners[v] + 1]);
    }
  }
  expect_ok(qses_set_colors(context, nullptr, atoms.size()));
  EXPECT_EQ(compute_view(context, settings(0.8)).colors, nullptr);
}

TEST(Visible, DropsTrianglesOfHiddenAtoms) {
  const Atoms atoms = crambin();
  const Context context;
  set_atoms(context, atoms);
  const std::vector<uint32_t> colors = some_colors(atoms.size());
  expect_ok(qses_set_colors(context, bytes(colors), atoms.size()));
  std::mt19937 random(3);
  for (int trial = 0; trial < 12; ++trial) {
    qses_settings s = trial % 2 ? interleaved(trial % 4 == 1) : settings(0.6);
    if (trial == 9) s.vertex_layout = QSES_VERTICES_COMPACT;
    s.patch_types = trial % 3 == 0 ? 1 : 0;
    s.winding = trial % 5 == 0 ? QSES_WINDING_REVERSED : QSES_WINDING_OUTWARD;
    if (trial == 7) s.method = QSES_METHOD_GRID, s.patch_types = 0;
    std::vector<uint8_t> visible(atoms.size());
    for (size_t i = 0; i < visible.size(); ++i)
      visible[i] = trial < 6 ? random() % 4 != 0 : i < visible.size() / 2;  // holes, or the half of a molecule
    expect_ok(qses_set_visible(context, nullptr, atoms.size()));
    const Copy whole = copy(compute_view(context, s));
    const qses_report whole_report = report_of(context);
    expect_ok(qses_set_visible(context, visible.data(), atoms.size()));
    const qses_mesh mesh = compute_view(context, s);
    const Copy expected = filtered(whole, visible);
    ASSERT_LT(expected.triangles, whole.triangles);
    expect_equal(copy(mesh), expected);
    const qses_report report = report_of(context);
    EXPECT_EQ(report.hidden_vertices, whole.vertices - expected.vertices);
    EXPECT_EQ(report.hidden_triangles, whole.triangles - expected.triangles);
    EXPECT_EQ(report.area, whole_report.area);
    EXPECT_EQ(report.volume, whole_report.volume);
    for (int d = 0; d < 3; ++d) {
      float low = INFINITY, high = -INFINITY;
      for (size_t v = 0; v < expected.vertices; ++v) {
        low = std::min(low, expected.positions[3 * v + size_t(d)]);
        high = std::max(high, expected.positions[3 * v + size_t(d)]);
      }
      EXPECT_EQ(mesh.bounds_min[d], low);
      EXPECT_EQ(mesh.bounds_max[d], high);
    }
  }
}

TEST(Visible, NoneOrAll) {
  const Atoms atoms = crambin();
  const Context context;
  set_atoms(context, atoms);
  const Copy whole = copy(compute_view(context, settings(0.8)));
  expect_ok(qses_set_visible(context, std::vector<uint8_t>(atoms.size(), 1).data(), atoms.size()));
  expect_equal(copy(compute_view(context, settings(0.8))), whole);
  expect_ok(qses_set_visible(context, std::vector<uint8_t>(atoms.size(), 0).data(), atoms.size()));
  const qses_mesh none = compute_view(context, settings(0.8));
  EXPECT_EQ(none.vertex_count, 0u);
  EXPECT_EQ(none.triangle_count, 0u);
  EXPECT_EQ(none.bounds_max[0], 0.f);
}

TEST(Visible, WithinASmallBudget) {
  const Atoms atoms = crambin();
  std::vector<uint8_t> visible(atoms.size(), 1);
  std::fill(visible.begin(), visible.begin() + 100, uint8_t(0));
  const Context unbounded;
  set_atoms(unbounded, atoms);
  expect_ok(qses_set_visible(unbounded, visible.data(), visible.size()));
  const qses_settings s = settings(0.25);
  const Copy expected = copy(compute_view(unbounded, s));
  const qses_size_estimate e = estimate_of(unbounded, s);
  const Context context(2, e.smallest_budget);
  set_atoms(context, atoms);
  expect_ok(qses_set_visible(context, visible.data(), visible.size()));
  expect_equal(copy(compute_view(context, s)), expected);
}

TEST(Appearance, OfAJobIsThatOfItsBeginning) {
  const Atoms atoms = crambin();
  const Context context;
  set_atoms(context, atoms);
  std::vector<uint32_t> first = some_colors(atoms.size()), second(atoms.size(), 5);
  expect_ok(qses_set_colors(context, bytes(first), atoms.size()));
  const qses_settings s = settings(0.3);
  expect_ok(qses_begin(context, &s));
  for (int k = 0; k < 50; ++k) expect_ok(qses_set_colors(context, bytes(second), atoms.size()));
  const std::vector<uint8_t> hidden(atoms.size(), 0);
  expect_ok(qses_set_visible(context, hidden.data(), atoms.size()));
  expect_ok(qses_wait(context, -1, nullptr));
  qses_mesh mesh;
  qses_mesh_init(&mesh);
  expect_ok(qses_collect(context, &mesh));
  const Copy c = copy(mesh);
  ASSERT_GT(c.vertices, 0u);
  for (size_t v = 0; v < c.vertices; ++v) ASSERT_EQ(c.colors[v], first[c.owners[v]]);
}

TEST(Appearance, IsTakenBackByOtherAtoms) {
  const Atoms atoms = crambin();
  const Context context;
  EXPECT_EQ(qses_set_visible(context, nullptr, 3), QSES_NO_ATOMS);
  EXPECT_EQ(qses_set_colors(context, nullptr, 3), QSES_NO_ATOMS);
  set_atoms(context, atoms);
  const std::vector<uint32_t> colors = some_colors(atoms.size());
  EXPECT_EQ(qses_set_colors(context, bytes(colors), atoms.size() - 1), QSES_INVALID_ARGUMENT);
  EXPECT_NE(std::string(qses_last_error()).find("327"), std::string::npos) << qses_last_error();
  EXPECT_EQ(qses_set_texcoords(context, nullptr, 1), QSES_INVALID_ARGUMENT);
  expect_ok(qses_set_colors(context, bytes(colors), atoms.size()));
  set_atoms(context, atoms);
  EXPECT_NE(compute_view(context, settings(0.8)).colors, nullptr) << "as many atoms as before keep it";
  Atoms fewer;
  fewer.add(0, 0, 0, 1.5);
  set_atoms(context, fewer);
  EXPECT_EQ(compute_view(context, settings(0.8)).colors, nullptr);
}
