// SPDX-License-Identifier: MIT
// The part of the C API about meshes that go to a graphics API without leaving the GPU.
#include "quickses/quickses_gpu.h"

#include "capi/appearance_in.h"
#include "capi/context.h"
#include "capi/structs.h"

using quickses::check_choice;
using quickses::guarded;
using quickses::invalid;
using quickses::require;

#if defined(QUICKSES_HAS_CUDA)
#include "graphics/render_queue.h"

struct qses_gpu_target {
  std::shared_ptr<quickses::GpuTarget> held = std::make_shared<quickses::GpuTarget>();
};

namespace {

using quickses::Appearance;
using quickses::RenderQueue;

void check_graphics(qses_graphics graphics) { quickses::require_graphics(graphics); }

qses_gpu_target *make_target() {
  auto made = std::make_unique<qses_gpu_target>();
  RenderQueue::instance().add(made->held);
  return made.release();
}

void end_target(qses_gpu_target *target) {
  RenderQueue::instance().remove(target->held);
  delete target;
}

void set_look(qses_gpu_target *target, const qses_gpu_look *given) {
  if (!given) return target->held->set_look(nullptr, 0);
  const qses_gpu_look look = quickses::read_struct(given, qses_gpu_look_init, "qses_gpu_look");
  const size_t n = static_cast<size_t>(look.atom_count);
  if (n == 0 || (!look.colors && !look.texcoords && !look.visible)) return target->held->set_look(nullptr, 0);
  const auto made = std::make_shared<Appearance>();
  quickses::copy_colors(look.colors, n, made.get());
  quickses::copy_texcoords(look.texcoords, n, made.get());
  quickses::copy_visible(look.visible, n, made.get());
  target->held->set_look(made, n);
}

bool try_submit(qses_gpu_target *target, const qses_kept_mesh &kept, const qses_gpu_buffers &buffers, int32_t *event) {
  quickses::require_kept(kept);
  const std::shared_ptr<const quickses::DeviceMesh> &mesh = kept.held.on_device;
  if (!mesh) throw quickses::Error(QSES_NO_RESULT, "the mesh that is kept is not on a device (settings.delivery)");
  check_graphics(buffers.graphics);
  quickses::Submission submission;
  submission.mesh = mesh;
  submission.buffers = buffers;
  return RenderQueue::instance().try_submit(*target->held, std::move(submission), event);
}

qses_gpu_status status_of(const qses_gpu_target *target) { return target->held->status(); }

int32_t next_event() { return RenderQueue::instance().next_event(); }

void run_event(int32_t event) {
  const quickses::FloatScope floats;
  RenderQueue::instance().run(event);
}

}  // namespace
#else

struct qses_gpu_target {};

namespace {

[[noreturn]] void refuse() {
  throw quickses::Error(QSES_BACKEND_UNAVAILABLE, "this library was built without CUDA: there is no mesh on a GPU");
}

void check_graphics(qses_graphics) { refuse(); }
qses_gpu_target *make_target() { refuse(); }
void end_target(qses_gpu_target *) {}
void set_look(qses_gpu_target *, const qses_gpu_look *) {}
bool try_submit(qses_gpu_target *, const qses_kept_mesh &, const qses_gpu_buffers &, int32_t *) { refuse(); }
qses_gpu_status status_of(const qses_gpu_target *) { refuse(); }
int32_t next_event() { return 0; }
void run_event(int32_t) {}

}  // namespace
#endif

namespace {

void check_known(const char *name, const qses_graphics &graphics) {
  check_choice(name, graphics, QSES_GRAPHICS_D3D11);
  if (static_cast<int>(graphics) == 0) invalid(std::string(name) + " is 0, which names nothing in the header");
}

}  // namespace

extern "C" {

uint32_t qses_gpu_abi_version(void) { return QSES_GPU_ABI_VERSION; }

qses_status qses_gpu_check_graphics(qses_graphics graphics) {
  return guarded([&] {
    check_known("graphics", graphics);
    check_graphics(graphics);
  });
}

qses_status qses_gpu_target_create(qses_gpu_target **target) {
  if (target) *target = nullptr;
  return guarded([&] {
    require(target, "target");
    *target = make_target();
  });
}

void qses_gpu_target_destroy(qses_gpu_target *target) {
  guarded([&] {
    if (target) end_target(target);
  });
}

qses_status qses_gpu_target_set_look(qses_gpu_target *target, const qses_gpu_look *look) {
  return guarded([&] {
    require(target, "target");
    set_look(target, look);
  });
}

qses_status qses_gpu_target_submit(qses_gpu_target *target, const qses_kept_mesh *kept, const qses_gpu_buffers *buffers,
                                   int32_t *event) {
  bool is_taken = false;
  const qses_status status = guarded([&] {
    require(target, "target");
    require(kept, "kept");
    require(buffers, "buffers");
    const qses_gpu_buffers b = quickses::read_struct(buffers, qses_gpu_buffers_init, "qses_gpu_buffers");
    check_known("buffers.graphics", b.graphics);
    int32_t number = 0;
    is_taken = try_submit(target, *kept, b, &number);
    if (is_taken && event) *event = number;
  });
  // Callers ask in every frame: an exception would be too dear an answer.
  if (status == QSES_OK && !is_taken)
    return quickses::fail(QSES_BUSY, "the meshes that were submitted before have to wait for their events");
  return status;
}

qses_status qses_gpu_target_status(const qses_gpu_target *target, qses_gpu_status *status) {
  return guarded([&] {
    require(target, "target");
    require(status, "status");
    quickses::write_struct(status, status_of(target), "qses_gpu_status");
  });
}

qses_status qses_gpu_next_event(int32_t *event) {
  return guarded([&] {
    require(event, "event");
    *event = next_event();
  });
}

qses_gpu_event qses_gpu_event_function(void) { return run_event; }

}  // extern "C"
