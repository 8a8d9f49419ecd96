// SPDX-License-Identifier: MIT
// A surface in another form against the first mesh: the same corners, bit by bit, and the same numbers.
#pragma once

#include "properties/property_checks.h"

namespace properties {

// What forms are compared with is what it must be: components are numbered by their first vertices, and areas of atoms
// add up.
inline void check_additions(const Result &first, Verdict &v) {
  const mesh_checks::Mesh &mesh = first.surface.mesh;
  for (size_t k = 0; k < mesh.indices.size() && !first.component_ids.empty(); ++k)
    if (first.component_ids[mesh.indices[k]] != first.component_ids[mesh.indices[k - k % 3]])
      return blame(v, Fault::kComponents, "triangle %zu has corners of two components", k / 3);
  uint32_t found = 0;
  for (uint32_t id : first.component_ids) {
    if (id > found) break;
    found = std::max(found, id + 1);
  }
  if (!first.component_ids.empty() && found != first.components.size())
    blame(v, Fault::kComponents, "vertices are numbered for %u components of %zu", found, first.components.size());
  if (first.atom_areas.empty()) return;
  double sum = 0;
  for (double area : first.atom_areas) sum += area;
  // The area, too, is a sum of whole multiples of something tiny.
  if (!(std::abs(sum - first.surface.report.area) <= 1e-9 * sum + 1e-12))
    blame(v, Fault::kReport, "the atoms have %.15g of the area %.15g", sum, first.surface.report.area);
}

class FormComparison {
 public:
  // first: made with settings_of_first.
  FormComparison(const Case &c, const Result &first, const Result &other, Verdict &v)
      : first_(first),
        other_(other),
        verdict_(v),
        settings_(settings_of_form(c.settings, c.form)),
        look_(c.atoms.size(), c.form),
        name_(name_of_form(c.form)),
        atoms_(c.atoms.size()),
        spacing_(static_cast<double>(c.settings.spacing)),
        extent_(half_extent(c.atoms) + largest_radius(c.atoms) + inflation(c.settings) + spacing_),
        delivered_(settings_.delivery != QSES_DELIVERY_NONE) {
    const bool of_balls = first.surface.report.measured_by == QSES_MEASURED_BY_ATOMS;
    lists_components_ = settings_.components || settings_.component_ids || settings_.outer_only;
    makes_mesh_ = delivered_ || lists_components_ || !of_balls;
    // Vertices on creases then have the normals of both sides, along which triangles measure more.
    other_measures_ = settings_.hard_edges && settings_.method == QSES_METHOD_EXACT && !settings_.creases && !of_balls;
  }

  void run() {
    find_shown();
    compare_counts();
    if (!verdict_.good()) return;
    compare_vertices();
    compare_triangles();
    compare_box();
    compare_components();
    compare_measures();
    compare_areas();
  }

 private:
  template <class... Values>
  void differs(const char *format, Values... values) {
    char what[160];
    std::snprintf(what, sizeof what, format, values...);
    blame(verdict_, Fault::kForm, "%s (%.70s)", what, name_.c_str());
  }

  static const float *at(const std::vector<float> &values, size_t k) { return values.data() + k; }
  static bool same(const float *a, const float *b, size_t count) { return std::memcmp(a, b, count * sizeof *a) == 0; }

  // What is to be seen of the first mesh, in its order; which of its vertices lie at the border of that.
  void find_shown() {
    const mesh_checks::Mesh &mesh = first_.surface.mesh;
    std::vector<uint8_t> used(mesh.vertex_count());
    at_border_.assign(mesh.vertex_count(), 0);
    for (size_t t = 0; t < mesh.triangle_count() && delivered_; ++t) {
      const uint32_t *const corner = &mesh.indices[3 * t];
      bool shown = !settings_.outer_only || !first_.components[first_.component_ids[corner[0]]].is_cavity;
      for (size_t k = 0; k < 3; ++k) shown = shown && look_.shows(mesh.owners[corner[k]]);
      if (shown) triangles_.push_back(static_cast<uint32_t>(t));
      for (size_t k = 0; k < 3; ++k) (shown ? used : at_border_)[corner[k]] = 1;
    }
    for (uint32_t k = 0; k < used.size(); ++k)
      if (used[k]) vertices_.push_back(k);
  }

  void compare_counts() {
    const size_t v = delivered_ ? vertices_.size() : makes_mesh_ ? first_.vertex_count : 0;
    const size_t t = delivered_ ? triangles_.size() : makes_mesh_ ? first_.triangle_count : 0;
    const size_t repeated = other_.repeated.size();
    if (other_.triangle_count != t || other_.vertex_count != v + repeated)
      return differs("%u vertices, of which %zu are repeated, and %u triangles; %zu, %zu", other_.vertex_count,
                     repeated, other_.triangle_count, v, t);
    if (repeated > 0 && !settings_.hard_edges) differs("%zu vertices are repeated", repeated);
    for (size_t k = 0; k < repeated; ++k)
      if (other_.repeated[k] >= v || (k > 0 && other_.repeated[k] <= other_.repeated[k - 1]))
        return differs("vertex %zu repeats vertex %u", v + k, other_.repeated[k]);
    const qses_report &report = other_.surface.report;
    const size_t hidden_vertices = delivered_ ? first_.vertex_count - v : 0,
                 hidden_triangles = delivered_ ? first_.triangle_count - t : 0;
    if (report.hidden_vertices != hidden_vertices || report.hidden_triangles != hidden_triangles)
      differs("%u vertices and %u triangles are hidden; %zu, %zu", report.hidden_vertices, report.hidden_triangles,
              hidden_vertices, hidden_triangles);
    compare_sizes(delivered_ ? other_.vertex_count : 0, delivered_ ? other_.triangle_count : 0);
  }

  // Arrays are there if they were asked for, and as long as they must be.
  void compare_sizes(size_t v, size_t t) {
    const mesh_checks::Mesh &mesh = other_.surface.mesh;
    const auto expect = [&](const char *what, size_t found, size_t wanted) {
      if (found != wanted) differs("%zu %s; %zu", found, what, wanted);
    };
    const bool compact = settings_.vertex_layout == QSES_VERTICES_COMPACT,
               owners = !settings_.without_owners || settings_.delivery != QSES_DELIVERY_HOST;
    expect("numbers of positions", mesh.positions.size(), 3 * v);
    expect("numbers of normals", mesh.normals.size(), compact ? 0 : 3 * v);
    expect("packed normals", other_.packed_normals.size(), compact ? v : 0);
    expect("corners", mesh.indices.size(), 3 * t);
    expect("owners", mesh.owners.size(), owners ? v : 0);
    expect("patches", other_.surface.patches.size(), settings_.patch_types ? v : 0);
    expect("bytes of colors", other_.colors.size(), look_.colors.empty() ? 0 : 4 * v);
    expect("numbers of texcoords", other_.texcoords.size(), settings_.texcoords || settings_.occlusion ? 2 * v : 0);
    expect("component ids", other_.component_ids.size(), settings_.component_ids ? v : 0);
    expect("areas of atoms", other_.atom_areas.size(), settings_.atom_areas ? atoms_ : 0);
  }

  // The vertex of the first mesh that one stands for.
  uint32_t origin(uint32_t vertex) const {
    return vertices_[vertex < vertices_.size() ? vertex : other_.repeated[vertex - vertices_.size()]];
  }

  // "corner 1 of triangle 17", the first that there is.
  std::string corner_with(uint32_t vertex) const {
    const std::vector<uint32_t> &indices = other_.surface.mesh.indices;
    for (size_t k = 0; k < indices.size(); ++k)
      if (indices[k] == vertex) return "corner " + std::to_string(k % 3) + " of triangle " + std::to_string(k / 3);
    return "vertex " + std::to_string(vertex);
  }

  void compare_vertices() {
    const mesh_checks::Mesh &mesh = other_.surface.mesh, &whole = first_.surface.mesh;
    const size_t count = mesh.vertex_count();
    for (uint32_t k = 0; k < count; ++k) {
      const uint32_t from = origin(k);
      const char *what = nullptr;
      if (!same(at(mesh.positions, 3 * k), at(whole.positions, 3 * size_t(from)), 3)) what = "position";
      if (!mesh.owners.empty() && mesh.owners[k] != whole.owners[from]) what = "owner";
      if (settings_.patch_types && other_.surface.patches[k] != first_.surface.patches[from]) what = "patch";
      if (settings_.component_ids && other_.component_ids[k] != first_.component_ids[from]) what = "component id";
      const uint32_t atom = whole.owners[from];
      if (!other_.colors.empty() && std::memcmp(&other_.colors[4 * k], &look_.colors[4 * size_t(atom)], 4) != 0)
        what = "color";
      const bool keeps_normal = !turns_normal(from);
      if (!is_normal(k, from, keeps_normal)) what = "normal";
      if (!other_.texcoords.empty() && !is_texcoord(k, from, keeps_normal)) what = "texture coordinate";
      if (what) return differs("other %s of %s, vertex %u of the first mesh", what, corner_with(k).c_str(), from);
    }
  }

  // Hard edges have the normals of their sides; with creases, normals face those of their triangles that are shown.
  bool turns_normal(uint32_t from) const {
    if (settings_.method == QSES_METHOD_EXACT && settings_.hard_edges) return true;
    return settings_.creases && at_border_[from];
  }

  bool is_normal(uint32_t vertex, uint32_t from, bool keeps_normal) const {
    const float *const wanted = at(first_.surface.mesh.normals, 3 * size_t(from));
    if (settings_.vertex_layout != QSES_VERTICES_COMPACT) {
      const float *const n = at(other_.surface.mesh.normals, 3 * size_t(vertex));
      if (keeps_normal) return same(n, wanted, 3);
      return std::abs(length({static_cast<double>(n[0]), static_cast<double>(n[1]), static_cast<double>(n[2])}) - 1) <=
             1e-5;
    }
    // Multiples of 1/127, each the nearest.
    const std::array<int8_t, 4> &packed = other_.packed_normals[vertex];
    const Point n = (1.0 / 127) * Point{double(packed[0]), double(packed[1]), double(packed[2])};
    const double step = 0.5 / 127 + 1e-6, values[3] = {n.x, n.y, n.z};
    if (packed[3] != 0 || std::abs(length(n) - 1) > 2 * step) return false;
    for (size_t d = 0; d < 3 && keeps_normal; ++d)
      if (std::abs(values[d] - static_cast<double>(wanted[d])) > step) return false;
    return true;
  }

  // Ambient occlusion follows the normal.
  bool is_texcoord(uint32_t vertex, uint32_t from, bool keeps_normal) const {
    const float *const found = at(other_.texcoords, 2 * size_t(vertex));
    const size_t atom = first_.surface.mesh.owners[from];
    const bool of_atoms = !look_.texcoords.empty();
    float wanted[2] = {of_atoms ? look_.texcoords[2 * atom] : 1.f, of_atoms ? look_.texcoords[2 * atom + 1] : 0.f};
    if (settings_.occlusion) {
      wanted[0] = keeps_normal ? first_.texcoords[2 * size_t(from)] : found[0];
      if (!of_atoms) wanted[1] = 1.f;
      if (!(found[0] >= 0.f && found[0] <= 1.f)) return false;
    }
    return same(found, wanted, 2);
  }

  void compare_triangles() {
    const std::vector<uint32_t> &found = other_.surface.mesh.indices, &whole = first_.surface.mesh.indices;
    const bool reversed = settings_.winding == QSES_WINDING_REVERSED;
    for (size_t k = 0; k < found.size(); ++k)
      if (found[k] >= other_.vertex_count) return differs("corner %zu is vertex %u", k, found[k]);
    for (size_t t = 0; 3 * t < found.size(); ++t) {
      const uint32_t *const wanted = &whole[3 * size_t(triangles_[t])];
      const uint32_t corners[3] = {origin(found[3 * t]), origin(found[3 * t + 1]), origin(found[3 * t + 2])};
      size_t first = 0;  // where the other one begins; with the other winding it may be anywhere
      while (reversed && first < 2 && corners[first] != wanted[0]) ++first;
      for (size_t k = 0; k < 3; ++k) {
        const size_t place = reversed ? (first + 3 - k) % 3 : k;
        if (corners[place] != wanted[k])
          return differs("corner %zu of triangle %zu, %u in the first mesh, is vertex %u; %u", place, t, triangles_[t],
                         corners[place], wanted[k]);
      }
    }
  }

  // Of what is shown; of a mesh that is nowhere, of all.
  void compare_box() {
    std::array<float, 3> low{}, high{};
    if (!delivered_ && makes_mesh_) low = first_.low, high = first_.high;
    for (size_t k = 0; k < vertices_.size(); ++k)
      for (size_t d = 0; d < 3; ++d) {
        const float x = first_.surface.mesh.positions[3 * size_t(vertices_[k]) + d];
        low[d] = k == 0 ? x : std::min(low[d], x);
        high[d] = k == 0 ? x : std::max(high[d], x);
      }
    for (size_t d = 0; d < 3; ++d)
      if (other_.low[d] != low[d] || other_.high[d] != high[d])
        differs("box from %.9g to %.9g along axis %zu; %.9g, %.9g", static_cast<double>(other_.low[d]),
                static_cast<double>(other_.high[d]), d, static_cast<double>(low[d]), static_cast<double>(high[d]));
  }

  // Sums of whole numbers: exactly the same.
  void compare_components() {
    const std::vector<qses_component> &found = other_.components, &wanted = first_.components;
    if (found.size() != (lists_components_ ? wanted.size() : 0))
      return differs("%zu components; %zu", found.size(), lists_components_ ? wanted.size() : 0);
    for (size_t k = 0; k < found.size(); ++k) {
      const qses_component &a = found[k], &b = wanted[k];
      if (a.triangles != b.triangles || a.is_cavity != b.is_cavity) differs("component %zu is another one", k);
      if (!same(a.bounds_min, b.bounds_min, 3) || !same(a.bounds_max, b.bounds_max, 3) || !same(a.center, b.center, 3))
        differs("component %zu is elsewhere", k);
      if (!other_measures_ && (a.area != b.area || a.volume != b.volume))
        differs("component %zu has area %.17g, volume %.17g; %.17g, %.17g", k, a.area, a.volume, b.area, b.volume);
    }
  }

  // Without components, triangles are summed up as floating-point numbers, volumes from another place.
  void compare_measures() {
    const qses_report &found = other_.surface.report, &wanted = first_.surface.report;
    const bool measured = settings_.measure != 0, of_atoms = wanted.measured_by == QSES_MEASURED_BY_ATOMS;
    if (found.measured_by != (measured ? wanted.measured_by : QSES_MEASURED_BY_NOTHING))
      differs("measured by %d", static_cast<int>(found.measured_by));
    const double h = spacing_, area = wanted.triangle_area,
                 area_play = lists_components_ ? 0 : 1e-9 * area + 1e-10 * h * h,
                 volume_play = lists_components_ ? 0 : 1e-9 * area * h + 1e-12 * area * extent_ + 1e-10 * h * h * h;
    const auto expect = [&](const char *what, double a, double b, double play) {
      if (!(std::abs(a - b) <= play)) differs("%s %.17g; %.17g", what, a, b);
    };
    if (!other_measures_) {
      expect("area", found.area, measured ? wanted.area : 0, of_atoms ? 0 : area_play);
      expect("volume", found.volume, measured ? wanted.volume : 0, of_atoms ? 0 : volume_play);
    }
    const bool sums = measured && makes_mesh_;
    expect("triangles' area", found.triangle_area, sums ? wanted.triangle_area : 0, area_play);
    expect("triangles' volume", found.triangle_volume, sums ? wanted.triangle_volume : 0, volume_play);
    if (makes_mesh_ && found.unplaced_vertices != wanted.unplaced_vertices)
      differs("%llu unplaced vertices", static_cast<unsigned long long>(found.unplaced_vertices));
  }

  // Sums of whole numbers, or those of the atoms.
  void compare_areas() {
    for (size_t i = 0; i < other_.atom_areas.size() && !other_measures_; ++i)
      if (other_.atom_areas[i] != first_.atom_areas[i])
        return differs("atom %zu has area %.17g; %.17g", i, other_.atom_areas[i], first_.atom_areas[i]);
  }

  const Result &first_, &other_;
  Verdict &verdict_;
  const qses_settings settings_;
  const Look look_;
  const std::string name_;
  const size_t atoms_;
  const double spacing_, extent_;
  const bool delivered_;
  bool lists_components_ = false, makes_mesh_ = false, other_measures_ = false;
  std::vector<uint32_t> vertices_, triangles_;  // of the first mesh, that are shown
  std::vector<uint8_t> at_border_;
};

}  // namespace properties
