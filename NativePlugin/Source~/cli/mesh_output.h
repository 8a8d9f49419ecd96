// SPDX-License-Identifier: MIT
// Meshes of the C API to files, pictures and pages.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/options.h"
#include "io/structure.h"
#include "quickses/quickses.h"
#include "render/page.h"

namespace quickses::cli {

// Takes the surface of all atoms for good. Throws Failure (kComputingFailed) if the mesh is not closed, which that
// surface always should be.
void accept_surface(const qses_mesh &mesh);

// How atoms are coloured; of colours that are not those of atoms: nothing.
std::optional<io::ColorScheme> scheme_of(MeshColors colors);

// Of a mesh as it was written.
struct MeshSize {
  uint32_t vertices = 0, triangles = 0;
};

// What there is to do with the meshes of a structure, in one conformation or many. Any number of threads may use it.
class MeshOutput {
 public:
  // The structure must outlive it.
  MeshOutput(const Options &options, const io::Structure &structure);

  // So that a surface fills the picture. centers: of the structure's atoms when it was made. mesh: null unless
  // camera_needs_mesh().
  render::Camera camera_for(const float *centers, const qses_mesh *mesh) const;
  // Whether the surface lies outside of its atoms, as they are seen, so that they don't tell its extent.
  bool camera_needs_mesh() const { return camera_needs_mesh_; }
  // Before anything is shown.
  void look(const render::Camera &camera) { camera_ = camera; }

  // Takes the surface of all atoms for good, and writes it, with owners as places in the structure's file; an empty
  // path: writes nothing. centers: of the structure's atoms when the mesh was made, only looked at if needs_centers().
  // Throws as accept_surface, before anything is written; io::Error (output).
  MeshSize accept(const std::string &path, const qses_mesh &mesh, const float *centers) const;
  bool needs_centers() const { return options_.sharp || is_shown_; }
  bool is_shown() const { return is_shown_; }

  // The same for a page of many: text becomes what Page::add takes.
  MeshSize page_mesh(const qses_mesh &mesh, const float *centers, const std::string &label, std::string *text) const;
  std::unique_ptr<render::Page> begin_page(const std::string &path) const;

 private:
  struct Prepared;

  std::vector<uint8_t> colors_of(const qses_mesh &mesh) const;
  void prepare(const qses_mesh &mesh, io::MeshFormat format, const float *centers, Prepared &prepared) const;
  render::Balls balls(const float *centers) const;
  void draw(const std::string &path, const io::MeshView &view, const float *centers) const;

  const io::Structure &structure_;
  const MeshFileOptions options_;
  const PictureOptions picture_;
  const bool is_shown_, is_series_, camera_needs_mesh_;
  const std::string title_;
  const unsigned threads_;
  const float probe_radius_, added_radius_;
  render::Camera camera_;             // of what is shown
  std::vector<uint8_t> atom_colors_;  // N x 4; empty if colours are not those of atoms
};

// Says so, unless quiet, if a page is so large that browsers need time for it.
void hint_at_size(const render::Page &page, const Options &options);

// Throws io::Error (output) if a mesh could not be written there; an empty path is none.
void check_mesh_writable(const std::string &path);

}  // namespace quickses::cli
