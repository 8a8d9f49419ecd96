// SPDX-License-Identifier: MIT
// quickses INPUT: a structure in, a mesh and a report out.
#include <cstdio>
#include <filesystem>
#include <optional>

#include "cli/area_tables.h"
#include "cli/clock.h"
#include "cli/commands.h"
#include "cli/engine.h"
#include "cli/exit_code.h"
#include "cli/input.h"
#include "cli/mesh_output.h"
#include "cli/progress.h"
#include "cli/report.h"
#include "cli/text_output.h"
#include "cli/used_files.h"
#include "io/file_path.h"

namespace quickses::cli {
namespace {

// out.ply for one model; out_0001.ply and so on with --model all.
std::string output_of_model(const Options &options, int model) {
  if (options.output.empty() || options.read.model != 0) return options.output;
  const std::filesystem::path path = io::path_of(options.output);
  char number[16];
  std::snprintf(number, sizeof number, "_%04d", model);
  const std::string name = io::utf8_of(path.stem()) + number + io::utf8_of(path.extension());
  return io::utf8_of(path.parent_path() / io::path_of(name));
}

void print_summary(const Options &options, const io::Structure &structure, const Engine &engine, const qses_mesh &mesh,
                   const qses_report &report) {
  const auto vertices = static_cast<uint32_t>(mesh.vertex_count - mesh.repeated_count);
  std::printf("%zu atoms, %u vertices, %u triangles, area %.2f Å², volume %.2f Å³, %s, %.2f ms%s%s\n",
              structure.atoms.size(), vertices, mesh.triangle_count, report.area, report.volume,
              name_of(engine.backend()), report.compute_ms, options.output.empty() ? "" : ", ", options.output.c_str());
}

}  // namespace

void run_surface(const Options &options) {
  // Before anything takes time: can the results be written?
  check_mesh_writable(options.output);
  check_text_output(options.json);
  AreaTables tables(options, {options.compute.surface});

  const Input input(options, options.quiet);
  Timings timings;
  timings.read = input.read_ms;

  Engine engine = start_engine(options.compute, options.quiet);
  const qses_settings settings = mesh_settings_of(options);
  if (!options.json.empty()) qses_set_stage_times(engine.context(), 1);

  const bool all_models = options.read.model == 0;
  if (all_models && !options.output.empty()) {
    const UsedFiles files(options);
    for (const io::Structure &structure : input.file.models)
      files.check_mesh(output_of_model(options, structure.model));
  }
  std::string reports;
  for (const io::Structure &structure : input.file.models) {
    Options model_options = input.options;
    model_options.output = output_of_model(options, structure.model);
    engine.set_atoms(structure, options.input);
    std::optional<qses_size_estimate> predicted;
    if (!options.json.empty()) predicted = engine.estimate(settings);
    qses_mesh mesh;
    {
      ProgressBar bar(engine.context(), options.quiet);
      mesh = engine.compute(settings);
    }
    const qses_report report = engine.report();
    const auto write_start = Clock::now();
    MeshOutput(options, structure).accept(model_options.output, mesh, structure.positions.data());
    tables.write(make_area_rows(options, all_models ? std::to_string(structure.model) : "", structure,
                                areas_of(options.compute.surface, mesh)));
    timings.write = ms_since(write_start);
    if (!options.json.empty()) {
      const Json json =
          surface_json(model_options, structure, engine, mesh, report, timings, predicted ? &*predicted : nullptr);
      reports += dump(json, all_models);  // of several models: one line each
    }
    if (!options.quiet && !options.prints_data()) print_summary(model_options, structure, engine, mesh, report);
  }
  tables.finish();
  if (!options.json.empty()) write_text(options.json, reports);
}

}  // namespace quickses::cli
