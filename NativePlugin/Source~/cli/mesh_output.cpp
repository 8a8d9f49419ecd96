// SPDX-License-Identifier: MIT
// Meshes of the C API to files, pictures and pages.
#include "cli/mesh_output.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <iterator>
#include <numeric>

#include "cli/exit_code.h"
#include "cli/mesh_check.h"
#include "cli/processes.h"
#include "cli/shown_output.h"
#include "cli/tell.h"
#include "io/atomic_file.h"
#include "io/color_borders.h"
#include "io/file_path.h"
#include "io/mesh_writer.h"
#include "render/picture.h"

namespace quickses::cli {
namespace {

// Of qses_patch, to be told apart by whoever sees colours otherwise: three of those of Okabe and Ito (2008).
constexpr io::Rgba kPatchColors[] = {{0, 158, 115, 255}, {240, 228, 66, 255}, {0, 114, 178, 255}};

// Of colours that are not those of atoms: none.
std::vector<uint8_t> atom_colors_of(const MeshFileOptions &options, const io::Structure &structure) {
  const std::optional<io::ColorScheme> scheme = scheme_of(options.colors);
  if (!scheme) return {};
  std::vector<uint8_t> colors(4 * structure.atoms.size());
  io::color_atoms(structure, *scheme, options.color, colors.data());
  return colors;
}

// The largest piece has the first colour, in every frame.
std::vector<io::Rgba> component_colors_of(const qses_mesh &mesh) {
  std::vector<uint32_t> order(mesh.component_count);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return mesh.components[a].area > mesh.components[b].area; });
  std::vector<io::Rgba> colors(order.size());
  for (size_t k = 0; k < order.size(); ++k) colors[order[k]] = io::distinct_color(k);
  return colors;
}

// In the file, not among the atoms that were kept.
std::vector<uint32_t> file_owners_of(const qses_mesh &mesh, const io::Structure &structure) {
  std::vector<uint32_t> owners(mesh.vertex_count);
  for (uint32_t i = 0; i < mesh.vertex_count; ++i) owners[i] = structure.atoms[mesh.owners[i]].file_index;
  return owners;
}

// How open the surface is, if that was asked for.
std::vector<float> occlusion_of(const qses_mesh &mesh) {
  std::vector<float> openness(mesh.texcoords ? mesh.vertex_count : 0);
  for (size_t i = 0; i < openness.size(); ++i) openness[i] = mesh.texcoords[2 * i];
  return openness;
}

// mesh: what the vertices are of, or were before they became more.
std::vector<float> placed(const io::MeshView &vertices, const qses_mesh &mesh, const MeshFileOptions &options) {
  std::vector<float> positions(3 * size_t(vertices.vertex_count));
  double middle[3] = {0, 0, 0};
  if (options.center)
    for (int axis = 0; axis < 3; ++axis) middle[axis] = (double(mesh.bounds_min[axis]) + mesh.bounds_max[axis]) / 2;
  for (size_t i = 0; i < positions.size(); ++i)
    positions[i] = static_cast<float>((vertices.positions[i] - middle[i % 3]) * options.scale);
  return positions;
}

// "angstrom", or "angstrom times 0.5"
std::string unit_of(const MeshFileOptions &options) {
  if (options.scale == 1) return "angstrom";
  char digits[32];
  return "angstrom times " + std::string(digits, std::to_chars(digits, std::end(digits), options.scale).ptr);
}

render::View view_of(const PictureOptions &picture, bool is_series) {
  const auto vector = [](const std::array<double, 3> &v) { return glm::vec3(v[0], v[1], v[2]); };
  render::View view;
  if (picture.toward) view.toward = vector(*picture.toward);
  if (picture.up) view.up = vector(*picture.up);
  for (size_t k = 0; k < 2; ++k) view.turn[k] = static_cast<float>(picture.turn[k]);
  view.zoom = static_cast<float>(picture.zoom);
  if (is_series) view.fill = 0.85f;  // atoms move
  return view;
}

std::string title_of(const std::string &input) {
  return input == "-" ? "standard input" : io::utf8_of(io::path_of(input).filename());
}

// Frames are drawn beside each other.
unsigned drawing_threads(const Options &options) {
  if (!options.trajectories.empty()) return 1;
  return options.compute.threads ? options.compute.threads : Processes().threads();
}

}  // namespace

std::optional<io::ColorScheme> scheme_of(MeshColors colors) {
  switch (colors) {
    case MeshColors::kOne:
      return io::ColorScheme::kUniform;
    case MeshColors::kElement:
      return io::ColorScheme::kElement;
    case MeshColors::kChain:
      return io::ColorScheme::kChain;
    case MeshColors::kResidue:
      return io::ColorScheme::kResidue;
    case MeshColors::kHydrophobicity:
      return io::ColorScheme::kHydrophobicity;
    case MeshColors::kSequence:
      return io::ColorScheme::kSequence;
    case MeshColors::kDefault:
    case MeshColors::kNone:
    case MeshColors::kComponent:
    case MeshColors::kPatch:
      break;
  }
  return std::nullopt;
}

// What a file needs of a mesh, beside the mesh.
struct MeshOutput::Prepared {
  std::vector<uint32_t> owners;
  std::vector<uint8_t> colors;
  std::vector<float> occlusion, positions;
  io::OwnedMesh cut;
  io::MeshView view;
};

void accept_surface(const qses_mesh &mesh) {
  if (!is_closed(mesh))
    throw Failure(kComputingFailed,
                  "the surface that was computed is not closed, so it is not used: a fault of this program; please "
                  "report it with the input and the settings (another --spacing may help meanwhile)");
}

MeshOutput::MeshOutput(const Options &options, const io::Structure &structure)
    : structure_(structure),
      options_(options.mesh),
      picture_(options.picture),
      is_shown_(makes_shown(options)),
      is_series_(options.is_series()),
      camera_needs_mesh_(options.compute.surface == QSES_SURFACE_GAUSSIAN ||
                         options.compute.method == QSES_METHOD_GRID),
      title_(title_of(options.input)),
      threads_(drawing_threads(options)),
      probe_radius_(static_cast<float>(options.compute.probe * options.mesh.scale)),
      added_radius_(options.compute.surface == QSES_SURFACE_SAS ? static_cast<float>(options.compute.probe) : 0),
      atom_colors_(atom_colors_of(options.mesh, structure)) {}

render::Balls MeshOutput::balls(const float *centers) const {
  return {centers, structure_.radii.data(), structure_.atoms.size(), added_radius_};
}

render::Camera MeshOutput::camera_for(const float *centers, const qses_mesh *mesh) const {
  const render::Balls atoms = balls(centers);
  const bool is_of_mesh = mesh && mesh->vertex_count != 0;
  return {atoms, is_of_mesh ? render::Balls{mesh->positions, nullptr, mesh->vertex_count} : atoms,
          view_of(picture_, is_series_), picture_.height > picture_.width};
}

std::vector<uint8_t> MeshOutput::colors_of(const qses_mesh &mesh) const {
  std::vector<uint8_t> colors;
  const auto fill = [&](const auto &color_of) {
    colors.resize(4 * size_t(mesh.vertex_count));
    for (size_t i = 0; i < mesh.vertex_count; ++i) std::memcpy(&colors[4 * i], color_of(i), 4);
  };
  if (options_.colors == MeshColors::kComponent) {
    const std::vector<io::Rgba> of_components = component_colors_of(mesh);
    fill([&](size_t i) { return of_components[mesh.component_ids[i]].data(); });
  } else if (options_.colors == MeshColors::kPatch) {
    fill([&](size_t i) { return kPatchColors[mesh.patches[i]].data(); });
  } else if (!atom_colors_.empty()) {
    fill([&](size_t i) { return &atom_colors_[4 * size_t(mesh.owners[i])]; });
  }
  return colors;
}

void MeshOutput::prepare(const qses_mesh &mesh, io::MeshFormat format, const float *centers, Prepared &prepared) const {
  auto &[owners, colors, occlusion, positions, cut, view] = prepared;
  owners = file_owners_of(mesh, structure_);
  colors = colors_of(mesh);
  view.vertex_count = mesh.vertex_count;
  view.triangle_count = mesh.triangle_count;
  view.positions = mesh.positions;
  view.normals = mesh.normals;
  view.owners = owners.data();
  if (format == io::MeshFormat::kMsms) view.patches = mesh.patches;
  if (options_.component_ids) view.component_ids = mesh.component_ids;
  if (!colors.empty()) view.colors = colors.data();
  occlusion = occlusion_of(mesh);
  if (!occlusion.empty()) view.occlusion = occlusion.data();
  view.indices = mesh.indices;
  view.repeated = mesh.repeated;
  view.repeated_count = static_cast<uint32_t>(mesh.repeated_count);
  view.unit = unit_of(options_);
  view.atom_count = structure_.file_atom_count;
  view.probe_radius = probe_radius_;
  if (options_.sharp) {
    cut = io::cut_at_color_borders(view, {mesh.owners, centers, structure_.radii.data()});
    view = cut.view();
    // These have the colour of a place, so there must be one for each colour.
    if (!io::format_traits_of(format).has_repeated_vertices) view.repeated_count = 0;
  }
  if (options_.center || options_.scale != 1) {
    positions = placed(view, mesh, options_);
    view.positions = positions.data();
  }
}

MeshSize MeshOutput::accept(const std::string &path, const qses_mesh &mesh, const float *centers) const {
  accept_surface(mesh);
  if (path.empty()) return {};
  const io::MeshFormat format = io::mesh_format_of(path);
  Prepared prepared;
  prepare(mesh, format, centers, prepared);
  if (format == io::MeshFormat::kPng)
    draw(path, prepared.view, centers);
  else
    io::write_mesh(path, prepared.view, format, options_.text);
  return {prepared.view.vertex_count, prepared.view.triangle_count};
}

void MeshOutput::draw(const std::string &path, const io::MeshView &view, const float *centers) const {
  render::PictureSettings settings;
  settings.width = picture_.width, settings.height = picture_.height;
  settings.samples = static_cast<int>(picture_.samples);
  if (picture_.background[3] != 0) settings.background = picture_.background;
  settings.edges = picture_.edges;
  settings.threads = threads_;
  render::write_png(path, render::draw(view, camera_, camera_.middle(balls(centers)), settings));
}

MeshSize MeshOutput::page_mesh(const qses_mesh &mesh, const float *centers, const std::string &label,
                               std::string *text) const {
  accept_surface(mesh);
  Prepared prepared;
  prepare(mesh, io::MeshFormat::kHtml, centers, prepared);
  *text = render::page_mesh(prepared.view, camera_.middle(balls(centers)), label);
  return {prepared.view.vertex_count, prepared.view.triangle_count};
}

std::unique_ptr<render::Page> MeshOutput::begin_page(const std::string &path) const {
  return std::make_unique<render::Page>(
      path, render::PageSettings{title_, structure_.atoms.size(), picture_.background, camera_});
}

void hint_at_size(const render::Page &page, const Options &options) {
  if (options.quiet || page.size() < render::Page::kManyBytes) return;
  tell("the page has " + std::to_string(page.size() / 1'000'000) +
       " MB, for which browsers need some time: a larger --spacing" +
       (options.trajectories.empty() ? "" : ", or fewer --frames,") + " makes it smaller");
}

void check_mesh_writable(const std::string &path) {
  if (path.empty()) return;
  for (const std::string &file : io::mesh_files_of(path)) io::check_writable(file);
}

}  // namespace quickses::cli
