// SPDX-License-Identifier: MIT
#include "process/helper_threads.h"

#include "process/worker_threads.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

#if defined(__SSE2__) || defined(_M_X64)
#include <emmintrin.h>
#endif
#if defined(_WIN32)
#include <windows.h>
#endif

namespace quickses {
namespace {

void pause_a_little() {
#if defined(__SSE2__) || defined(_M_X64)
  for (int k = 0; k < 16; ++k) _mm_pause();
#else
  std::this_thread::yield();
#endif
}

// To any thread that waits for this processor: a plain yield of Windows leaves out those of lower priority, which stand
// back.
void yield_to_any() {
#if defined(_WIN32)
  SwitchToThread();
#else
  std::this_thread::yield();
#endif
}

// Longer than what is done between two passes, as a rule.
constexpr std::chrono::microseconds kAwake{100};
// A thread that lost its processor in the middle of its work needs one of those that wait.
constexpr int kPausesBeforeYield = 64;

}  // namespace

struct HelperThreads::Crew {
  ~Crew();
  void call(size_t workers, Work the_work, const void *of) noexcept;
  void help();
  bool is_called() const { return seats > 0 || quits; }
  void wait_to_be_called();
  bool take_seat();

  // What is to be done; who has a seat may read it.
  Work work = nullptr;
  const void *context = nullptr;
  std::atomic<size_t> next_worker{1};

  // A helper counts itself in before it takes a seat, and who calls takes back the seats before it looks whether any
  // is in: so one of them always sees the other. (All in one order, as atomics have them by default.)
  std::atomic<size_t> seats{0}, at_work{0};
  std::atomic<bool> quits{false};
  std::atomic<size_t> asleep{0};
  std::mutex mutex;
  std::condition_variable called;
  std::vector<std::thread> threads;
};

HelperThreads::HelperThreads(unsigned helpers, bool in_background) {
  try {
    crew_ = std::make_unique<Crew>();
    Crew &crew = *crew_;
    crew.threads.reserve(helpers);
    while (crew.threads.size() < helpers)
      crew.threads.emplace_back([&crew, in_background] {
        if (in_background) stand_back();
        crew.help();
      });
  } catch (const std::system_error &) {
  } catch (const std::bad_alloc &) {
  }
}

HelperThreads::~HelperThreads() {
  if (!own_crew()) crew_.release();
}

size_t HelperThreads::count() const {
  const Crew *const crew = own_crew();
  return crew ? crew->threads.size() : 0;
}

void HelperThreads::run(size_t workers, Work work, const void *context) noexcept {
  if (Crew *const crew = own_crew())
    crew->call(workers, work, context);
  else
    work(context, 0);
}

HelperThreads::Crew::~Crew() {
  {
    const std::lock_guard<std::mutex> lock(mutex);
    quits = true;
  }
  called.notify_all();
  for (std::thread &thread : threads) thread.join();
}

void HelperThreads::Crew::call(size_t workers, Work the_work, const void *of) noexcept {
  work = the_work;
  context = of;
  next_worker = 1;
  const size_t wanted = std::min(workers - 1, threads.size());
  seats = wanted;
  if (asleep > 0) {
    { const std::lock_guard<std::mutex> lock(mutex); }  // who is about to sleep has looked at the seats, or sleeps
    for (size_t k = 0; k < wanted; ++k) called.notify_one();
  }
  work(context, 0);
  seats = 0;
  for (int pauses = 0; at_work > 0; ++pauses) {
    if (pauses < kPausesBeforeYield)
      pause_a_little();
    else
      yield_to_any();
  }
}

void HelperThreads::Crew::help() {
  for (;;) {
    wait_to_be_called();
    if (quits) return;
    ++at_work;
    if (take_seat()) work(context, next_worker++);
    --at_work;
  }
}

void HelperThreads::Crew::wait_to_be_called() {
  if (is_called()) return;
  const auto end = std::chrono::steady_clock::now() + kAwake;
  do {
    pause_a_little();
    if (is_called()) return;
    std::this_thread::yield();  // to whoever has something to do
  } while (std::chrono::steady_clock::now() < end);
  std::unique_lock<std::mutex> lock(mutex);
  ++asleep;
  called.wait(lock, [&] { return is_called(); });
  --asleep;
}

bool HelperThreads::Crew::take_seat() {
  size_t left = seats;
  while (left > 0 && !seats.compare_exchange_weak(left, left - 1)) {
  }
  return left > 0;
}

}  // namespace quickses
