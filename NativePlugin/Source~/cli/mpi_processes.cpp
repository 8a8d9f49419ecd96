// SPDX-License-Identifier: MIT
// Many processes under MPI. The first has the ledger of frames and answers the others; they ask for a frame when a
// worker of theirs is free, and send its result back.
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <climits>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "cli/processes.h"
#include "cli/tell.h"

#if defined(__linux__)
#include <sched.h>
#endif

namespace quickses::cli {
namespace {

constexpr int kFirst = 0;

enum Tag {
  kRequest = 1,  // other -> first: empty
  kReply = 2,    // first -> other: Reply
  kResult = 3,   // other -> first: a FrameResult, packed
  kDone = 4,     // other -> first: empty
};

struct Reply {
  uint64_t answer, place, frame;  // answer: FrameLedger::Answer
};

constexpr int kReplyLength = 3;
constexpr std::chrono::microseconds kPollingInterval(100);  // MPI has no wait that leaves the processor to others
constexpr std::chrono::milliseconds kLater(2);

std::vector<uint8_t> pack(const FrameResult &result) {
  nlohmann::json packed = {result.place, result.frame};
  for (const std::string *text :
       {&result.csv, &result.json, &result.page, &result.per_atom, &result.per_residue, &result.error})
    packed.push_back(nlohmann::json::binary({text->begin(), text->end()}));
  return nlohmann::json::to_msgpack(packed);
}

FrameResult unpack(const std::vector<uint8_t> &bytes) {
  const nlohmann::json packed = nlohmann::json::from_msgpack(bytes);
  const auto text = [&](size_t k) {
    const auto &binary = packed.at(k).get_binary();
    return std::string(binary.begin(), binary.end());
  };
  return {
      packed.at(0).get<uint64_t>(), packed.at(1).get<uint64_t>(), text(2), text(3), text(4), text(5), text(6), text(7)};
}

// Of a process that can't go on: the frames it has would be missing for ever, and others wait for its answers.
void abort_all(std::exception_ptr why) {
  const Failure failure = failure_of(why);
  tell(failure.what());
  MPI_Abort(MPI_COMM_WORLD, failure.code());
}

// Workers of this process take turns at talking to the first process.
class RemoteSupply : public FrameSupply {
 public:
  std::optional<FrameTask> next() override {
    for (;;) {
      Reply reply{};
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        MPI_Send(nullptr, 0, MPI_BYTE, kFirst, kRequest, MPI_COMM_WORLD);
        MPI_Recv(&reply, kReplyLength, MPI_UINT64_T, kFirst, kReply, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
      }
      const auto answer = static_cast<FrameLedger::Answer>(reply.answer);
      if (answer == FrameLedger::Answer::kTask) return FrameTask{reply.place, reply.frame};
      if (answer == FrameLedger::Answer::kNoMore) return std::nullopt;
      std::this_thread::sleep_for(kLater);
    }
  }

  void deliver(FrameResult result) override {
    const std::vector<uint8_t> bytes = pack(result);
    if (bytes.size() > INT_MAX)
      throw Failure(kComputingFailed, "frame " + std::to_string(result.frame) + ": the result has more than " +
                                          std::to_string(INT_MAX) + " bytes, which MPI does not send");
    const std::lock_guard<std::mutex> lock(mutex_);
    MPI_Send(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, kFirst, kResult, MPI_COMM_WORLD);
  }

  void give_up(std::exception_ptr why) override { abort_all(why); }

 private:
  std::mutex mutex_;
};

class MpiProcesses : public Processes {
 public:
  MpiProcesses(int *argc, char ***argv) {
    int provided = MPI_THREAD_SINGLE;
    MPI_Init_thread(argc, argv, MPI_THREAD_SERIALIZED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &count_);
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &local_);
    MPI_Comm_rank(local_, &local_rank_);
    MPI_Comm_size(local_, &local_count_);
    has_threads_ = provided >= MPI_THREAD_SERIALIZED;
    share_processors();
  }

  ~MpiProcesses() override {
    MPI_Comm_free(&local_);
    MPI_Finalize();
  }

  bool has_threads() const { return has_threads_; }
  int rank() const override { return rank_; }
  int count() const override { return count_; }
  int local_rank() const override { return local_rank_; }
  unsigned threads() const override { return threads_; }

  uint64_t sum(uint64_t value) const override {
    uint64_t total = 0;
    MPI_Allreduce(&value, &total, 1, MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD);
    return total;
  }

  void agree(const Failure *failure) const override {
    const int mine = failure ? rank_ : count_;
    int first = count_;
    MPI_Allreduce(&mine, &first, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    if (first == count_) return;
    std::string message = rank_ == first ? failure->what() : "";
    int numbers[2] = {rank_ == first ? failure->code() : 0, static_cast<int>(message.size())};
    MPI_Bcast(numbers, 2, MPI_INT, first, MPI_COMM_WORLD);
    message.resize(static_cast<size_t>(numbers[1]));
    MPI_Bcast(&message[0], numbers[1], MPI_BYTE, first, MPI_COMM_WORLD);
    if (first != kFirst) message += " (process " + std::to_string(first) + ")";
    throw Failure(static_cast<ExitCode>(numbers[0]), message);
  }

  std::unique_ptr<FrameSupply> remote_supply() override {
    return rank_ == kFirst ? nullptr : std::make_unique<RemoteSupply>();
  }

  void serve(FrameLedger &ledger) override {
    try {
      for (int working = count_ - 1; working > 0;) {
        int is_there = 0;
        MPI_Status status;
        MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &is_there, &status);
        if (!is_there)
          std::this_thread::sleep_for(kPollingInterval);
        else if (serve(ledger, status) == kDone)
          --working;
      }
    } catch (...) {
      abort_all(std::current_exception());
    }
  }

  void say_done() override { MPI_Send(nullptr, 0, MPI_BYTE, kFirst, kDone, MPI_COMM_WORLD); }

 private:
  // Gives the kind of the message.
  static int serve(FrameLedger &ledger, const MPI_Status &status) {
    int size = 0;
    MPI_Get_count(&status, MPI_BYTE, &size);
    std::vector<uint8_t> bytes(static_cast<size_t>(size));
    MPI_Recv(bytes.data(), size, MPI_BYTE, status.MPI_SOURCE, status.MPI_TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    if (status.MPI_TAG == kResult) ledger.deliver(unpack(bytes));
    if (status.MPI_TAG == kRequest) answer(ledger, status.MPI_SOURCE);
    return status.MPI_TAG;
  }

  static void answer(FrameLedger &ledger, int asker) {
    FrameTask task;
    const FrameLedger::Answer answer = ledger.try_next(task);
    const Reply reply = {static_cast<uint64_t>(answer), task.place, task.frame};
    MPI_Send(&reply, kReplyLength, MPI_UINT64_T, asker, kReply, MPI_COMM_WORLD);
  }

  // Launchers may have bound each process to processors of its own, or none at all: those that any process of this
  // machine may run on are shared evenly.
  void share_processors() {
    unsigned mine = Processes::threads(), together = mine;
#if defined(__linux__)
    cpu_set_t set, all;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof set, &set) != 0) CPU_ZERO(&set);
    MPI_Allreduce(&set, &all, sizeof set, MPI_BYTE, MPI_BOR, local_);
    if (CPU_COUNT(&all) > 0) together = static_cast<unsigned>(CPU_COUNT(&all));
#endif
    threads_ = std::max(1u, std::min(mine, together / static_cast<unsigned>(local_count_)));
  }

  MPI_Comm local_ = MPI_COMM_NULL;
  int rank_ = 0, count_ = 1, local_rank_ = 0, local_count_ = 1;
  unsigned threads_ = 1;
  bool has_threads_ = false;
};

}  // namespace

std::unique_ptr<Processes> start_processes(int *argc, char ***argv) {
  auto processes = std::make_unique<MpiProcesses>(argc, argv);
  if (!processes->has_threads() && processes->count() > 1)
    throw Failure(kComputingFailed, "this MPI library can't be used with threads (MPI_THREAD_SERIALIZED)");
  return processes;
}

}  // namespace quickses::cli
