// SPDX-License-Identifier: MIT
// TRR: the trajectories of GROMACS in full precision.
#pragma once

#include <memory>

#include "io/byte_source.h"
#include "io/trajectory_reader.h"

namespace quickses::io {

// Throws Error (kInput).
std::unique_ptr<TrajectoryReader> open_trr(std::unique_ptr<ByteSource> source);

// Whether a file starts like one. size may be less than the file has.
bool is_trr(const unsigned char *head, size_t size);

}  // namespace quickses::io
