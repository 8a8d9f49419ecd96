// SPDX-License-Identifier: MIT
// The verbs of parallel/executor.h as plain loops: the slowest back end, and the easiest to believe. For tests.
#pragma once

#include "parallel/arena.h"
#include "parallel/executor.h"
#include "process/host_memory.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <numeric>
#include <vector>

struct SerialMemory {
  static constexpr const char *kName = "the machine";
  static uint64_t free_bytes() { return 0; }
  static void *acquire(size_t bytes) { return quickses::HostMemory::acquire(bytes); }
  static void release(void *memory) { quickses::HostMemory::release(memory); }
};

class SerialExecutor : public quickses::NothingQueued {
 public:
  static constexpr bool kIsCuda = false, kCounts = false;
  explicit SerialExecutor(unsigned = 1) {}
  quickses::Arena<SerialMemory> &arena() { return arena_; }

  template <class T>
  quickses::Span<T> allocate(size_t n) {
    return {static_cast<T *>(arena_.allocate(n * sizeof(T))), n};
  }
  template <class T>
  quickses::Span<T> allocate_zeros(size_t n) {
    const auto zeros = allocate<T>(n);
    fill(zeros, 0);
    return zeros;
  }
  template <class F>
  void for_each(size_t n, F f, uint64_t = 0) {
    for (size_t i = 0; i < n; ++i) f(i);
  }
  template <class Scratch, class F>
  void for_each_brick(size_t n, F f, size_t = 8, uint64_t = 0) {
    const std::unique_ptr<Scratch> scratch(new Scratch);
    for (size_t i = 0; i < n; ++i) f(quickses::SoloTeam{}, *scratch, i);
  }
  template <class Load, class T>
  void exclusive_scan(size_t n, Load load, quickses::Span<T> out) {
    T sum{};
    for (size_t i = 0; i < n; ++i) {
      out[i] = sum;
      sum = sum + static_cast<T>(load(i));
    }
    out[n] = sum;
  }
  template <class T = double, class Load>
  T reduce(size_t n, Load load, uint64_t = 0) {
    T sum{};
    for (size_t i = 0; i < n; ++i) sum += load(i);
    return sum;
  }
  template <class Key, class Value>
  void sort_by_key(quickses::Span<Key> keys, quickses::Span<Value> values) {
    std::vector<size_t> order(keys.size);
    std::iota(order.begin(), order.end(), size_t(0));
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return keys[a] < keys[b]; });
    const std::vector<Key> old_keys(keys.begin(), keys.end());
    const std::vector<Value> old_values(values.begin(), values.end());
    for (size_t i = 0; i < order.size(); ++i) {
      keys[i] = old_keys[order[i]];
      values[i] = old_values[order[i]];
    }
  }
  template <class Keep, class T>
  size_t compact(size_t n, Keep keep, quickses::Span<T> out) {
    size_t kept = 0;
    for (size_t i = 0; i < n; ++i)
      if (keep(i)) out[kept++] = static_cast<T>(i);
    return kept;
  }
  template <class Keep, class T>
  void compact(size_t n, Keep keep, quickses::Span<T> out, uint64_t *count) {
    *count = compact(n, keep, out);
  }
  template <class T>
  T fetch(const T *p) {
    return *p;
  }
  template <class T>
  void fetch_all(T *values, const T *source, size_t n) {
    if (values != source) std::copy(source, source + n, values);
  }
  template <class T>
  T *take_counts() {
    return allocate_zeros<T>(1).data;
  }
  template <class T>
  T expect(const char *, const T *counts, const T &) {
    return *counts;
  }
  template <class T>
  void upload(T *destination, const T *host, size_t n) {
    std::copy(host, host + n, destination);
  }
  template <class T>
  void download(T *host, const T *source, size_t n) {
    std::copy(source, source + n, host);
  }
  template <class T>
  void fill(quickses::Span<T> span, int byte) {
    std::memset(static_cast<void *>(span.data), byte, span.size * sizeof(T));
  }

 private:
  quickses::Arena<SerialMemory> arena_;
};
