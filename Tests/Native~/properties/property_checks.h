// SPDX-License-Identifier: MIT
// What must hold for the surface of any atoms, and the kinds of faults there are.
#pragma once

#include "properties/property_closed_forms.h"
#include "properties/property_result.h"

namespace properties {

enum class Fault : int {
  kNone,
  kCrash,
  kHang,
  kStatus,
  kOpen,
  kNotFinite,
  kNormals,
  kOwners,
  kBounds,
  kComponents,
  kReport,
  kOffSurface,
  kStretched,  // triangles that reach farther than the lattice allows
  kMisplaced,  // inside where it must be outside, or the reverse
  kClosedForm,
  kBytes,
  kOrder,
  kForm,   // asked for in another form
  kFrame,  // after another frame
  kCount
};

inline const char *name_of(Fault fault) {
  constexpr const char *names[] = {"none",       "crash",       "hang",      "status",    "open",
                                   "not finite", "normals",     "owners",    "bounds",    "components",
                                   "report",     "off surface", "stretched", "misplaced", "closed form",
                                   "bytes",      "order",       "form",      "frame"};
  static_assert(sizeof names / sizeof *names == static_cast<size_t>(Fault::kCount), "one name for each");
  return names[static_cast<int>(fault)];
}

struct Verdict {
  Fault fault = Fault::kNone;
  char sentence[240] = "";
  double error = 0;     // Å beyond the rounding of positions, the largest of the vertices measured
  double edge = 0;      // spacings, the longest edge of a triangle
  bool coarse = false;  // the spacing is above two probe radii
  uint32_t vertices = 0;
  uint64_t border_bricks = 0, unplaced = 0;  // as the report has them
  double milliseconds = 0;

  bool good() const { return fault == Fault::kNone; }
};

template <class... Values>
void blame(Verdict &verdict, Fault fault, const char *format, Values... values) {
  if (!verdict.good()) return;
  verdict.fault = fault;
  std::snprintf(verdict.sentence, sizeof verdict.sentence, format, values...);
}

// Spacings. D is 1-Lipschitz, so a vertex is moved by at most a spacing from its lattice edge onto the surface; two of
// one cell are then less than 4 apart. Longer edges are those of vertices that went elsewhere. 2 is usual.
constexpr double kLongestEdge = 4;

inline void check_edges(const Case &c, const Result &r, Verdict &v) {
  const mesh_checks::Mesh &mesh = r.surface.mesh;
  double longest = 0;
  for (size_t t = 0; t < mesh.triangle_count(); ++t)
    for (size_t k = 0; k < 3; ++k)
      longest = std::max(longest, length(point(mesh.position(mesh.indices[3 * t + k])) -
                                         point(mesh.position(mesh.indices[3 * t + (k + 1) % 3]))));
  v.edge = (longest - 2 * rounding_of_positions(c)) / static_cast<double>(c.settings.spacing);
  if (v.edge > kLongestEdge) blame(v, Fault::kStretched, "the longest edge has %.3g spacings", v.edge);
}

// Is x inside of the mesh? Signed crossings of rays in one direction, which must favour no axis; edges are passed by
// one of their triangles also where a ray hits them.
class Windings {
 public:
  explicit Windings(const mesh_checks::Mesh &mesh) : mesh_(mesh) {
    const Point z = (1 / length({0.3194, 0.7717, 0.5496})) * Point{0.3194, 0.7717, 0.5496};
    const Point x = exact_reference::perpendicular(z), y = exact_reference::cross(z, x);
    axes_[0] = x, axes_[1] = y, axes_[2] = z;
    for (size_t v = 0; v < mesh.vertex_count(); ++v) corners_.push_back(turned(point(mesh.position(v))));
  }

  int at(const Point &place) const {
    const Point o = turned(place);
    int crossings = 0;
    for (size_t t = 0; t < mesh_.triangle_count(); ++t) {
      const uint32_t *k = &mesh_.indices[3 * t];
      const Point &a = corners_[k[0]], &b = corners_[k[1]], &c = corners_[k[2]];
      if (std::max({a.z, b.z, c.z}) < o.z) continue;
      const int ab = side(k[0], k[1], o), bc = side(k[1], k[2], o), ca = side(k[2], k[0], o);
      if (ab != bc || bc != ca) continue;
      // Height of the plane above the place.
      const Point n = exact_reference::cross(b - a, c - a);
      if (exact_reference::dot(n, a - o) * n.z > 0) crossings += ab;
    }
    return crossings;
  }

 private:
  Point turned(const Point &p) const {
    return {exact_reference::dot(p, axes_[0]), exact_reference::dot(p, axes_[1]), exact_reference::dot(p, axes_[2])};
  }
  // The same number for both directions of an edge, but for the sign.
  int side(uint32_t from, uint32_t to, const Point &o) const {
    const bool swap = from > to;
    const Point &a = corners_[swap ? to : from], &b = corners_[swap ? from : to];
    const double area = (a.x - o.x) * (b.y - o.y) - (b.x - o.x) * (a.y - o.y);
    return (area > 0) != swap ? 1 : -1;
  }

  const mesh_checks::Mesh &mesh_;
  Point axes_[3];
  std::vector<Point> corners_;
};

inline void expect_inside(const Windings &windings, const Point &x, bool inside, Verdict &v) {
  const int found = windings.at(x);
  if (found != (inside ? 1 : 0))
    blame(v, Fault::kMisplaced, "(%.9g %.9g %.9g), %s the surface, is within %d surfaces of the mesh", x.x, x.y, x.z,
          inside ? "inside" : "outside", found);
}

inline void check_connection(const Result &r, Verdict &v) {
  const mesh_checks::Mesh &mesh = r.surface.mesh;
  const std::string fault = mesh_checks::manifold_fault(mesh);
  if (!fault.empty())
    blame(v, fault.find("finite") != std::string::npos ? Fault::kNotFinite : Fault::kOpen, "%s", fault.c_str());
  if (mesh.vertex_count() > 0 && mesh_checks::worst_normal_length(mesh) > 1e-5)
    blame(v, Fault::kNormals, "a normal's length is off by %g", mesh_checks::worst_normal_length(mesh));
}

inline void check_bounds(const Result &r, Verdict &v) {
  std::array<float, 3> low{}, high{};
  const std::vector<float> &p = r.surface.mesh.positions;
  for (size_t k = 0; k < p.size(); ++k) {
    low[k % 3] = k < 3 ? p[k] : std::min(low[k % 3], p[k]);
    high[k % 3] = k < 3 ? p[k] : std::max(high[k % 3], p[k]);
  }
  for (int d = 0; d < 3; ++d)
    if (!(low[d] == r.low[d] && high[d] == r.high[d]))
      blame(v, Fault::kBounds, "bounds %g to %g, vertices from %g to %g", static_cast<double>(r.low[d]),
            static_cast<double>(r.high[d]), static_cast<double>(low[d]), static_cast<double>(high[d]));
}

// Sums of the triangles, the report and the components agree.
inline void check_measures(const Case &c, const Result &r, Verdict &v) {
  const mesh_checks::Mesh &mesh = r.surface.mesh;
  const double area = mesh_checks::area(mesh), volume = mesh_checks::signed_volume(mesh),
               rounding = rounding_of_positions(c);
  const qses_report &report = r.surface.report;
  const double reported_area = report.triangle_area, reported_volume = report.triangle_volume;
  if (!std::isfinite(report.area) || !std::isfinite(report.volume) || !std::isfinite(reported_area) ||
      !std::isfinite(reported_volume))
    blame(v, Fault::kNotFinite, "area %g, volume %g", reported_area, reported_volume);
  // Triangles that are small against the rounding of their corners have any area.
  const double area_play =
      1e-4 * area + 1e-9 + 4 * rounding * std::sqrt(area * static_cast<double>(mesh.triangle_count()));
  const double volume_play = 1e-4 * std::abs(volume) + (2e-5 + rounding) * area + 1e-9;
  if (std::abs(reported_area - area) > area_play || std::abs(reported_volume - volume) > volume_play)
    blame(v, Fault::kReport, "reported area %.9g, volume %.9g; of the triangles %.9g, %.9g", reported_area,
          reported_volume, area, volume);
  uint64_t triangles = 0;
  double areas = 0, volumes = 0, size = 0;
  for (const qses_component &k : r.components) {
    triangles += k.triangles;
    areas += k.area;
    volumes += k.volume;
    size += std::abs(k.volume);
  }
  if (triangles != mesh.triangle_count())
    blame(v, Fault::kComponents, "components have %llu triangles of %zu", static_cast<unsigned long long>(triangles),
          mesh.triangle_count());
  if (r.components.size() != mesh_checks::piece_count(mesh))
    blame(v, Fault::kComponents, "%zu components, but the mesh has %zu pieces", r.components.size(),
          mesh_checks::piece_count(mesh));
  if (report.measured_by == QSES_MEASURED_BY_ATOMS) return;  // which know better than the components' normals
  // Sums of whole multiples of something tiny.
  if (std::abs(areas - report.area) > 1e-5 * areas + 1e-9 ||
      std::abs(volumes - report.volume) > 1e-5 * size + 1e-6 * areas + 1e-9)
    blame(v, Fault::kComponents, "components have area %.9g, volume %.9g; the report %.9g, %.9g", areas, volumes,
          report.area, report.volume);
}

// With GRID, vertices have their owners before they are smoothed.
inline void check_owners(const Case &c, const Result &r, Verdict &v) {
  const mesh_checks::Mesh &mesh = r.surface.mesh;
  const size_t n = c.atoms.size(), stride = 1 + mesh.vertex_count() * n / 400000;
  const double tie = 1e-3 + 2 * rounding_of_positions(c);  // what a tolerance on a large atom is on a tiny one
  for (size_t k = 0; k < mesh.vertex_count(); ++k)
    if (mesh.owners[k] >= n)
      return blame(v, Fault::kOwners, "vertex %zu belongs to atom %u of %zu", k, mesh.owners[k], n);
  if (c.settings.method == QSES_METHOD_GRID && c.settings.relaxation_steps > 0) return;
  for (size_t k = 0; k < mesh.vertex_count(); k += stride) {
    const Point x = point(mesh.position(k));
    const auto away = [&](size_t i) {
      return length(x - point(c.atoms.center(i))) - static_cast<double>(c.atoms.radii[i]);
    };
    const size_t owner = mesh.owners[k];
    const double own = away(owner);
    for (size_t i = 0; i < n; ++i) {
      if (away(i) < own - tie)
        return blame(v, Fault::kOwners, "vertex %zu belongs to atom %zu; atom %zu is %g Å nearer", k, owner, i,
                     own - away(i));
      if (i < owner && c.atoms.center(i) == c.atoms.center(owner) && c.atoms.radii[i] >= c.atoms.radii[owner])
        return blame(v, Fault::kOwners, "vertex %zu belongs to atom %zu, a duplicate of atom %zu", k, owner, i);
    }
  }
}

// Some vertices from everywhere, and those that the probes of other vertices cover most.
inline std::vector<size_t> worth_measuring(const Surface &surface, double probe, size_t wanted) {
  const size_t count = surface.vertex_count(), step = 1 + 3 * count / (2 * wanted), every = 1 + count / 300;
  std::vector<size_t> chosen;
  for (size_t k = step / 2; k < count; k += step) chosen.push_back(k);
  std::vector<Point> probes;
  for (size_t k = every / 2; k < count; k += every)
    probes.push_back(point(surface.mesh.position(k)) + probe * point(surface.normal(k)));
  std::vector<std::pair<double, size_t>> nearest(count);
  for (size_t k = 0; k < count; ++k) {
    const double d = exact_reference::nearest_sample(probes, point(surface.mesh.position(k)));
    nearest[k] = {std::isfinite(d) ? d : -1, k};
  }
  const size_t covered = std::min(count, wanted / 3);
  std::partial_sort(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(covered), nearest.end());
  for (size_t k = 0; k < covered; ++k) chosen.push_back(nearest[k].second);
  return chosen;
}

// Vertices and normals against the exact surface. A vertex of the SES is a probe radius away from where its normal says
// that the probe is; the probe there touches an atom and overlaps none; and no such place is nearer.
inline void check_distances(const Case &c, const Result &r, const ExactSurface &exact, Verdict &v) {
  const mesh_checks::Mesh &mesh = r.surface.mesh;
  const size_t count = mesh.vertex_count();
  const double p = exact.probe();
  const double rounding = rounding_of_positions(c) + (exact.is_ses() ? rounding_of_circles(c) : 0);
  v.coarse = exact.is_ses() && static_cast<double>(c.settings.spacing) > 2 * p;
  const double bound = v.coarse ? std::max(0.02, 0.1 * static_cast<double>(c.settings.spacing)) : 0.02;
  const auto judge = [&](size_t k, double error, const char *what) {
    error -= rounding;
    if (!(error <= v.error)) v.error = error;
    if (!(error <= bound))
      blame(v, Fault::kOffSurface, "vertex %zu (%.9g %.9g %.9g) is %g Å off%s", k,
            static_cast<double>(mesh.positions[3 * k]), static_cast<double>(mesh.positions[3 * k + 1]),
            static_cast<double>(mesh.positions[3 * k + 2]), error, what);
  };
  const size_t stride = 1 + count * c.atoms.size() / 200000;
  std::vector<size_t> between;  // vertices whose normal is not that of a single sheet
  for (size_t k = 0; k < count; k += stride) {
    const Point x = point(mesh.position(k)), n = point(r.surface.normal(k));
    // Which way a point lies from an atom that is smaller than the rounding there, nobody can tell.
    const double own_radius = static_cast<double>(c.atoms.radii[mesh.owners[k]]);
    const bool has_direction = own_radius > 4 * rounding_of_positions(c);
    if (!exact.is_ses()) {
      judge(k, std::abs(exact.depth(x)), "");
    } else if (has_direction) {
      const double depth = exact.depth(x + p * n);
      if (std::max(depth - play_of_radii(c), -depth) - rounding > bound)
        between.push_back(k);
      else
        judge(k, std::max(depth - play_of_radii(c), -depth), ": along its normal the probe overlaps an atom, or none");
    }
  }
  if (!exact.is_ses()) return;
  // The normal of a vertex between sheets is no single one's. Asked where triangles are small enough to show probe and
  // atom, and larger than rounding.
  const auto shows_sheets = [&](size_t k) {
    return rounding <= 1e-3 && static_cast<double>(c.settings.spacing) <=
                                   0.5 * std::min(p, static_cast<double>(c.atoms.radii[mesh.owners[k]]));
  };
  const size_t most = exact.is_costly() ? 12 : 60;
  std::vector<size_t> chosen = worth_measuring(r.surface, p, most);
  const size_t every = 1 + between.size() / most, first_between = chosen.size();
  for (size_t k = 0; k < between.size(); k += every) chosen.push_back(between[k]);
  for (size_t q = 0; q < chosen.size(); ++q) {
    const size_t k = chosen[q];
    const Point x = point(mesh.position(k));
    const Range d = exact.distance(x, p + 2 * (bound + rounding));
    // The probe is its own proof, whatever the reference may have missed.
    if (exact.depth(d.probe) <= 0) judge(k, p - d.most, ": a probe covers it");
    judge(k, d.least - p, ": no probe touches it");
    if (q < first_between || c.settings.creases || !shows_sheets(k)) continue;
    // A mean of two sheets' normals does not point away from their probes: of those that touch the vertex the one that
    // is nearest to a place a little along the normal lies on that side.
    const Point n = point(r.surface.normal(k));
    if (dot(exact.distance(x + 0.1 * p * n, 1.1 * p + 2 * (bound + rounding)).probe - x, n) < -0.3 * p)
      blame(v, Fault::kOffSurface, "the normal of vertex %zu points away from all probes that touch it", k);
  }
  if (!c.settings.creases) return;
  // With creases it may have been turned, but not against all triangles around it.
  std::vector<uint8_t> faces(count), touched(count);
  for (size_t t = 0; t < mesh.indices.size(); t += 3) {
    const Point a = point(mesh.position(mesh.indices[t]));
    const Point face =
        cross(point(mesh.position(mesh.indices[t + 1])) - a, point(mesh.position(mesh.indices[t + 2])) - a);
    for (size_t k = t; k < t + 3; ++k) {
      touched[mesh.indices[k]] = 1;
      if (!(dot(face, point(r.surface.normal(mesh.indices[k]))) < 0)) faces[mesh.indices[k]] = 1;
    }
  }
  for (size_t k : between)
    if (touched[k] && !faces[k] && shows_sheets(k))
      return blame(v, Fault::kOffSurface, "the normal of vertex %zu points against all triangles around it", k);
}

// Places that are deeper inside or farther outside than the mesh can be wrong by.
inline void check_sides(const Case &c, const Result &r, const ExactSurface &exact, Verdict &v) {
  const double h = static_cast<double>(c.settings.spacing), margin = 2 * h + rounding_of_positions(c),
               p = exact.probe();
  const bool ses = exact.is_ses();
  Random random(c.seed + 77);
  const Windings windings(r.surface.mesh);
  const size_t wanted = exact.is_costly() ? 10 : 24;
  for (size_t k = 0; k < wanted && c.atoms.size() > 0; ++k) {
    const size_t i = static_cast<size_t>(random.below(c.atoms.size()));
    const double R = static_cast<double>(c.atoms.radii[i]) + p;
    const Point x =
        point(c.atoms.center(i)) + (random.chance(0.3) ? 0.01 * R : (R + 2 * h) * random.unit()) * random.direction();
    const double depth = exact.depth(x);
    double least = depth, most = depth;  // how deep inside the surface, at least and at most
    if (ses && depth <= 0) {
      least = most = depth - p;
    } else if (ses) {
      const Range d = exact.distance(x, p + margin);
      least = d.least - p;
      most = d.most - p;
    }
    if (least <= margin && most >= -margin) continue;
    expect_inside(windings, x, least > margin, v);
  }
}

inline void check_closed_form(const Case &c, const Result &r, Verdict &v) {
  if (c.atoms.size() == 0 || c.atoms.size() > 2) return;
  const Measures m = closed_form(c);
  const qses_report &report = r.surface.report;
  const double rounding = rounding_of_positions(c), area = report.triangle_area, volume = report.triangle_volume;
  const double triangles = static_cast<double>(r.surface.mesh.triangle_count());
  const double area_play = m.chord_area + 1e-4 * m.area + 4 * rounding * std::sqrt(m.area * triangles);
  const double volume_play = m.chord_volume + 1e-4 * m.volume + (1e-4 + rounding) * m.area;
  if (std::abs(area - m.area) > area_play)
    blame(v, Fault::kClosedForm, "area %.9g, exact %.9g, a mesh may be %g off", area, m.area, area_play);
  if (std::abs(volume - m.volume) > volume_play)
    blame(v, Fault::kClosedForm, "volume %.9g, exact %.9g, a mesh may be %g off", volume, m.volume, volume_play);
  if (report.measured_by != QSES_MEASURED_BY_ATOMS) return;
  if (std::abs(report.area - m.area) > 1e-4 * m.area || std::abs(report.volume - m.volume) > 1e-4 * m.volume)
    blame(v, Fault::kClosedForm, "of the atoms: area %.9g, volume %.9g, exact %.9g, %.9g", report.area, report.volume,
          m.area, m.volume);
}

}  // namespace properties
