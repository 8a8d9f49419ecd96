// SPDX-License-Identifier: MIT
// What a qses_context holds.
#pragma once

#include "surface/engine.h"

#include <memory>

struct qses_context {
  qses_backend backend = QSES_BACKEND_CPU;
  qses_backend_description description{};
  std::unique_ptr<quickses::SurfaceEngine> engine;
  bool has_atoms = false;
  bool has_result = false;
  size_t atom_count = 0;
  float max_radius = 0.f;
};
