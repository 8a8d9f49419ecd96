// SPDX-License-Identifier: MIT
// Threads that help another one. OpenMP's sleep between passes, and wake up late; those of oneTBB are no faster, and a
// plug-in would share them with whoever else in the process has a oneTBB.
#pragma once

#include "process/this_process.h"

#include <cstddef>
#include <memory>

namespace quickses {

// They wait awake for a little while after they helped, since passes follow each other soon, and then sleep. One caller
// at a time. In a forked child, which they are not in, the caller is alone.
class HelperThreads {
 public:
  // Starts so many, or as many as the system gives. in_background: they stand back.
  explicit HelperThreads(unsigned helpers, bool in_background = false);
  ~HelperThreads();
  HelperThreads(const HelperThreads &) = delete;
  HelperThreads &operator=(const HelperThreads &) = delete;

  size_t count() const;

  // work(context, worker), which must not throw, for worker 0 by the calling thread, and for others up to workers - 1
  // by the helpers that come before it is through. Nobody waits for those that do not: what is to be done is shared out
  // by `work`. All that began have ended when this returns.
  using Work = void (*)(const void *context, size_t worker);
  void run(size_t workers, Work work, const void *context) noexcept;

 private:
  struct Crew;
  // Not even to be destroyed in a forked child: there it says that threads wait for it, as they did in the parent.
  Crew *own_crew() const noexcept { return process_ == this_process() ? crew_.get() : nullptr; }

  long process_ = this_process();  // that has them
  std::unique_ptr<Crew> crew_;
};

}  // namespace quickses
