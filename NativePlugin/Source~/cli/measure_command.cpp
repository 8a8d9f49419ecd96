// SPDX-License-Identifier: MIT
// quickses measure INPUT...: area and volume, without a mesh.
#include <cstdio>
#include <optional>
#include <string>

#include "cli/area_tables.h"
#include "cli/commands.h"
#include "cli/each_input.h"
#include "cli/input.h"
#include "cli/measuring.h"
#include "cli/text_output.h"
#include "io/text.h"

namespace quickses::cli {
namespace {

void print_table(const Options &options, const io::Structure &structure, const Engine &engine,
                 const Measurement &measurement) {
  const std::string model = options.read.model == 0 ? ", model " + std::to_string(structure.model) : "";
  std::printf("%s%s: %s, %s%s, %.2f ms\n", options.input.c_str(), model.c_str(),
              io::counted(structure.atoms.size(), "atom").c_str(),
              probe_text(options.measured, options.compute.probe).c_str(), name_of(engine.backend()),
              measurement.milliseconds);
  std::printf("surface          area Å²        volume Å³  measured by\n");
  for (const SurfaceNumbers &numbers : measurement.surfaces) {
    const bool is_exact = numbers.report.measured_by == QSES_MEASURED_BY_ATOMS;
    char mesh[64];
    std::snprintf(mesh, sizeof mesh, "a mesh of spacing %g Å", options.compute.spacing);
    std::printf("%-7s %16.2f %16.2f  %s\n", name_of(numbers.surface), numbers.report.area, numbers.report.volume,
                is_exact ? "atoms, exactly" : mesh);
  }
}

}  // namespace

void run_measure(const Options &options) {
  check_text_output(options.json);
  AreaTables tables(options, options.measured);
  std::optional<Engine> engine;
  std::string reports;
  const bool has_several = options.read.model == 0 || options.has_several_inputs();
  const auto measure = [&](const Options &one) {
    const Input input(one, options.quiet);
    Timings timings;
    timings.read = input.read_ms;
    if (!engine) engine.emplace(start_engine(options.compute, options.quiet));
    for (const io::Structure &structure : input.file.models) {
      engine->set_atoms(structure, one.input);
      const Measurement measurement = measure_surfaces(*engine, one);
      tables.write(make_area_rows(one, first_columns(one, structure), structure, measurement.areas));
      if (!options.json.empty())
        reports += dump(measurement_json(input.options, structure, *engine, measurement, timings), has_several);
      if (!options.quiet && !options.prints_data()) print_table(one, structure, *engine, measurement);
    }
  };
  const size_t failed_count = for_each_input(options, measure, [&](const Options &one, const Failure &failure) {
    if (!options.json.empty()) reports += dump(failed_input_json(one, failure), true);
  });
  tables.finish();
  if (!options.json.empty()) write_text(options.json, reports);
  check_failed_inputs(options, failed_count);
}

}  // namespace quickses::cli
