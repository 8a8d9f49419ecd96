// SPDX-License-Identifier: MIT
// Memory that takes long to give back, and that nobody waits for.
#pragma once

namespace quickses {

// Calls release(memory), which must not throw, on a thread of its own, soon; or at once where the system refuses the
// thread. What has not had its turn when the process ends is left to the system. Any thread.
void release_later(void (*release)(void *), void *memory) noexcept;

}  // namespace quickses
