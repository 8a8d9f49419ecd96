// SPDX-License-Identifier: MIT
// quickses INPUT --trajectory FILE: the surfaces of many frames, several at a time.
#include <algorithm>
#include <cstdio>
#include <exception>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "cli/area_tables.h"
#include "cli/commands.h"
#include "cli/engine_pool.h"
#include "cli/exit_code.h"
#include "cli/frame_ledger.h"
#include "cli/frame_worker.h"
#include "cli/progress.h"
#include "cli/shown_output.h"
#include "cli/tell.h"
#include "cli/text_output.h"
#include "cli/used_files.h"
#include "io/error.h"
#include "io/text.h"

namespace quickses::cli {
namespace {

constexpr unsigned kMostCudaWorkers = 8;  // keep a GPU busy, each with much to wait for
constexpr size_t kMostMessages = 20;      // of failed frames; more are only counted

// What this process has for its frames.
struct Share {
  ComputeOptions compute;    // of one engine
  std::vector<int> devices;  // of the engines
  unsigned shared_by = 1;    // engines of a device, which share its memory
  unsigned threads = 1;      // that take frames from reading to writing

  size_t device_count() const { return std::set<int>(devices.begin(), devices.end()).size(); }
};

Share divide(const Options &options, const Processes &processes, size_t frame_count) {
  Share share;
  share.compute = options.compute;
  const unsigned threads = options.compute.threads ? options.compute.threads : processes.threads();
  share.compute.threads = threads;
  std::vector<int> devices = {0};
  if (options.compute.backend != QSES_BACKEND_CPU)
    devices = chosen_devices(options.compute, static_cast<unsigned>(processes.local_rank()));
  // Tells what auto means here.
  const Engine whole = start_engine(share.compute, devices.front(), options.quiet || !processes.is_first());
  share.compute.backend = whole.backend();
  const bool is_cuda = whole.backend() == QSES_BACKEND_CUDA;
  if (!is_cuda) devices = {0};

  // On the CPU, frames side by side use threads better than threads within a frame.
  const unsigned device_count = static_cast<unsigned>(devices.size());
  const unsigned wanted = options.workers ? options.workers
                          : is_cuda       ? std::clamp(threads / device_count, 2u, kMostCudaWorkers)
                                          : threads;
  const size_t frames_here = (frame_count - 1) / static_cast<size_t>(processes.count()) + 1;
  const auto engines = static_cast<unsigned>(std::min<size_t>(size_t(wanted) * device_count, frames_here));
  for (unsigned k = 0; k < engines; ++k) share.devices.push_back(devices[k % device_count]);
  share.shared_by = (engines - 1) / device_count + 1;
  // While a frame is computed, another one is read and one is written, where there are threads for that.
  share.threads = static_cast<unsigned>(std::min<size_t>(std::clamp(threads, engines, 3 * engines), frames_here));
  share.compute.threads = std::max(1u, threads / engines);
  if (options.compute.memory != 0)
    share.compute.memory = std::max<uint64_t>(1, options.compute.memory / share.shared_by);
  return share;
}

// Results in the order of the frames: table, report, messages, progress.
class ResultWriter {
 public:
  ResultWriter(const Options &options, size_t frame_count, std::unique_ptr<render::Page> page)
      : options_(options),
        frame_count_(frame_count),
        page_(std::move(page)),
        csv_(options.csv),
        json_(options.json),
        areas_(options, surfaces_of(options)),
        progress_(frame_count, options.quiet) {
    if (!options.csv.empty()) csv_.write(csv_header(options));
  }

  void begin() { progress_.begin(); }

  void write(const FrameResult &result) {
    if (page_ && !result.page.empty()) add_to_page(result);
    csv_.write(result.csv);
    json_.write(result.json);
    areas_.write({result.per_atom, result.per_residue});
    if (!result.error.empty() && ++failed_ <= kMostMessages) {
      progress_.clear();
      tell("frame " + std::to_string(result.frame) + " failed: " + result.error);
    }
    progress_.advance();
  }

  void finish() {
    progress_.clear();
    if (failed_ > kMostMessages)
      tell(io::counted(failed_ - kMostMessages, "more message of failed frames is",
                       "more messages of failed frames are") +
           " not shown");
    csv_.finish();
    json_.finish();
    areas_.finish();
    if (!makes_page(options_)) return;
    if (!page_) throw Failure(kOutputUnwritable, "'" + options_.output + "' was not written");
    page_->finish();
    hint_at_size(*page_, options_);
  }

  const FrameProgress &progress() const { return progress_; }

 private:
  static std::vector<qses_surface> surfaces_of(const Options &options) {
    if (options.command == Options::Command::kMeasure) return options.measured;
    return {options.compute.surface};
  }

  // A page that gets too large does not take the tables with it.
  void add_to_page(const FrameResult &result) {
    try {
      page_->add(result.page, frame_count_ - 1 - static_cast<size_t>(result.place));
    } catch (const io::Error &error) {
      if (options_.csv.empty() && options_.json.empty() && !options_.wants_areas()) throw;
      progress_.clear();
      tell(std::string(error.what()) + "; the rest is done without it");
      page_.reset();
    }
  }

  const Options &options_;
  const size_t frame_count_;
  std::unique_ptr<render::Page> page_;  // null: there is none, or no more
  TextOutput csv_, json_;
  AreaTables areas_;
  FrameProgress progress_;
  size_t failed_ = 0;
};

void work(FrameWorker &worker, FrameSupply &supply) {
  try {
    while (const std::optional<FrameTask> task = supply.next()) supply.deliver(worker.run(*task));
  } catch (...) {
    supply.give_up(std::current_exception());
  }
}

class Run {
 public:
  Run(const Options &options, Processes &processes)
      : processes_(processes),
        inputs_(options, options.quiet || !processes.is_first()),
        frames_(options.frames.select(inputs_.trajectory.frame_count(), options.quoted_trajectories())),
        share_(divide(inputs_.options, processes, frames_.count)) {
    const Options &used = inputs_.options;
    if (processes.is_first()) {
      if (inputs_.pattern)
        check_meshes();
      else
        check_mesh_writable(used.output);
    }
    engines_ = std::make_unique<EnginePool>(share_.compute, share_.devices,
                                            [this](Engine &engine) { prepare_engine(engine, inputs_); });
    for (unsigned k = 0; k < share_.threads; ++k)
      workers_.push_back(std::make_unique<FrameWorker>(inputs_, *engines_, share_.compute.backend, share_.shared_by));
    if (makes_shown(used)) look_at_first_frame();
    if (processes.is_first())
      writer_ = std::make_unique<ResultWriter>(
          used, frames_.count, makes_page(used) ? inputs_.mesh_output.begin_page(used.output) : nullptr);
  }

  // Computes all frames, with the other processes.
  void run() {
    const uint64_t all_engines = processes_.sum(share_.devices.size());
    const size_t window = 64 + 16 * static_cast<size_t>(all_engines);
    FrameLedger ledger(frames_, window, [this](const FrameResult &result) { writer_->write(result); });
    const std::unique_ptr<FrameSupply> remote = processes_.remote_supply();
    FrameSupply &supply = remote ? *remote : ledger;
    std::vector<std::thread> threads;
    threads.reserve(workers_.size());
    if (writer_) writer_->begin();
    try {
      for (const auto &worker : workers_) threads.emplace_back([&] { work(*worker, supply); });
    } catch (const std::exception &) {  // there are no more to be had: these do, or this one
    }
    if (!remote) processes_.serve(ledger);
    if (threads.empty()) work(*workers_.front(), supply);
    for (std::thread &thread : threads) thread.join();
    if (remote)
      processes_.say_done();
    else
      finish(ledger, all_engines);
  }

 private:
  // All are seen as the first that can be shown.
  void look_at_first_frame() {
    for (size_t place = 0; place < frames_.count; ++place) {
      try {
        inputs_.mesh_output.look(workers_.front()->camera({place, frames_.frame(place)}));
        return;
      } catch (const std::exception &) {  // which is told when it is that frame's turn
      }
    }
  }

  void check_meshes() const {
    UsedFiles files(inputs_.options);
    for (size_t place = 0; place < frames_.count; ++place)
      files.check_mesh(inputs_.pattern->name(frames_.frame(place)));
    check_mesh_writable(inputs_.pattern->name(frames_.first));
  }

  void finish(FrameLedger &ledger, uint64_t all_engines) {
    ledger.finish();
    const double seconds = writer_->progress().seconds(), rate = writer_->progress().frames_per_second();
    writer_->finish();
    const Options &options = inputs_.options;
    if (!options.quiet && !options.prints_data())
      std::printf("%s of %s, %s, %s%llu at a time, %.2f s, %.1f frames/s%s%s\n",
                  io::counted(frames_.count, "frame").c_str(),
                  io::counted(inputs_.structure().atoms.size(), "atom").c_str(), name_of(share_.compute.backend),
                  devices_text().c_str(), static_cast<unsigned long long>(all_engines), seconds, rate,
                  options.csv.empty() ? "" : ", ", options.csv.c_str());
    if (const size_t failed = ledger.failed_count())
      throw Failure(kSomeFailed, std::to_string(failed) + " of " + io::counted(frames_.count, "frame") + " failed");
  }

  // Several of this process.
  std::string devices_text() const {
    const size_t count = share_.device_count();
    return count > 1 ? std::to_string(count) + " devices, " : "";
  }

  Processes &processes_;
  FrameInputs inputs_;
  const FrameSelection frames_;
  const Share share_;
  std::unique_ptr<ResultWriter> writer_;  // of the first process
  std::unique_ptr<EnginePool> engines_;
  std::vector<std::unique_ptr<FrameWorker>> workers_;
};

// Runs something that must go well in all processes before they go on.
template <class Action>
void together(const Processes &processes, const Action &action) {
  std::unique_ptr<Failure> failure;
  try {
    action();
  } catch (...) {
    failure = std::make_unique<Failure>(failure_of(std::current_exception()));
  }
  processes.agree(failure.get());
}

}  // namespace

void run_trajectory(const Options &options, Processes &processes) {
  std::unique_ptr<Run> run;
  together(processes, [&] { run = std::make_unique<Run>(options, processes); });
  together(processes, [&] { run->run(); });
}

}  // namespace quickses::cli
