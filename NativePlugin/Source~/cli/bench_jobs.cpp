// SPDX-License-Identifier: MIT
// quickses bench --jobs: what a job costs the thread that asks for it, and what its coarse levels cost.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <thread>

#include "cli/bench.h"
#include "cli/exit_code.h"

namespace quickses::cli {
namespace {

void check(qses_status status) {
  if (status != QSES_OK) throw Failure(exit_code_of(status), qses_last_error());
}

struct Latencies {
  std::vector<double> begin, replace, cancel, destroy, first_level, ladder, finest;
};

void wait_for_all(const Engine &engine) {
  check(qses_wait(engine.context(), -1, nullptr));
  qses_progress progress;
  qses_progress_init(&progress);
  check(qses_poll(engine.context(), &progress));
  if (progress.state == QSES_JOB_FAILED) throw Failure(exit_code_of(progress.status), progress.message);
}

void begin(const Engine &engine, const qses_settings &settings) { check(qses_begin(engine.context(), &settings)); }

// Takes the mesh that waits to be collected, if there is one.
bool collect(const Engine &engine) {
  qses_mesh mesh;
  qses_mesh_init(&mesh);
  return qses_collect(engine.context(), &mesh) == QSES_OK;
}

// A job to its end; when its first level could be collected goes to first_level, if given.
double run_job(const Engine &engine, const qses_settings &settings, std::vector<double> *first_level) {
  collect(engine);
  const auto start = Clock::now();
  begin(engine, settings);
  for (int32_t ended = 0; first_level && !ended;) {
    check(qses_wait(engine.context(), 0, &ended));
    if (collect(engine)) {
      first_level->push_back(ms_since(start));
      break;
    }
    std::this_thread::yield();  // to sleep for a moment would take longer than what is measured
  }
  wait_for_all(engine);
  return ms_since(start);
}

void sleep_ms(double ms) { std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(ms)); }

std::string line(const char *name, const std::vector<double> &times) {
  char text[120];
  std::snprintf(text, sizeof text, "\n  %-16s %9.3f ms median %9.3f ms max", name, median(times),
                *std::max_element(times.begin(), times.end()));
  return text;
}

Json summary(const std::vector<double> &times) {
  return {{"median", median(times)}, {"max", *std::max_element(times.begin(), times.end())}};
}

}  // namespace

std::string bench_jobs(const BenchSubject &subject, Json *entry) {
  const auto &[structure, path, options, backend] = subject;
  Engine engine = start_engine(subject);
  const qses_settings ladder = bench_settings(options);
  qses_settings finest = ladder;
  finest.level_count = 0;
  Latencies found;
  run_job(engine, ladder, nullptr);  // warms up
  for (unsigned k = 0; k < options.bench.repeat; ++k) {
    found.finest.push_back(run_job(engine, finest, nullptr));
    found.ladder.push_back(run_job(engine, ladder, &found.first_level));
  }
  const double length = median(found.ladder);
  for (unsigned k = 0; k < options.bench.repeat; ++k) {
    const double moment = length * k / options.bench.repeat;  // all parts of a job have their turn
    engine.set_positions(structure);
    auto start = Clock::now();
    begin(engine, ladder);
    found.begin.push_back(ms_since(start));
    sleep_ms(moment);
    start = Clock::now();
    begin(engine, ladder);
    found.replace.push_back(ms_since(start));
    wait_for_all(engine);

    begin(engine, ladder);
    sleep_ms(moment);
    start = Clock::now();
    check(qses_cancel(engine.context()));
    wait_for_all(engine);
    found.cancel.push_back(ms_since(start));

    auto other = std::make_unique<Engine>(start_engine(subject));
    run_job(*other, ladder, nullptr);
    begin(*other, ladder);
    sleep_ms(moment);
    start = Clock::now();
    other.reset();
    found.destroy.push_back(ms_since(start));
  }
  const double ratio = length / median(found.finest);
  (*entry)["jobs"] = {{"begin", summary(found.begin)},
                      {"begin_replacing", summary(found.replace)},
                      {"cancel_to_idle", summary(found.cancel)},
                      {"destroy", summary(found.destroy)},
                      {"first_level", summary(found.first_level)},
                      {"finest_alone", summary(found.finest)},
                      {"ladder", summary(found.ladder)},
                      {"ladder_to_finest", ratio}};
  char text[120];
  std::snprintf(text, sizeof text, "\n  the ladder takes %.2f times as long as its finest level alone", ratio);
  return std::string("jobs, ") + name_of(backend) + ", " + std::to_string(options.bench.repeat) + " each" +
         line("begin", found.begin) + line("begin, replacing", found.replace) + line("cancel to idle", found.cancel) +
         line("destroy", found.destroy) + line("first level", found.first_level) + line("finest alone", found.finest) +
         line("ladder", found.ladder) + text;
}

}  // namespace quickses::cli
