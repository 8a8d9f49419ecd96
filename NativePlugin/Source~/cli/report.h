// SPDX-License-Identifier: MIT
// The JSON reports of the program. Lengths in Å, areas in Å², volumes in Å³, times in ms, memory in bytes.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "cli/engine.h"
#include "cli/exit_code.h"
#include "cli/mesh_output.h"
#include "cli/options.h"

namespace quickses::cli {

using Json = nlohmann::ordered_json;

// Of Documentation~/report.schema.json, which says what is in a report. It counts up when something changes its meaning
// or goes; new fields leave it.
constexpr int kReportSchema = 1;

struct Timings {
  double read = 0;
  double write = 0;
};

Json settings_json(const ComputeOptions &options);

// "atoms" and so on: where area and volume come from.
const char *name_of(qses_measured_by measured_by);

// Of one of several inputs that can't be used: schema, input, error.
Json failed_input_json(const Options &options, const Failure &failure);

// What reports begin with: schema, version, input, model, atoms, settings, backend, device.
Json report_head_json(const Options &options, const io::Structure &structure, const Engine &engine);
// area, volume, measured_by, and those of the triangles where there are any.
Json measures_json(const qses_report &report);
// memory of a report: peak_device (CUDA), peak_host, mesh.
Json memory_json(const qses_report &report, qses_backend backend);
// Of a component, with its number: component, triangles, area, volume, cavity, center, bounds.
Json component_json(uint32_t number, const qses_component &component);

// The report of one surface, which is closed (see accept_surface). The mesh must have been computed with its
// components. written: of what was written of it.
Json surface_json(const Options &options, const io::Structure &structure, const Engine &engine, const qses_mesh &mesh,
                  const MeshSize &written, const qses_report &report, const Timings &timings);

// Text of a report; names that are no UTF-8 are made so.
std::string dump(const Json &json, bool one_line);

}  // namespace quickses::cli
