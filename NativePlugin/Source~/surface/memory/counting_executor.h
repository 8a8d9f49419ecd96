// SPDX-License-Identifier: MIT
// An executor that does nothing but count the bytes that the stages ask it for. The pipeline run on it is the forecast
// of what the pipeline takes: both are one piece of code, so that they can't differ.
#pragma once

#include "parallel/arena.h"
#include "parallel/executor.h"
#include "surface/memory/work_facts.h"

#include <algorithm>

namespace quickses {

// What a stage would read back of what it counted. Stages whose memory depends on that overload this.
template <class T>
T expected_value(const WorkFacts &, const T *) {
  return T{};
}

class CountingArena {
 public:
  using Mark = uint64_t;
  explicit CountingArena(uint64_t limit, bool has_budget) : limit_(limit), has_budget_(has_budget) {}
  void take(uint64_t bytes) {
    used_ += arena_bytes(bytes);
    peak_ = std::max(peak_, used_);
  }
  Mark mark() const { return used_; }
  void rewind(Mark mark) { used_ = mark; }
  uint64_t peak() const { return peak_; }
  uint64_t limit() const { return limit_; }
  uint64_t available() const { return limit_ > used_ ? limit_ - used_ : 0; }
  bool has_budget() const { return has_budget_; }

 private:
  uint64_t used_ = 0, peak_ = 0, limit_;
  bool has_budget_;
};

// Executor: the one that would do the work.
template <class Executor>
class CountingExecutor : public NothingQueued {
 public:
  static constexpr bool kIsCuda = Executor::kIsCuda, kCounts = true;

  // limit: bytes that the work may take. facts must outlive this.
  CountingExecutor(Executor &executor, const WorkFacts &facts, uint64_t limit, bool has_budget)
      : executor_(executor), facts_(facts), arena_(limit, has_budget) {}

  Executor &real() { return executor_; }
  auto multiprocessors() const { return executor_.multiprocessors(); }
  const WorkFacts &facts() const { return facts_; }
  CountingArena &arena() { return arena_; }

  template <class T>
  Span<T> allocate(size_t n) {
    arena_.take(n * sizeof(T));
    return {nullptr, n};
  }
  template <class T>
  Span<T> allocate_zeros(size_t n) {
    return allocate<T>(n);
  }
  template <class F>
  void for_each(size_t, const F &, uint64_t = 0) {}
  template <class Scratch, class F>
  void for_each_brick(size_t, const F &, size_t = 8, uint64_t = 0) {}
  template <class... Arguments>
  void launch(const Arguments &...) {}
  template <class Shape>
  bool is_few_launches(size_t items, const Shape &shape) const {
    return executor_.is_few_launches(items, shape);
  }
  static auto for_each_shape(uint64_t steps) { return Executor::for_each_shape(steps); }
  auto for_each_brick_shape(uint64_t steps) const { return executor_.for_each_brick_shape(steps); }
  template <class Load, class T>
  void exclusive_scan(size_t n, const Load &, Span<T>) {
    take_for_a_while(executor_.template scan_bytes<T>(n));
  }
  template <class T = double, class Load>
  T reduce(size_t n, const Load &, uint64_t = 0) {
    take_for_a_while(executor_.template reduce_bytes<T>(n));
    return T{};
  }
  template <class Key, class Value>
  void sort_by_key(Span<Key> keys, Span<Value>) {
    if (keys.size > 1) take_for_a_while(executor_.template sort_bytes<Key, Value>(keys.size));
  }
  template <class Keep, class T>
  size_t compact(size_t n, const Keep &, Span<T>) {
    take_for_a_while(executor_.compact_bytes(n));
    return 0;
  }
  template <class Keep, class T>
  void compact(size_t n, const Keep &keep, Span<T> out, uint64_t *) {
    compact(n, keep, out);
  }
  template <class T>
  T fetch(const T *p) {
    return expected_value(facts_, p);
  }
  template <class T>
  void fetch_all(T *, const T *, size_t) {}
  template <class T>
  T *take_counts() {
    return allocate<T>(1).data;
  }
  template <class T>
  T expect(const char *, const T *counts, const T &) {
    return fetch(counts);
  }
  template <class T>
  T verified(const T *) const {
    return T{};
  }
  template <class T>
  void upload(T *, const T *, size_t) {}
  template <class T>
  void download(T *, const T *, size_t) {}
  template <class T>
  void fill(Span<T>, int) {}

 private:
  void take_for_a_while(uint64_t bytes) {
    const uint64_t mark = arena_.mark();
    arena_.take(bytes);
    arena_.rewind(mark);
  }

  Executor &executor_;
  const WorkFacts &facts_;
  CountingArena arena_;
};

// The one that counts for an executor, without limit. facts must outlive it.
template <class Executor>
CountingExecutor<Executor> counting(Executor &executor, const WorkFacts &facts) {
  return {executor, facts, ~uint64_t(0) >> 1, executor.arena().has_budget()};
}
template <class Executor>
CountingExecutor<Executor> counting(CountingExecutor<Executor> &executor, const WorkFacts &facts) {
  return counting(executor.real(), facts);
}

}  // namespace quickses
