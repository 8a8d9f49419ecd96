// SPDX-License-Identifier: MIT
#include "parallel/working_thread.h"

#include "parallel/error.h"

namespace quickses {
namespace {

thread_local const std::atomic<bool> *stop_of_thread = nullptr;

}  // namespace

WorkScope::WorkScope(const std::atomic<bool> *stop) : before_(stop_of_thread) { stop_of_thread = stop; }

WorkScope::~WorkScope() { stop_of_thread = before_; }

void throw_if_stopped() {
  const std::atomic<bool> *const stop = stop_of_thread;
  if (stop && stop->load(std::memory_order_relaxed)) throw Cancelled{};
}

}  // namespace quickses
