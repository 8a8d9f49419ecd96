// SPDX-License-Identifier: MIT
// The graphics event with a fake driver (fake_graphics.cpp): what is asked of the driver, in which order, and what the
// buffers have then. What a kernel would write is not there, since the fake's kernels do nothing. That every call may
// fail is in fake_graphics_failures.cpp.
#include "cudart/fake_graphics_fixture.h"

#include "graphics/gpu_target.h"

#include <atomic>
#include <thread>

namespace {

using namespace fake_driver;

class GraphicsEvent : public GraphicsTestOfApi {};
INSTANTIATE_TEST_SUITE_P(Apis, GraphicsEvent, testing::ValuesIn(graphics_apis()), name_of_api);

// ---- order of calls

TEST_P(GraphicsEvent, MapsTheBuffersOfAllTargetsInOneCall) {
  const HandMadeMesh first(1), second(100, 8, 8, 0, true), third(50);
  DrawnSurface a(api(), 1), b(api(), 3, true);
  int32_t of_a = 0, of_b = 0;
  expect_ok(a.submit(first, &of_a));
  expect_ok(b.submit(second, &of_b));
  EXPECT_EQ(of_a, of_b);
  EXPECT_EQ(a.status().waiting, 1u);
  expect_calls({});
  EXPECT_EQ(draw(), of_a);
  expect_calls({registering(api(), 1, 7), {all("Map", 1, 7)}, each("Pointer", 1, 7), {all("Unmap", 1, 7)}});
  a.expect_shows(first);
  b.expect_shows(second);
  for (const DrawnSurface *surface : {&a, &b}) {
    surface->expect_status(QSES_OK, {});
    EXPECT_EQ(surface->status().done, of_a);
    EXPECT_EQ(surface->status().submitted, of_a);
    EXPECT_EQ(surface->status().waiting, 0u);
  }
  EXPECT_EQ(a.status().registrations, 2u);
  EXPECT_EQ(b.status().registrations, 5u);
  EXPECT_EQ(draw(), 0) << "there was nothing to do";

  // CUDA knows them now. The time is that of the event before.
  expect_ok(a.submit(third));
  draw();
  expect_calls({{all("Map", 1, 2)}, each("Pointer", 1, 2), {all("Unmap", 1, 2)}});
  a.expect_shows(third);
  b.expect_shows(second);
  EXPECT_EQ(a.status().registrations, 2u);
  EXPECT_EQ(a.status().copy_ms, 1.f);
}

TEST_P(GraphicsEvent, MakesBuffersOfAnotherGenerationKnownAnew) {
  const HandMadeMesh before(1), after(9), last(90);
  DrawnSurface surface(api(), 1);
  expect_ok(surface.submit(before));
  draw();
  calls();
  surface.make_buffers(11);
  expect_ok(surface.submit(after));
  draw();
  expect_calls({each("Unregister", 1, 2),
                registering(api(), 11, 12),
                {all("Map", 11, 12)},
                each("Pointer", 11, 12),
                {all("Unmap", 11, 12)}});
  surface.expect_shows(after);
  EXPECT_EQ(surface.status().registrations, 4u);

  // The same names for other buffers: what CUDA knew went on into the former one.
  surface.vertices().make_anew(21, 24 * DrawnSurface::kVertices);
  surface.indices().make_anew(22, 12 * DrawnSurface::kTriangles);
  ++surface.to.generation;
  expect_ok(surface.submit(last));
  draw();
  surface.expect_shows(last);
}

TEST_P(GraphicsEvent, LetsGoOfTheBuffersOfATargetThatEnded) {
  const HandMadeMesh mesh(1);
  DrawnSurface ended(api(), 1), other(api(), 3), never_drawn(api(), 5);
  expect_ok(ended.submit(mesh));
  expect_ok(other.submit(mesh));
  draw();
  calls();
  ended.destroy();
  never_drawn.destroy();
  expect_calls({});
  EXPECT_GT(draw(), 0);
  expect_calls({each("Unregister", 1, 2)});
  EXPECT_EQ(draw(), 0);
  expect_ok(other.submit(mesh));
  draw();
  other.expect_status(QSES_OK, {});
}

TEST_P(GraphicsEvent, LetsGoOfWhatWaitsWhenATargetEnds) {
  HandMadeMesh mesh(1);
  DrawnSurface surface(api(), 1);
  expect_ok(surface.submit(mesh));
  mesh.let_go();
  EXPECT_TRUE(mesh.is_held());
  surface.destroy();
  EXPECT_FALSE(mesh.is_held());
  draw();
  expect_calls({});
}

// ---- which meshes

TEST_P(GraphicsEvent, ShowsTheNewestOfThoseThatWait) {
  HandMadeMesh older(1);
  const HandMadeMesh newer(100);
  DrawnSurface surface(api(), 1);
  expect_ok(surface.submit(older));
  expect_ok(surface.submit(newer));
  expect_error(surface.submit(newer), QSES_BUSY, {"wait"});
  EXPECT_EQ(surface.status().waiting, 2u);
  older.let_go();
  EXPECT_TRUE(older.is_held());
  draw();
  EXPECT_FALSE(older.is_held());
  surface.expect_shows(newer);
  expect_calls({registering(api(), 1, 2), {all("Map", 1, 2)}, each("Pointer", 1, 2), {all("Unmap", 1, 2)}});
}

TEST_P(GraphicsEvent, LeavesWhatIsSubmittedLaterToALaterEvent) {
  const HandMadeMesh first(1), second(100);
  DrawnSurface surface(api(), 1);
  int32_t event = 0, later = 0;
  expect_ok(surface.submit(first, &event));
  int32_t closed = 0;
  expect_ok(qses_gpu_next_event(&closed));
  EXPECT_EQ(closed, event);
  expect_ok(surface.submit(second, &later));
  EXPECT_GT(later, event);
  issue(event);
  surface.expect_shows(first);
  EXPECT_EQ(surface.status().done, event);
  EXPECT_EQ(surface.status().submitted, later);
  EXPECT_EQ(surface.status().waiting, 1u);
  EXPECT_EQ(draw(), later);
  surface.expect_shows(second);
}

TEST(GraphicsEvents, AreNumberedInTurnWhenTheNumbersBeginAnew) {
  using quickses::is_later;
  constexpr int32_t kLast = std::numeric_limits<int32_t>::max();
  EXPECT_TRUE(is_later(2, 1));
  EXPECT_FALSE(is_later(1, 1));
  EXPECT_FALSE(is_later(1, 2));
  EXPECT_TRUE(is_later(1, kLast)) << "1 follows the last number";
  EXPECT_FALSE(is_later(kLast, 1));
  EXPECT_TRUE(is_later(5, kLast - 5));
  EXPECT_FALSE(is_later(kLast - 5, 5));
}

// What was kept and what it came from may be gone; who writes into the memory next has to wait for the copies.
TEST_P(GraphicsEvent, HasTheMemoryOfAMeshUntilItIsCopied) {
  HandMadeMesh mesh(1);
  DrawnSurface surface(api(), 1);
  expect_ok(surface.submit(mesh));
  draw();
  EXPECT_NE(mesh.take_readers(), nullptr);
  expect_ok(surface.submit(mesh));
  mesh.let_go();
  EXPECT_TRUE(mesh.is_held());
  draw();
  EXPECT_FALSE(mesh.is_held());
  surface.expect_shows(mesh);
}

// ---- what is written

TEST_P(GraphicsEvent, ClearsTheRestOfTheIndicesWhereThatIsAskedFor) {
  const HandMadeMesh mesh(1, 5, 4);
  DrawnSurface surface(api(), 1);
  surface.to.clear_rest = 1;
  expect_ok(surface.submit(mesh));
  draw();
  surface.expect_shows(mesh);
  const Bytes indices = surface.indices().first(12 * DrawnSurface::kTriangles);
  EXPECT_EQ(Bytes(indices.begin() + 12 * 4, indices.end()), Bytes(12 * (DrawnSurface::kTriangles - 4), 0));
}

// As the library makes it. The fake's kernels find no surface.
TEST_P(GraphicsEvent, TakesAMeshThatIsEmpty) {
  qses_context_options options;
  qses_context_options_init(&options);
  options.backend = QSES_BACKEND_CUDA;
  qses_context *context = nullptr;
  qses_kept_mesh *kept = nullptr;
  expect_ok(qses_context_create(&options, &context));
  expect_ok(qses_kept_mesh_create(&kept));
  set_atoms(context, water());
  qses_settings s = settings();
  s.vertex_layout = QSES_VERTICES_INTERLEAVED;
  s.delivery = QSES_DELIVERY_DEVICE;
  expect_ok(qses_compute(context, &s, nullptr));
  expect_ok(qses_keep(context, kept));
  qses_context_destroy(context);

  const HandMadeMesh before(1);
  DrawnSurface surface(api(), 1, true);
  expect_ok(surface.submit(before));
  draw();
  surface.to.clear_rest = 1;
  expect_ok(surface.submit(kept));
  draw();
  surface.expect_status(QSES_OK, {});
  EXPECT_EQ(surface.indices().first(12 * DrawnSurface::kTriangles), Bytes(12 * DrawnSurface::kTriangles, 0));
  qses_kept_mesh_destroy(kept);
}

TEST_P(GraphicsEvent, PaintsWhiteWhatHasNoColours) {
  const HandMadeMesh mesh(1);
  DrawnSurface surface(api(), 1, true);
  expect_ok(surface.submit(mesh));
  draw();
  surface.expect_shows(mesh);
  EXPECT_EQ(surface.colors().first(4 * 5), Bytes(4 * 5, 0xff));
  // Texture coordinates that the mesh has not come from a kernel.
  expect_calls({registering(api(), 1, 5), {all("Map", 1, 5)}, each("Pointer", 1, 5), {"Launch", all("Unmap", 1, 5)}});
}

// By kernels, which may only run while the buffers are mapped.
TEST_P(GraphicsEvent, PaintsAndHidesAsTheLookSays) {
  const HandMadeMesh mesh(1, 5, 4, 0, true);
  DrawnSurface surface(api(), 1, true);
  paint_and_hide(surface);
  expect_ok(surface.submit(mesh));
  draw();
  surface.expect_status(QSES_OK, {});
  expect_calls({registering(api(), 1, 5),
                {all("Map", 1, 5)},
                each("Pointer", 1, 5),
                {"Launch", "Launch"},
                {all("Unmap", 1, 5)}});
  // A look that says nothing is none.
  qses_gpu_look look;
  qses_gpu_look_init(&look);
  expect_ok(qses_gpu_target_set_look(surface.target(), &look));
  expect_ok(surface.submit(mesh));
  draw();
  expect_calls({{all("Map", 1, 5)}, each("Pointer", 1, 5), {all("Unmap", 1, 5)}});
  surface.expect_shows(mesh);
}

// ---- what does not go

TEST_P(GraphicsEvent, ServesTheOthersWhereTheBuffersOfOneCantBeMapped) {
  const HandMadeMesh first(1), second(100);
  DrawnSurface a(api(), 1), bad(api(), 3), c(api(), 5);
  const auto submit_all = [&](const HandMadeMesh &mesh) {
    for (const DrawnSurface *surface : {&a, &bad, &c}) expect_ok(surface->submit(mesh));
  };
  submit_all(first);
  draw();
  calls();
  bad.indices().spoil();
  submit_all(second);
  draw();
  bad.expect_status(QSES_DEVICE_ERROR, {"cudaGraphicsMapResources"});
  for (const DrawnSurface *surface : {&a, &c}) {
    surface->expect_status(QSES_OK, {});
    surface->expect_shows(second);
  }
  bad.expect_shows(first);
  expect_calls({{all("Map", 1, 6) + " = 205"},
                {all("Map", 1, 2), all("Map", 3, 4) + " = 205", all("Map", 5, 6), "Unregister 3", "Unregister 4"},
                {"Pointer 1", "Pointer 2", "Pointer 5", "Pointer 6"},
                {"Unmap 1 2 5 6"}});
  bad.make_buffers(13);
  submit_all(first);
  draw();
  for (const DrawnSurface *surface : {&a, &bad, &c}) {
    surface->expect_status(QSES_OK, {});
    surface->expect_shows(first);
  }
}

TEST_P(GraphicsEvent, SaysThatABufferHasLessRoomThanWasSaid) {
  const HandMadeMesh mesh(1);
  DrawnSurface small(api(), 1), other(api(), 3);
  small.indices().make_anew(2, 12 * 4 - 1);
  for (const DrawnSurface *surface : {&small, &other}) expect_ok(surface->submit(mesh));
  draw();
  small.expect_status(QSES_INVALID_ARGUMENT, {"47 bytes", "48"});
  other.expect_status(QSES_OK, {});
  other.expect_shows(mesh);
}

TEST_P(GraphicsEvent, SaysThatTwoTargetsHaveTheSameBuffer) {
  const HandMadeMesh mesh(1), newer(100);
  DrawnSurface a(api(), 1), b(api(), 3);
  const uint64_t own = b.to.indices;
  b.to.indices = a.to.indices;
  for (const DrawnSurface *surface : {&a, &b}) expect_ok(surface->submit(mesh));
  draw();
  a.expect_status(QSES_OK, {});
  a.expect_shows(mesh);
  b.expect_status(QSES_DEVICE_ERROR, {api() == QSES_GRAPHICS_OPENGL ? "Map" : "Register"});
  b.to.indices = own;
  for (const DrawnSurface *surface : {&a, &b}) expect_ok(surface->submit(newer));
  draw();
  for (const DrawnSurface *surface : {&a, &b}) surface->expect_shows(newer);
}

TEST_P(GraphicsEvent, SaysThatAnotherGpuDraws) {
  const HandMadeMesh mesh(1);
  DrawnSurface surface(api(), 1);
  for (const int drawing : {1, -1}) {
    draw_on(drawing);
    expect_ok(surface.submit(mesh));
    draw();
    if (drawing == 1)
      surface.expect_status(QSES_BACKEND_UNAVAILABLE, {"computed on CUDA device 0", "1 draws"});
    else
      surface.expect_status(QSES_BACKEND_UNAVAILABLE, {"no CUDA device"});
    expect_calls({});
  }
  draw_on(0);
  expect_ok(surface.submit(mesh));
  draw();
  surface.expect_status(QSES_OK, {});
  surface.expect_shows(mesh);
}

// The buffers are registered where the mesh is.
TEST_P(GraphicsEvent, FollowsToAnotherGpu) {
  const HandMadeMesh here(1), there(100, 5, 4, 1);
  DrawnSurface surface(api(), 1);
  expect_ok(surface.submit(here));
  draw();
  calls();
  draw_on(1);
  expect_ok(surface.submit(there));
  draw();
  surface.expect_status(QSES_OK, {});
  surface.expect_shows(there);
  expect_calls({each("Unregister", 1, 2),
                registering(api(), 1, 2),
                {all("Map", 1, 2)},
                each("Pointer", 1, 2),
                {all("Unmap", 1, 2)}});
}

TEST_P(GraphicsEvent, RefusesWhatDoesNotFit) {
  const HandMadeMesh mesh(1), separate(1, 5, 4, 0, false, QSES_VERTICES_SEPARATE), large(1, 9, 8), many(1, 8, 9);
  DrawnSurface surface(api(), 1);
  expect_error(surface.submit(separate), QSES_INVALID_ARGUMENT, {"SEPARATE"});
  expect_error(surface.submit(large), QSES_INVALID_ARGUMENT, {"vertex_capacity is 8", "9"});
  expect_error(surface.submit(many), QSES_INVALID_ARGUMENT, {"index_capacity is 24", "27"});
  for (uint64_t *const needed : {&surface.to.vertices, &surface.to.indices}) {
    const uint64_t key = *needed;
    *needed = 0;
    expect_error(surface.submit(mesh), QSES_INVALID_ARGUMENT, {"is 0"});
    *needed = key;
  }
  const std::vector<uint8_t> visible = {1, 0};
  qses_gpu_look look;
  qses_gpu_look_init(&look);
  look.atom_count = visible.size();
  look.visible = visible.data();
  expect_ok(qses_gpu_target_set_look(surface.target(), &look));
  expect_error(surface.submit(mesh), QSES_INVALID_ARGUMENT, {"2 atoms", "3"});
  EXPECT_EQ(draw(), 0);
}

TEST_P(GraphicsEvent, GivesUpMeshesWhoseEventsDoNotCome) {
  HandMadeMesh waits(1);
  const HandMadeMesh mesh(100);
  DrawnSurface surface(api(), 1);
  LongGpuPatience::end();
  expect_ok(surface.submit(waits));
  waits.let_go();
  int32_t lost = 0;
  expect_ok(qses_gpu_next_event(&lost));
  EXPECT_GT(lost, 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(QSES_GPU_PATIENCE_MS + 1));
  EXPECT_EQ(surface.status().stopped, 1);
  EXPECT_EQ(surface.status().waiting, 0u);
  EXPECT_FALSE(waits.is_held());
  LongGpuPatience::begin();
  expect_error(surface.submit(mesh), QSES_BUSY, {"wait"});
  EXPECT_GT(draw(), 0) << "one to try with";
  EXPECT_EQ(surface.status().stopped, 0);
  expect_calls({});
  expect_ok(surface.submit(mesh));
  draw();
  surface.expect_shows(mesh);
}

// One thread draws while another one submits, asks, and makes and ends targets.
TEST_P(GraphicsEvent, RunsBesideTheThreadThatSubmits) {
  const HandMadeMesh meshes[] = {HandMadeMesh(1), HandMadeMesh(60, 8, 8), HandMadeMesh(120, 3, 1)};
  DrawnSurface surface(api(), 1);
  std::atomic<bool> is_over{false};
  std::thread drawing([&] {
    while (!is_over) {
      draw();
      std::this_thread::yield();
    }
  });
  std::vector<std::unique_ptr<DrawnSurface>> passing;  // their buffers stay until events have run
  while (passing.size() < 300) {
    const HandMadeMesh &mesh = meshes[passing.size() % 3];
    const qses_status status = surface.submit(mesh);
    EXPECT_TRUE(status == QSES_OK || status == QSES_BUSY) << qses_last_error();
    surface.expect_status(QSES_OK, {});
    if (status != QSES_OK) continue;
    passing.push_back(std::make_unique<DrawnSurface>(api(), 3));
    expect_ok(passing.back()->submit(mesh));
    passing.back()->expect_status(QSES_OK, {});
    passing.back()->destroy();
  }
  is_over = true;
  drawing.join();
  draw();
  expect_ok(surface.submit(meshes[0]));
  draw();
  surface.expect_status(QSES_OK, {});
  surface.expect_shows(meshes[0]);
}

// ---- other graphics APIs, other drivers

TEST(GraphicsCheck, NamesWhatTheHeaderHas) {
  REQUIRE_DRIVER("graphics");
  expect_ok(qses_gpu_check_graphics(QSES_GRAPHICS_OPENGL));
#if defined(_WIN32)
  expect_ok(qses_gpu_check_graphics(QSES_GRAPHICS_D3D11));
#else
  expect_error(qses_gpu_check_graphics(QSES_GRAPHICS_D3D11), QSES_BACKEND_UNAVAILABLE, {"Direct3D 11", "Windows only"});
#endif
  for (const int32_t value : {0, 3, -1}) {
    qses_graphics graphics;
    set_any(&graphics, value);
    expect_error(qses_gpu_check_graphics(graphics), QSES_INVALID_ARGUMENT, {"graphics"});
  }
}

// One that lacks any of the functions can't.
TEST(GraphicsCheck, SaysThatTheDriverCantShareBuffers) {
  REQUIRE_DRIVER("no_graphics");
  expect_error(qses_gpu_check_graphics(QSES_GRAPHICS_OPENGL), QSES_BACKEND_UNAVAILABLE, {"OpenGL", "driver"});
#if defined(_WIN32)
  expect_error(qses_gpu_check_graphics(QSES_GRAPHICS_D3D11), QSES_BACKEND_UNAVAILABLE, {"Direct3D 11", "driver"});
#endif
  const HandMadeMesh mesh(1);
  const DrawnSurface surface(QSES_GRAPHICS_OPENGL, 1);
  expect_error(surface.submit(mesh), QSES_BACKEND_UNAVAILABLE, {"OpenGL", "driver"});
  EXPECT_EQ(draw(), 0);
  surface.expect_status(QSES_OK, {});
}

}  // namespace
