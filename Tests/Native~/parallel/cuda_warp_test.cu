// SPDX-License-Identifier: MIT
// What the threads of a warp or a block find together, against plain loops.
#include "parallel/cuda_executor.cuh"
#include "parallel/cuda_warp.cuh"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <utility>
#include <vector>

namespace {

using namespace quickses;

constexpr int kThreads = 128;

struct Found {
  uint32_t all_bits, sum, least;
  int32_t most;
  float largest, largest_of_eight;
  gpu::NumberedValue numbered, numbered_of_eight;
};
struct WarpJob {
  const uint32_t *numbers;
  const float *values;
  Found *found;  // by each thread
};
__global__ void find_of_warps_kernel(QueuedItems queued, WarpJob job) {
  const LaunchItems items = queued.in_turn();
  const size_t i = items.first + blockIdx.x * size_t(kThreads) + threadIdx.x;
  const uint32_t number = job.numbers[i];
  const float value = job.values[i];
  job.found[i] = {gpu::warp_or(number),
                  gpu::warp_sum(number),
                  gpu::warp_minimum(number),
                  gpu::warp_maximum(static_cast<int32_t>(number)),
                  gpu::warp_maximum(value),
                  gpu::warp_maximum<8>(value),
                  gpu::warp_largest({value, number}),
                  gpu::warp_largest<8>({value, number})};
}

struct AppendJob {
  const uint8_t *wanted;
  uint32_t count;
  uint32_t *list, *listed;
};
__global__ void append_of_blocks_kernel(QueuedItems queued, AppendJob job) {
  const LaunchItems items = queued.in_turn();
  const uint32_t i = static_cast<uint32_t>(items.first) + blockIdx.x * kThreads + threadIdx.x;
  gpu::append_of_block<kThreads>(job.list, job.listed, i, i < job.count && job.wanted[i]);
}

// A warp per job: all items of its runs, behind each other.
struct RunsJob {
  const ItemRun *runs;
  const uint32_t *first_run, *first_item;  // of each job
  uint32_t most;
  uint32_t *items, *met;
};
template <class Items>
__global__ void visit_runs_kernel(QueuedItems queued, RunsJob job) {
  const LaunchItems items = queued.in_turn();
  const size_t warp = items.first + blockIdx.x * size_t(kThreads / 32) + threadIdx.x / 32;
  if (warp >= items.last) return;
  const uint32_t first = job.first_run[warp], rows = job.first_run[warp + 1] - first;
  uint32_t *const out = job.items + job.first_item[warp];
  uint32_t listed = 0;
  const uint32_t met = gpu::visit_runs<Items>(
      static_cast<int>(rows), [&](int r) { return job.runs[first + static_cast<uint32_t>(r)]; },
      [&](uint32_t item, bool on) {
        const uint32_t place = gpu::append_place(on, &listed);
        if (on) out[place] = item;
      },
      job.most);
  if (threadIdx.x % 32 == 0) job.met[warp] = met;
}

class CudaWarps : public testing::Test {
 protected:
  void SetUp() override {
    const CudaDevice description = describe_cuda_device(0);
    if (!description.available) GTEST_SKIP() << "skipped: no CUDA device (" << description.reason << ")";
    executor_ = std::make_unique<CudaExecutor>(0);
  }
  template <class T>
  Span<T> to_device(const std::vector<T> &host) {
    Span<T> span = executor_->allocate<T>(host.size());
    executor_->upload(span.data, host.data(), host.size());
    return span;
  }
  template <class T>
  std::vector<T> to_host(Span<T> span) {
    std::vector<T> host(span.size);
    executor_->download(host.data(), span.data, span.size);
    executor_->wait();
    return host;
  }
  std::unique_ptr<CudaExecutor> executor_;
};

// Numbers of all sizes, and values of both signs, many of them equal.
TEST_F(CudaWarps, FindTheSameAsALoop) {
  std::mt19937 random(7);
  constexpr size_t kCount = 40 * kThreads;
  std::vector<uint32_t> numbers(kCount);
  std::vector<float> values(kCount);
  for (size_t i = 0; i < kCount; ++i) {
    numbers[i] = static_cast<uint32_t>(random()) >> (random() % 32);
    const float kinds[] = {static_cast<float>(random() % 5) - 2.f,
                           std::ldexp(1.f, static_cast<int>(random() % 200) - 100),
                           -std::ldexp(1.f, static_cast<int>(random() % 200) - 100), -1e30f};
    values[i] = kinds[i / kThreads % 2 ? random() % 4 : random() % 2 * 3];
  }
  Span<Found> found = executor_->allocate<Found>(kCount);
  executor_->launch("find_of_warps", find_of_warps_kernel, kCount, LaunchShape{kThreads, kThreads, 64},
                    WarpJob{to_device(numbers).data, to_device(values).data, found.data});
  const std::vector<Found> all = to_host(found);
  const auto largest = [&](size_t first, size_t lanes) {
    gpu::NumberedValue best{values[first], numbers[first]};
    for (size_t i = first; i < first + lanes; ++i)
      if (values[i] > best.value || (values[i] == best.value && numbers[i] < best.number))
        best = {values[i], numbers[i]};
    return best;
  };
  for (size_t i = 0; i < kCount; ++i) {
    const size_t warp = i / 32 * 32, group = i / 8 * 8;
    uint32_t bits = 0, sum = 0, least = ~0u;
    int32_t most = INT32_MIN;
    for (size_t k = warp; k < warp + 32; ++k) {
      bits |= numbers[k];
      sum += numbers[k];
      least = std::min(least, numbers[k]);
      most = std::max(most, static_cast<int32_t>(numbers[k]));
    }
    ASSERT_EQ(all[i].all_bits, bits) << i;
    ASSERT_EQ(all[i].sum, sum) << i;
    ASSERT_EQ(all[i].least, least) << i;
    ASSERT_EQ(all[i].most, most) << i;
    ASSERT_EQ(all[i].largest, largest(warp, 32).value) << i;
    ASSERT_EQ(all[i].largest_of_eight, largest(group, 8).value) << i;
    ASSERT_EQ(all[i].numbered.value, largest(warp, 32).value) << i;
    ASSERT_EQ(all[i].numbered.number, largest(warp, 32).number) << i;
    ASSERT_EQ(all[i].numbered_of_eight.value, largest(group, 8).value) << i;
    ASSERT_EQ(all[i].numbered_of_eight.number, largest(group, 8).number) << i;
  }
}

// Blocks of which all, some or no threads have an item: each is listed once, and nothing else.
TEST_F(CudaWarps, BlocksListEachItemOnce) {
  std::mt19937 random(11);
  std::vector<uint8_t> wanted(50 * kThreads + 77);
  std::vector<uint32_t> expected;
  for (size_t i = 0; i < wanted.size(); ++i) {
    const size_t kind = i / kThreads % 4;
    wanted[i] = kind == 0 ? 0 : kind == 1 ? 1 : kind == 2 ? random() % 2 : random() % kThreads == 0;
    if (wanted[i]) expected.push_back(static_cast<uint32_t>(i));
  }
  Span<uint32_t> list = executor_->allocate<uint32_t>(wanted.size()), listed = executor_->allocate_zeros<uint32_t>(1);
  executor_->launch("append_of_blocks", append_of_blocks_kernel, wanted.size(), LaunchShape{kThreads, kThreads, 64},
                    AppendJob{to_device(wanted).data, static_cast<uint32_t>(wanted.size()), list.data, listed.data});
  const uint32_t count = to_host(listed)[0];
  ASSERT_EQ(count, expected.size());
  std::vector<uint32_t> found = to_host(list);
  found.resize(count);
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, expected);
}

// Runs of all lengths, of which many are empty: their items in order, whatever tells them apart. Where there are more
// than is asked for, that is told.
TEST_F(CudaWarps, VisitTheItemsOfRunsInOrder) {
  std::mt19937 random(13);
  constexpr size_t kJobs = 300;
  std::vector<ItemRun> runs;
  std::vector<uint32_t> first_run{0}, first_item{0}, expected;
  for (size_t j = 0; j < kJobs; ++j) {
    const size_t rows = random() % 100, longest = 1 + (random() >> (random() % 32)) % 90, empty = random() % 4;
    for (size_t r = 0; r < rows; ++r) {
      const uint32_t begin = random() % 100000;
      const uint32_t length = random() % 4 < empty ? 0 : static_cast<uint32_t>(random() % longest);
      runs.push_back({begin, begin + length});
      for (uint32_t k = 0; k < length; ++k) expected.push_back(begin + k);
    }
    first_run.push_back(static_cast<uint32_t>(runs.size()));
    first_item.push_back(static_cast<uint32_t>(expected.size()));
  }
  const auto visit = [&](auto kernel, uint32_t most) {
    RunsJob job{to_device(runs).data, to_device(first_run).data, to_device(first_item).data, most, nullptr, nullptr};
    Span<uint32_t> items = executor_->allocate_zeros<uint32_t>(expected.size()),
                   met = executor_->allocate<uint32_t>(kJobs);
    job.items = items.data;
    job.met = met.data;
    executor_->launch("visit_runs", kernel, kJobs, LaunchShape{kThreads, kThreads / 32, 4096}, job);
    return std::pair(to_host(items), to_host(met));
  };
  const auto check = [&](const char *name, auto kernel) {
    const auto [items, met] = visit(kernel, ~uint32_t(0));
    EXPECT_EQ(items, expected) << name;
    for (size_t j = 0; j < kJobs; ++j) ASSERT_EQ(met[j], first_item[j + 1] - first_item[j]) << name << " " << j;
    constexpr uint32_t kMost = 100;
    const auto [few, met_of_few] = visit(kernel, kMost);
    for (size_t j = 0; j < kJobs; ++j) {
      const uint32_t all = first_item[j + 1] - first_item[j];
      ASSERT_EQ(met_of_few[j] > kMost, all > kMost) << name << " " << j;
      if (all <= kMost)
        for (uint32_t k = first_item[j]; k < first_item[j + 1]; ++k) ASSERT_EQ(few[k], expected[k]) << name << " " << j;
    }
  };
  check("by search", visit_runs_kernel<gpu::RunItems>);
  check("by marks", visit_runs_kernel<gpu::MarkedRunItems>);
}

}  // namespace
