// SPDX-License-Identifier: MIT
// Passes in which few items need more than a glance. A team goes through its items, and then shares out those few among
// its threads: on a GPU, threads that have nothing to do would wait for the ones beside them.
#pragma once

#include "parallel/atomics.h"
#include "parallel/executor.h"

namespace quickses {

// Of a team's items, those that are left for the second step, in any order.
struct LeftItems {
  static constexpr size_t kChunk = 128;
  uint32_t count;
  uint8_t place[kChunk];  // in the chunk
};

template <class Pass>
struct TwoSteps {
  Pass pass;
  size_t n;
  template <class Team>
  QSES_FN void operator()(const Team &team, LeftItems &left, size_t chunk) const {
    const size_t first = chunk * left.kChunk, end = first + left.kChunk < n ? first + left.kChunk : n;
    if (team.rank() == 0) left.count = 0;
    team.sync();
    for (size_t i = first + static_cast<size_t>(team.rank()); i < end; i += static_cast<size_t>(team.size()))
      if (!pass.is_done_at_a_glance(i))
        left.place[atomic_add(&left.count, uint32_t(1))] = static_cast<uint8_t>(i - first);
    team.sync();
    for (uint32_t k = static_cast<uint32_t>(team.rank()); k < left.count; k += static_cast<uint32_t>(team.size()))
      pass.finish(first + left.place[k]);
  }
};

// Calls pass.is_done_at_a_glance(i), and pass.finish(i) where that is not so. steps: of both.
template <class Executor, class Pass>
void for_each_in_two_steps(Executor &executor, size_t n, const Pass &pass, uint64_t steps = kPlainSteps) {
  executor.template for_each_brick<LeftItems>((n + LeftItems::kChunk - 1) / LeftItems::kChunk, TwoSteps<Pass>{pass, n},
                                              4, steps);
}

}  // namespace quickses
