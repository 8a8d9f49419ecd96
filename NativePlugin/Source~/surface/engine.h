// SPDX-License-Identifier: MIT
// What the C API sees of a back end: atoms in, mesh out. One implementation per executor (pipeline.h).
#pragma once

#include "quickses/quickses.h"
#include "surface/types.h"

#include <functional>
#include <memory>
#include <string>

namespace quickses {

// Everything about the atoms that the host knows before the back end sees them.
struct AtomBounds {
  glm::vec3 low, high;  // of the centres, caller's coordinates
  float max_radius;     // without the probe
};

class SurfaceEngine {
 public:
  virtual ~SurfaceEngine() = default;

  // Room for the atoms in memory the back end reads fast: centre in the caller's coordinates and van der Waals radius.
  // The caller fills it, then calls set_atoms. Throws Error.
  virtual Sphere *atom_buffer(size_t count) = 0;
  virtual void set_atoms(size_t count, const AtomBounds &bounds) = 0;

  // Settings are checked already. On success mesh and report are replaced; on an exception they keep the last result.
  virtual void compute(const qses_settings &settings) = 0;
  virtual const qses_mesh &mesh() const = 0;
  virtual const qses_report &report() const = 0;

  virtual void enable_stage_times(bool enabled) = 0;
  // Called with the fraction done; empty: not at all.
  virtual void set_progress(std::function<void(double)> progress) = 0;
};

std::unique_ptr<SurfaceEngine> make_cpu_engine(unsigned threads, uint64_t memory_budget);
#if defined(QUICKSES_HAS_CUDA)
std::unique_ptr<SurfaceEngine> make_cuda_engine(int device, uint64_t memory_budget);
#endif

}  // namespace quickses
