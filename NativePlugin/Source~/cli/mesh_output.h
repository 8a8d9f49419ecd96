// SPDX-License-Identifier: MIT
// Meshes of the C API to files.
#pragma once

#include <string>
#include <vector>

#include "cli/options.h"
#include "io/structure.h"
#include "quickses/quickses.h"

namespace quickses::cli {

// Takes the surface of all atoms for good. Throws Failure (kComputingFailed) if the mesh is not closed, which that
// surface always should be.
void accept_surface(const qses_mesh &mesh);

// What there is to do with the meshes of a structure, in one conformation or many. Any number of threads may use it.
class MeshOutput {
 public:
  // The structure must outlive it.
  MeshOutput(const Options &options, const io::Structure &structure);

  // Takes the surface of all atoms for good, and writes it, with owners as places in the structure's file; an empty
  // path: writes nothing. centers: of the structure's atoms when the mesh was made, only looked at if needs_centers().
  // Throws as accept_surface, before anything is written; io::Error (output).
  void accept(const std::string &path, const qses_mesh &mesh, const float *centers) const;
  bool needs_centers() const { return options_.sharp; }

 private:
  std::vector<uint8_t> colors_of(const qses_mesh &mesh) const;

  const io::Structure &structure_;
  const MeshFileOptions options_;
  const float probe_radius_;
  std::vector<uint8_t> atom_colors_;  // N x 4; empty if colours are not those of atoms
};

// Throws io::Error (output) if a mesh could not be written there; an empty path is none.
void check_mesh_writable(const std::string &path);

}  // namespace quickses::cli
