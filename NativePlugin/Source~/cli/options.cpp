// SPDX-License-Identifier: MIT
// The flags of the program.
#include "cli/options.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>

#include "cli/exit_code.h"
#include "cli/output_pattern.h"
#include "cli/used_files.h"
#include "io/mesh_writer.h"
#include "io/text.h"

namespace quickses::cli {
namespace {

const std::map<std::string, qses_surface> kSurfaces = {
    {"ses", QSES_SURFACE_SES}, {"sas", QSES_SURFACE_SAS}, {"vdw", QSES_SURFACE_VDW}};
const std::map<std::string, qses_method> kMethods = {{"exact", QSES_METHOD_EXACT}, {"grid", QSES_METHOD_GRID}};
const std::map<std::string, qses_backend> kBackends = {
    {"auto", QSES_BACKEND_AUTO}, {"cuda", QSES_BACKEND_CUDA}, {"cpu", QSES_BACKEND_CPU}};
const std::map<std::string, Switch> kSwitches = {{"on", Switch::kOn}, {"off", Switch::kOff}};

const char kFooter[] =
    "Exit codes:\n"
    "  0  done\n"
    "  1  wrong usage: an unknown flag, a value out of range, an unknown extension of the output\n"
    "  2  an input file can't be read, or has no atoms (after the filters)\n"
    "  3  an output file can't be written\n"
    "  4  computing failed: memory, the device, a spacing too fine for either, a mesh that is not closed\n"
    "  5  the back end asked for can't be used here\n"
    "  6  some frames of a trajectory failed; the others are done\n"
    "\n"
    "Owner atoms in PLY files are 0-based places among the atoms of the input's model, before any filter.\n"
    "Lengths are in angstrom, areas in A^2, volumes in A^3.\n";

const std::map<std::string, Creases> kCreases = {
    {"auto", Creases::kAuto}, {"on", Creases::kOn}, {"off", Creases::kOff}};

template <typename Enum>
const char *find_name(const std::map<std::string, Enum> &names, Enum value) {
  for (const auto &entry : names)
    if (entry.second == value) return entry.first.c_str();
  return "unknown";
}

// An option whose text is looked up; anything else is refused with the list of what there is.
template <typename Enum>
CLI::Option *add_option_of(CLI::App *app, const char *flag, Enum &value, const std::map<std::string, Enum> &names,
                           const char *help) {
  return app->add_option_function<std::string>(
      flag,
      [&value, &names, flag](const std::string &text) {
        const auto found = names.find(text);
        if (found != names.end()) {
          value = found->second;
          return;
        }
        std::string list;
        for (const auto &entry : names) list += (list.empty() ? "" : ", ") + entry.first;
        throw Failure(kUsage, std::string(flag) + ": '" + text + "' is not one of " + list);
      },
      help);
}
template <typename Enum>
void add_choice(CLI::App *app, const char *flag, Enum &value, const std::map<std::string, Enum> &names,
                const char *help) {
  add_option_of(app, flag, value, names, help)->type_name("NAME")->default_str(find_name(names, value));
}

void add_number(CLI::App *app, const char *flags, const char *shown, double &value, double low, double high,
                const char *help) {
  app->add_option_function<std::string>(
         flags,
         [&value, shown, low, high](const std::string &text) {
           double number = 0;
           if (!io::parse_number(text, number))
             throw Failure(kUsage, std::string(shown) + ": '" + text + "' is no number");
           if (number < low || number > high) {
             char range[96];
             std::snprintf(range, sizeof range, " is not between %g and %g angstrom", low, high);
             throw Failure(kUsage, std::string(shown) + ": " + text + range);
           }
           value = number;
         },
         help)
      ->type_name("A")
      ->default_str(CLI::detail::to_string(value));
}

void add_count(CLI::App *app, const char *flags, const char *shown, unsigned &value, int low, int high,
               const char *help) {
  app->add_option_function<std::string>(
         flags,
         [&value, shown, low, high](const std::string &text) {
           int number = 0;
           if (!io::parse_integer(text, number) || number < low || number > high)
             throw Failure(kUsage, std::string(shown) + ": '" + text + "' is no whole number between " +
                                       std::to_string(low) + " and " + std::to_string(high));
           value = static_cast<unsigned>(number);
         },
         help)
      ->type_name("N");
}

void add_size(CLI::App *app, const char *flag, uint64_t &value, const char *help) {
  app->add_option_function<std::string>(
         flag,
         [&value, flag](const std::string &text) {
           if (!parse_size(text, value))
             throw Failure(kUsage, std::string(flag) + ": '" + text + "' is no size such as 512M or 2G");
         },
         help)
      ->type_name("SIZE");
}

void add_compute_options(CLI::App *app, ComputeOptions &options, int &device) {
  add_number(app, "-v,--spacing", "--spacing (-v)", options.spacing, 0.001, 100,
             "Distance of lattice points (voxel size)");
  add_count(app, "-l,--steps", "--steps (-l)", options.steps, 0, 100, "Smoothing steps; default 1");
  add_count(app, "-s,--slice", "--slice (-s)", options.slice, 8, 1 << 20,
            "Work in slices of at most N^3 lattice points; the mesh is the same. Default: as memory allows");
  add_number(app, "--probe", "--probe", options.probe, 0, 100, "Radius of the probe (solvent molecule)");
  add_choice(app, "--surface", options.surface, kSurfaces,
             "ses: solvent-excluded; sas: solvent-accessible; vdw: the atoms themselves");
  add_choice(app, "--method", options.method, kMethods,
             "exact: vertices on the exact surface; grid: the voxel method of Martinez, Krone and Baaden 2019");
  add_choice(
      app, "--creases", options.creases, kCreases,
      "Sharp creases: edges that cut across one are split there; default: on for a mesh that is written, off for "
      "trajectories and bench");
  add_choice(app, "--backend", options.backend, kBackends, "What computes; auto: CUDA if it can be used, else the CPU");
  app->add_option_function<std::string>(
         "--device",
         [&device](const std::string &text) {
           if (!io::parse_integer(text, device) || device < 0)
             throw Failure(kUsage, "--device: '" + text + "' is no number of a CUDA device");
         },
         "CUDA device; default 0")
      ->type_name("N");
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
         "file with lines `ELEMENT radius` (`*` for all others)")
      ->type_name("SET|FILE")
      ->default_str("quickses");
}

void add_surface_options(CLI::App &app, Options &options) {
  app.add_option("-i,--input,INPUT", options.input,
                 "Structure: .pdb .ent .cif .mmcif .pqr .xyzr .gro, each also as .gz");
  app.add_option("-o,--output", options.output, "Mesh: .obj, .ply (binary, with normals and owner atoms) or .stl")
      ->type_name("FILE");
  add_option_of(
      &app, "--hard-edges", options.hard_edges, kSwitches,
      "on: a vertex on a crease has a normal for each side, so that light breaks there; PLY files then have it "
      "once per side. Default: on for .obj and .ply")
      ->type_name("on|off");
  app.add_flag_callback(
      "--no-water", [&options] { options.read.water = false; }, "Leave out water");
  app.add_flag_callback(
      "--no-hetero", [&options] { options.read.hetero = false; }, "Leave out HETATM records");
  app.add_flag_callback(
      "--no-hydrogen", [&options] { options.read.hydrogen = false; }, "Leave out hydrogen");
  app.add_option("--select", options.read.selection, "Only these atoms, such as //A or //A/10-40 or (ALA)")
      ->type_name("CID");
  app.add_option_function<std::string>(
         "--model",
         [&options](const std::string &text) {
           if (text == "all") {
             options.read.model = 0;
           } else if (!io::parse_integer(text, options.read.model) || options.read.model < 1) {
             throw Failure(kUsage, "--model: '" + text + "' is neither a number from 1 on nor 'all'");
           }
         },
         "Which model of the file; all: one mesh each, as out_0001.ply for -o out.ply; default 1")
      ->type_name("N|all");
}

void add_trajectory_options(CLI::App &app, Options &options) {
  app.add_option("--trajectory", options.trajectory,
                 "Frames of the atoms of INPUT: .dcd .xtc, or .pdb with several models, each also as .gz")
      ->type_name("FILE");
  app.add_option_function<std::string>(
         "--frames", [&options](const std::string &text) { options.frames = FrameRange(text); },
         "Which frames, from 0: A:B:STEP as in Python (B is left out, negative numbers count from the end), or one")
      ->type_name("A:B:STEP");
  app.add_flag("--unwrap", options.unwrap, "Make molecules whole that the borders of the periodic box tear apart");
  app.add_option("--csv", options.csv, "Table of the frames: area, volume, components, cavities; - for standard output")
      ->type_name("FILE|-");
  add_count(&app, "--workers", "--workers", options.workers, 1, 1024,
            "Frames in flight at a time; default: one per thread, with CUDA at most 8");
}

void add_file_options(CLI::App *app, Options &options) {
  add_size(app, "--max-input", options.max_input,
           "Bound of what is taken into memory of each input, unpacked; default 4G, of gzip data 100 times its size");
  app->add_option("--json", options.json, "Report as JSON; - for standard output")->type_name("FILE|-");
  app->add_flag("--quiet", options.quiet, "Print nothing but errors");
}

// given: whether a flag was on the command line.
void check_trajectory(const Options &options, const std::function<bool(const char *)> &given) {
  if (options.trajectory.empty()) {
    for (const char *flag : {"--frames", "--unwrap", "--csv", "--workers"})
      if (given(flag))
        throw Failure(kUsage, std::string(flag) +
                                  " is for trajectories, and there is no --trajectory (a PDB file with " +
                                  "several models is one: quickses FILE --trajectory FILE)");
    return;
  }
  if (options.read.model == 0)
    throw Failure(kUsage, "--model all: with --trajectory, the atoms are those of one model");
  if (options.csv == "-" && options.json == "-")
    throw Failure(kUsage, "--csv and --json can't both go to standard output");
  if (!options.output.empty()) OutputPattern check(options.output);  // throws if it is none
}

void check(const Options &options, const std::function<bool(const char *)> &given) {
  if (options.compute.device_given && options.compute.backend == QSES_BACKEND_CPU)
    throw Failure(kUsage, "--device: only CUDA has devices to choose from, and --backend is cpu");
  if (options.compute.method == QSES_METHOD_GRID && options.compute.surface != QSES_SURFACE_SES)
    throw Failure(kUsage, "--method grid makes the solvent-excluded surface only: leave --surface at ses");
  if (options.compute.method == QSES_METHOD_GRID && options.compute.creases == Creases::kOn)
    throw Failure(kUsage, "--creases on: --method grid does not know where creases are");
  if (options.command == Options::Command::kBench) {
    if (options.inputs.empty()) throw Failure(kUsage, "bench: no input file was given");
    if (options.jobs && options.small > 0) throw Failure(kUsage, "--jobs and --small: one at a time");
    UsedFiles check(options);
    return;
  }
  if (options.input.empty()) throw Failure(kUsage, "no input file was given; see quickses --help");
  check_trajectory(options, given);
  if (!options.output.empty()) {
    try {
      io::mesh_format_of(options.output);
    } catch (const std::exception &error) {
      throw Failure(kUsage, std::string("--output (-o): ") + error.what());
    }
  }
  if (options.hard_edges == Switch::kOn && !has_hard_edges(options))
    throw Failure(kUsage, "--hard-edges on: is for the exact method and mesh files with normals, .obj or .ply");
  UsedFiles check(options);
}

}  // namespace

bool parse_size(const std::string &text, uint64_t &bytes) {
  size_t digits = 0;
  while (digits < text.size() && ((text[digits] >= '0' && text[digits] <= '9') || text[digits] == '.')) ++digits;
  double number = 0;
  if (!io::parse_number(text.substr(0, digits), number)) return false;
  std::string unit = text.substr(digits);
  for (char &c : unit) c = io::to_upper(c);
  if (unit.size() > 1 && unit.back() == 'B') unit.pop_back();
  if (unit.size() > 1 && unit.back() == 'I') unit.pop_back();
  if (unit == "B") unit.clear();
  const size_t power = unit.empty() ? 0 : unit.size() > 1 ? std::string::npos : std::string("KMGT").find(unit[0]) + 1;
  if (power > 4 || (!unit.empty() && power == 0)) return false;
  const double size = std::ldexp(number, static_cast<int>(10 * power));
  if (!(size >= 1) || size > 9e18) return false;
  bytes = static_cast<uint64_t>(size);
  return true;
}

const char *name_of(qses_surface surface) { return find_name(kSurfaces, surface); }
const char *name_of(qses_method method) { return find_name(kMethods, method); }
const char *name_of(qses_backend backend) { return find_name(kBackends, backend); }

bool has_hard_edges(const Options &options) {
  return options.hard_edges != Switch::kOff && options.compute.method == QSES_METHOD_EXACT && !options.output.empty() &&
         io::mesh_format_of(options.output) != io::MeshFormat::kStl;
}

Options parse_options(int argc, char **argv, std::ostream &out) {
  Options options;
  int device = -1;
  CLI::App app(
      "Molecular surfaces as closed triangle meshes.\n\n"
      "  quickses INPUT [-o OUT.obj|OUT.ply|OUT.stl] [options]\n"
      "  quickses INPUT --trajectory FILE [--frames A:B:STEP] [--csv FILE] [-o frame_%05d.ply] [options]\n"
      "  quickses bench FILE... [--repeat N] [--small N | --jobs] [options]\n",
      "quickses");
  app.allow_windows_style_options(false);  // a path may begin with a slash there too
  app.footer(kFooter);
  app.set_version_flag("--version", std::string("quickses ") + qses_version(), "Print the version");
  add_surface_options(app, options);
  add_compute_options(&app, options.compute, device);
  add_trajectory_options(app, options);
  add_file_options(&app, options);

  CLI::App *bench = app.add_subcommand("bench", "Time warm calls: median ms from atoms in memory to mesh in memory");
  bench->footer(kFooter);
  bench->add_option("FILE", options.inputs, "Structures")->type_name("FILE");
  add_count(bench, "--repeat", "--repeat", options.repeat, 1, 1000000, "Timed calls per structure; default 20");
  add_count(bench, "--small", "--small", options.small, 1, 1000000,
            "Time 100 surfaces of at least N atoms each instead, cut between residues, one after the other");
  bench->add_flag(
      "--jobs", options.jobs,
      "Time jobs instead: begin, cancel, destroy, the first level, and all levels against the finest alone");
  add_compute_options(bench, options.compute, device);
  add_file_options(bench, options);

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success &success) {  // --help, --version
    app.exit(success, out);
    options.command = Options::Command::kNone;
    return options;
  } catch (const CLI::ParseError &error) {
    std::string message = error.what();
    for (char &c : message)
      if (c == '\n') c = ' ';
    throw Failure(kUsage, message);
  }
  if (bench->parsed()) {
    if (app.count_all() > bench->count_all() + 1) throw Failure(kUsage, "bench: its options go behind the word bench");
    options.command = Options::Command::kBench;
  }
  options.compute.device_given = device >= 0;
  if (device >= 0) options.compute.device = device;
  if (options.compute.creases == Creases::kAuto) {
    const bool is_picture = options.command == Options::Command::kSurface && !options.output.empty() &&
                            options.trajectory.empty() && options.compute.method == QSES_METHOD_EXACT;
    options.compute.creases = is_picture ? Creases::kOn : Creases::kOff;
  }
  check(options, [&app](const char *flag) { return app.count(flag) != 0; });
  return options;
}

}  // namespace quickses::cli
