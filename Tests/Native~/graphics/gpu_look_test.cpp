// SPDX-License-Identifier: MIT
// Colours, texture coordinates and what is shown of meshes that go to OpenGL: as on the host.
#include "graphics/graphics_fixture.h"

using namespace graphics_fixture;

namespace {

struct Look {
  std::vector<uint8_t> colors, visible;
  std::vector<float> texcoords;

  Look(size_t atoms, unsigned seed) : visible(some_visible(atoms, seed)) {
    std::mt19937 random(seed);
    for (size_t k = 0; k < 4 * atoms; ++k) colors.push_back(static_cast<uint8_t>(random()));
    for (size_t k = 0; k < 2 * atoms; ++k) texcoords.push_back(static_cast<float>(random() % 1000) / 1000.f);
  }
  size_t atom_count() const { return visible.size(); }
  qses_gpu_look view() const {
    qses_gpu_look look;
    qses_gpu_look_init(&look);
    look.atom_count = atom_count();
    look.colors = colors.data();
    look.texcoords = texcoords.data();
    look.visible = visible.data();
    return look;
  }
};

template <class T>
std::vector<char> painted(const Kept &kept, const std::vector<T> &per_atom, size_t value_bytes, size_t atoms) {
  const uint32_t n = kept.view().vertex_count;
  std::vector<char> out(n * value_bytes);
  expect_ok(qses_kept_mesh_paint(kept, per_atom.data(), value_bytes, atoms, 0, n, out.data()));
  return out;
}

// Hidden triangles become points.
std::vector<char> shown_indices(const qses_mesh &mesh, const uint8_t *visible) {
  std::vector<uint32_t> indices(mesh.indices, mesh.indices + 3 * size_t(mesh.triangle_count));
  size_t hidden = 0;
  for (uint32_t t = 0; t < mesh.triangle_count; ++t) {
    if (is_shown(mesh, t, visible)) continue;
    uint32_t *const corners = &indices[3 * size_t(t)];
    corners[1] = corners[2] = corners[0];
    ++hidden;
  }
  EXPECT_EQ(hidden > 0, visible != nullptr);
  EXPECT_LT(hidden, mesh.triangle_count);
  return bytes_of(indices.data(), 4 * indices.size());
}

class GpuLook : public Graphics {
 protected:
  // Both: what the host says of the same mesh is what is expected.
  void keep(const qses_settings &settings, const uint8_t *own_colors = nullptr, const float *own_texcoords = nullptr) {
    qses_settings s = settings;
    s.delivery = QSES_DELIVERY_BOTH;
    context_ = std::make_unique<CudaContext>();
    set_atoms(*context_, atoms_);
    expect_ok(qses_set_colors(*context_, own_colors, atoms_.size()));
    expect_ok(qses_set_texcoords(*context_, own_texcoords, atoms_.size()));
    compute_view(*context_, s);
    kept_ = std::make_unique<Kept>();
    expect_ok(qses_keep(*context_, *kept_));
    buffers_.make_for(kept_->view());
    target_ = std::make_unique<Target>();
  }
  void show(const qses_gpu_look *look) {
    expect_ok(qses_gpu_target_set_look(*target_, look));
    target_->submit(*kept_, buffers_);
    run_next_event();
    expect_done(*target_);
  }
  void expect_shown(const std::vector<char> &colors, const std::vector<char> &texcoords, const uint8_t *visible) {
    const qses_mesh mesh = kept_->view();
    const size_t n = mesh.vertex_count;
    EXPECT_TRUE(holds(buffers_, buffers_.told.vertices, bytes_of(mesh.positions, n * mesh.vertex_bytes)));
    EXPECT_TRUE(holds(buffers_, buffers_.told.owners, bytes_of(mesh.owners, 4 * n)));
    EXPECT_TRUE(holds(buffers_, buffers_.told.colors, colors));
    EXPECT_TRUE(holds(buffers_, buffers_.told.texcoords, texcoords));
    EXPECT_TRUE(holds(buffers_, buffers_.told.indices, shown_indices(mesh, visible)));
  }
  void TearDown() override {
    target_ = nullptr;
    if (drawing_) buffers_.end();
    Graphics::TearDown();
  }
  std::vector<char> white() const { return std::vector<char>(4 * size_t(kept_->view().vertex_count), char(0xff)); }
  std::vector<char> default_texcoords() const {  // 1, 0, as of qses_set_texcoords
    std::vector<float> uv;
    for (uint32_t v = 0; v < kept_->view().vertex_count; ++v) uv.insert(uv.end(), {1.f, 0.f});
    return bytes_of(uv.data(), 4 * uv.size());
  }

  const Atoms atoms_ = cluster(250, 7);
  std::unique_ptr<CudaContext> context_;
  std::unique_ptr<Kept> kept_;
  SurfaceBuffers buffers_;
  std::unique_ptr<Target> target_;
};

TEST_F(GpuLook, IsThatOfTheHost) {
  for (const qses_vertex_layout layout : {QSES_VERTICES_INTERLEAVED, QSES_VERTICES_COMPACT}) {
    qses_settings s = interleaved();
    s.vertex_layout = layout;
    keep(s);
    const Look look(atoms_.size(), 8);
    const qses_gpu_look view = look.view();
    show(&view);
    expect_shown(painted(*kept_, look.colors, 4, atoms_.size()), painted(*kept_, look.texcoords, 8, atoms_.size()),
                 look.visible.data());
  }
}

TEST_F(GpuLook, HasDefaults) {
  keep(interleaved());
  show(nullptr);
  expect_shown(white(), default_texcoords(), nullptr);
  const Look look(atoms_.size(), 9);
  for (int which = 0; which < 3; ++which) {
    qses_gpu_look view = look.view();
    if (which != 0) view.colors = nullptr;
    if (which != 1) view.texcoords = nullptr;
    if (which != 2) view.visible = nullptr;
    show(&view);
    expect_shown(which == 0 ? painted(*kept_, look.colors, 4, atoms_.size()) : white(),
                 which == 1 ? painted(*kept_, look.texcoords, 8, atoms_.size()) : default_texcoords(),
                 which == 2 ? look.visible.data() : nullptr);
  }
}

TEST_F(GpuLook, IsTheMeshsOwnIfNothingElseIsSaid) {
  const Look own(atoms_.size(), 10), other(atoms_.size(), 11);
  qses_settings s = interleaved();
  s.texcoords = 1;
  keep(s, own.colors.data(), own.texcoords.data());
  const qses_mesh mesh = kept_->view();
  const std::vector<char> colors = bytes_of(mesh.colors, 4 * size_t(mesh.vertex_count)),
                          texcoords = bytes_of(mesh.texcoords, 8 * size_t(mesh.vertex_count));
  EXPECT_EQ(colors, painted(*kept_, own.colors, 4, atoms_.size()));
  show(nullptr);
  expect_shown(colors, texcoords, nullptr);
  qses_gpu_look view = other.view();
  show(&view);
  expect_shown(painted(*kept_, other.colors, 4, atoms_.size()), painted(*kept_, other.texcoords, 8, atoms_.size()),
               other.visible.data());
  view.colors = nullptr;
  view.texcoords = nullptr;
  show(&view);
  expect_shown(colors, texcoords, other.visible.data());
}

// The mesh that is shown is submitted again; nothing is computed, and the context may have gone.
TEST_F(GpuLook, ChangesWithoutAComputation) {
  keep(interleaved());
  context_ = nullptr;
  for (unsigned seed = 20; seed < 30; ++seed) {
    const Look look(atoms_.size(), seed);
    const qses_gpu_look view = look.view();
    show(&view);
    expect_shown(painted(*kept_, look.colors, 4, atoms_.size()), painted(*kept_, look.texcoords, 8, atoms_.size()),
                 look.visible.data());
  }
  show(nullptr);
  expect_shown(white(), default_texcoords(), nullptr);
}

// It is copied, and holds for what is submitted from then on: not for what waits already.
TEST_F(GpuLook, HoldsForWhatIsSubmittedLater) {
  keep(interleaved());
  Look look(atoms_.size(), 12);
  const qses_gpu_look view = look.view();
  const std::vector<char> colors = painted(*kept_, look.colors, 4, atoms_.size()),
                          texcoords = painted(*kept_, look.texcoords, 8, atoms_.size());
  const std::vector<uint8_t> visible = look.visible;
  expect_ok(qses_gpu_target_set_look(*target_, &view));
  std::fill(look.colors.begin(), look.colors.end(), uint8_t(3));
  std::fill(look.visible.begin(), look.visible.end(), uint8_t(0));
  target_->submit(*kept_, buffers_);
  expect_ok(qses_gpu_target_set_look(*target_, nullptr));
  run_next_event();
  expect_done(*target_);
  expect_shown(colors, texcoords, visible.data());
  target_->submit(*kept_, buffers_);
  run_next_event();
  expect_shown(white(), default_texcoords(), nullptr);
}

TEST_F(GpuLook, MayHideEverything) {
  keep(interleaved());
  const std::vector<uint8_t> none(atoms_.size(), 0);
  qses_gpu_look view;
  qses_gpu_look_init(&view);
  view.atom_count = none.size();
  view.visible = none.data();
  show(&view);
  const qses_mesh mesh = kept_->view();
  const std::vector<char> indices = buffers_.read(buffers_.told.indices, 12 * size_t(mesh.triangle_count));
  for (uint32_t t = 0; t < mesh.triangle_count; ++t) {
    uint32_t corners[3];
    std::memcpy(corners, &indices[12 * size_t(t)], sizeof corners);
    ASSERT_EQ(corners[0], mesh.indices[3 * size_t(t)]);
    ASSERT_EQ(corners[1], corners[0]);
    ASSERT_EQ(corners[2], corners[0]);
  }
}

}  // namespace
