// SPDX-License-Identifier: MIT
// Meshes that are kept on the GPU and brought to the host when they are wanted there.
#include "capi/device_mesh_fixture.h"

#include <thread>

using namespace device_mesh_fixture;

namespace {

// A molecule that has everything a mesh can have.
struct Molecule {
  explicit Molecule(const Atoms &given) : atoms(given), colors(4 * given.size()), texcoords(2 * given.size()) {
    for (size_t k = 0; k < colors.size(); ++k) colors[k] = static_cast<uint8_t>(k * 37);
    for (size_t k = 0; k < texcoords.size(); ++k) texcoords[k] = static_cast<float>(k);
  }
  void set(qses_context *context) const {
    set_atoms(context, atoms);
    expect_ok(qses_set_colors(context, colors.data(), atoms.size()));
    expect_ok(qses_set_texcoords(context, texcoords.data(), atoms.size()));
  }

  Atoms atoms;
  std::vector<uint8_t> colors;
  std::vector<float> texcoords;
};

std::vector<qses_settings> variants() {
  std::vector<qses_settings> all;
  for (const qses_vertex_layout layout : {QSES_VERTICES_SEPARATE, QSES_VERTICES_INTERLEAVED, QSES_VERTICES_COMPACT}) {
    qses_settings s = settings(0.6);
    s.vertex_layout = layout;
    s.tag = 4;
    all.push_back(s);
    s.texcoords = s.patch_types = s.components = s.component_ids = s.pickable = s.creases = s.hard_edges = 1;
    all.push_back(s);
  }
  all.back().atom_areas = 1;
  return all;
}

void expect_same_numbers(const qses_mesh &a, const qses_mesh &b) {
  EXPECT_EQ(a.vertex_bytes, b.vertex_bytes);
  EXPECT_EQ(a.tag, b.tag);
  EXPECT_EQ(a.spacing, b.spacing);
  EXPECT_EQ(a.level, b.level);
  ASSERT_EQ(a.component_count, b.component_count);
  if (a.component_count) {
    EXPECT_EQ(std::memcmp(a.components, b.components, a.component_count * sizeof(qses_component)), 0);
  }
  ASSERT_EQ(a.atom_count, b.atom_count);
  if (a.atom_count) {
    EXPECT_EQ(std::memcmp(a.atom_areas, b.atom_areas, static_cast<size_t>(a.atom_count) * sizeof(double)), 0);
  }
  for (int d = 0; d < 3; ++d) {
    EXPECT_EQ(a.bounds_min[d], b.bounds_min[d]);
    EXPECT_EQ(a.bounds_max[d], b.bounds_max[d]);
  }
}

TEST(KeptDeviceMesh, DownloadedIsTheSameAsBothAndHost) {
  REQUIRE_CUDA_DEVICE();
  const Molecule molecule(cluster(300, 1));
  const CudaContext context, other;
  molecule.set(context);
  molecule.set(other);
  for (qses_settings s : variants()) {
    const qses_mesh host = compute_view(other, s);
    const HostMesh expected = copy_of(host);
    EXPECT_GT(expected.vertices.size(), 0u);
    s.delivery = QSES_DELIVERY_BOTH;
    compute_view(context, s);
    const Kept both, downloaded;
    expect_ok(qses_keep(context, both));
    expect_equal(copy_of(both.view()), expected);
    keep_on_device(context, s, downloaded);
    const qses_mesh before = downloaded.view();
    EXPECT_EQ(before.vertex_count, expected.vertex_count);
    EXPECT_EQ(before.triangle_count, expected.triangle_count);
    EXPECT_EQ(before.positions, nullptr);
    EXPECT_EQ(before.owners, nullptr);
    EXPECT_EQ(before.indices, nullptr);
    EXPECT_EQ(before.colors, nullptr);
    EXPECT_EQ(before.texcoords, nullptr);
    for (int time = 0; time < 2; ++time) {  // the second does nothing
      ASSERT_EQ(qses_kept_mesh_download(downloaded), QSES_OK) << qses_last_error();
      expect_equal(copy_of(downloaded.view()), expected);
    }
    expect_same_numbers(downloaded.view(), host);
    expect_same_numbers(both.view(), host);
    ASSERT_EQ(qses_kept_mesh_download(both), QSES_OK);
    expect_equal(copy_of(both.view()), expected);
  }
}

TEST(KeptDeviceMesh, IsPickedPaintedAndFilteredOnceDownloaded) {
  REQUIRE_CUDA_DEVICE();
  const Molecule molecule(cluster(300, 2));
  const size_t n = molecule.atoms.size();
  const std::vector<uint8_t> visible = some_visible(n, 3);
  const CudaContext context, other;
  molecule.set(context);
  molecule.set(other);
  for (const qses_bool pickable : {0, 1}) {
    qses_settings s = interleaved();
    s.pickable = pickable;
    const Kept kept, host;
    compute_view(other, s);
    expect_ok(qses_keep(other, host));
    keep_on_device(context, s, kept);
    const uint32_t v = host.view().vertex_count, t = host.view().triangle_count;
    std::vector<uint8_t> painted(4 * size_t(v)), expected(4 * size_t(v));
    std::vector<uint32_t> filtered(3 * size_t(t)), expected_indices(3 * size_t(t));
    uint32_t count = 0, expected_count = 0;
    qses_hit hit, expected_hit;
    qses_hit_init(&hit);
    qses_hit_init(&expected_hit);
    const float origin[3] = {60, 1, 2}, direction[3] = {-1, 0, 0};
    const auto paint = [&] { return qses_kept_mesh_paint(kept, molecule.colors.data(), 4, n, 0, v, painted.data()); };
    const auto filter = [&] { return qses_kept_mesh_filter(kept, visible.data(), n, 0, t, filtered.data(), &count); };
    const auto pick = [&] { return qses_kept_mesh_pick(kept, origin, direction, visible.data(), n, &hit); };
    expect_error(paint(), QSES_INVALID_ARGUMENT, {"device", "qses_kept_mesh_download"});
    expect_error(filter(), QSES_INVALID_ARGUMENT, {"device", "qses_kept_mesh_download"});
    expect_error(pick(), QSES_INVALID_ARGUMENT, {"device", "qses_kept_mesh_download"});
    expect_ok(qses_kept_mesh_download(kept));
    ASSERT_EQ(paint(), QSES_OK) << qses_last_error();
    ASSERT_EQ(filter(), QSES_OK) << qses_last_error();
    expect_ok(qses_kept_mesh_paint(host, molecule.colors.data(), 4, n, 0, v, expected.data()));
    expect_ok(qses_kept_mesh_filter(host, visible.data(), n, 0, t, expected_indices.data(), &expected_count));
    EXPECT_EQ(painted, expected);
    EXPECT_GT(count, 0u);
    EXPECT_LT(count, t);
    ASSERT_EQ(count, expected_count);
    filtered.resize(3 * size_t(count));
    expected_indices.resize(3 * size_t(count));
    EXPECT_EQ(filtered, expected_indices);
    int found = 0;
    for (int ray = 0; ray < 200; ++ray) {
      const float angle = 0.1f * static_cast<float>(ray), height = 0.1f * static_cast<float>(ray - 100);
      const float from[3] = {60 * std::cos(angle), 60 * std::sin(angle), height};
      const float along[3] = {-from[0], -from[1], 0.3f * height};
      expect_ok(qses_kept_mesh_pick(kept, from, along, visible.data(), n, &hit));
      expect_ok(qses_kept_mesh_pick(host, from, along, visible.data(), n, &expected_hit));
      EXPECT_EQ(std::memcmp(&hit, &expected_hit, sizeof hit), 0);
      found += hit.found ? 1 : 0;
    }
    EXPECT_GT(found, 20);
  }
}

TEST(KeptDeviceMesh, OutlivesItsContext) {
  REQUIRE_CUDA_DEVICE();
  const Atoms atoms = cluster(200, 4);
  const HostMesh expected = host_mesh(atoms, interleaved());
  const Kept kept;
  {
    const CudaContext context;
    keep_on_device(context, atoms, interleaved(), kept);
  }
  {
    const CudaContext another;  // which may get the memory that the other one had
    set_atoms(another, cluster(200, 5));
    compute_view(another, on_device(interleaved()));
  }
  EXPECT_EQ(kept.view().vertex_count, expected.vertex_count);
  ASSERT_EQ(qses_kept_mesh_download(kept), QSES_OK) << qses_last_error();
  expect_equal(copy_of(kept.view()), expected);
  qses_report report;
  qses_report_init(&report);
  expect_ok(qses_kept_mesh_report(kept, &report));
  EXPECT_GT(report.mesh_bytes, 0u);
}

// Frame after frame is kept while the next ones are computed; each stays what it was.
TEST(KeptDeviceMesh, IsKeptDuringJobs) {
  REQUIRE_CUDA_DEVICE();
  const Atoms atoms = cluster(200, 6);
  const CudaContext context, other;
  std::vector<std::unique_ptr<Kept>> kept;
  qses_settings s = on_device(interleaved());
  const auto begin = [&](unsigned frame) {
    s.tag = frame;
    set_atoms(context, frame_of(atoms, frame));
    expect_ok(qses_begin(context, &s));
  };
  constexpr unsigned kFrames = 12;
  begin(0);
  while (kept.size() < kFrames) {
    expect_ok(qses_wait(context, -1, nullptr));
    qses_mesh mesh = empty_mesh();
    expect_ok(qses_collect(context, &mesh));
    EXPECT_EQ(mesh.positions, nullptr);
    begin(static_cast<unsigned>(kept.size()) + 1);
    kept.push_back(std::make_unique<Kept>());
    expect_ok(qses_keep(context, *kept.back()));
    if (kept.size() % 3 == 0) expect_ok(qses_kept_mesh_download(*kept.back()));  // beside a job
  }
  for (unsigned frame = 0; frame < kFrames; ++frame) {
    EXPECT_EQ(kept[frame]->view().tag, frame);
    ASSERT_EQ(qses_kept_mesh_download(*kept[frame]), QSES_OK) << qses_last_error();
    expect_equal(copy_of(kept[frame]->view()), host_mesh(other, frame_of(atoms, frame), interleaved()));
  }
}

TEST(KeptDeviceMesh, IsDownloadedByAnotherThread) {
  REQUIRE_CUDA_DEVICE();
  const Atoms atoms = cluster(150, 7);
  const CudaContext context, other;
  for (unsigned frame = 0; frame < 10; ++frame) {
    const Kept kept;
    keep_on_device(context, frame_of(atoms, frame), interleaved(), kept);
    qses_status status = QSES_INTERNAL_ERROR;
    std::thread downloading([&] { status = qses_kept_mesh_download(kept); });
    compute_view(context, on_device(interleaved()));
    downloading.join();
    ASSERT_EQ(status, QSES_OK);
    expect_equal(copy_of(kept.view()), host_mesh(other, frame_of(atoms, frame), interleaved()));
  }
}

TEST(KeptDeviceMesh, EmptyOnesHaveNothingToDownload) {
  REQUIRE_CUDA_DEVICE();
  const CudaContext context;
  const Kept kept;
  expect_error(qses_kept_mesh_download(kept), QSES_NO_RESULT, {"kept"});
  keep_on_device(context, Atoms(), interleaved(), kept);
  EXPECT_EQ(qses_kept_mesh_download(kept), QSES_OK) << qses_last_error();
  EXPECT_EQ(kept.view().vertex_count, 0u);
  qses_kept_mesh_clear(kept);
  EXPECT_EQ(qses_kept_mesh_download(kept), QSES_NO_RESULT);
}

TEST(KeptDeviceMesh, OfTheHostHaveNothingToDownload) {
  EXPECT_EQ(qses_kept_mesh_download(nullptr), QSES_INVALID_ARGUMENT);
  const KeptSurface kept(water());
  const HostMesh before = copy_of(kept.view());
  EXPECT_EQ(qses_kept_mesh_download(kept), QSES_OK) << qses_last_error();
  expect_equal(copy_of(kept.view()), before);
}

// ---- memory

TEST(KeptDeviceMesh, CountsForTheBudget) {
  REQUIRE_CUDA_DEVICE();
  const Atoms atoms = cluster(300, 8);
  const qses_settings s = on_device(interleaved(0.5));
  const HostMesh expected = host_mesh(atoms, s);
  const CudaContext context(uint64_t(48) << 20);
  set_atoms(context, atoms);
  std::vector<std::unique_ptr<Kept>> kept;
  const size_t room = keep_until_refused(context, s, &kept);
  EXPECT_GT(room, 0u);
  EXPECT_LT(room * expected.vertices.size(), uint64_t(48) << 20);
  for (const auto &mesh : kept) {
    ASSERT_EQ(qses_kept_mesh_download(*mesh), QSES_OK) << qses_last_error();
    expect_equal(copy_of(mesh->view()), expected);
  }
  // On the host there is room; and on the device, once what was kept is given back.
  qses_settings host = s;
  host.delivery = QSES_DELIVERY_HOST;
  expect_equal(copy_of(compute_view(context, host)), expected);
  kept.clear();
  EXPECT_EQ(qses_compute(context, &s, nullptr), QSES_OK) << qses_last_error();
  EXPECT_EQ(keep_until_refused(context, s, &kept), room);
}

TEST(KeptDeviceMesh, IsTheSameWithAnyBudgetOrRefused) {
  REQUIRE_CUDA_DEVICE();
  const Atoms atoms = cluster(300, 9);
  const qses_settings s = interleaved(0.4);
  const HostMesh expected = host_mesh(atoms, s);
  int refused = 0, made = 0;
  for (uint64_t budget = uint64_t(1) << 20; budget < (uint64_t(1) << 28); budget += budget / 2) {
    const CudaContext context(budget);
    set_atoms(context, atoms);
    const qses_settings device = on_device(s);
    const Kept kept;
    const qses_status status = qses_compute(context, &device, nullptr);
    if (status == QSES_OK) {
      ++made;
      expect_ok(qses_keep(context, kept));
      ASSERT_EQ(qses_kept_mesh_download(kept), QSES_OK) << qses_last_error();
      expect_equal(copy_of(kept.view()), expected);
    } else {
      ++refused;
      expect_error(status, QSES_OUT_OF_MEMORY, {});
    }
    // What is refused on the device may be made for the host, piece by piece.
    qses_mesh mesh = empty_mesh();
    const qses_status on_host = qses_compute(context, &s, &mesh);
    if (status == QSES_OK) {
      EXPECT_EQ(on_host, QSES_OK) << qses_last_error();
    }
    if (on_host == QSES_OK) expect_equal(copy_of(mesh), expected);
  }
  EXPECT_GT(refused, 0);
  EXPECT_GT(made, 0);
}

}  // namespace
