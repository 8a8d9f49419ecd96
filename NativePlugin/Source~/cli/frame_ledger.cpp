// SPDX-License-Identifier: MIT
// The list of frames to be computed.
#include "cli/frame_ledger.h"

namespace quickses::cli {

FrameLedger::FrameLedger(const FrameSelection &frames, size_t window, std::function<void(const FrameResult &)> sink)
    : frames_(frames), window_(window), sink_(std::move(sink)) {}

FrameLedger::Answer FrameLedger::take(FrameTask &task) {
  if (why_ended_ || handed_out_ == frames_.count) return Answer::kNoMore;
  if (handed_out_ >= passed_on_ + window_) return Answer::kLater;
  task = {handed_out_, frames_.frame(handed_out_)};
  ++handed_out_;
  return Answer::kTask;
}

FrameLedger::Answer FrameLedger::try_next(FrameTask &task) {
  const std::lock_guard<std::mutex> lock(mutex_);
  return take(task);
}

std::optional<FrameTask> FrameLedger::next() {
  std::unique_lock<std::mutex> lock(mutex_);
  FrameTask task;
  Answer answer;
  changed_.wait(lock, [&] { return (answer = take(task)) != Answer::kLater; });
  if (answer == Answer::kNoMore) return std::nullopt;
  return task;
}

void FrameLedger::deliver(FrameResult result) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (why_ended_) return;
  if (!result.error.empty()) ++failed_count_;
  try {
    early_.emplace(result.place, std::move(result));
    for (; !early_.empty() && early_.begin()->first == passed_on_; ++passed_on_) {
      sink_(early_.begin()->second);
      early_.erase(early_.begin());
    }
  } catch (...) {
    why_ended_ = std::current_exception();
  }
  changed_.notify_all();
}

void FrameLedger::give_up(std::exception_ptr why) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!why_ended_) why_ended_ = why;
  changed_.notify_all();
}

void FrameLedger::finish() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (why_ended_) std::rethrow_exception(why_ended_);
}

}  // namespace quickses::cli
