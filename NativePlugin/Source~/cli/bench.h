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

// A structure whose atoms are in the engine already. Each adds what it found to the entry and returns lines of text for
// the user.

// Surfaces of the whole, from atoms in memory to the mesh in memory.
std::string bench_surface(Engine &engine, const io::Structure &structure, const Options &options, Json *entry);

// Many surfaces of a few residues each, one after the other.
std::string bench_small(Engine &engine, const io::Structure &structure, const Options &options, Json *entry);

// Jobs: how long their calls take, how soon they end, and what the coarse levels cost.
std::string bench_jobs(Engine &engine, const io::Structure &structure, const Options &options, Json *entry);

}  // namespace quickses::cli
