// SPDX-License-Identifier: MIT
// The flags that say which atoms of which structures.
#include "cli/input_options.h"

#include <map>

#include "cli/exit_code.h"
#include "cli/help_format.h"
#include "cli/option_kinds.h"
#include "io/mesh_writer.h"
#include "io/text.h"

namespace quickses::cli {
namespace {

const std::map<std::string, io::StructureFormat> kInputFormats = {{"pdb", io::StructureFormat::kPdb},
                                                                  {"mmcif", io::StructureFormat::kMmcif},
                                                                  {"pqr", io::StructureFormat::kPqr},
                                                                  {"xyzr", io::StructureFormat::kXyzr},
                                                                  {"gro", io::StructureFormat::kGro}};

const char kInputHelp[] =
    "Structure: .pdb .ent .brk .cif .mmcif .pqr .xyzr .xyzrn .gro, each also as .gz; - for standard input";

void add_structure_options(CLI::App *app, Options &options, const std::string &input_help, const char *model_help) {
  app->add_option("-i,--input,INPUT", options.inputs, input_help)->type_name("FILE");
  add_input_format(app, options);
  app->add_flag_callback(
      "--no-water", [&options] { options.read.water = false; }, "Leave out water; ions and ligands stay");
  app->add_flag_callback(
      "--no-hetero", [&options] { options.read.hetero = false; },
      "Leave out HETATM records: ligands, ions, most waters");
  app->add_flag_callback(
      "--no-hydrogen", [&options] { options.read.hydrogen = false; }, "Leave out hydrogen");
  app->add_option(
         "--select", options.read.selection,
         "Only these atoms: words such as 'protein and chain A' or 'within 5 of ligand', or CID such as //A/10-40")
      ->type_name("SELECTION");
  app->add_option("--assembly", options.read.assembly,
                  "Biological assembly of a PDB or mmCIF file, by its name there, mostly 1: copies of chains")
      ->type_name("NAME");
  app->add_option(
         "--altloc", options.read.altloc,
         "Which alternate locations: first, highest (of the greatest occupancy), or a label where there is one")
      ->type_name("first|highest|LABEL")
      ->default_str("first");
  app->add_option_function<std::string>(
         "--model",
         [&options](const std::string &text) {
           options.model_given = true;
           if (text == "all") {
             options.read.model = 0;
           } else if (!io::parse_integer(text, options.read.model) || options.read.model < 1) {
             throw Failure(kUsage, "--model: '" + text + "' is neither a number from 1 on nor 'all'");
           }
         },
         model_help)
      ->type_name("N|all");
  put_rest_into_group(app, "Input");
}

}  // namespace

void add_input_format(CLI::App *app, Options &options) {
  app->add_option_function<std::string>(
         "--input-format",
         [&options](const std::string &text) { options.input_format = look_up("--input-format", kInputFormats, text); },
         "pdb, mmcif, pqr, xyzr or gro, whatever the name and the content say")
      ->type_name("NAME");
}

void add_input_options(CLI::App *app, Options &options, const char *model_help) {
  add_structure_options(app, options, kInputHelp + std::string(". Or several, each with a mesh of its own"),
                        model_help);
}

void add_single_input_options(CLI::App *app, Options &options, const char *model_help) {
  add_structure_options(app, options, kInputHelp, model_help);
  app->get_option("--model")->type_name("N");
}

void check_inputs(const Options &options) {
  if (!options.has_several_inputs()) return;
  const std::string count = std::to_string(options.inputs.size());
  if (options.command == Options::Command::kCavities)
    throw Failure(kUsage, "cavities: one structure at a time, and " + count + " were given");
  if (!options.trajectories.empty())
    throw Failure(kUsage, "--trajectory: its frames are of one structure, and " + count +
                              " were given (of several trajectories, each needs a --trajectory before it)");
  for (const std::string &input : options.inputs)
    if (options.output.empty() && io::find_mesh_format(input))
      throw Failure(kUsage, "'" + input + "': one INPUT was given already; did you mean -o " + input + "?");
  if (!options.output.empty() && options.output.find("%s") == std::string::npos)
    throw Failure(kUsage, "--output (-o): '" + options.output + "' names one file for " + count +
                              " structures: write %s where the name of each goes, as in out/%s.ply");
}

}  // namespace quickses::cli
