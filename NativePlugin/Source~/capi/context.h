// SPDX-License-Identifier: MIT
// What a qses_context holds, and a qses_kept_mesh.
#pragma once

#include "capi/barrier.h"
#include "capi/structs.h"
#include "jobs/surface_job.h"
#include "parallel/cpu_threads.h"

#include <memory>
#include <string>
#include <vector>

struct qses_context {
  qses_backend backend = QSES_BACKEND_CPU;
  qses_backend_description description{};
  std::unique_ptr<quickses::SurfaceJob> job;
  std::unique_ptr<quickses::CpuThreads> copy_threads;  // with CUDA, where each frame waits for its atoms; else null
  std::shared_ptr<const quickses::AtomSet> atoms;      // of the next computation; null before qses_set_atoms
  std::vector<float> radii;  // theirs: here, since reading what a GPU fetches each frame is slow
  std::shared_ptr<const quickses::Appearance> appearance = std::make_shared<quickses::Appearance>();
  std::vector<std::shared_ptr<quickses::Appearance>> appearance_pool;
};

struct qses_kept_mesh {
  quickses::KeptMesh held;
};

namespace quickses {

inline void require_kept(const qses_kept_mesh &kept) {
  if (!kept.held.is_full) throw Error(QSES_NO_RESULT, "nothing is kept here yet");
}

// function: the one that was called, for the message.
inline void require_atoms(const qses_context &context, const char *function) {
  if (!context.atoms) throw Error(QSES_NO_ATOMS, std::string("qses_set_atoms must come before ") + function);
}

inline void check_atom_count(const qses_context &context, size_t count, const char *function) {
  require_atoms(context, function);
  check_atom_count(count, context.atoms->count, "context");
}

}  // namespace quickses
