// SPDX-License-Identifier: MIT
// Meshes that are kept for longer than their contexts keep them: what they hold, whose memory it is, painting and
// filtering. Picking has a test of its own.
#include "capi/kept_mesh_fixture.h"

#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>

using namespace kept_mesh_fixture;

namespace {

qses_settings all_attributes() {
  qses_settings s = settings(0.7);
  s.components = s.patch_types = s.texcoords = s.pickable = 1;
  s.tag = 42;
  return s;
}

// All that a mesh holds, in memory of our own.
struct Copy {
  std::vector<float> positions, normals;
  std::vector<uint32_t> owners, indices;
  std::vector<uint8_t> patches;
  std::vector<uint64_t> component_triangles;

  explicit Copy(const qses_mesh &m)
      : positions(m.positions, m.positions + 3 * m.vertex_count),
        normals(m.normals, m.normals + 3 * m.vertex_count),
        owners(m.owners, m.owners + m.vertex_count),
        indices(m.indices, m.indices + 3 * m.triangle_count),
        patches(m.patches, m.patches + (m.patches ? m.vertex_count : 0)) {
    for (uint32_t k = 0; k < m.component_count; ++k) component_triangles.push_back(m.components[k].triangles);
  }
  bool operator==(const Copy &o) const {
    return positions == o.positions && normals == o.normals && owners == o.owners && indices == o.indices &&
           patches == o.patches && component_triangles == o.component_triangles;
  }
};

TEST(KeptMesh, IsTheMeshThatWasComputed) {
  const Context context;
  set_atoms(context, crambin());
  const qses_mesh mesh = compute_view(context, all_attributes());
  const Copy before(mesh);
  const qses_report report = report_of(context);
  ASSERT_GT(mesh.component_count, 0u);
  const Kept kept;
  expect_ok(qses_keep(context, kept));
  const qses_mesh view = kept.view();
  EXPECT_EQ(view.positions, mesh.positions) << "nothing is copied";
  EXPECT_EQ(view.vertex_count, mesh.vertex_count);
  EXPECT_EQ(view.tag, 42u);
  EXPECT_EQ(view.spacing, 0.7f);
  EXPECT_EQ(view.bounds_max[1], mesh.bounds_max[1]);
  EXPECT_TRUE(Copy(view) == before);
  qses_report kept_report;
  qses_report_init(&kept_report);
  expect_ok(qses_kept_mesh_report(kept, &kept_report));
  EXPECT_EQ(kept_report.area, report.area);
  EXPECT_EQ(kept_report.mesh_bytes, report.mesh_bytes);

  qses_mesh none = empty_mesh();
  expect_error(qses_context_mesh(context, &none), QSES_NO_RESULT, {"kept"});
  expect_error(qses_context_report(context, &kept_report), QSES_NO_RESULT, {});
  expect_error(qses_keep(context, kept), QSES_NO_RESULT, {"kept"});
  EXPECT_EQ(kept.view().positions, mesh.positions) << "an error takes nothing away";
  // What is computed afterwards is somewhere else.
  const qses_mesh next = compute_view(context, settings(0.5));
  EXPECT_NE(next.positions, mesh.positions);
  EXPECT_TRUE(Copy(kept.view()) == before);
}

TEST(KeptMesh, OutlivesItsContext) {
  const Kept kept;
  auto context = std::make_unique<Context>();
  set_atoms(*context, crambin());
  const Copy before(compute_view(*context, all_attributes()));
  expect_ok(qses_keep(*context, kept));
  context.reset();
  EXPECT_TRUE(Copy(kept.view()) == before);
  // Filled again from another one, and that one first to go.
  context = std::make_unique<Context>();
  set_atoms(*context, water());
  const uint32_t vertices = compute_view(*context, settings()).vertex_count;
  expect_ok(qses_keep(*context, kept));
  EXPECT_EQ(kept.view().vertex_count, vertices);
  context.reset();
  std::thread([&] { qses_kept_mesh_clear(kept); }).join();
  EXPECT_EQ(kept.view().vertex_count, 0u);
}

TEST(KeptMesh, MemoryGoesRound) {
  const Context context;
  set_atoms(context, crambin());
  const Kept kept;
  std::vector<const float *> places;
  for (int k = 0; k < 20; ++k) {
    places.push_back(compute_view(context, settings()).positions);
    expect_ok(qses_keep(context, kept));
  }
  std::sort(places.begin(), places.end());
  EXPECT_LE(std::unique(places.begin(), places.end()) - places.begin(), 2);
}

TEST(KeptMesh, SpareMemoryIsBounded) {
  const Context context;
  set_atoms(context, crambin());
  const qses_settings s = settings(0.4);
  constexpr uint64_t kMeshes = 40;
  uint64_t mesh_bytes = 0, before = 0;
  {
    std::vector<std::unique_ptr<Kept>> all;
    for (uint64_t k = 0; k < kMeshes; ++k) {
      compute_view(context, s);
      mesh_bytes = report_of(context).mesh_bytes;
      if (k == 0) before = report_of(context).host_bytes_peak;
      all.push_back(std::make_unique<Kept>());
      expect_ok(qses_keep(context, *all.back()));
    }
    compute_view(context, s);
    EXPECT_GE(report_of(context).host_bytes_peak, before + kMeshes * mesh_bytes) << "what is kept is reported";
  }
  compute_view(context, s);
  EXPECT_LE(report_of(context).host_bytes_peak, before + 5 * (mesh_bytes + mesh_bytes / 8 + 8192));
}

// A buffer that was made for a large mesh does not go away with a small one.
TEST(KeptMesh, SmallOnesTakeLittleMemory) {
  const Context context;
  set_atoms(context, crambin());
  compute_view(context, settings(0.15));
  const uint64_t large = report_of(context).mesh_bytes, before = report_of(context).host_bytes_peak;
  set_atoms(context, water());
  std::vector<std::unique_ptr<Kept>> all;
  for (int k = 0; k < 30; ++k) {
    compute_view(context, settings(1.0));
    all.push_back(std::make_unique<Kept>());
    expect_ok(qses_keep(context, *all.back()));
  }
  compute_view(context, settings(1.0));
  EXPECT_LE(report_of(context).host_bytes_peak, before + large);
}

TEST(KeptMesh, LevelsAreKeptWhileAJobGoesOn) {
  const Context context;
  set_atoms(context, cluster(3000, 4));
  qses_settings s = settings(0.4);
  s.levels[0] = 1.6f;
  s.levels[1] = 0.8f;
  expect_ok(qses_begin(context, &s));
  const Kept kept[3];
  uint32_t levels = 0;
  for (qses_bool finished = 0; !finished;) {
    expect_ok(qses_wait(context, 1, &finished));
    qses_mesh mesh = empty_mesh();
    if (qses_collect(context, &mesh) != QSES_OK) continue;
    const uint32_t vertices = mesh.vertex_count;
    ASSERT_LT(levels, 3u);
    expect_ok(qses_keep(context, kept[levels]));
    EXPECT_EQ(kept[levels].view().vertex_count, vertices);
    ++levels;
  }
  ASSERT_GE(levels, 1u);
  EXPECT_EQ(kept[levels - 1].view().level, 2u);
  // All of them are as they were made.
  for (uint32_t k = 0; k < levels; ++k) {
    s.spacing = kept[k].view().spacing;
    s.level_count = 0;
    const qses_mesh mesh = compute_view(context, s);
    EXPECT_EQ(mesh.vertex_count, kept[k].view().vertex_count);
  }
}

TEST(KeptMesh, EmptyOnesAreFine) {
  const Kept kept;
  EXPECT_EQ(kept.view().vertex_count, 0u);
  EXPECT_EQ(kept.view().positions, nullptr);
  qses_report report;
  qses_report_init(&report);
  expect_error(qses_kept_mesh_report(kept, &report), QSES_NO_RESULT, {});
  qses_kept_mesh_clear(kept);
  const Context context;
  expect_error(qses_keep(context, kept), QSES_NO_RESULT, {});
  expect_ok(qses_set_atoms(context, nullptr, 0, nullptr, 0));
  compute_view(context, all_attributes());
  expect_ok(qses_keep(context, kept));
  expect_ok(qses_kept_mesh_report(kept, &report));
  EXPECT_EQ(kept.view().vertex_count, 0u);
  uint32_t triangles = 7;
  expect_ok(qses_kept_mesh_paint(kept, nullptr, 4, 0, 0, 0, nullptr));
  expect_ok(qses_kept_mesh_filter(kept, nullptr, 0, 0, 0, nullptr, &triangles));
  EXPECT_EQ(triangles, 0u);
  qses_kept_mesh_clear(kept);
  expect_error(qses_kept_mesh_report(kept, &report), QSES_NO_RESULT, {"nothing is kept"});
  qses_kept_mesh_clear(nullptr);
  qses_kept_mesh_destroy(nullptr);
}

TEST(KeptMesh, NothingIsKeptOfNone) {
  const Context context;
  set_atoms(context, crambin());
  qses_settings s = all_attributes();
  s.delivery = QSES_DELIVERY_NONE;
  compute_view(context, s);
  const Kept kept;
  expect_error(qses_keep(context, kept), QSES_INVALID_ARGUMENT, {"NONE"});
  expect_error(qses_kept_mesh_download(kept), QSES_NO_RESULT, {"nothing is kept"});
  expect_error(qses_kept_mesh_download(nullptr), QSES_INVALID_ARGUMENT, {"kept is NULL"});
  s.delivery = QSES_DELIVERY_HOST;
  const Copy before(compute_view(context, s));
  expect_ok(qses_keep(context, kept));
  expect_ok(qses_kept_mesh_download(kept));  // it is there already
  EXPECT_TRUE(Copy(kept.view()) == before);
}

TEST(KeptMesh, ComesFromTheDeviceWhenAskedFor) {
  if (tested_backend() != QSES_BACKEND_CUDA) GTEST_SKIP() << "there is no device";
  auto context = std::make_unique<Context>();
  set_atoms(*context, crambin());
  qses_settings s = all_attributes();
  const Copy expected(compute_view(*context, s));
  for (const qses_delivery delivery : {QSES_DELIVERY_DEVICE, QSES_DELIVERY_BOTH}) {
    s.delivery = delivery;
    compute_view(*context, s);
    const Kept kept;
    expect_ok(qses_keep(*context, kept));
    EXPECT_EQ(kept.view().vertex_count > 0 && !kept.view().positions, delivery == QSES_DELIVERY_DEVICE);
    for (int frame = 0; frame < 4; ++frame) compute_view(*context, s);
    if (delivery == QSES_DELIVERY_BOTH) context.reset();  // what is kept lives on
    expect_ok(qses_kept_mesh_download(kept));
    EXPECT_TRUE(Copy(kept.view()) == expected);
  }
}

// ---- painting

template <size_t kWords>
void expect_painted(const qses_kept_mesh *kept, const qses_mesh &mesh, size_t atoms) {
  std::vector<std::array<uint32_t, kWords>> values(atoms), painted(mesh.vertex_count + 1);
  std::mt19937 random(kWords);
  for (auto &value : values)
    for (uint32_t &word : value) word = static_cast<uint32_t>(random());
  const std::array<uint32_t, kWords> untouched = {7};
  painted.back() = untouched;
  const uint32_t third = mesh.vertex_count / 3;
  for (const auto &run : {std::pair<uint32_t, uint32_t>{0, third}, {third, 0}, {third, mesh.vertex_count - third}})
    expect_ok(qses_kept_mesh_paint(kept, values.data(), 4 * kWords, atoms, run.first, run.second, &painted[run.first]));
  for (uint32_t v = 0; v < mesh.vertex_count; ++v) ASSERT_EQ(painted[v], values[mesh.owners[v]]);
  EXPECT_EQ(painted.back(), untouched);
}

TEST(KeptMesh, PaintGivesVerticesWhatTheirAtomsHave) {
  const Atoms atoms = crambin();
  const KeptSurface kept(atoms);
  const qses_mesh mesh = kept.view();
  expect_painted<1>(kept, mesh, atoms.size());
  expect_painted<2>(kept, mesh, atoms.size());
  expect_painted<3>(kept, mesh, atoms.size());
  expect_painted<4>(kept, mesh, atoms.size());
}

TEST(KeptMesh, PaintGivesTheColoursThatAComputationGives) {
  const Context context;
  const Atoms atoms = crambin();
  set_atoms(context, atoms);
  std::vector<uint8_t> rgba(4 * atoms.size());
  for (size_t k = 0; k < rgba.size(); ++k) rgba[k] = static_cast<uint8_t>(37 * k + k / 256);
  expect_ok(qses_set_colors(context, rgba.data(), atoms.size()));
  const qses_mesh computed = compute_view(context, settings());
  const std::vector<uint8_t> expected(computed.colors, computed.colors + 4 * size_t(computed.vertex_count));
  const Kept kept;
  expect_ok(qses_keep(context, kept));
  std::vector<uint8_t> painted(expected.size());
  expect_ok(qses_kept_mesh_paint(kept, rgba.data(), 4, atoms.size(), 0, computed.vertex_count, painted.data()));
  EXPECT_EQ(painted, expected);
}

// ---- filtering

TEST(KeptMesh, FilterLeavesTrianglesOfVisibleAtoms) {
  const Atoms atoms = crambin();
  const KeptSurface kept(atoms);
  const qses_mesh mesh = kept.view();
  for (unsigned seed = 0; seed < 5; ++seed) {
    std::vector<uint8_t> visible = some_visible(atoms.size(), seed);
    if (seed == 3) std::fill(visible.begin(), visible.end(), uint8_t(0));
    if (seed == 4) std::fill(visible.begin(), visible.end(), uint8_t(200));
    std::vector<uint32_t> expected, found;
    for (uint32_t t = 0; t < mesh.triangle_count; ++t)
      if (is_shown(mesh, t, visible.data()))
        expected.insert(expected.end(), mesh.indices + 3 * size_t(t), mesh.indices + 3 * size_t(t) + 3);
    const uint32_t piece = mesh.triangle_count / 7 + 1;
    std::vector<uint32_t> room(3 * size_t(piece) + 1);
    for (uint32_t first = 0; first < mesh.triangle_count; first += piece) {
      const uint32_t count = std::min(piece, mesh.triangle_count - first);
      room[3 * size_t(count)] = 12345;
      uint32_t triangles = 0;
      expect_ok(qses_kept_mesh_filter(kept, visible.data(), atoms.size(), first, count, room.data(), &triangles));
      EXPECT_EQ(room[3 * size_t(count)], 12345u);
      found.insert(found.end(), room.begin(), room.begin() + 3 * std::ptrdiff_t(triangles));
    }
    EXPECT_EQ(found, expected);
    EXPECT_EQ(expected.empty(), seed == 3);
  }
}

// ---- errors

TEST(KeptMesh, OneIsSingular) {
  const Context context;
  const Atoms atoms = Atoms().add(0, 0, 0, 1);
  const KeptSurface kept(atoms);
  const uint8_t visible[2] = {1, 1};
  uint32_t triangles = 0, room[3];
  EXPECT_EQ(qses_kept_mesh_filter(kept, visible, 2, 0, 0, room, &triangles), QSES_INVALID_ARGUMENT);
  EXPECT_STREQ(qses_last_error(), "atom_count is 2 but the mesh was made of 1 atom");
}

TEST(KeptMesh, WrongArgumentsAreNamed) {
  const Context context;
  const Atoms atoms = water();
  const KeptSurface kept(atoms);
  const qses_mesh mesh = kept.view();
  const uint32_t v = mesh.vertex_count, t = mesh.triangle_count;
  std::vector<uint32_t> values(4 * atoms.size()), room(3 * size_t(std::max(v, t)));
  const std::vector<uint8_t> visible(atoms.size(), 1);
  uint32_t triangles = 0;

  expect_error(qses_kept_mesh_create(nullptr), QSES_INVALID_ARGUMENT, {"kept"});
  expect_error(qses_keep(nullptr, kept), QSES_INVALID_ARGUMENT, {"context"});
  expect_error(qses_keep(context, nullptr), QSES_INVALID_ARGUMENT, {"kept"});
  expect_error(qses_kept_mesh_view(nullptr, nullptr), QSES_INVALID_ARGUMENT, {"kept"});
  expect_error(qses_kept_mesh_view(kept, nullptr), QSES_INVALID_ARGUMENT, {"mesh"});
  expect_error(qses_kept_mesh_report(kept, nullptr), QSES_INVALID_ARGUMENT, {"report"});

  const auto paint = [&](const void *from, size_t bytes, size_t count, uint32_t first, uint32_t run, void *to) {
    return qses_kept_mesh_paint(kept, from, bytes, count, first, run, to);
  };
  for (const size_t bytes : {0, 1, 3, 5, 20})
    expect_error(paint(values.data(), bytes, 3, 0, v, room.data()), QSES_INVALID_ARGUMENT, {"value_bytes"});
  expect_error(paint(values.data(), 4, 4, 0, v, room.data()), QSES_INVALID_ARGUMENT, {"atom_count", "4", "3"});
  expect_error(paint(values.data(), 4, 3, 0, v + 1, room.data()), QSES_INVALID_ARGUMENT, {"count", "vertices"});
  expect_error(paint(values.data(), 4, 3, v + 1, 0, room.data()), QSES_INVALID_ARGUMENT, {"first", "vertices"});
  expect_error(paint(values.data(), 4, 3, 2, ~0u, room.data()), QSES_INVALID_ARGUMENT, {"count", "vertices"});
  expect_error(paint(nullptr, 4, 3, 0, v, room.data()), QSES_INVALID_ARGUMENT, {"per_atom"});
  expect_error(paint(values.data(), 4, 3, 0, v, nullptr), QSES_INVALID_ARGUMENT, {"per_vertex"});

  const auto filter = [&](const uint8_t *mask, size_t count, uint32_t first, uint32_t run, uint32_t *to) {
    return qses_kept_mesh_filter(kept, mask, count, first, run, to, &triangles);
  };
  expect_error(filter(visible.data(), 2, 0, t, room.data()), QSES_INVALID_ARGUMENT, {"atom_count"});
  expect_error(filter(visible.data(), 3, 1, t, room.data()), QSES_INVALID_ARGUMENT, {"triangles"});
  expect_error(filter(nullptr, 3, 0, t, room.data()), QSES_INVALID_ARGUMENT, {"visible"});
  expect_error(filter(visible.data(), 3, 0, t, nullptr), QSES_INVALID_ARGUMENT, {"indices"});
  expect_error(qses_kept_mesh_filter(kept, visible.data(), 3, 0, t, room.data(), nullptr), QSES_INVALID_ARGUMENT,
               {"kept_triangles"});
}

// ---- threads

// One thread computes and keeps, another one looks at what it is given and gives it back, while the context works on,
// and after its end. The thread sanitizer looks on.
TEST(KeptMesh, AnotherThreadLooksAndGivesBack) {
  const Atoms atoms = crambin();
  std::mutex mutex;
  std::condition_variable changed;
  std::unique_ptr<Kept> handed_over;
  bool is_over = false;
  uint64_t looked_at = 0;
  std::thread other([&] {
    for (;;) {
      std::unique_lock<std::mutex> lock(mutex);
      changed.wait(lock, [&] { return handed_over || is_over; });
      if (!handed_over) return;
      const std::unique_ptr<Kept> mine = std::move(handed_over);
      lock.unlock();
      changed.notify_all();
      const qses_mesh mesh = mine->view();
      const std::vector<uint32_t> values(atoms.size(), 3);
      std::vector<uint32_t> painted(mesh.vertex_count);
      EXPECT_EQ(qses_kept_mesh_paint(*mine, values.data(), 4, atoms.size(), 0, mesh.vertex_count, painted.data()),
                QSES_OK);
      looked_at += std::count(painted.begin(), painted.end(), 3u);
      qses_kept_mesh_clear(*mine);
    }
  });
  uint64_t expected = 0;
  for (int round = 0; round < 3; ++round) {
    const Context context;
    set_atoms(context, atoms);
    qses_settings s = settings(0.8);
    for (int k = 0; k < 10; ++k) {
      expect_ok(qses_begin(context, &s));
      for (qses_bool finished = 0; !finished;) {
        expect_ok(qses_wait(context, 1, &finished));
        qses_mesh mesh = empty_mesh();
        if (qses_collect(context, &mesh) != QSES_OK) continue;
        expected += mesh.vertex_count;
        auto kept = std::make_unique<Kept>();
        expect_ok(qses_keep(context, *kept));
        std::unique_lock<std::mutex> lock(mutex);
        changed.wait(lock, [&] { return !handed_over; });
        handed_over = std::move(kept);
        lock.unlock();
        changed.notify_all();
      }
    }
  }
  {
    const std::lock_guard<std::mutex> lock(mutex);
    is_over = true;
  }
  changed.notify_all();
  other.join();
  EXPECT_GT(expected, 0u);
  EXPECT_EQ(looked_at, expected);
}

TEST(KeptMesh, WithoutOwnersIsOnlyShown) {
  const Context context;
  const Atoms atoms = crambin();
  set_atoms(context, atoms);
  qses_settings s = settings(1);
  s.without_owners = 1;
  const Kept kept;
  compute_view(context, s);
  expect_ok(qses_keep(context, kept));
  const qses_mesh mesh = kept.view();
  ASSERT_GT(mesh.vertex_count, 0u);
  EXPECT_EQ(mesh.owners, nullptr);
  const std::vector<uint32_t> colors(atoms.size());
  const std::vector<uint8_t> visible(atoms.size(), 1);
  std::vector<uint32_t> room(3 * size_t(mesh.triangle_count));
  const float from[3] = {0, 0, 0}, along[3] = {1, 0, 0};
  uint32_t count;
  qses_hit hit;
  qses_hit_init(&hit);
  expect_error(qses_kept_mesh_paint(kept, colors.data(), 4, atoms.size(), 0, mesh.vertex_count, room.data()),
               QSES_INVALID_ARGUMENT, {"without_owners"});
  expect_error(qses_kept_mesh_filter(kept, visible.data(), atoms.size(), 0, mesh.triangle_count, room.data(), &count),
               QSES_INVALID_ARGUMENT, {"without_owners"});
  expect_error(qses_kept_mesh_pick(kept, from, along, nullptr, 0, &hit), QSES_INVALID_ARGUMENT, {"without_owners"});
}

}  // namespace
