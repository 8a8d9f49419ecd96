// SPDX-License-Identifier: MIT
// The list of frames to be computed.
#include "cli/frame_ledger.h"

namespace quickses::cli {
namespace {

size_t size_of(const FrameResult &result) {
  return result.csv.size() + result.json.size() + result.page.size() + result.per_atom.size() +
         result.per_residue.size() + result.error.size();
}

}  // namespace

FrameLedger::FrameLedger(const FrameSelection &frames, size_t window, std::function<void(const FrameResult &)> sink,
                         size_t most_kept)
    : frames_(frames), window_(window), most_kept_(most_kept), sink_(std::move(sink)) {}

FrameLedger::Answer FrameLedger::take(FrameTask &task) {
  if (why_ended_ || handed_out_ == frames_.count) return Answer::kNoMore;
  if (handed_out_ >= passed_on_ + window_ || kept_ > most_kept_) return Answer::kLater;
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

// Whoever brings the result that was missing passes on what has come after it, too, without holding others up.
void FrameLedger::deliver(FrameResult result) {
  std::unique_lock<std::mutex> lock(mutex_);
  if (why_ended_) return;
  if (!result.error.empty()) ++failed_count_;
  try {
    const uint64_t place = result.place;
    kept_ += size_of(result);
    early_.emplace(place, std::move(result));
    if (is_passing_on_) return;
    is_passing_on_ = true;
    while (!why_ended_ && !early_.empty() && early_.begin()->first == passed_on_) {
      const auto next = early_.extract(early_.begin());
      lock.unlock();
      sink_(next.mapped());
      lock.lock();
      ++passed_on_;
      kept_ -= size_of(next.mapped());
      changed_.notify_all();
    }
  } catch (...) {
    if (!lock.owns_lock()) lock.lock();
    if (!why_ended_) why_ended_ = std::current_exception();
    changed_.notify_all();
  }
  is_passing_on_ = false;
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
