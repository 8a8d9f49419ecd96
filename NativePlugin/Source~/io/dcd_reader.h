// SPDX-License-Identifier: MIT
// DCD: the trajectories of CHARMM, NAMD and X-PLOR, and of many programs after them.
#pragma once

#include <memory>

#include "io/byte_source.h"
#include "io/trajectory_reader.h"

namespace quickses::io {

// Throws Error (kInput).
std::unique_ptr<TrajectoryReader> open_dcd(std::unique_ptr<ByteSource> source);

// Whether a file starts like one. size may be less than the file has.
bool is_dcd(const unsigned char *head, size_t size);

}  // namespace quickses::io
