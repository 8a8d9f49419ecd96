// SPDX-License-Identifier: MIT
// Numbers of surfaces, without their meshes.
#pragma once

#include <vector>

#include "cli/area_tables.h"
#include "cli/engine.h"
#include "cli/report.h"

namespace quickses::cli {

struct SurfaceNumbers {
  qses_surface surface;
  qses_report report;
};

struct Measurement {
  std::vector<SurfaceNumbers> surfaces;  // in the order of options.measured
  std::vector<AtomAreas> areas;          // of the same, if the options ask for tables of them
  double milliseconds = 0;
};

// Of the atoms that the engine has.
Measurement measure_surfaces(Engine &engine, const Options &options);

Json measurement_json(const Options &options, const io::Structure &structure, const Engine &engine,
                      const Measurement &measurement, const Timings &timings);

// The head of the table of frames, and its row; time: in ps, or not known.
std::string measurement_csv_header(const std::vector<qses_surface> &surfaces);
std::string measurement_csv_row(uint64_t frame, std::optional<double> time, const Measurement &measurement);

}  // namespace quickses::cli
