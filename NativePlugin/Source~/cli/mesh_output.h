// SPDX-License-Identifier: MIT
// Meshes of the C API to files.
#pragma once

#include <string>

#include "io/structure.h"
#include "quickses/quickses.h"

namespace quickses::cli {

// Takes the surface of all atoms of a structure for good, and writes it, with owners as places in the structure's file;
// an empty path: writes nothing. Throws Failure (kComputingFailed) before anything is written if the mesh is not
// closed, which that surface always should be; io::Error (output).
void accept_surface(const std::string &path, const qses_mesh &mesh, const io::Structure &structure);

}  // namespace quickses::cli
