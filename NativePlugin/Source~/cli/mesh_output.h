// SPDX-License-Identifier: MIT
// Meshes of the C API to files.
#pragma once

#include <string>

#include "io/structure.h"
#include "quickses/quickses.h"

namespace quickses::cli {

// Owners are written as places in the structure's file. Throws io::Error (output).
void write_surface(const std::string &path, const qses_mesh &mesh, const io::Structure &structure);

}  // namespace quickses::cli
