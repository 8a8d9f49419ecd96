// SPDX-License-Identifier: MIT
// What quickses bench can measure of one structure. Times are wall-clock times in ms.
#pragma once

#include <string>
#include <vector>

#include "cli/clock.h"
#include "cli/engine.h"
#include "cli/report.h"

namespace quickses::cli {

// Of at least one value.
double median(std::vector<double> values);

struct BenchSubject {
  const io::Structure &structure;
  const std::string &path;  // that it came from
  const Options &options;
  qses_backend backend;  // CUDA or CPU: what the options come to here
};

// Of all that is timed; meshes go to host memory.
qses_settings bench_settings(const Options &options);

// A context of its own, so that nothing is in its memory but what is measured, with the atoms.
Engine start_engine(const BenchSubject &subject);

// Each adds what it found to the entry and returns lines of text for the user.

// Surfaces of the whole, from atoms in host memory to the mesh, which is left on the device or brought to host memory.
std::string bench_surface(const BenchSubject &subject, Json *entry);

// Many surfaces of a few residues each, several at a time.
std::string bench_small(const BenchSubject &subject, Json *entry);

// Jobs: how long their calls take, how soon they end, and what the coarse levels cost.
std::string bench_jobs(const BenchSubject &subject, Json *entry);

}  // namespace quickses::cli
