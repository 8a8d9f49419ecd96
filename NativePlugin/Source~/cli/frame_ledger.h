// SPDX-License-Identifier: MIT
// The list of frames to be computed: hands them out one by one, and passes results on in their order.
#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>

#include "cli/frame_range.h"
#include "cli/frame_supply.h"

namespace quickses::cli {

class FrameLedger : public FrameSupply {
 public:
  // sink: called with one result after the other, from any thread but never from two at a time. What it throws ends the
  // run. window: how many frames may be handed out beyond the oldest one that is missing; most_kept: none while results
  // of more bytes wait for an older one.
  FrameLedger(const FrameSelection &frames, size_t window, std::function<void(const FrameResult &)> sink,
              size_t most_kept = size_t(256) << 20);

  std::optional<FrameTask> next() override;
  void deliver(FrameResult result) override;
  void give_up(std::exception_ptr why) override;

  enum class Answer { kTask, kLater, kNoMore };
  // As next, without waiting.
  Answer try_next(FrameTask &task);

  // After all workers are done: throws what ended the run early, if anything did.
  void finish();

  size_t failed_count() const { return failed_count_; }

 private:
  Answer take(FrameTask &task);

  const FrameSelection frames_;
  const size_t window_, most_kept_;
  const std::function<void(const FrameResult &)> sink_;
  std::mutex mutex_;
  std::condition_variable changed_;
  size_t handed_out_ = 0, passed_on_ = 0, failed_count_ = 0;
  std::map<uint64_t, FrameResult> early_;  // by place, waiting for those before
  size_t kept_ = 0;                        // bytes of those, and of the one that is being passed on
  bool is_passing_on_ = false;             // one of those who deliver
  std::exception_ptr why_ended_;
};

}  // namespace quickses::cli
