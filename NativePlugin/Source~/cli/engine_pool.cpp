// SPDX-License-Identifier: MIT
// The engines that many threads share.
#include "cli/engine_pool.h"

#include <algorithm>
#include <chrono>
#include <future>

#include "cli/clock.h"
#include "cli/exit_code.h"

namespace quickses::cli {

EnginePool::EnginePool(const ComputeOptions &options, const std::vector<int> &devices,
                       const std::function<void(Engine &)> &prepare) {
  const bool is_one_device =
      std::count(devices.begin(), devices.end(), devices.front()) == std::ptrdiff_t(devices.size());
  const auto make = [&](int device) {
    try {
      auto engine = std::make_unique<Engine>(options, device);
      prepare(*engine);
      return engine;
    } catch (const Failure &failure) {
      if (is_one_device) throw;
      throw Failure(failure.code(), "device " + std::to_string(device) + ": " + failure.what());
    }
  };
  // Where the system refuses a thread, this one makes the engine.
  std::vector<std::future<std::unique_ptr<Engine>>> made;
  for (const int device : devices) made.push_back(std::async(std::launch::async | std::launch::deferred, make, device));
  for (auto &engine : made) engines_.push_back(engine.get());
  free_.reserve(engines_.size());
  for (const auto &engine : engines_) free_.push_back(engine.get());
}

void EnginePool::call(Request &request, Engine &engine) {
  try {
    request.action(engine);
  } catch (...) {
    request.failed = std::current_exception();
  }
}

// To wake a thread that waits takes some hundredths of a millisecond, in which the engine would have nothing to do: so
// whoever has one goes on with what others wait for, for a while.
void EnginePool::serve(Request &mine) {
  constexpr std::chrono::milliseconds kWhile(5);
  std::unique_lock<std::mutex> lock(mutex_);
  if (free_.empty()) {
    waiting_.push_back(&mine);
    mine.changed.wait(lock, [&] { return mine.is_done || mine.engine; });
  } else {
    mine.engine = free_.front();
    free_.erase(free_.begin());
  }
  if (!mine.is_done) {
    Engine *const engine = mine.engine;
    const auto until = Clock::now() + kWhile;
    lock.unlock();
    call(mine, *engine);
    lock.lock();
    while (!waiting_.empty() && Clock::now() < until) {
      Request *const next = waiting_.front();
      waiting_.pop_front();
      lock.unlock();
      call(*next, *engine);
      lock.lock();
      next->is_done = true;
      next->changed.notify_one();
    }
    pass_on(engine);
  }
  lock.unlock();
  if (mine.failed) std::rethrow_exception(mine.failed);
}

// The mutex is held.
void EnginePool::pass_on(Engine *engine) {
  if (waiting_.empty()) {
    free_.push_back(engine);  // there is room for all
    return;
  }
  Request *const next = waiting_.front();
  waiting_.pop_front();
  next->engine = engine;
  next->changed.notify_one();
}

}  // namespace quickses::cli
