// SPDX-License-Identifier: MIT
// Tests of what is left in a forked child, which has none of its parent's threads. Where there is fork(), and no
// sanitizer: those allow little in such a child.
#pragma once

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define QSES_TEST_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define QSES_TEST_SANITIZED
#endif
#endif

#if defined(__linux__) && !defined(QSES_TEST_SANITIZED)
#define QSES_TEST_FORKS

#include "process/patience.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

// Whether a child returns from work(), and ends, before long; also true where the machine refuses it just now.
template <class Work>
bool forked_child_ends(const Work &work) {
  const pid_t child = fork();
  if (child == 0) {
    alarm(kPatience.count());
    work();
    std::exit(0);
  }
  int status = 0;
  return child < 0 || (waitpid(child, &status, 0) == child && status == 0);
}
#endif
