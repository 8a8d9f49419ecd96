// SPDX-License-Identifier: MIT
// How much one launch of a kernel may be given. Windows (WDDM) ends what runs on a GPU that shows the desktop for two
// seconds, and nothing that runs or is queued can be cancelled. So the rule is: no launch takes more than 200 ms on the
// smallest GPU that is supported, whatever the input. Every kernel says what a thread does at most for an item, and the
// executor gives a launch no more items than fit the rule. Where a single item may be too long (an atom among very
// many) it is cut where it is worked on.
//
// Counted are steps: a round of a loop of one warp, some 25 instructions. An estimate, not a measurement: the smallest
// GPU (compute capability 7.5, as an NVIDIA T400: 6 multiprocessors of 1.4 GHz, of two warps' instructions per clock)
// does some 40 million of them per second and multiprocessor, if it reaches two fifths of what it could. kLaunchSteps
// are then about 100 ms. A thread whose block is alone waits for memory in every step, some 300 clocks: kThreadSteps
// (executor.h) are 110 ms. More multiprocessors get as many times more items; faster ones are done earlier.
//
// Passes of CUB are not cut: they stream through memory of the device, and to read and write all that a GPU has takes
// each of them less than that.
#pragma once

#include "parallel/executor.h"

#include <cuda_runtime.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace quickses {

// The items of one launch.
struct LaunchItems {
  size_t first, last;
};

// They are told to a kernel when all that was queued before it is done: so it may be sent to the multiprocessors while
// the last blocks of the kernel before it still run (programmatic dependent launch, from compute capability 9.0 on),
// and has no other way to learn what it is to do. Each kernel asks first of all, and by all its threads. (To let the
// next one in as early as a kernel starts was slower: what waits takes room from what works.)
class QueuedItems {
 public:
  QueuedItems(size_t first, size_t last) : items_{first, last} {}
  __device__ __forceinline__ LaunchItems in_turn() const {
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 900
    asm volatile("griddepcontrol.wait;" ::: "memory");
#endif
    return items_;
  }

 private:
  LaunchItems items_;
};

// For __launch_bounds__: so many blocks that a multiprocessor is to hold at once, or as many as it can hold at all, and
// as their threads leave room for (CUDA C++ Programming Guide, "Technical Specifications per Compute Capability").
constexpr int blocks_at_once(int threads, int wanted) {
#if defined(__CUDA_ARCH__) && __CUDA_ARCH__ < 800
  constexpr int kMostThreads = 1024, kMostBlocks = 16;
#elif defined(__CUDA_ARCH__) && __CUDA_ARCH__ >= 860 && __CUDA_ARCH__ < 890
  constexpr int kMostThreads = 1536, kMostBlocks = 16;
#elif defined(__CUDA_ARCH__) && ((__CUDA_ARCH__ >= 890 && __CUDA_ARCH__ < 900) || __CUDA_ARCH__ >= 1200)
  constexpr int kMostThreads = 1536, kMostBlocks = 24;
#else
  constexpr int kMostThreads = 2048, kMostBlocks = 32;
#endif
  const int most = kMostThreads / threads < kMostBlocks ? kMostThreads / threads : kMostBlocks;
  return wanted < most ? wanted : most;
}

// Threads that keep a multiprocessor busy: where there would be fewer, each item may have several.
constexpr size_t kFullThreads = 1024;

// Where items take unlike times, so many blocks of each multiprocessor take turns: enough to fill it whatever their
// size, and each goes on with what others would have waited for.
template <class Executor>
size_t blocks_in_turns(const Executor &executor) {
  return size_t(executor.multiprocessors()) * 20;
}

// Steps per multiprocessor.
constexpr uint64_t kLaunchSteps = uint64_t(1) << 22;
struct LaunchShape {
  int threads;             // of a block
  size_t items_per_block;  // at a time
  uint64_t steps;          // of a thread for its share of those items, at most
  size_t most_blocks = 0;  // which take turns; 0: a block for each share
  size_t shared_bytes = 0;
};

// Whole blocks' worth. At least one block per multiprocessor.
inline size_t most_items_of_launch(const LaunchShape &shape, unsigned multiprocessors) {
  const uint64_t warps = static_cast<uint64_t>(shape.threads) / 32, steps = std::max<uint64_t>(1, shape.steps);
  const uint64_t blocks = std::max<uint64_t>(1, kLaunchSteps / warps / steps) * multiprocessors;
  return static_cast<size_t>(std::min<uint64_t>(blocks, 0x7fffffff)) * shape.items_per_block;
}

// For tests and measurements: hears of every launch.
class LaunchObserver {
 public:
  struct Launch {
    const char *name;
    uint64_t steps;  // per multiprocessor, at most; 0 for passes of CUB, which stream through memory
    size_t blocks;   // 0 for passes of CUB
    cudaStream_t stream;
  };
  virtual ~LaunchObserver() = default;
  // That an executor which is made now takes the GPU to have: fewer make more launches.
  virtual unsigned multiprocessors(unsigned there_are) { return there_are; }
  virtual void before(const Launch &launch) = 0;
  virtual void after(const Launch &launch) = 0;
  static inline LaunchObserver *current = nullptr;  // set it while nothing computes
};

// Tells it.
class LaunchWatch {
 public:
  LaunchWatch(const char *name, size_t blocks, size_t shares, const LaunchShape &shape, unsigned multiprocessors,
              cudaStream_t stream) {
    if (!LaunchObserver::current) return;
    const uint64_t steps = std::max<uint64_t>(1, shape.steps) * (static_cast<uint64_t>(shape.threads) / 32);
    launch_ = {name, (shares + multiprocessors - 1) / multiprocessors * steps, blocks, stream};
    LaunchObserver::current->before(launch_);
  }
  LaunchWatch(const char *name, cudaStream_t stream) {
    if (!LaunchObserver::current) return;
    launch_ = {name, 0, 0, stream};
    LaunchObserver::current->before(launch_);
  }
  ~LaunchWatch() {
    if (LaunchObserver::current) LaunchObserver::current->after(launch_);
  }
  LaunchWatch(const LaunchWatch &) = delete;
  LaunchWatch &operator=(const LaunchWatch &) = delete;

 private:
  LaunchObserver::Launch launch_{};
};

}  // namespace quickses
