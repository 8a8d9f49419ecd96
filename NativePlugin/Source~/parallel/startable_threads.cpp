// SPDX-License-Identifier: MIT
#include "parallel/startable_threads.h"

#include <future>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

namespace quickses {

unsigned count_startable_threads(unsigned wanted) {
  std::vector<std::thread> threads;
  std::promise<void> all_started;
  const std::shared_future<void> end = all_started.get_future().share();
  try {
    threads.reserve(wanted);
    while (threads.size() < wanted) threads.emplace_back([end] { end.wait(); });
  } catch (const std::system_error &) {
  } catch (const std::bad_alloc &) {
  }
  all_started.set_value();
  for (std::thread &thread : threads) thread.join();
  return static_cast<unsigned>(threads.size());
}

}  // namespace quickses
