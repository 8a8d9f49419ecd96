// SPDX-License-Identifier: MIT
// AMBER's trajectories and restart files in netCDF's classic format.
#pragma once

#include <memory>

#include "io/byte_source.h"
#include "io/trajectory_reader.h"

namespace quickses::io {

// Throws Error (kInput).
std::unique_ptr<TrajectoryReader> open_netcdf(std::unique_ptr<ByteSource> source);

}  // namespace quickses::io
