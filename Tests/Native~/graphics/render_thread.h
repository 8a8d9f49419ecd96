// SPDX-License-Identifier: MIT
// A thread that draws, as Unity has one: it does what it is told in order, up to two frames behind whoever tells it.
#pragma once

#include "graphics/gl_without_window.h"

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace graphics_fixture {

class RenderThread {
 public:
  static constexpr size_t kFramesBehind = 2;

  // The context is current on the thread until it ends, and must not be current elsewhere.
  explicit RenderThread(const gl_without_window::Context &context)
      : thread_([this, &context] {
          context.make_current();
          work();
          gl_without_window::Context::release();
        }) {}
  ~RenderThread() { finish(); }
  RenderThread(const RenderThread &) = delete;
  RenderThread &operator=(const RenderThread &) = delete;

  // Waits while it is too far behind.
  void draw(std::function<void()> frame) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return behind_ < kFramesBehind; });
    frames_.push_back(std::move(frame));
    ++behind_;
    changed_.notify_all();
  }
  // Draws what it was told so far, and ends.
  void finish() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      quit_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
  }

 private:
  void work() {
    for (;;) {
      std::function<void()> frame;
      {
        std::unique_lock<std::mutex> lock(mutex_);
        changed_.wait(lock, [this] { return quit_ || !frames_.empty(); });
        if (frames_.empty()) return;
        frame = std::move(frames_.front());
        frames_.pop_front();
      }
      frame();
      const std::lock_guard<std::mutex> lock(mutex_);
      --behind_;
      changed_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> frames_;
  size_t behind_ = 0;
  bool quit_ = false;
  std::thread thread_;
};

}  // namespace graphics_fixture
