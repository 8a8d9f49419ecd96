// SPDX-License-Identifier: MIT
// The exception barrier: what throws behind it becomes a status and a sentence for qses_last_error.
#pragma once

#include "io/error.h"
#include "parallel/error.h"
#include "parallel/working_thread.h"

#include <string>

namespace quickses {

// The message of the last failed call of this thread.
const char *last_error_message() noexcept;

// Remembers the sentence, cut between two letters where it is too long. Needs no memory.
qses_status fail(qses_status status, const char *message) noexcept;

// Calls compute in a floating-point environment of their own, and leave the caller's as it was.
template <class Call>
qses_status guarded(const Call &call) noexcept {
  const FloatScope floats;
  qses_status outcome = QSES_OK;
  try {
    call();
  } catch (const io::Error &e) {
    outcome = fail(e.kind() == io::ErrorKind::kUsage ? QSES_INVALID_ARGUMENT : QSES_FILE_ERROR, e.what());
  } catch (...) {
    explain_exception([&](qses_status status, const char *message) { outcome = fail(status, message); });
  }
  return outcome;
}

inline void require(const void *pointer, const char *name) {
  if (!pointer) invalid(std::string(name) + " is NULL");
}

// In host memory.
inline void require_owners(const qses_mesh &mesh) {
  if (mesh.vertex_count > 0 && !mesh.owners) invalid("the mesh has no owners: settings.without_owners left them out");
}

}  // namespace quickses
