// SPDX-License-Identifier: MIT
// The C API for the program: handles that free themselves, statuses as exceptions.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cli/options.h"
#include "io/structure.h"
#include "quickses/quickses.h"

namespace quickses::cli {

// Holds the memory of a mesh. It may outlive its engine.
class KeptMesh {
 public:
  KeptMesh();

  qses_kept_mesh *handle() const { return kept_.get(); }
  // Valid until another mesh is kept here, or this one is cleared.
  qses_mesh view() const;
  void clear() { qses_kept_mesh_clear(handle()); }

 private:
  std::unique_ptr<qses_kept_mesh, void (*)(qses_kept_mesh *)> kept_;
};

class Engine {
 public:
  // device: of CUDA. Throws Failure with the exit code that belongs to the status.
  Engine(const ComputeOptions &options, int device);

  qses_context *context() const { return context_.get(); }
  // Like the next two it never changes, and may be asked while another thread computes.
  qses_backend backend() const { return backend_; }
  std::string device() const { return description_.device; }
  std::string why_not_cuda() const { return description_.reason; }  // empty: it is CUDA, or the CPU was asked for

  void set_atoms(const io::Structure &structure, const std::string &path);
  void set_positions(const io::Structure &structure);  // of the same atoms
  // The next frame: atom i is at xyz[indices[i]]. xyz has three numbers for each of position_count atoms.
  void set_frame(const float *xyz, size_t position_count, const std::vector<uint32_t> &indices);
  qses_mesh compute(const qses_settings &settings);
  // The mesh that compute() left on the device.
  qses_device_mesh collect_device();
  qses_report report() const;
  // Moves what was computed last out of here, so that the next can be computed while somebody still needs this one.
  void keep(KeptMesh &kept);
  // The atoms of component k of a mesh are those from (*starts)[k] to (*starts)[k + 1].
  void find_component_atoms(const qses_mesh &mesh, std::vector<uint32_t> *starts, std::vector<uint32_t> *atoms) const;

 private:
  std::unique_ptr<qses_context, void (*)(qses_context *)> context_;
  qses_backend backend_ = QSES_BACKEND_CPU;
  qses_backend_description description_ = {};
};

qses_settings settings_of(const ComputeOptions &options);
// Of the mesh that the options ask for, and of what is told about it.
qses_settings mesh_settings_of(const Options &options);

// The CUDA devices that are chosen, at least one; nth: which of all, counted round and round, where none is. Throws
// Failure.
std::vector<int> chosen_devices(const ComputeOptions &options, unsigned nth);

// Says on standard error, unless quiet, why the CPU computes although CUDA was preferred. Throws as Engine does.
Engine start_engine(const ComputeOptions &options, int device, bool quiet);
// On the device that is chosen.
Engine start_engine(const ComputeOptions &options, bool quiet);

}  // namespace quickses::cli
