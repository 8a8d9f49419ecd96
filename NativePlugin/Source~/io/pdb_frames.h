// SPDX-License-Identifier: MIT
// PDB files with several models, as trajectories.
#pragma once

#include <memory>

#include "io/byte_source.h"
#include "io/trajectory_reader.h"

namespace quickses::io {

// Throws Error (kInput).
std::unique_ptr<TrajectoryReader> open_pdb_frames(std::unique_ptr<ByteSource> source);

// Whether a file starts like one. size may be less than the file has.
bool is_pdb(const unsigned char *head, size_t size);

}  // namespace quickses::io
