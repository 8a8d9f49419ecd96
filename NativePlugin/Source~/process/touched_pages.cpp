// SPDX-License-Identifier: MIT
#include "process/touched_pages.h"

#include "process/host_memory.h"
#include "process/worker_threads.h"

#include <algorithm>
#include <system_error>
#include <thread>
#include <vector>

#if defined(_WIN32)
#include <malloc.h>
#else
#include <sys/mman.h>
#endif

namespace quickses {
namespace {

constexpr size_t kPage = 4096, kLargePage = size_t(2) << 20;
constexpr size_t kMuch = size_t(4) << 20;  // is worth large pages, and threads

void *take(size_t bytes) {
  const size_t page = bytes < kMuch ? kPage : kLargePage, whole = (bytes + page - 1) / page * page;
#if defined(_WIN32)
  return _aligned_malloc(whole, page);
#else
  void *const memory = std::aligned_alloc(page, whole);
#if defined(MADV_HUGEPAGE)
  if (memory && bytes >= kMuch) madvise(memory, bytes, MADV_HUGEPAGE);  // as the system likes
#endif
  return memory;
#endif
}

void touch(char *begin, char *end) {
  for (volatile char *page = begin; page < end; page += kPage) *page = 0;
}

}  // namespace

void *TouchedPages::acquire(size_t bytes) {
  if (bytes > HostMemory::free_bytes() / 4) return nullptr;
  char *const memory = static_cast<char *>(take(bytes));
  if (!memory) return nullptr;
  const size_t pages = (bytes + kLargePage - 1) / kLargePage;
  const size_t most = bytes < kMuch ? 1 : std::clamp<size_t>(processors(), 1, 8);
  const size_t share = (pages + most - 1) / most * kLargePage;
  std::vector<std::thread> threads;
  char *next = memory, *const end = memory + bytes;
  try {
    for (; static_cast<size_t>(end - next) > share; next += share) threads.emplace_back(touch, next, next + share);
  } catch (const std::system_error &) {  // no more threads: this one does the rest
  } catch (const std::bad_alloc &) {
  }
  touch(next, end);
  for (std::thread &thread : threads) thread.join();
  return memory;
}

void TouchedPages::release(void *memory) {
#if defined(_WIN32)
  _aligned_free(memory);
#else
  std::free(memory);
#endif
}

}  // namespace quickses
