// SPDX-License-Identifier: MIT
// The flags of the program.
#include "cli/options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <functional>
#include <map>

#include "cli/bench_options.h"
#include "cli/exit_code.h"
#include "cli/help_format.h"
#include "cli/input_options.h"
#include "cli/manual.h"
#include "cli/mesh_options.h"
#include "cli/option_kinds.h"
#include "cli/output_pattern.h"
#include "cli/picture_options.h"
#include "cli/shown_output.h"
#include "cli/suggestions.h"
#include "cli/used_files.h"
#include "cli/wildcards.h"
#include "io/atomic_file.h"
#include "io/file_path.h"
#include "io/text.h"

namespace quickses::cli {
namespace {

const std::map<std::string, qses_surface> kSurfaces = {{"ses", QSES_SURFACE_SES},
                                                       {"sas", QSES_SURFACE_SAS},
                                                       {"vdw", QSES_SURFACE_VDW},
                                                       {"gaussian", QSES_SURFACE_GAUSSIAN}};
// By measure.
const std::map<std::string, qses_surface> kMeasured = [] {
  std::map<std::string, qses_surface> surfaces = kSurfaces;
  surfaces.erase("gaussian");
  return surfaces;
}();
const std::map<std::string, qses_method> kMethods = {{"exact", QSES_METHOD_EXACT}, {"grid", QSES_METHOD_GRID}};
const std::map<std::string, qses_backend> kBackends = {
    {"auto", QSES_BACKEND_AUTO}, {"cuda", QSES_BACKEND_CUDA}, {"cpu", QSES_BACKEND_CPU}};

const char kFooter[] =
    "Exit codes:\n"
    "  0  done\n"
    "  1  wrong usage: an unknown flag, a value out of range, an unknown extension of the output\n"
    "  2  an input file can't be read, or has no atoms (after the filters)\n"
    "  3  an output file can't be written\n"
    "  4  computing failed: memory, the device, a spacing too fine for either, a mesh not closed\n"
    "  5  the back end, or the CUDA device, asked for can't be used here\n"
    "  6  some frames of a trajectory, or some of several structures, failed; the others are done\n"
    "\n"
    "Owner atoms in PLY and GLB files are 0-based places among the atoms of the input's model (or of\n"
    "the assembly), before any filter.\n"
    "Lengths are in angstrom, areas in A^2, volumes in A^3.\n";

void add_compute_options(CLI::App *app, ComputeOptions &options) {
  add_number(app, "-v,--spacing", "--spacing (-v)", options.spacing, 0.001, 100,
             "Distance of lattice points (voxel size)");
  add_count(app, "-l,--steps", "--steps (-l)", options.steps, 0, 100, "Smoothing steps; default 1");
  add_count(app, "-s,--slice", "--slice (-s)", options.slice, 8, 1 << 20,
            "Work in slices of at most N^3 lattice points; the mesh is the same. Default: as memory allows");
  add_number(app, "--probe", "--probe", options.probe, 0, 100, "Radius of the probe (solvent molecule)");
  add_choice(app, "--backend", options.backend, kBackends, "What computes; auto: CUDA if it can be used, else the CPU");
  app->add_option_function<std::string>(
         "--device", [&options](const std::string &text) { options.devices = DeviceChoice(text); },
         "CUDA device; default 0. With --trajectory also several, which share the frames: 0,1 or all")
      ->type_name("N|N,N|all");
  add_count(app, "--threads", "--threads", options.threads, 1, 4096, "CPU threads; default: all there are");
  add_size(app, "--memory", options.memory,
           "Bound of the memory for the work, on the device or in the machine: 512M, 2G (K, M, G: powers of 1024)");
  app->add_option_function<std::string>(
         "--radii",
         [&options](const std::string &text) {
           options.radii = text;
           options.radii_given = true;
         },
         "Van der Waals radii: quickses (O 1.52, C 1.70, N 1.55, H 1.20, S 1.80, P 1.80, others 1.40), bondi, or a "
         "file with lines `ELEMENT radius` (`*` for all others) or `RESIDUE ATOM radius`")
      ->type_name("quickses|bondi|FILE")
      ->default_str("quickses");
  put_into_group(app, "Input", {"--radii"});
  put_into_group(app, "Surface", {"--spacing", "--steps", "--slice", "--probe"});
  put_into_group(app, "Computing", {"--backend", "--device", "--threads", "--memory"});
}

void add_creases(CLI::App *app, ComputeOptions &options) {
  add_switch(
      app, "--creases", options.creases,
      "on: edges of triangles that cut across a crease are split on it, for sharp rims and for numbers. Default: "
      "on where there are creases, but off for trajectories and bench");
}

void add_surface_choice(CLI::App *app, ComputeOptions &options) {
  add_choice(app, "--surface", options.surface, kSurfaces,
             "ses: solvent-excluded; sas: solvent-accessible; vdw: the atoms themselves; gaussian: of a density, as "
             "QuickSurf's");
  add_number(app, "--radius-scale", "--radius-scale", options.radius_scale, 0.05, 10,
             "gaussian: an atom's standard deviation over its radius", false);
  add_number(app, "--isovalue", "--isovalue", options.isovalue, 0.01, 1000, "gaussian: the density on the surface",
             false);
  add_choice(app, "--method", options.method, kMethods,
             "exact: vertices on the exact surface; grid: the voxel method of Martinez, Krone and Baaden 2019");
  add_creases(app, options);
  add_switch(app, "--occlusion", options.occlusion,
             "on: how open the surface is at each vertex (ambient occlusion), in .ply and .glb files, and as shade in "
             ".png and .html. Default: on for these two");
  put_rest_into_group(app, "Surface");
}

void add_measured(CLI::App *app, std::vector<qses_surface> &measured) {
  app->add_option_function<std::string>(
         "--surface",
         [&measured](const std::string &text) {
           measured.clear();
           for (const std::string &name : io::split(text, ',')) {
             const qses_surface surface = look_up("--surface", kMeasured, name);
             if (std::find(measured.begin(), measured.end(), surface) != measured.end())
               throw Failure(kUsage, "--surface: '" + text + "' names one of them twice");
             measured.push_back(surface);
           }
         },
         "Which, in this order: sas, vdw, or ses (through a mesh that is not written), with commas between them")
      ->type_name("LIST")
      ->default_str("sas,vdw");
}

void add_area_options(CLI::App *app, Options &options) {
  app->add_option("--per-atom", options.per_atom, "Table of the area of each atom (CSV); - for standard output")
      ->type_name("FILE|-");
  app->add_option("--per-residue", options.per_residue,
                  "Table of the area of each residue (CSV); - for standard output")
      ->type_name("FILE|-");
  put_rest_into_group(app, "Report");
}

void add_trajectory_options(CLI::App *app, Options &options, const char *csv_help) {
  app->add_option("--trajectory", options.trajectories,
                  "Frames of the atoms of INPUT: .dcd .xtc .trr .nc .ncdf .ncrst, or .pdb .ent .brk with several "
                  "models, each also as .gz. Given several times: files in a row, their frames numbered through")
      ->type_name("FILE")
      ->allow_extra_args(false);  // INPUT may come next
  app->add_option_function<std::string>(
         "--frames", [&options](const std::string &text) { options.frames = FrameRange(text); },
         "Which frames, from 0: A:B:STEP as in Python (B is left out, negative numbers count from the end), or one")
      ->type_name("A:B:STEP");
  app->add_flag("--unwrap", options.unwrap, "Make molecules whole that the borders of the periodic box tear apart");
  app->add_option("--csv", options.csv, csv_help)->type_name("FILE|-");
  add_count(app, "--workers", "--workers", options.workers, 1, 1024,
            "Frames computed at a time, on each device; default: one per thread, with CUDA at most 8");
  put_rest_into_group(app, "Trajectory");
}

void add_file_options(CLI::App *app, Options &options) {
  add_size(app, "--max-input", options.max_input,
           "Bound of what is taken into memory of each input, unpacked; default 4G, of gzip data 100 times its size");
  app->add_option("--json", options.json, "Report as JSON; - for standard output")->type_name("FILE|-");
  app->add_flag("--quiet", options.quiet, "Print nothing but errors");
  put_into_group(app, "Input", {"--max-input"});
  put_rest_into_group(app, "Report");
}

// How to get numbers of all models of the input.
std::string hint_at_models(const Options &options) {
  const std::string extension =
      options.inputs.empty() ? "" : io::lower_extension_of_content(io::path_of(options.inputs.front()));
  if (extension == ".pdb" || extension == ".ent" || extension == ".brk")
    return " (a PDB file with several models is one: quickses FILE --trajectory FILE)";
  return " (numbers of all models of a file: --model all --json FILE)";
}

// given: whether a flag was on the command line.
void check_trajectory(const Options &options, const std::function<bool(const char *)> &given) {
  if (options.trajectories.empty()) {
    for (const char *flag : {"--frames", "--unwrap", "--csv", "--workers"})
      if (given(flag))
        throw Failure(
            kUsage, std::string(flag) + " is for trajectories, and there is no --trajectory" + hint_at_models(options));
    return;
  }
  if (options.read.model == 0)
    throw Failure(kUsage, "--model all: with --trajectory, the atoms are those of one model");
  if (!options.read.assembly.empty())
    throw Failure(kUsage, "--assembly: the frames of --trajectory have the atoms of the file, not of an assembly");
  if (!options.output.empty() && !makes_page(options)) OutputPattern check(options.output);  // throws if it is none
}

void check_standard_output(const Options &options) {
  const std::string mesh = io::is_standard_output(options.output) ? "-" : "";
  const std::pair<const char *, const std::string &> outputs[] = {{"--output (-o)", mesh},
                                                                  {"--csv", options.csv},
                                                                  {"--per-atom", options.per_atom},
                                                                  {"--per-residue", options.per_residue},
                                                                  {"--json", options.json}};
  const char *first = nullptr;
  for (const auto &[flag, name] : outputs) {
    if (name != "-") continue;
    if (first) throw Failure(kUsage, std::string(first) + " and " + flag + " can't both go to standard output");
    first = flag;
  }
}

void check_standard_input(const Options &options) {
  const auto count = std::count(options.inputs.begin(), options.inputs.end(), "-");
  if (count > 1)
    throw Failure(kUsage,
                  "'-': standard input is given " + std::to_string(count) + " times, and can be read only once");
}

// As from a variable of a shell that is not set. Without a file to write to, a run would do nothing and say nothing.
void check_values(const CLI::App &used) {
  for (const CLI::Option *option : used.get_options())
    for (const std::string &value : option->results())
      if (value.empty()) throw Failure(kUsage, option->get_name() + ": '' is given, which is nothing");
}

// CLI11 would take --quiet=no for the flag left out, and --quiet=3 for the flag.
void refuse_values_of_flags(CLI::App *command) {
  for (CLI::Option *option : command->get_options())
    if (option->get_items_expected_max() == 0) option->disable_flag_override();
}

void check_devices(const Options &options) {
  const DeviceChoice &devices = options.compute.devices;
  if (devices.is_given() && options.compute.backend == QSES_BACKEND_CPU)
    throw Failure(kUsage, "--device: only CUDA has devices to choose from, and --backend is cpu");
  if (devices.may_be_many() && options.trajectories.empty())
    throw Failure(kUsage, "--device " + devices.text() +
                              ": several devices share the frames of a trajectory, and there is no --trajectory");
}

void check(const Options &options, const std::function<bool(const char *)> &given) {
  check_devices(options);
  check_standard_input(options);
  if (options.compute.method == QSES_METHOD_GRID && options.compute.surface != QSES_SURFACE_SES)
    throw Failure(kUsage, "--method grid makes the solvent-excluded surface only: leave --surface at ses");
  const bool is_gaussian = options.compute.surface == QSES_SURFACE_GAUSSIAN;
  if (is_gaussian && options.compute.creases == Switch::kOn)
    throw Failure(kUsage, "--creases on: a Gaussian surface has none");
  const bool measures = options.command == Options::Command::kMeasure;  // which knows no such flag
  for (const char *flag : {"--radius-scale", "--isovalue"})
    if (!is_gaussian && !measures && given(flag))
      throw Failure(kUsage, std::string(flag) + ": is for --surface gaussian");
  if (options.compute.method == QSES_METHOD_GRID && options.compute.creases == Switch::kOn)
    throw Failure(kUsage, "--creases on: --method grid does not know where creases are");
  if (options.command == Options::Command::kBench) {
    check_bench(options, given);
    UsedFiles check(options);
    return;
  }
  if (options.inputs.empty()) throw Failure(kUsage, "no input file was given; see quickses --help");
  check_inputs(options);
  if (options.command == Options::Command::kCavities) {
    if (options.read.model == 0) throw Failure(kUsage, "--model all: cavities lists those of one model");
  } else {
    check_trajectory(options, given);
  }
  if (options.wants_areas() && options.compute.method == QSES_METHOD_GRID)
    throw Failure(kUsage, "--per-atom and --per-residue: areas of atoms are there with --method exact only");
  check_mesh_options(options);
  check_picture_options(options, given);
  check_standard_output(options);
  UsedFiles check(options);
}

}  // namespace

std::string probe_text(const std::vector<qses_surface> &surfaces, double probe) {
  if (std::none_of(surfaces.begin(), surfaces.end(), uses_probe)) return "";
  char text[40];
  std::snprintf(text, sizeof text, "probe %g Å, ", probe);
  return text;
}

const char *name_of(qses_surface surface) { return find_name(kSurfaces, surface); }
const char *name_of(qses_method method) { return find_name(kMethods, method); }
const char *name_of(qses_backend backend) { return find_name(kBackends, backend); }

bool Options::prints_data() const {
  return csv == "-" || json == "-" || per_atom == "-" || per_residue == "-" || io::is_standard_output(output) ||
         io::descriptor_of(output) == 1;
}

std::string Options::quoted_trajectories() const {
  const std::string first = "'" + trajectories.front() + "'";
  return trajectories.size() == 1 ? first : first + " and " + std::to_string(trajectories.size() - 1) + " more";
}

Options parse_options(int argc, char **argv, std::ostream &out) {
  Options options;
  CLI::App app(
      "Molecular surfaces as closed triangle meshes.\n\n"
      "  quickses INPUT [-o OUT.ply|OUT.obj|OUT.glb|OUT.stl|OUT.off|OUT.vert|OUT.png|OUT.html] [options]\n"
      "  quickses INPUT... [-o out/%s.ply] [options]\n"
      "  quickses INPUT --trajectory FILE [--frames A:B:STEP] [--csv FILE] [-o frame_%05d.ply] [options]\n"
      "  quickses measure INPUT... [--surface sas,vdw,ses] [--per-atom FILE] [--per-residue FILE] [options]\n"
      "  quickses cavities INPUT [--csv FILE] [options]\n"
      "  quickses bench FILE... [--repeat N] [--copies N] [--small N | --jobs] [options]\n",
      "quickses");
  app.formatter(std::make_shared<HelpFormat>());
  put_into_group(&app, "Report", {"--help"});
  app.allow_windows_style_options(false);  // a path may begin with a slash there too
  app.footer(kFooter);
  app.set_version_flag("--version", std::string("quickses ") + qses_version(), "Print the version");
  put_rest_into_group(&app, "Report");
  add_input_options(&app, options,
                    "Which model of the file; all: one mesh each, as out_0001.ply for -o out.ply; default 1");
  add_mesh_options(&app, options);
  add_picture_options(&app, options.picture);
  add_compute_options(&app, options.compute);
  add_surface_choice(&app, options.compute);
  add_trajectory_options(&app, options,
                         "Table of the frames: area, volume, components, cavities; - for standard output");
  add_area_options(&app, options);
  add_file_options(&app, options);

  CLI::App *measure = app.add_subcommand(
      "measure", "Area and volume, those of SAS and VDW exactly and without a mesh, per atom and residue on request");
  measure->footer(kFooter);
  put_into_group(measure, "Report", {"--help"});
  add_input_options(measure, options, "Which model of the file, or all of them; default 1");
  add_measured(measure, options.measured);
  add_compute_options(measure, options.compute);
  add_creases(measure, options.compute);
  put_rest_into_group(measure, "Surface");
  add_trajectory_options(measure, options, "Table of the frames: area and volume; - for standard output");
  add_area_options(measure, options);
  add_file_options(measure, options);

  CLI::App *cavities =
      app.add_subcommand("cavities", "The cavities of a surface: volume, area, centre and the residues that line them");
  cavities->footer(kFooter);
  put_into_group(cavities, "Report", {"--help"});
  add_single_input_options(cavities, options, "Which model of the file; default 1");
  add_compute_options(cavities, options.compute);
  add_surface_choice(cavities, options.compute);
  cavities->add_option("--csv", options.csv, "Table of the cavities; - for standard output")->type_name("FILE|-");
  add_file_options(cavities, options);

  CLI::App *bench = app.add_subcommand("bench", "Time warm calls: median ms from atoms in host memory to the mesh");
  bench->footer(kFooter);
  put_into_group(bench, "Report", {"--help"});
  bench->add_option("FILE", options.inputs, "Structures")->type_name("FILE");
  add_input_format(bench, options);
  add_bench_options(bench, options.bench);
  add_compute_options(bench, options.compute);
  add_surface_choice(bench, options.compute);
  add_file_options(bench, options);

  for (CLI::App *command : {&app, measure, cavities, bench}) refuse_values_of_flags(command);
  const std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
  if (arguments.size() == 1 && (arguments[0] == "--help-man" || arguments[0] == "--help-completion")) {
    out << (arguments[0] == "--help-man" ? manual_page(app, qses_version()) : bash_completion(app));
    options.command = Options::Command::kNone;
    return options;
  }
  const CLI::App &asked = command_of(app, arguments);
  check_dashes(asked, arguments);
  try {
    app.parse(argc, argv);
  } catch (const Failure &failure) {  // of an option's value
    throw Failure(failure.code(), failure.what() + suggest_dashes(asked, arguments));
  } catch (const CLI::ExtrasError &error) {
    const std::vector<std::string> extras = app.remaining(true);
    throw Failure(kUsage, extras.empty() ? error.what() : explain_extra(asked, arguments, extras[0]));
  } catch (const CLI::Success &success) {  // --help, --version
    app.exit(success, out);
    options.command = Options::Command::kNone;
    return options;
  } catch (const CLI::ParseError &error) {
    std::string message = error.what();
    for (char &c : message)
      if (c == '\n') c = ' ';
    throw Failure(kUsage, explain_count(message, arguments));
  }
  const CLI::App *used = &app;
  const std::pair<const CLI::App *, Options::Command> commands[] = {{measure, Options::Command::kMeasure},
                                                                    {cavities, Options::Command::kCavities},
                                                                    {bench, Options::Command::kBench}};
  for (const auto &[command, value] : commands) {
    if (!command->parsed()) continue;
    if (app.count_all() > command->count_all() + 1)
      throw Failure(kUsage, command->get_name() + ": its options go behind the word " + command->get_name());
    used = command;
    options.command = value;
  }
  expand_wildcards(&options.inputs);
  expand_wildcards(&options.trajectories);
  if (!options.inputs.empty()) options.input = options.inputs.front();
  if (used == &app && options.has_several_inputs()) check_command(app, options.input);
  resolve_output(options);
  set_mesh_defaults(options);
  if (options.compute.creases == Switch::kDefault) {
    const bool is_many = options.command == Options::Command::kBench || !options.trajectories.empty();
    options.compute.creases = is_many || !knows_creases(options.compute) ? Switch::kOff : Switch::kOn;
  }
  check_values(*used);
  check(options, [used](const char *flag) { return used->count(flag) != 0; });
  return options;
}

}  // namespace quickses::cli
