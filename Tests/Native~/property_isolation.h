// SPDX-License-Identifier: MIT
// Runs cases of the property tests one after the other in a process of their own, so that a crash or a hang is a fault of
// one case and the next ones are still run. With CUDA, which does not live on in forked processes, and on Windows, they
// run in this process.
#pragma once

#include "property_checks.h"

#ifndef _WIN32
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#endif

namespace properties {

inline Verdict checked(Checker &checker, const Case &c) {
  try {
    return checker.check(c);
  } catch (const std::exception &e) {
    Verdict v;
    blame(v, Fault::kStatus, "%s", e.what());
    return v;
  }
}

class Runner {
 public:
  // In this process if asked for, for instance by tools that follow one process only.
  explicit Runner(bool in_process) : in_process_(in_process || surface_fixture::tested_backend() == QSES_BACKEND_CUDA) {
#ifdef _WIN32
    in_process_ = true;
#endif
  }

  std::vector<Verdict> run(const std::vector<Case> &cases, unsigned seconds_per_case = 60) {
    std::vector<Verdict> verdicts(cases.size());
    if (in_process_) {
      if (!checker_) checker_ = std::make_unique<Checker>();
      for (size_t i = 0; i < cases.size(); ++i) verdicts[i] = checked(*checker_, cases[i]);
    } else {
      run_apart(cases, verdicts, seconds_per_case);
    }
    return verdicts;
  }

  Verdict run(const Case &c, unsigned seconds = 60) { return run(std::vector<Case>{c}, seconds)[0]; }

 private:
#ifdef _WIN32
  void run_apart(const std::vector<Case> &, std::vector<Verdict> &, unsigned) {}
#else
  struct Board {
    volatile size_t done;
    Verdict verdicts[1];
  };

  static void run_apart(const std::vector<Case> &cases, std::vector<Verdict> &verdicts, unsigned seconds_per_case) {
    const size_t bytes = sizeof(Board) + cases.size() * sizeof(Verdict);
    void *memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::runtime_error("no shared memory");
    Board *board = static_cast<Board *>(memory);
    for (size_t begin = 0; begin < cases.size();) {
      board->done = begin;
      const pid_t child = fork();
      if (child < 0) throw std::runtime_error("no further process");
      if (child == 0) {
        const rlimit no_core{0, 0};
        setrlimit(RLIMIT_CORE, &no_core);
        Checker checker;
        for (size_t i = begin; i < cases.size(); ++i) {
          alarm(seconds_per_case);
          board->verdicts[i] = checked(checker, cases[i]);
          board->done = i + 1;
        }
        _exit(0);
      }
      int status = 0;
      waitpid(child, &status, 0);
      const size_t done = board->done;
      for (size_t i = begin; i < done; ++i) verdicts[i] = board->verdicts[i];
      if (done < cases.size()) {
        const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
        Verdict &v = verdicts[done];
        if (signal == SIGALRM)
          blame(v, Fault::kHang, "not finished after %u s", seconds_per_case);
        else
          blame(v, Fault::kCrash, "the process ended by signal %d, exit status %d", signal,
                WIFEXITED(status) ? WEXITSTATUS(status) : 0);
      }
      begin = done + 1;
    }
    munmap(memory, bytes);
  }
#endif

  bool in_process_;
  std::unique_ptr<Checker> checker_;
};

}  // namespace properties
