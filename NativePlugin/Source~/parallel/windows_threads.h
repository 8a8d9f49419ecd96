// SPDX-License-Identifier: MIT
// Threads of a thread pool of Windows. Its header, whose names are everywhere, stays in the source file.
#pragma once

#include <cstddef>

namespace quickses {

// A pool that nobody else uses, so that the priority of its threads is ours. Windows starts them when there is work,
// and lets go of those that had none for long. One caller at a time.
class WindowsThreads {
 public:
  // helpers: so many threads at most, besides those that call.
  explicit WindowsThreads(unsigned helpers) noexcept;
  ~WindowsThreads();
  WindowsThreads(const WindowsThreads &) = delete;
  WindowsThreads &operator=(const WindowsThreads &) = delete;

  // Whether there is a pool at all.
  bool is_open() const noexcept { return pool_ != nullptr; }

  // work(context, worker), which must not throw, for worker 0 by the calling thread, and for others up to workers - 1
  // by the helpers that come before it is through. Nobody waits for the others: what is to be done is shared out by
  // `work`.
  void run(size_t workers, void (*work)(const void *context, size_t worker), const void *context) noexcept;

 private:
  struct Pool;
  Pool *pool_;  // nullptr: Windows refused it
};

}  // namespace quickses
