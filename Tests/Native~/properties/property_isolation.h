// SPDX-License-Identifier: MIT
// Runs cases of the property tests one after the other in a process of their own, so that a crash or a hang is a fault
// of one case and the next ones are still run. With CUDA, which does not live on in forked processes, and on Windows,
// they run in this process.
#pragma once

#include "process/patience.h"
#include "properties/property_checker.h"

#include <csignal>

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

// What is printed if this process crashes.
class LastWords {
 public:
  LastWords() {
    for (int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGILL}) std::signal(signal, print);
  }
  ~LastWords() {
    for (int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGILL}) std::signal(signal, SIG_DFL);
  }
  template <class... Values>
  void say(const char *format, Values... values) const {
    std::snprintf(words(), kSize, format, values...);
  }

 private:
  static constexpr size_t kSize = 100;
  static char *words() {
    static char text[kSize] = "";
    return text;
  }
  static void print(int signal) {
    std::fputs(words(), stderr);
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
};

class Runner {
 public:
  // processes: how many at a time; 0: all in this process, for tools that follow one process only.
  explicit Runner(unsigned processes = 1) : processes_(processes) {
    if (surface_fixture::tested_backend() == QSES_BACKEND_CUDA) processes_ = 0;
#if defined(_WIN32) || defined(__SANITIZE_THREAD__)
    processes_ = 0;
#endif
  }

  static constexpr unsigned kSeconds = static_cast<unsigned>(kPatience.count());

  // How many cases keep all processes busy.
  size_t batch() const { return 500 * std::max(1u, processes_); }

  std::vector<Verdict> run(const std::vector<Case> &cases, unsigned seconds_per_case = kSeconds) {
    std::vector<Verdict> verdicts(cases.size());
    if (processes_ > 0) {
      run_apart(cases, verdicts, seconds_per_case);
    } else {
      if (!checker_) checker_ = std::make_unique<Checker>();
      const LastWords last_words;
      for (size_t i = 0; i < cases.size(); ++i) {
        last_words.say("property test: ended within seed %llu\n", static_cast<unsigned long long>(cases[i].seed));
        verdicts[i] = checked(*checker_, cases[i]);
      }
    }
    return verdicts;
  }

  Verdict run(const Case &c, unsigned seconds = kSeconds) { return run(std::vector<Case>{c}, seconds)[0]; }

 private:
#ifdef _WIN32
  void run_apart(const std::vector<Case> &, std::vector<Verdict> &, unsigned) {}
#else
  // Cases from `next` to `end` are one process's. What it has found is in memory that is shared with it.
  struct Share {
    size_t next, end;
    pid_t process;
  };

  template <class T>
  struct Shared {
    explicit Shared(size_t n) : bytes(n * sizeof(T)) {
      void *memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
      if (memory == MAP_FAILED) throw std::runtime_error("no shared memory");
      data = static_cast<T *>(memory);
    }
    Shared(const Shared &) = delete;
    Shared &operator=(const Shared &) = delete;
    ~Shared() { munmap(const_cast<std::remove_volatile_t<T> *>(data), bytes); }
    size_t bytes;
    T *data;
  };

  void run_apart(const std::vector<Case> &cases, std::vector<Verdict> &verdicts, unsigned seconds_per_case) {
    if (cases.empty()) return;
    const Shared<Verdict> found(cases.size());
    const Shared<volatile size_t> done(processes_);
    const auto start = [&](Share &share, size_t k) {
      done.data[k] = share.next;
      if (share.next == share.end) return false;
      share.process = fork();
      if (share.process < 0) throw std::runtime_error("no further process");
      if (share.process > 0) return true;
      const rlimit no_core{0, 0};
      setrlimit(RLIMIT_CORE, &no_core);
      Checker checker;
      for (size_t i = share.next; i < share.end; ++i) {
        alarm(seconds_per_case);
        found.data[i] = checked(checker, cases[i]);
        done.data[k] = i + 1;
      }
      _exit(0);
    };
    std::vector<Share> shares;
    size_t running = 0;
    for (size_t k = 0; k < processes_; ++k) {
      shares.push_back({k * cases.size() / processes_, (k + 1) * cases.size() / processes_, 0});
      running += start(shares[k], k) ? 1 : 0;
    }
    while (running > 0) {
      int status = 0;
      const pid_t ended = waitpid(-1, &status, 0);
      for (size_t k = 0; k < shares.size(); ++k) {
        Share &share = shares[k];
        if (share.process != ended) continue;
        --running;
        for (; share.next < done.data[k]; ++share.next) verdicts[share.next] = found.data[share.next];
        if (share.next == share.end) continue;
        const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
        Verdict &v = verdicts[share.next++];
        if (signal == SIGALRM)
          blame(v, Fault::kHang, "not finished after %u s", seconds_per_case);
        else
          blame(v, Fault::kCrash, "the process ended by signal %d, exit status %d", signal,
                WIFEXITED(status) ? WEXITSTATUS(status) : 0);
        running += start(share, k) ? 1 : 0;
      }
    }
  }
#endif

  unsigned processes_;
  std::unique_ptr<Checker> checker_;
};

}  // namespace properties
