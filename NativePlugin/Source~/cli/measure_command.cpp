// SPDX-License-Identifier: MIT
// quickses measure INPUT: area and volume, without a mesh.
#include <cstdio>
#include <string>

#include "cli/area_tables.h"
#include "cli/commands.h"
#include "cli/input.h"
#include "cli/measuring.h"
#include "cli/text_output.h"

namespace quickses::cli {
namespace {

void print_table(const Options &options, const io::Structure &structure, const Engine &engine,
                 const Measurement &measurement) {
  const std::string model = options.read.model == 0 ? ", model " + std::to_string(structure.model) : "";
  std::printf("%s%s: %zu atoms, probe %g Å, %s, %.2f ms\n", options.input.c_str(), model.c_str(),
              structure.atoms.size(), options.compute.probe, name_of(engine.backend()), measurement.milliseconds);
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
  const Input input(options, options.quiet);
  Timings timings;
  timings.read = input.read_ms;

  Engine engine = start_engine(options.compute, options.quiet);
  const bool all_models = options.read.model == 0;
  std::string reports;
  for (const io::Structure &structure : input.file.models) {
    engine.set_atoms(structure, options.input);
    const Measurement measurement = measure_surfaces(engine, options);
    tables.write(
        make_area_rows(options, all_models ? std::to_string(structure.model) : "", structure, measurement.areas));
    if (!options.json.empty())
      reports += dump(measurement_json(input.options, structure, engine, measurement, timings), all_models);
    if (!options.quiet && !options.prints_data()) print_table(options, structure, engine, measurement);
  }
  tables.finish();
  if (!options.json.empty()) write_text(options.json, reports);
}

}  // namespace quickses::cli
