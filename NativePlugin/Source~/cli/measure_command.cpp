// SPDX-License-Identifier: MIT
// quickses measure INPUT: area and volume, without a mesh.
#include <cstdio>
#include <string>

#include "cli/area_tables.h"
#include "cli/clock.h"
#include "cli/commands.h"
#include "cli/measuring.h"
#include "cli/text_output.h"
#include "io/atomic_file.h"
#include "io/radii.h"

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
  if (!options.json.empty() && options.json != "-") io::check_writable(options.json);
  AreaTables tables(options, options.measured);
  const auto read_start = Clock::now();
  const io::StructureFile file = load(options.input, options.read, options.compute, options.quiet);
  Timings timings;
  timings.read = ms_since(read_start);
  for (const io::Structure &structure : file.models) check_has_residues(options, structure);

  Engine engine(options.compute);
  explain_fallback(engine, options.compute, options.quiet);
  Options used = options;
  if (io::has_own_radii(file.format)) used.compute.radii = "file";
  const bool all_models = options.read.model == 0;
  std::string reports;
  for (const io::Structure &structure : file.models) {
    engine.set_atoms(structure, options.input);
    const Measurement measurement = measure_surfaces(engine, used);
    tables.write(make_area_rows(used, all_models ? std::to_string(structure.model) : "", structure, measurement.areas));
    if (!options.json.empty())
      reports += dump(measurement_json(used, structure, engine, measurement, timings), all_models);
    if (!options.quiet && !options.prints_data()) print_table(used, structure, engine, measurement);
  }
  tables.finish();
  if (!options.json.empty()) write_text(options.json, reports);
}

}  // namespace quickses::cli
