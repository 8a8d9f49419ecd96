// SPDX-License-Identifier: MIT
// What happens when the program is stopped from outside.
#include "cli/stopping.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>

#include "cli/exit_code.h"
#include "cli/utf8.h"
#include "io/atomic_file.h"

#if defined(_WIN32)
#include <windows.h>
#else
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <system_error>
#include <thread>
#endif

namespace quickses::cli {
namespace {

bool is_out_of_memory(const std::exception_ptr &exception) {
  if (!exception) return false;
  try {
    std::rethrow_exception(exception);
  } catch (const std::bad_alloc &) {
    return true;
  } catch (...) {
    return false;
  }
}

// Memory may run out where no exception may pass: nlohmann's JSON allocates in its destructor.
[[noreturn]] void on_terminate() {
  io::abandon_files();
  leave_utf8();
  if (!is_out_of_memory(std::current_exception())) std::abort();
  std::fprintf(stderr, "quickses: %s\n", kNotEnoughMemory);
  std::_Exit(kComputingFailed);
}

#if defined(_WIN32)

// Runs in a thread of its own. What comes next ends the process.
BOOL WINAPI on_stop(DWORD) {
  io::abandon_files();
  leave_utf8();
  return FALSE;
}

#else

// Not if it is ignored, as by nohup, or if a library loaded before has a use for it.
bool ends_the_program(int signal_number) {
  struct sigaction action;
  return sigaction(signal_number, nullptr, &action) == 0 && action.sa_handler == SIG_DFL;
}

// Dies by the signal, as the shell expects it, but after cleaning up. A thread may do what a handler of signals may
// not.
void wait_for_stop(sigset_t signals) {
  int signal_number = 0;
  if (sigwait(&signals, &signal_number) != 0) return;
  io::abandon_files();
  signal(signal_number, SIG_DFL);
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
  raise(signal_number);
}

// A file that is opened must not become what others of this process take for standard output. What was closed can't be
// used all the same: standard input is not read from, nor are the others written to.
void occupy_standard_streams() {
  int descriptor = 0;
  if (fcntl(STDIN_FILENO, F_GETFD) < 0) descriptor = open("/dev/null", O_WRONLY);  // the first number that is free
  while (descriptor >= 0 && descriptor <= STDERR_FILENO) descriptor = open("/dev/null", O_RDONLY);
  if (descriptor > STDERR_FILENO) close(descriptor);
}

#endif

}  // namespace

#if defined(_WIN32)

void prepare_for_stopping() {
  std::set_terminate(&on_terminate);
  SetConsoleCtrlHandler(&on_stop, TRUE);
}

#else

void prepare_for_stopping() {
  std::set_terminate(&on_terminate);
  occupy_standard_streams();
  for (int signal_number : {SIGPIPE, SIGXFSZ}) signal(signal_number, SIG_IGN);
  sigset_t signals;
  sigemptyset(&signals);
  // Batch systems tell of the end of a job's time by SIGUSR1 or SIGUSR2; an alarm may have been set before exec.
  for (int signal_number : {SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGXCPU, SIGUSR1, SIGUSR2, SIGALRM})
    if (ends_the_program(signal_number)) sigaddset(&signals, signal_number);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);  // in all threads to come
  try {
    std::thread(wait_for_stop, signals).detach();
  } catch (const std::system_error &) {  // no threads left: stopped without cleaning up
    pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
  }
}

#endif

}  // namespace quickses::cli
