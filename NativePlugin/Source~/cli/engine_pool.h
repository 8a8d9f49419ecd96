// SPDX-License-Identifier: MIT
// The engines that many threads share: more threads than engines, so that one always has something to compute.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "cli/engine.h"

namespace quickses::cli {

class EnginePool {
 public:
  // One on each of the devices, which may come several times. prepare: what is done with each of them first. They are
  // made side by side, since a device takes a while to start. Throws Failure; with several devices it names the one.
  EnginePool(const ComputeOptions &options, const std::vector<int> &devices,
             const std::function<void(Engine &)> &prepare);

  // Calls action(engine) with an engine that nobody else has meanwhile. Waits for one; then it may be called on another
  // thread that waits here too. Throws what it throws. From any thread, but not from an action.
  template <class Action>
  void run(const Action &action) {
    Request request(action);
    serve(request);
  }

 private:
  struct Request {
    explicit Request(std::function<void(Engine &)> what) : action(std::move(what)) {}

    const std::function<void(Engine &)> action;
    std::exception_ptr failed;
    bool is_done = false;
    Engine *engine = nullptr;  // handed over by who had it
    std::condition_variable changed;
  };

  void serve(Request &request);
  static void call(Request &request, Engine &engine);
  void pass_on(Engine *engine);

  std::vector<std::unique_ptr<Engine>> engines_;
  std::mutex mutex_;
  std::vector<Engine *> free_;     // for the longest time first
  std::deque<Request *> waiting_;  // the same
};

}  // namespace quickses::cli
