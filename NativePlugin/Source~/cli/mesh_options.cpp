// SPDX-License-Identifier: MIT
// The flags that say what mesh files have in them.
#include "cli/mesh_options.h"

#include <map>

#include "cli/each_input.h"
#include "cli/exit_code.h"
#include "cli/help_format.h"
#include "cli/mesh_output.h"
#include "cli/option_kinds.h"
#include "cli/shown_output.h"
#include "io/atomic_file.h"
#include "io/mesh_writer.h"

namespace quickses::cli {
namespace {

const std::map<std::string, MeshColors> kColors = {
    {"none", MeshColors::kNone},           {"element", MeshColors::kElement},
    {"chain", MeshColors::kChain},         {"residue", MeshColors::kResidue},
    {"sequence", MeshColors::kSequence},   {"hydrophobicity", MeshColors::kHydrophobicity},
    {"component", MeshColors::kComponent}, {"patch", MeshColors::kPatch}};

void read_color(const std::string &text, MeshFileOptions &mesh) {
  if (parse_color(text, mesh.color)) {
    mesh.colors = MeshColors::kOne;
    return;
  }
  if (text.compare(0, 1, "#") == 0)
    throw Failure(kUsage, "--color: '" + text + "' is no colour: they are written #RRGGBB, as #C08000");
  mesh.colors = look_up("--color", kColors, text);
}

// Of those that are one file each.
const std::map<std::string, io::MeshFormat> kMeshFormats = {
    {"obj", io::MeshFormat::kObj},  {"ply", io::MeshFormat::kPly}, {"stl", io::MeshFormat::kStl},
    {"glb", io::MeshFormat::kGlb},  {"off", io::MeshFormat::kOff}, {"png", io::MeshFormat::kPng},
    {"html", io::MeshFormat::kHtml}};

// Of the output, which there is.
io::MeshFormat format_of(const Options &options) {
  try {
    return io::mesh_format_of(options.output);
  } catch (const std::exception &error) {
    throw Failure(kUsage, std::string("--output (-o): ") + error.what());
  }
}

void check_hard_edges(const Options &options) {
  if (options.hard_edges == Switch::kOn && !has_hard_edges(options))
    throw Failure(kUsage,
                  "--hard-edges on: is for the exact method and files with normals, .obj, .ply, .glb, .png or .html");
}

bool has_colors(const MeshFileOptions &mesh) {
  return mesh.colors != MeshColors::kNone && mesh.colors != MeshColors::kDefault;
}

void check_without_output(const MeshFileOptions &mesh) {
  const auto refuse = [](const char *flag, const char *what) {
    throw Failure(kUsage, std::string(flag) + ": " + what + " of a mesh file, and there is no --output (-o)");
  };
  if (mesh.component_ids) refuse("--component-ids", "they are part");
  if (has_colors(mesh)) refuse("--color", "it is");
  if (mesh.sharp) refuse("--sharp-colors", "it is about colours");
  if (mesh.text) refuse("--ascii", "it is a form");
  if (mesh.center) refuse("--center", "it moves the vertices");
  if (mesh.scale != 1) refuse("--scale", "it is the size");
}

bool differ_by_atom(MeshColors colors) {
  return scheme_of(colors).value_or(io::ColorScheme::kUniform) != io::ColorScheme::kUniform;
}

void check_format(const Options &options) {
  const MeshFileOptions &mesh = options.mesh;
  const io::MeshFormat format = format_of(options);
  const auto refuse = [&](const char *flag, const char *what) {
    throw Failure(kUsage, std::string(flag) + ": " + what + ", and --output (-o) is '" + options.output + "'");
  };
  if (mesh.component_ids && format != io::MeshFormat::kPly && format != io::MeshFormat::kGlb)
    refuse("--component-ids", "only PLY and GLB files have them");
  if (mesh.text && format != io::MeshFormat::kPly) refuse("--ascii", "only PLY files are there as bytes and as text");
  if (has_colors(mesh) && !io::format_traits_of(format).has_colors)
    refuse("--color", "STL and MSMS files have no colours (.ply, .obj, .glb, .off, .png and .html have)");
  if (options.compute.occlusion == Switch::kOn && !io::format_traits_of(format).has_occlusion)
    refuse("--occlusion", "such files have no place for it (.ply, .glb, .png and .html have)");
  if (mesh.center && io::format_traits_of(format).is_shown)
    refuse("--center", "a picture or page has the middle in the middle anyway");
  if (mesh.scale != 1 && io::format_traits_of(format).is_shown)
    refuse("--scale", "a picture or page has no unit (there is --zoom)");
  if (mesh.scale < 0.01 && format == io::MeshFormat::kMsms)
    refuse("--scale", "MSMS files have six digits behind the point, which are too few below 0.01");
  if (mesh.sharp && !differ_by_atom(mesh.colors) && mesh.colors != MeshColors::kDefault)
    throw Failure(
        kUsage,
        "--sharp-colors: is for colours of atoms (--color element, chain, residue, hydrophobicity or sequence)");
  if (!knows_creases(options.compute) && needs_patches(options))
    throw Failure(kUsage,
                  std::string(options.compute.method == QSES_METHOD_GRID ? "--method grid" : "--surface gaussian") +
                      " does not know on what kind of patch a vertex is, which " +
                      std::string(format == io::MeshFormat::kMsms ? "MSMS files tell" : "--color patch shows"));
}

}  // namespace

void add_mesh_options(CLI::App *app, Options &options) {
  MeshFileOptions &mesh = options.mesh;
  app->add_option("-o,--output", options.output,
                  "Mesh: .obj, .ply (with normals and owner atoms), .glb (glTF 2.0), .stl, .off, or .vert, with .face "
                  "beside it, as MSMS writes them. Or a picture of it: .png, or .html, a web page to turn it. %s "
                  "stands for the name of INPUT")
      ->type_name("FILE|-");
  app->add_option_function<std::string>(
         "--output-format",
         [&options](const std::string &text) {
           look_up("--output-format", kMeshFormats, text);
           options.output_format = text;
         },
         "obj, ply, stl, glb, off, png or html: what -o - writes to standard output")
      ->type_name("NAME");
  add_switch(app, "--hard-edges", options.hard_edges,
             "on: a vertex on a crease has a normal for each side, so that light breaks there; PLY and GLB files then "
             "have it once per side. Default: on for .obj, .ply, .glb, .png and .html");
  app->add_flag("--outer", options.outer, "Leave the walls of cavities out of the mesh, not of the numbers");
  app->add_option_function<std::string>(
         "--color", [&mesh](const std::string &text) { read_color(text, mesh); },
         "Colours of the vertices, in all but .stl and .vert: element (Jmol's), chain, residue (their classes), "
         "hydrophobicity, sequence, component (connected pieces), patch (contact, toroidal, reentrant), none, or one "
         "for "
         "all. Default: none; of .png and .html chain, or element where there is one chain only")
      ->type_name("NAME|#RRGGBB");
  app->add_flag("--sharp-colors", mesh.sharp,
                "Cut triangles where the colours of atoms meet, so that each has one colour and borders are smooth");
  app->add_flag("--component-ids", mesh.component_ids,
                "The number of each vertex's connected piece in PLY files, as int component, and in GLB files");
  app->add_flag("--ascii", mesh.text, "PLY files as text");
  app->add_flag("--center", mesh.center, "The middle of the mesh's box goes to the origin, in the file");
  add_number(app, "--scale", "--scale", mesh.scale, 1e-12, 1e12,
             "Multiply coordinates in the file, which are in angstrom: 0.5 prints half a millimetre per angstrom",
             false);
  put_rest_into_group(app, "Output");
}

void set_mesh_defaults(Options &options) {
  MeshFileOptions &mesh = options.mesh;
  const bool is_shown = makes_shown(options);
  if (!is_shown && mesh.colors == MeshColors::kDefault) mesh.colors = MeshColors::kNone;
  if (is_shown && options.compute.occlusion == Switch::kDefault) options.compute.occlusion = Switch::kOn;
  if (is_shown && !options.picture.edges && (mesh.colors == MeshColors::kDefault || differ_by_atom(mesh.colors)))
    mesh.sharp = true;
}

void check_mesh_options(const Options &options) {
  if (options.output.empty())
    check_without_output(options.mesh);
  else
    check_format(options);
  check_hard_edges(options);
}

void resolve_output(Options &options) {
  const std::string &format = options.output_format;
  for (std::string *name : {&options.output, &options.csv, &options.per_atom, &options.per_residue, &options.json})
    if (io::is_standard_output(*name)) *name = "./" + *name;  // a file that is called so
  for (std::string *name : {&options.csv, &options.per_atom, &options.per_residue, &options.json})
    if (io::descriptor_of(*name) == 1) *name = "-";  // as /dev/stdout
  if (!options.has_several_inputs())
    options.output =
        output_of_input(options.output, options.input, !options.trajectories.empty() && !makes_page(options));
  if (options.output != "-") {
    if (!format.empty())
      throw Failure(kUsage, "--output-format: is for standard output (-o -); a file's extension names its format");
    return;
  }
  if (format.empty())
    throw Failure(kUsage, "--output (-o): standard output has no extension: --output-format ply says what to write");
  if (options.has_several_inputs() || (options.is_series() && format != "html"))
    throw Failure(kUsage, "--output (-o): standard output takes one mesh, and there may be several");
  options.output = "-." + format;
}

bool has_hard_edges(const Options &options) {
  return options.hard_edges != Switch::kOff && knows_creases(options.compute) && !options.output.empty() &&
         io::format_traits_of(io::mesh_format_of(options.output)).has_hard_edges;
}

bool needs_patches(const Options &options) {
  return options.mesh.colors == MeshColors::kPatch ||
         (!options.output.empty() && io::mesh_format_of(options.output) == io::MeshFormat::kMsms);
}

const char *name_of(MeshColors colors) { return colors == MeshColors::kOne ? "one" : find_name(kColors, colors); }

}  // namespace quickses::cli
