// SPDX-License-Identifier: MIT
// Meshes that go from CUDA into buffers of OpenGL: the bytes are those of the ordinary mesh, whatever becomes of the
// buffers.
#include "graphics/graphics_fixture.h"

using namespace graphics_fixture;

namespace {

using GpuBuffers = Graphics;

std::vector<char> zeros(size_t bytes) { return std::vector<char>(bytes, 0); }

TEST_F(GpuBuffers, HoldTheMesh) {
  const Atoms atoms = cluster(300, 1);
  const CudaContext context;
  for (const qses_vertex_layout layout : {QSES_VERTICES_INTERLEAVED, QSES_VERTICES_COMPACT}) {
    qses_settings s = interleaved();
    s.vertex_layout = layout;
    const Kept kept;
    keep_on_device(context, atoms, s, kept);
    SurfaceBuffers buffers;
    buffers.make_for(kept.view());
    const Target target;
    EXPECT_EQ(target.status().submitted, 0);
    EXPECT_EQ(target.status().done, 0);
    const int32_t event = target.submit(kept, buffers);
    EXPECT_EQ(target.status().waiting, 1u);
    EXPECT_TRUE(buffers.are_untouched());
    EXPECT_EQ(next_event(), event);
    run_event(event);
    expect_done(target);
    EXPECT_EQ(target.status().done, event);
    EXPECT_EQ(target.status().registrations, 5u);
    const HostMesh expected = host_mesh(atoms, s);
    EXPECT_EQ(kept.view().vertex_count, expected.vertex_count);
    EXPECT_EQ(kept.view().triangle_count, expected.triangle_count);
    expect_holds(buffers, expected);
    // Behind the mesh nothing is written.
    const std::vector<char> indices =
        buffers.read(buffers.told.indices, static_cast<size_t>(buffers.told.index_capacity) * 4);
    for (size_t k = expected.indices.size(); k < indices.size(); ++k) ASSERT_EQ(indices[k], kUntouched);
    EXPECT_EQ(next_event(), 0);
  }
}

TEST_F(GpuBuffers, ThatAreZeroAreNotWritten) {
  const Atoms atoms = cluster(100, 2);
  const CudaContext context;
  const Kept kept;
  keep_on_device(context, atoms, interleaved(), kept);
  SurfaceBuffers all;
  all.make_for(kept.view());
  SurfaceBuffers few;
  few.told = all.told;
  few.told.colors = few.told.owners = few.told.texcoords = 0;
  const Target target;
  target.submit(kept, few);
  run_next_event();
  expect_done(target);
  EXPECT_EQ(target.status().registrations, 2u);
  const HostMesh expected = host_mesh(atoms, interleaved());
  EXPECT_TRUE(holds(all, all.told.vertices, expected.vertices));
  EXPECT_TRUE(holds(all, all.told.indices, expected.indices));
  EXPECT_TRUE(holds(all, all.told.owners, std::vector<char>(expected.owners.size(), kUntouched)));
  few.forget();
}

// As the surface of a molecule that moves, is refined, or loses atoms.
TEST_F(GpuBuffers, GrowAndShrink) {
  const CudaContext context;
  const Target target;
  SurfaceBuffers buffers;
  const Kept kept;
  uint32_t made = 0;
  bool has_grown = false, has_shrunk = false;
  uint32_t before = 0;
  for (const auto &[count, spacing] : std::vector<std::pair<size_t, double>>{
           {200, 1.0}, {200, 0.5}, {50, 0.5}, {400, 0.5}, {400, 2.0}, {400, 0.4}, {10, 1.0}, {400, 0.5}}) {
    const Atoms atoms = cluster(count, 3);
    keep_on_device(context, atoms, interleaved(spacing), kept);
    const qses_mesh mesh = kept.view();
    has_grown = has_grown || (before && mesh.vertex_count > before);
    has_shrunk = has_shrunk || mesh.vertex_count < before;
    before = mesh.vertex_count;
    if (mesh.vertex_count > buffers.told.vertex_capacity || 3 * mesh.triangle_count > buffers.told.index_capacity) {
      buffers.make_for(mesh);
      ++made;
    }
    buffers.told.clear_rest = 1;
    target.submit(kept, buffers);
    run_next_event();
    expect_done(target);
    const HostMesh expected = host_mesh(atoms, interleaved(spacing));
    expect_holds(buffers, expected);
    const size_t capacity = static_cast<size_t>(buffers.told.index_capacity) * 4;
    const std::vector<char> indices = buffers.read(buffers.told.indices, capacity);
    const std::vector<char> rest(indices.begin() + static_cast<ptrdiff_t>(expected.indices.size()), indices.end());
    EXPECT_EQ(rest, zeros(rest.size()));
    EXPECT_EQ(target.status().registrations, 5 * made);
  }
  EXPECT_TRUE(has_grown);
  EXPECT_TRUE(has_shrunk);
  EXPECT_GT(made, 1u);
}

TEST_F(GpuBuffers, AreClearedForAnEmptyMesh) {
  const CudaContext context;
  const Kept kept;
  keep_on_device(context, cluster(50, 4), interleaved(), kept);
  SurfaceBuffers buffers;
  buffers.make_for(kept.view());
  buffers.told.clear_rest = 1;
  const Target target;
  target.submit(kept, buffers);
  run_next_event();
  keep_on_device(context, Atoms(), interleaved(), kept);
  EXPECT_EQ(kept.view().vertex_count, 0u);
  target.submit(kept, buffers);
  run_next_event();
  expect_done(target);
  EXPECT_TRUE(holds(buffers, buffers.told.indices, zeros(static_cast<size_t>(buffers.told.index_capacity) * 4)));
}

struct Piece {
  explicit Piece(unsigned seed) : atoms(cluster(60 + 40 * seed, seed)) {
    keep_on_device(context, atoms, interleaved(), kept);
    buffers.make_for(kept.view());
    expected = host_mesh(atoms, interleaved());
  }
  void submit() { target.submit(kept, buffers); }

  const Atoms atoms;
  const CudaContext context;
  const Kept kept;
  SurfaceBuffers buffers;
  const Target target;
  HostMesh expected;
};

std::vector<std::unique_ptr<Piece>> some_pieces() {
  std::vector<std::unique_ptr<Piece>> pieces;
  for (unsigned k = 1; k <= 6; ++k) pieces.push_back(std::make_unique<Piece>(k));
  return pieces;
}

TEST_F(GpuBuffers, OfSeveralSurfacesShareAnEvent) {
  const auto pieces = some_pieces();
  std::vector<int32_t> events;
  for (const auto &piece : pieces) events.push_back(piece->target.submit(piece->kept, piece->buffers));
  EXPECT_EQ(events, std::vector<int32_t>(events.size(), events[0]));
  run_next_event();
  EXPECT_EQ(next_event(), 0);
  for (const auto &piece : pieces) {
    expect_done(piece->target);
    expect_holds(piece->buffers, piece->expected);
  }
}

// Whatever is wrong with one surface, the others are drawn.
TEST_F(GpuBuffers, ThatFailDoNotDisturbOthers) {
  const auto pieces = some_pieces();
  Piece &deleted = *pieces[1], &small = *pieces[3];
  const auto told = deleted.buffers.told;
  deleted.buffers.end();
  deleted.buffers.told = told;
  const auto needed = small.buffers.told;
  small.buffers.make(needed.vertex_capacity, needed.index_capacity, 24, 0.5);
  for (const bool again : {false, true}) {
    for (const auto &piece : pieces) piece->submit();
    run_next_event();
    for (const auto &piece : pieces) {
      if (piece.get() == &deleted || piece.get() == &small) {
        expect_failed(piece->target);
        continue;
      }
      expect_done(piece->target);
      expect_holds(piece->buffers, piece->expected);
      EXPECT_EQ(piece->target.status().registrations, 5u) << again;
    }
    EXPECT_EQ(small.target.status().status, QSES_INVALID_ARGUMENT);
    EXPECT_NE(std::string(small.target.status().message).find("bytes"), std::string::npos);
  }
  while (gl.GetError() != gl_without_window::kNoError) {  // CUDA asked OpenGL about a buffer that is not there
  }
  // With good buffers they are drawn as well.
  deleted.buffers.forget();
  for (Piece *const piece : {&deleted, &small}) {
    piece->buffers.make_for(piece->kept.view());
    piece->submit();
  }
  run_next_event();
  for (Piece *const piece : {&deleted, &small}) {
    expect_done(piece->target);
    expect_holds(piece->buffers, piece->expected);
  }
}

// Buffers may be deleted after CUDA was told of them, with nothing said about it: then nothing can be right in them,
// but in all others.
TEST_F(GpuBuffers, ThatAreDeletedLaterDoNotDisturbOthers) {
  const auto pieces = some_pieces();
  for (const auto &piece : pieces) piece->submit();
  run_next_event();
  const auto told = pieces[2]->buffers.told;
  pieces[2]->buffers.end();
  pieces[2]->buffers.told = told;
  for (const auto &piece : pieces) piece->submit();
  run_next_event();
  for (const auto &piece : pieces) {
    if (piece == pieces[2]) continue;
    expect_done(piece->target);
    expect_holds(piece->buffers, piece->expected);
  }
  while (gl.GetError() != gl_without_window::kNoError) {
  }
  pieces[2]->buffers.forget();
}

TEST_F(GpuBuffers, MadeAnewUnderTheSameNames) {
  const Atoms atoms = cluster(150, 5);
  const CudaContext context;
  const Kept kept;
  const Target target;
  SurfaceBuffers buffers;
  for (unsigned frame = 0; frame < 4; ++frame) {
    const Atoms moved = frame_of(atoms, frame);
    keep_on_device(context, moved, interleaved(), kept);
    buffers.make(40000, 240000);  // of names and sizes that come again, as drivers reuse names
    target.submit(kept, buffers);
    run_next_event();
    expect_done(target);
    expect_holds(buffers, host_mesh(moved, interleaved()));
    EXPECT_EQ(target.status().registrations, 5 * (frame + 1));
  }
}

// OpenGL may write to them between events as it likes.
TEST_F(GpuBuffers, ThatWereWrittenToByOthers) {
  Piece piece(3);
  for (int round = 0; round < 3; ++round) {
    piece.submit();
    run_next_event();
    expect_done(piece.target);
    expect_holds(piece.buffers, piece.expected);
    const auto other = zeros(piece.expected.vertices.size());
    gl.NamedBufferSubData(static_cast<unsigned>(piece.buffers.told.vertices), 0, static_cast<ptrdiff_t>(other.size()),
                          other.data());
    EXPECT_TRUE(holds(piece.buffers, piece.buffers.told.vertices, other));
  }
  EXPECT_EQ(piece.target.status().registrations, 5u);
}

}  // namespace
