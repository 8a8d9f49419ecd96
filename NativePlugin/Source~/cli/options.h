// SPDX-License-Identifier: MIT
// The flags of the program.
#pragma once

#include <array>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "cli/device_choice.h"
#include "cli/frame_range.h"
#include "io/atom_colors.h"
#include "io/structure.h"
#include "quickses/quickses.h"

namespace quickses::cli {

// A flag with the values on and off, or not given.
enum class Switch { kDefault, kOff, kOn };

// How to compute: flags that all commands share.
struct ComputeOptions {
  qses_backend backend = QSES_BACKEND_AUTO;
  DeviceChoice devices;
  unsigned threads = 0;  // 0 = one per hardware thread
  uint64_t memory = 0;   // bytes; 0 = no bound
  qses_surface surface = QSES_SURFACE_SES;
  qses_method method = QSES_METHOD_EXACT;
  double probe = 1.4;                       // Å
  double spacing = 0.5;                     // Å
  double radius_scale = 1, isovalue = 0.5;  // of the Gaussian surface
  unsigned steps = 1;
  unsigned slice = 0;                 // 0 = sized by memory
  Switch creases = Switch::kDefault;  // when options are read: on or off
  Switch occlusion = Switch::kDefault;
  std::string radii = "quickses";
  bool radii_given = false;
};

// Whether the surface is made of the features of balls, whose creases are known.
inline bool knows_creases(const ComputeOptions &options) {
  return options.method == QSES_METHOD_EXACT && options.surface != QSES_SURFACE_GAUSSIAN;
}

// Whether the radius of the probe matters to the surface.
inline bool uses_probe(qses_surface surface) { return surface == QSES_SURFACE_SES || surface == QSES_SURFACE_SAS; }

// Which meshes bench times: those in host memory, those that stay on the device. Not given: those there are.
enum class Deliveries { kDefault, kHost, kDevice, kBoth };

struct BenchOptions {
  unsigned repeat = 20;
  unsigned copies = 1;  // of each structure, side by side
  Deliveries deliveries = Deliveries::kDefault;
  qses_vertex_layout layout = QSES_VERTICES_SEPARATE;
  bool without_owners = false;
  bool measure = false;  // area and volume as well
  bool stages = false;
  unsigned small = 0;  // atoms per surface; 0 = the whole
  bool jobs = false;
};

// What the colours of vertices tell.
enum class MeshColors {
  kDefault,  // of what shows a mesh: its chains, of a single one its elements. Of mesh files: none
  kNone,
  kOne,  // the same for all
  kElement,
  kChain,
  kResidue,
  kHydrophobicity,
  kSequence,
  kComponent,
  kPatch
};

// What is in a mesh file, besides the mesh.
struct MeshFileOptions {
  MeshColors colors = MeshColors::kDefault;  // when options are read, only of what shows a mesh
  io::Rgba color = {190, 190, 190, 255};     // kOne, and of atoms of which the others tell nothing
  bool sharp = false;                        // triangles are cut along the borders of colours
  bool component_ids = false;
  bool text = false;    // of formats that can be both
  bool center = false;  // of the mesh's box at the origin
  double scale = 1;
};

// What a picture or a page shows, and how.
struct PictureOptions {
  int width = 1024, height = 1024;
  unsigned samples = 4;                         // along each side of a pixel
  io::Rgba background = {255, 255, 255, 255};   // alpha 0: none
  std::optional<std::array<double, 3>> toward;  // to the eye
  std::optional<std::array<double, 3>> up;
  std::array<double, 2> turn = {0, 0};  // degrees
  double zoom = 1;
  bool edges = false;  // of triangles
};

struct Options {
  enum class Command { kSurface, kMeasure, kCavities, kBench, kNone } command = Command::kSurface;
  ComputeOptions compute;
  io::ReadOptions read;
  bool model_given = false;
  std::optional<io::StructureFormat> input_format;  // nothing: name and content tell
  std::vector<std::string> inputs;                  // structures; "-" is standard input
  std::string input;                                // the one of them that these options are for, or the first
  std::string output;                               // empty: no mesh file; see also io::is_standard_output
  std::string output_format;                        // of standard output
  Switch hard_edges = Switch::kDefault;
  MeshFileOptions mesh;                                                       // of that file
  PictureOptions picture;                                                     // if that is what the file is
  bool outer = false;                                                         // without cavities
  std::vector<qses_surface> measured = {QSES_SURFACE_SAS, QSES_SURFACE_VDW};  // of measure
  BenchOptions bench;
  std::vector<std::string> trajectories;  // in a row; empty: the input alone
  FrameRange frames;                      // of the trajectory
  bool unwrap = false;                    // molecules in one piece
  unsigned workers = 0;                   // frames computed at a time, on each device; 0 = chosen by the program
  uint64_t max_input = 0;                 // bytes of an input in memory; 0 = the library's default
  std::string csv;                        // a file, "-" for standard output, empty: no table
  std::string per_atom;                   // a file, "-" for standard output, empty: no table
  std::string per_residue;                // the same
  std::string json;                       // a file, "-" for standard output, empty: no report
  bool quiet = false;

  bool has_several_inputs() const { return inputs.size() > 1; }
  // For messages: 'a.xtc', or 'a.xtc' and 2 more.
  std::string quoted_trajectories() const;
  // Whether frames and models have one picture each, seen the same way.
  bool is_series() const { return !trajectories.empty() || read.model == 0; }
  bool wants_areas() const { return !per_atom.empty() || !per_residue.empty(); }
  // Whether standard output is taken by something that other programs read.
  bool prints_data() const;
};

// Reads the command line. After --help or --version, which print to out, the command is kNone.
// Throws Failure (kUsage) with one sentence that names the flag.
Options parse_options(int argc, char **argv, std::ostream &out);

// Whether the mesh has a vertex on a crease once per side. The output, if there is one, has a known extension.
bool has_hard_edges(const Options &options);

// Whether the mesh file tells on what kind of patch vertices are. The output, if there is one, has a known extension.
bool needs_patches(const Options &options);

// "probe 1.4 Å, ", or nothing where no surface has one.
std::string probe_text(const std::vector<qses_surface> &surfaces, double probe);

const char *name_of(MeshColors colors);
const char *name_of(qses_surface surface);
const char *name_of(qses_method method);
const char *name_of(qses_backend backend);
const char *name_of(qses_vertex_layout layout);

}  // namespace quickses::cli
