// SPDX-License-Identifier: MIT
// Large meshes that leave the GPU slab by slab (methods/exact_slabs.h): byte for byte those that are made as a whole,
// whatever the frames before were like, and whatever happens in the midst of it.
#include "surface/surface_fixture.h"

#include "parallel/cuda_memory.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <thread>

using namespace surface_fixture;

namespace {

#define REQUIRE_DEVICE() \
  if (!quickses::describe_cuda_device(0).available) GTEST_SKIP() << "no CUDA device"

// Atoms about the points of a lattice, so long along an axis.
Atoms rod(int axis) {
  constexpr int kLength = 64;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> off(-0.7, 0.7);
  Atoms atoms;
  for (int k = 0; k < kLength * 144; ++k) {
    double x[3];
    x[axis] = 2.6 * (k / 144) + off(random);
    x[(axis + 1) % 3] = 2.6 * (k % 144 / 12) + off(random);
    x[(axis + 2) % 3] = 2.6 * (k % 12) + off(random);
    atoms.add(x[0], x[1], x[2], 1.2 + 0.1 * (k % 7));
  }
  return atoms;
}
// More than a million vertices.
qses_settings fine_settings() {
  qses_settings s = settings(0.14);
  s.patch_types = 1;
  return s;
}

struct Context : surface_fixture::Context {
  Context() : surface_fixture::Context(0, 0, QSES_BACKEND_CUDA) {}
};

// All arrays of a mesh, one behind the other.
std::string bytes_of(const qses_mesh &mesh) {
  std::string all;
  const auto add = [&](const void *array, size_t bytes) {
    all += std::to_string(array ? bytes : 0) + ":";
    if (array) all.append(static_cast<const char *>(array), bytes);
  };
  const size_t v = mesh.vertex_count;
  add(mesh.positions, v * (mesh.vertex_bytes ? mesh.vertex_bytes : 12));
  add(mesh.normals, mesh.vertex_bytes ? 0 : v * 12);
  add(mesh.colors, v * 4);
  add(mesh.texcoords, v * 8);
  add(mesh.owners, v * 4);
  add(mesh.patches, v);
  add(mesh.component_ids, v * 4);
  add(mesh.indices, size_t(mesh.triangle_count) * 12);
  add(mesh.bounds_min, 12);
  add(mesh.bounds_max, 12);
  return all;
}
struct Frame {
  std::string bytes;
  qses_report report;
};
Frame frame_of(qses_context *context, const Atoms &atoms, const qses_settings &s) {
  set_atoms(context, atoms);
  return {bytes_of(compute_view(context, s)), report_of(context)};
}
Frame alone(const Atoms &atoms, const qses_settings &s) { return frame_of(Context(), atoms, s); }

void expect_same(const Frame &frame, const Frame &expected) {
  EXPECT_EQ(frame.bytes.size(), expected.bytes.size());
  EXPECT_TRUE(frame.bytes == expected.bytes);
  EXPECT_EQ(frame.report.area, expected.report.area);
  EXPECT_EQ(frame.report.volume, expected.report.volume);
  EXPECT_EQ(frame.report.brick_count, expected.report.brick_count);
  EXPECT_EQ(frame.report.mesh_bytes, expected.report.mesh_bytes);
  EXPECT_EQ(frame.report.unplaced_vertices, expected.report.unplaced_vertices);
  EXPECT_EQ(frame.report.attempts, 1u);
}

// Once the context has made a frame, it makes more of the same.
void expect_more_in_slabs(qses_context *context, const Atoms &atoms, const qses_settings &s, const Frame &first) {
  for (int frame = 1; frame < 4; ++frame) {
    const Frame next = frame_of(context, atoms, s);
    expect_same(next, first);
    EXPECT_GT(next.report.slice_count, 1u) << "not what is tested here";
  }
}

TEST(ExactSlabs, AreTheMeshByteForByte) {
  REQUIRE_DEVICE();
  using Change = void (*)(qses_settings *);
  const Change changes[] = {
      [](qses_settings *) {},
      [](qses_settings *s) { s->vertex_layout = QSES_VERTICES_COMPACT; },
      [](qses_settings *s) { s->vertex_layout = QSES_VERTICES_INTERLEAVED, s->delivery = QSES_DELIVERY_BOTH; },
      [](qses_settings *s) { s->components = s->component_ids = s->pickable = s->texcoords = 1; },
      [](qses_settings *s) { s->winding = QSES_WINDING_REVERSED, s->measure = 1, s->relaxation_steps = 0; },
      [](qses_settings *s) { s->probe_radius = 0.5f; },
      [](qses_settings *s) { s->without_owners = 1; },
  };
  const Atoms atoms = rod(2);
  for (size_t k = 0; k < std::size(changes); ++k) {
    SCOPED_TRACE("change " + std::to_string(k));
    qses_settings s = fine_settings();
    changes[k](&s);
    const Context context;
    const Frame first = frame_of(context, atoms, s);
    EXPECT_EQ(first.report.slice_count, 1u);
    expect_more_in_slabs(context, atoms, s, first);
    expect_same(frame_of(context, shifted(atoms, 0.1, 0, 0), s), alone(shifted(atoms, 0.1, 0, 0), s));
  }
}

// Where spacings are wide, leaves have rows of their own.
TEST(ExactSlabs, MayHaveRowsOfLeaves) {
  REQUIRE_DEVICE();
  constexpr int kEdge = 26;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> off(-0.7, 0.7);
  Atoms atoms;
  for (int k = 0; k < kEdge * kEdge * kEdge; ++k) {
    const double x = 9 * (k % kEdge) + off(random), y = 9 * (k / kEdge % kEdge) + off(random),
                 z = 9 * (k / (kEdge * kEdge)) + off(random);
    atoms.add(x, y, z, 2.4 + 0.1 * (k % 8));
  }
  qses_settings s = fine_settings();
  s.spacing = 1.25f;
  const Context context;
  const Frame first = frame_of(context, atoms, s);
  expect_more_in_slabs(context, atoms, s, first);
}

// A quarter of the bricks is full of small balls, the others have a smooth surface through them: two or three times as
// many vertices in some slabs as in others, so that there is too little room for them at first.
TEST(ExactSlabs, MayBeUnevenlyFull) {
  REQUIRE_DEVICE();
  for (bool at_the_end : {false, true}) {
    SCOPED_TRACE(at_the_end);
    Atoms atoms;
    const double half = at_the_end ? 1 : -1;
    for (int k = 0; k < 44 * 44 * 5; ++k) atoms.add(k % 44, k / 44 % 44, half * (80 + k / (44 * 44)), 0.33);
    for (int k = 0; k < 48; ++k) atoms.add(22 + 13 * (k % 4 - 1.5), 22 + 13 * (k / 4 % 4 - 1.5), 13.0 * (k / 16), 6.2);
    qses_settings s = fine_settings();
    s.probe_radius = 0.06f;
    const Context context;
    const Frame first = frame_of(context, atoms, s);
    expect_more_in_slabs(context, atoms, s, first);
  }
}

// Also where they grow: vertices that have no owners yet are painted then, before it is known.
TEST(ExactSlabs, TakeColorsAlong) {
  REQUIRE_DEVICE();
  const Atoms atoms = rod(0);
  std::vector<uint8_t> colors(4 * atoms.size());
  for (size_t i = 0; i < colors.size(); ++i) colors[i] = static_cast<uint8_t>(i * 37);
  const qses_settings s = fine_settings();
  for (double growth : {1.0, 1.04, 1.06, 1.08, 1.25}) {
    SCOPED_TRACE(growth);
    const Context context;
    const auto colored_frame = [&](const Context &any, const Atoms &frame) {
      set_atoms(any, frame);
      expect_ok(qses_set_colors(any, colors.data(), frame.size()));
      return Frame{bytes_of(compute_view(any, s)), report_of(any)};
    };
    colored_frame(context, scaled(atoms, 1 / growth));
    EXPECT_GT(colored_frame(context, scaled(atoms, 1 / growth)).report.slice_count, 1u);
    expect_same(colored_frame(context, atoms), colored_frame(Context(), atoms));
    const qses_mesh mesh = compute_view(context, s);
    ASSERT_NE(mesh.colors, nullptr);
    for (uint32_t v = 0; v < mesh.vertex_count; v += 1001)
      EXPECT_EQ(std::memcmp(mesh.colors + 4 * v, colors.data() + 4 * mesh.owners[v], 4), 0);
  }
}

// More than was foreseen: of everything; and numbers of bricks that are next to each other farther apart, as where the
// widest layers of a long molecule come to lie another way.
TEST(ExactSlabs, AreGivenUpWhereTooLittleWasForeseen) {
  REQUIRE_DEVICE();
  const qses_settings s = fine_settings();
  const std::pair<Atoms, Atoms> changes[] = {
      {scaled(rod(2), 0.8), rod(2)}, {rod(2), rod(0)}, {rod(2), rod(1)}, {rod(0), rod(2)}};
  for (size_t k = 0; k < std::size(changes); ++k) {
    SCOPED_TRACE("change " + std::to_string(k));
    const Atoms &before = changes[k].first, &after = changes[k].second;
    const Context context;
    const Frame first = frame_of(context, before, s), expected = alone(after, s);
    EXPECT_GT(frame_of(context, before, s).report.slice_count, 1u);
    expect_same(frame_of(context, after, s), expected);
    expect_same(frame_of(context, after, s), expected);
    expect_same(frame_of(context, before, s), first);
  }
}

TEST(ExactSlabs, MayBeCancelledAtAnyTime) {
  REQUIRE_DEVICE();
  const Atoms atoms = rod(1);
  const qses_settings s = fine_settings();
  const Context context;
  const Frame first = frame_of(context, atoms, s);
  frame_of(context, atoms, s);
  int cancelled = 0;
  for (int microseconds = 0; microseconds < 8000; microseconds += 250) {
    const auto begin = std::chrono::steady_clock::now();
    std::thread other([&] {
      while (std::chrono::steady_clock::now() - begin < std::chrono::microseconds(microseconds))
        std::this_thread::yield();
      qses_cancel(context);
    });
    const qses_status status = qses_compute(context, &s, nullptr);
    other.join();
    if (status == QSES_CANCELLED)
      ++cancelled;
    else
      EXPECT_EQ(status, QSES_OK);
    const Frame next = frame_of(context, atoms, s);
    ASSERT_TRUE(next.bytes == first.bytes) << microseconds;
  }
  EXPECT_GT(cancelled, 4);
}

TEST(ExactSlabs, OfSeveralContextsAtATime) {
  REQUIRE_DEVICE();
  const qses_settings s = fine_settings();
  const Frame expected[] = {alone(rod(0), s), alone(rod(1), s), alone(rod(2), s)};
  std::vector<std::thread> threads;
  for (int axis = 0; axis < 3; ++axis)
    threads.emplace_back([&, axis] {
      const Context context;
      for (int frame = 0; frame < 8; ++frame) expect_same(frame_of(context, rod(axis), s), expected[axis]);
    });
  for (std::thread &thread : threads) thread.join();
}

}  // namespace
