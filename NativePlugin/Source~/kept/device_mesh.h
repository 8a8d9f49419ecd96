// SPDX-License-Identifier: MIT
// A finished mesh in the memory of a CUDA device. Whoever shares it may read it: the memory is nobody else's until the
// last one has let go.
#pragma once

#include "quickses/quickses.h"
#include "surface/mesh/mesh_memory.h"

namespace quickses {

struct DeviceMesh {
  qses_device_mesh view;
  MeshShape shape;
  size_t atom_count;
  MeshLease memory;  // empty for an empty mesh
};

}  // namespace quickses
