// SPDX-License-Identifier: MIT
// The exception barrier: what throws behind it becomes a status and a sentence for qses_last_error.
#pragma once

#include "io/error.h"
#include "parallel/error.h"
#include "parallel/working_thread.h"

#include <new>
#include <string>

namespace quickses {

// The message of the last failed call of this thread.
std::string &last_error_message() noexcept;

// Remembers the sentence; when even that finds no memory, a shorter one that needs none.
qses_status fail(qses_status status, const char *message) noexcept;

// Calls compute in a floating-point environment of their own, and leave the caller's as it was.
template <class Call>
qses_status guarded(const Call &call) noexcept {
  const FloatScope floats;
  try {
    call();
    return QSES_OK;
  } catch (const Error &e) {
    return fail(e.status(), e.what());
  } catch (const io::Error &e) {
    return fail(e.kind() == io::ErrorKind::kUsage ? QSES_INVALID_ARGUMENT : QSES_FILE_ERROR, e.what());
  } catch (const Cancelled &) {
    return fail(QSES_CANCELLED, "the computation was cancelled");
  } catch (const std::bad_alloc &) {
    return fail(QSES_OUT_OF_MEMORY, "the machine refused memory");
  } catch (const std::exception &e) {
    return fail(QSES_INTERNAL_ERROR, e.what());
  } catch (...) {
    return fail(QSES_INTERNAL_ERROR, "an unknown exception");
  }
}

[[noreturn]] inline void invalid(const std::string &message) { throw Error(QSES_INVALID_ARGUMENT, message); }

inline void require(const void *pointer, const char *name) {
  if (!pointer) invalid(std::string(name) + " is NULL");
}

}  // namespace quickses
