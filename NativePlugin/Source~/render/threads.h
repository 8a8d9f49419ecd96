// SPDX-License-Identifier: MIT
#pragma once

#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace quickses::render {

// Runs work on some threads, this one among them. Throws what one of them throws, after the end of all.
template <class Work>
void run_on_threads(unsigned count, const Work &work) {
  std::exception_ptr failed;
  std::mutex mutex;
  const auto guarded = [&] {
    try {
      work();
    } catch (...) {
      const std::lock_guard<std::mutex> lock(mutex);
      failed = std::current_exception();
    }
  };
  std::vector<std::thread> others;
  others.reserve(count);
  try {
    for (unsigned k = 1; k < count; ++k) others.emplace_back(guarded);
  } catch (const std::exception &) {  // there are no more to be had: these do
  }
  guarded();
  for (std::thread &thread : others) thread.join();
  if (failed) std::rethrow_exception(failed);
}

}  // namespace quickses::render
