// SPDX-License-Identifier: MIT
#include "graphics/render_queue.h"

#include "parallel/error.h"
#include "parallel/sole_holder.h"

#include <cuda_runtime_api.h>

#include <algorithm>
#include <chrono>
#include <limits>

namespace quickses {
namespace {

using Clock = std::chrono::steady_clock;

void fill_buffers(const GpuTarget &target, const Submission &s, const AppearanceView &look, void *stream) {
  const qses_mesh &mesh = s.mesh->view.mesh;
  const RegisteredBuffers &registered = target.registered;
  const size_t vertices = mesh.vertex_count, indices = 3 * size_t(mesh.triangle_count);
  MappedBuffers to{};
  to.index_count = s.buffers.clear_rest ? static_cast<size_t>(s.buffers.index_capacity) : indices;
  to.vertices = registered.address(RegisteredBuffers::kVertices, vertices * mesh.vertex_bytes);
  to.colors = static_cast<uint32_t *>(registered.address(RegisteredBuffers::kColors, 4 * vertices));
  to.owners = static_cast<uint32_t *>(registered.address(RegisteredBuffers::kOwners, 4 * vertices));
  to.texcoords = static_cast<float *>(registered.address(RegisteredBuffers::kTexcoords, 8 * vertices));
  to.indices = static_cast<uint32_t *>(registered.address(RegisteredBuffers::kIndices, 4 * to.index_count));
  copy_mesh(*s.mesh, look, to, stream);
}

}  // namespace

RenderQueue &RenderQueue::instance() {
  static RenderQueue &queue = *new RenderQueue;
  return queue;
}

void RenderQueue::add(std::shared_ptr<GpuTarget> target) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ended_.reserve(ended_.size() + targets_.size() + 1);  // so that remove can't fail
  targets_.push_back(std::move(target));
}

void RenderQueue::remove(const std::shared_ptr<GpuTarget> &target) noexcept {
  target->let_go();
  const std::lock_guard<std::mutex> lock(mutex_);
  targets_.erase(std::remove(targets_.begin(), targets_.end(), target), targets_.end());
  ended_.push_back(target);
  has_work_ = true;
}

bool RenderQueue::try_submit(GpuTarget &target, Submission submission, int32_t *event) {
  const std::lock_guard<std::mutex> lock(mutex_);
  submission.event = gathering_;
  if (!target.try_submit(std::move(submission))) return false;
  has_work_ = true;
  *event = gathering_;
  return true;
}

int32_t RenderQueue::next_event() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!has_work_ && std::none_of(targets_.begin(), targets_.end(), [](const auto &t) { return t->is_stopped(); }))
    return 0;
  has_work_ = false;
  const int32_t event = gathering_;
  gathering_ = gathering_ == std::numeric_limits<int32_t>::max() ? 1 : gathering_ + 1;
  return event;
}

void RenderQueue::run(int32_t event) noexcept try {
  const std::lock_guard<std::mutex> drawing(drawing_);
  const auto start = Clock::now();
  std::vector<std::shared_ptr<GpuTarget>> targets, ended;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    targets = targets_;
    ended = ended_;
  }
  std::vector<Arrival> arrivals;
  std::map<int, Arrivals> by_device;
  arrivals.reserve(targets.size());
  for (const std::shared_ptr<GpuTarget> &target : targets) {
    Arrival arrival;
    if (!target->take(event, &arrival.submission)) continue;
    arrival.target = target;
    arrivals.push_back(std::move(arrival));
  }
  for (Arrival &arrival : arrivals) by_device[arrival.submission.mesh->view.device].push_back(&arrival);
  for (const auto &[device, those] : by_device) serve(device, those);
  forget_ended(ended);
  const float event_ms = std::chrono::duration<float, std::milli>(Clock::now() - start).count();
  for (const Arrival &arrival : arrivals) {
    arrival.target->note_times(event_ms, lanes_[arrival.submission.mesh->view.device].copy_ms);
    arrival.target->note_outcome(event, arrival.outcome, arrival.message.c_str());
  }
} catch (...) {  // no memory for a list of a few pointers
  const std::lock_guard<std::mutex> lock(mutex_);
  has_work_ = has_work_ || !ended_.empty();
  for (const std::shared_ptr<GpuTarget> &target : targets_) target->note_interruption(event);
}

RenderQueue::Lane &RenderQueue::lane_of(int device) {
  Lane &lane = lanes_[device];
  if (lane.stream) return lane;
  for (void **const event : {&lane.begin, &lane.end}) {
    cudaEvent_t made = nullptr;
    if (*event) continue;  // the next one could not be made the last time
    check_cuda(cudaEventCreate(&made), "cudaEventCreate");
    *event = made;
  }
  cudaStream_t stream = nullptr;
  check_cuda(cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking), "cudaStreamCreateWithFlags");
  lane.stream = stream;
  return lane;
}

template <class Call>
bool RenderQueue::attempt(Arrival &arrival, const Call &call) {
  try {
    call();
    return true;
  } catch (...) {
    explain_exception([&](qses_status status, const char *message) {
      arrival.outcome = status;
      arrival.message = message;
    });
    return false;
  }
}

// Nothing here waits for the GPU.
void RenderQueue::serve(int device, const Arrivals &arrivals) {
  Arrival all;
  const bool is_done = attempt(all, [&] {
    const DeviceGuard guard(device);
    Lane &lane = lane_of(device);
    Arrivals ready;
    for (Arrival *const arrival : arrivals)
      if (attempt(*arrival, [&] { prepare(device, lane, *arrival); })) ready.push_back(arrival);
    const Arrivals mapped = map(ready, lane);
    if (!mapped.empty()) copy_and_unmap(device, lane, mapped);
  });
  if (is_done) return;
  for (Arrival *const arrival : arrivals) {
    if (arrival->outcome != QSES_OK) continue;
    arrival->outcome = all.outcome;
    arrival->message = all.message;
  }
}

// What comes before buffers are mapped, so that they are for a short time only.
void RenderQueue::prepare(int device, Lane &lane, Arrival &arrival) {
  GpuTarget &target = *arrival.target;
  if (target.device != device) forget_buffers(target);
  target.device = device;
  if (!target.look_there) target.look_there = std::make_unique<DeviceLook>(device);
  arrival.look = target.look_there->use(arrival.submission.look, lane.stream);
  target.registered.use(arrival.submission.buffers, device);
}

RenderQueue::Resources RenderQueue::resources_of(const Arrivals &arrivals) {
  Resources resources;
  for (const Arrival *const arrival : arrivals) {
    const RegisteredBuffers &r = arrival->target->registered;
    resources.insert(resources.end(), r.resources(), r.resources() + r.count());
  }
  return resources;
}

// Those whose buffers are mapped now: all in one call, as a rule; one by one if one of them can't be.
RenderQueue::Arrivals RenderQueue::map(const Arrivals &arrivals, Lane &lane) {
  const auto try_map = [&](const Arrivals &those) {
    Resources resources = resources_of(those);
    return cudaGraphicsMapResources(static_cast<int>(resources.size()), resources.data(),
                                    static_cast<cudaStream_t>(lane.stream));
  };
  if (arrivals.empty() || try_map(arrivals) == cudaSuccess) return arrivals;
  cudaGetLastError();
  Arrivals mapped;
  for (Arrival *const arrival : arrivals)
    if (attempt(*arrival, [&] { check_cuda(try_map({arrival}), "cudaGraphicsMapResources"); }))
      mapped.push_back(arrival);
    else
      arrival->target->registered.forget();  // should there be a next time, they are made known anew
  return mapped;
}

void RenderQueue::copy_and_unmap(int device, Lane &lane, const Arrivals &arrivals) {
  const auto stream = static_cast<cudaStream_t>(lane.stream);
  const auto begin = static_cast<cudaEvent_t>(lane.begin), end = static_cast<cudaEvent_t>(lane.end);
  Resources resources = resources_of(arrivals);
  if (lane.is_timed && cudaEventQuery(end) == cudaSuccess) cudaEventElapsedTime(&lane.copy_ms, begin, end);
  lane.is_timed = cudaEventRecord(begin, stream) == cudaSuccess;
  for (Arrival *const arrival : arrivals)
    attempt(*arrival, [&] { fill_buffers(*arrival->target, arrival->submission, arrival->look, stream); });
  lane.is_timed = cudaEventRecord(end, stream) == cudaSuccess && lane.is_timed;
  const cudaError_t unmapped = cudaGraphicsUnmapResources(static_cast<int>(resources.size()), resources.data(), stream);
  // Whoever writes into the meshes' memory next is held back until it has been read.
  const std::shared_ptr<const StreamMark> readers = mark(device, lane);
  for (const Arrival *const arrival : arrivals)
    if (!arrival->submission.mesh->memory.is_empty()) arrival->submission.mesh->memory.note_readers(readers);
  if (unmapped != cudaSuccess)
    for (const Arrival *const arrival : arrivals) arrival->target->registered.forget();  // else they stay mapped
  check_cuda(unmapped, "cudaGraphicsUnmapResources");
}

// Null: nothing has to be waited for any more.
std::shared_ptr<const StreamMark> RenderQueue::mark(int device, Lane &lane) {
  try {
    std::shared_ptr<StreamMark> free = find_unheld(lane.marks);
    if (!free) {
      free = std::make_shared<StreamMark>(device);
      lane.marks.push_back(free);
    }
    free->set(lane.stream);
    return free;
  } catch (...) {
    cudaStreamSynchronize(static_cast<cudaStream_t>(lane.stream));
    cudaGetLastError();
    return nullptr;
  }
}

// Throws Error, and then changes nothing.
void RenderQueue::forget_buffers(GpuTarget &target) {
  if (target.device < 0) return;
  const DeviceGuard guard(target.device);
  target.registered.forget();
  target.look_there = nullptr;
  target.device = -1;
}

// What does not go now is left to the next event, unless the device is lost, and what it knew with it.
void RenderQueue::forget_ended(const std::vector<std::shared_ptr<GpuTarget>> &ended) {
  for (const std::shared_ptr<GpuTarget> &target : ended) {
    Arrival outcome;
    const bool stays = !attempt(outcome, [&] { forget_buffers(*target); }) && may_hand_back();
    const std::lock_guard<std::mutex> lock(mutex_);
    if (stays)
      has_work_ = true;
    else
      ended_.erase(std::remove(ended_.begin(), ended_.end(), target),
                   ended_.end());  // which keeps what it has reserved
  }
}

}  // namespace quickses
