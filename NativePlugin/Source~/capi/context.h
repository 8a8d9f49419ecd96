// SPDX-License-Identifier: MIT
// What a qses_context holds.
#pragma once

#include "jobs/surface_job.h"

#include <memory>

struct qses_context {
  qses_backend backend = QSES_BACKEND_CPU;
  qses_backend_description description{};
  std::unique_ptr<quickses::SurfaceJob> job;
  std::shared_ptr<const quickses::AtomSet> atoms;  // of the next computation; null before qses_set_atoms
};
