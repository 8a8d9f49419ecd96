// SPDX-License-Identifier: MIT
// quickses INPUT...: structures in, meshes and a report out.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "cli/area_tables.h"
#include "cli/clock.h"
#include "cli/commands.h"
#include "cli/each_input.h"
#include "cli/engine.h"
#include "cli/exit_code.h"
#include "cli/input.h"
#include "cli/mesh_output.h"
#include "cli/progress.h"
#include "cli/report.h"
#include "cli/shown_output.h"
#include "cli/tell.h"
#include "cli/text_output.h"
#include "cli/used_files.h"
#include "io/file_path.h"
#include "io/text.h"

namespace quickses::cli {
namespace {

// out.ply for one model; out_0001.ply and so on with --model all.
std::string output_of_model(const Options &options, int model) {
  if (options.output.empty() || options.read.model != 0 || makes_page(options)) return options.output;
  const std::filesystem::path path = io::path_of(options.output);
  char number[16];
  std::snprintf(number, sizeof number, "_%04d", model);
  const std::string name = io::utf8_of(path.stem()) + number + io::utf8_of(path.extension());
  return io::utf8_of(path.parent_path() / io::path_of(name));
}

// Of a mesh without a triangle.
void say_why_empty(const Options &options) {
  const auto say = [&](const char *why, double value) {
    char number[40];
    std::snprintf(number, sizeof number, "%g", value);
    tell("'" + options.input + "': there is no surface: " + why + " " + number);
  };
  if (options.compute.surface == QSES_SURFACE_GAUSSIAN)
    say("the density is nowhere as high as --isovalue", options.compute.isovalue);
  else
    say("all of it lies between the points of a lattice of --spacing", options.compute.spacing);
}

void print_summary(const Options &options, const io::Structure &structure, const Engine &engine, const qses_mesh &mesh,
                   const MeshSize &written, const qses_report &report) {
  const auto vertices = static_cast<uint32_t>(mesh.vertex_count - mesh.repeated_count);
  if (options.has_several_inputs()) std::printf("%s: ", options.input.c_str());
  const std::string cut = options.mesh.sharp ? " (cut: " + std::to_string(written.triangles) + ")" : "";
  std::printf("%s, %u vertices, %u triangles%s, area %.2f Å², volume %.2f Å³, %s, %.2f ms%s%s\n",
              io::counted(structure.atoms.size(), "atom").c_str(), vertices, mesh.triangle_count, cut.c_str(),
              report.area, report.volume, name_of(engine.backend()), report.compute_ms,
              options.output.empty() ? "" : ", ", options.output.c_str());
}

// The surfaces of structures, one after the other, with one engine.
class SurfaceRun {
 public:
  explicit SurfaceRun(const Options &options)
      : options_(options), files_(options), tables_(options, {options.compute.surface}) {}

  // options: of one structure.
  void run(const Options &options) {
    const Input input(options, options.quiet);
    timings_.read = input.read_ms;
    if (!engine_) start();
    if (has_all_models() && !options.output.empty() && !makes_page(options))
      for (const io::Structure &structure : input.file.models)
        files_.check_mesh(output_of_model(options, structure.model));
    Shown shown;
    shown.to_come = input.file.models.size();
    for (const io::Structure &structure : input.file.models) {
      Options model_options = input.options;
      model_options.output = output_of_model(options, structure.model);
      run(model_options, structure, shown);
    }
    if (!shown.page) return;
    shown.page->finish();
    hint_at_size(*shown.page, options);
  }

  void add_failure(const Options &options, const Failure &failure) {
    if (!options.json.empty()) reports_ += dump(failed_input_json(options, failure), true);
  }

  void finish() {
    tables_.finish();
    if (!options_.json.empty()) write_text(options_.json, reports_);
  }

 private:
  // What the models of a structure share.
  struct Shown {
    std::optional<render::Camera> camera;  // of the first
    std::unique_ptr<render::Page> page;
    size_t to_come = 0;
  };

  bool has_all_models() const { return options_.read.model == 0; }

  // Once something could be read.
  void start() {
    engine_.emplace(start_engine(options_.compute, options_.quiet));
    if (!options_.json.empty()) qses_set_stage_times(engine_->context(), 1);
  }

  // options: of this model.
  void run(const Options &options, const io::Structure &structure, Shown &shown) {
    MeshOutput output(options, structure);
    const qses_settings settings = mesh_settings_of(options);
    engine_->set_atoms(structure, options.input);
    qses_mesh mesh;
    {
      ProgressBar bar(engine_->context(), options.quiet);
      mesh = engine_->compute(settings);
    }
    const qses_report report = engine_->report();
    if (mesh.triangle_count == 0 && !options.quiet) say_why_empty(options);
    const auto write_start = Clock::now();
    const float *const centers = structure.positions.data();
    if (output.is_shown()) {
      if (!shown.camera) shown.camera = output.camera_for(centers, output.camera_needs_mesh() ? &mesh : nullptr);
      output.look(*shown.camera);
      if (makes_page(options) && !shown.page) shown.page = output.begin_page(options.output);
    }
    --shown.to_come;
    MeshSize written;
    if (shown.page) {
      std::string text;
      written =
          output.page_mesh(mesh, centers, has_all_models() ? "model " + std::to_string(structure.model) : "", &text);
      shown.page->add(text, shown.to_come);
    } else {
      written = output.accept(options.output, mesh, centers);
    }
    tables_.write(
        make_area_rows(options, first_columns(options, structure), structure, areas_of(options.compute.surface, mesh)));
    timings_.write = ms_since(write_start);
    if (!options.json.empty()) {
      const Json json = surface_json(options, structure, *engine_, mesh, written, report, timings_);
      reports_ += dump(json, has_all_models() || options.has_several_inputs());  // of several: one line each
    }
    if (!options.quiet && !options.prints_data()) print_summary(options, structure, *engine_, mesh, written, report);
  }

  const Options &options_;
  UsedFiles files_;
  AreaTables tables_;
  std::optional<Engine> engine_;
  Timings timings_;
  std::string reports_;
};

}  // namespace

void run_surface(const Options &options) {
  // Before anything takes time: can the results be written?
  if (!options.output.empty()) check_mesh_writable(output_of_input(options, options.inputs.front()));
  check_text_output(options.json);
  SurfaceRun run(options);
  const size_t failed_count = for_each_input(
      options, [&](const Options &one) { run.run(one); },
      [&](const Options &one, const Failure &failure) { run.add_failure(one, failure); });
  run.finish();
  check_failed_inputs(options, failed_count);
}

}  // namespace quickses::cli
