// SPDX-License-Identifier: MIT
// Vertices where two sheets of the SES meet: where they are, their normals, and the mesh that has them once per side.
#include "surface/surface_checks.h"

#include <cstring>
#include <iterator>

namespace {

using namespace surface_checks;
using exact_reference::cross;
using exact_reference::dot;
using exact_reference::length;

qses_settings hard(qses_settings s) {
  s.hard_edges = 1;
  return s;
}

// What copy_surface leaves out.
struct HardSurface {
  Surface surface;
  std::vector<uint32_t> repeated, colors;
  std::vector<qses_component> components;
  size_t own = 0;  // vertices that repeat none

  mesh_checks::Mesh merged() const {
    mesh_checks::Mesh mesh = surface.mesh;
    mesh.positions.resize(3 * own);
    mesh.normals.resize(3 * own);
    mesh.owners.resize(own);
    for (uint32_t &i : mesh.indices)
      if (i >= own) i = repeated[i - own];
    return mesh;
  }
};

HardSurface compute_hard(qses_context *context, const qses_settings &s) {
  const qses_mesh m = compute_view(context, s);
  HardSurface h;
  h.surface = copy_surface(context);
  h.own = m.vertex_count - m.repeated_count;
  if (m.components) h.components.assign(m.components, m.components + m.component_count);
  if (m.repeated) h.repeated.assign(m.repeated, m.repeated + m.repeated_count);
  if (m.colors)
    for (size_t v = 0; v < m.vertex_count; ++v) {
      uint32_t color;
      std::memcpy(&color, m.colors + 4 * v, 4);
      h.colors.push_back(color);
    }
  return h;
}

HardSurface compute_hard(const Atoms &atoms, const qses_settings &s, unsigned threads = 2) {
  const Context context(threads);
  set_atoms(context, atoms);
  return compute_hard(context, s);
}

// Corners of triangles whose normal points against the triangle.
size_t corners_turned_away(const mesh_checks::Mesh &mesh) {
  size_t count = 0;
  for (size_t t = 0; t < mesh.triangle_count(); ++t) {
    const uint32_t *const c = mesh.indices.data() + 3 * t;
    const Point a = point(mesh.position(c[0])),
                face = cross(point(mesh.position(c[1])) - a, point(mesh.position(c[2])) - a);
    for (int k = 0; k < 3; ++k) {
      const float *const n = mesh.normals.data() + 3 * size_t(c[k]);
      count += dot(face, {n[0], n[1], n[2]}) < 0 ? 1 : 0;
    }
  }
  return count;
}

// Three atoms that a probe touches from above and from below. Their spheres meet in a circle in the plane between.
struct Ring {
  Atoms atoms;
  double probe = 1.4, crest;
  Ring() {
    const double distance = 2.7, r = 1.6, height = std::sqrt((r + probe) * (r + probe) - distance * distance);
    for (int k = 0; k < 3; ++k) atoms.add(distance * std::cos(k * 2.0943951), distance * std::sin(k * 2.0943951), 0, r);
    crest = std::sqrt(probe * probe - height * height);
  }
};

// Atoms so far apart that probes from different sides meet between them: walls of two sheets and holes everywhere.
Atoms sponge(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter(-0.4, 0.4);
  Atoms atoms;
  for (int k = 0; k < 64; ++k)
    atoms.add(3.7 * (k % 4) + jitter(random), 3.7 * (k / 4 % 4) + jitter(random), 3.7 * (k / 16) + jitter(random), 1.7);
  return atoms;
}

std::vector<Atoms> molecules() { return {crambin(), sponge(1), turned(sponge(2), 40, -70, 300), turned(Ring().atoms)}; }

TEST(Crests, OfTwoProbesAreTheCircleWhereTheirSpheresMeet) {
  const Ring ring;
  size_t crests = 0;
  for (double spacing : {0.5, 0.3, 0.17, 0.12}) {
    const HardSurface h = compute_hard(ring.atoms, hard(settings(spacing, ring.probe)));
    crests += h.repeated.size();
    for (size_t k = 0; k < h.repeated.size(); ++k) {
      const Point x = point(h.surface.mesh.position(h.own + k));
      EXPECT_NEAR(x.z, 0, 1e-4);
      EXPECT_NEAR(std::hypot(x.x, x.y), ring.crest, 1e-4);
      EXPECT_NEAR(h.surface.normal(h.own + k)[2], -h.surface.normal(h.repeated[k])[2], 1e-3);
    }
    // One normal for both sides lies between them: in the plane, towards the axis.
    const Surface smooth = compute(ring.atoms, settings(spacing, ring.probe));
    for (uint32_t v : h.repeated) {
      const Point x = point(smooth.mesh.position(v)), n = point(smooth.normal(v));
      EXPECT_NEAR(n.z, 0, 0.3);  // turned where triangles demand it
      EXPECT_LT(n.x * x.x + n.y * x.y, 0);
    }
  }
  EXPECT_GT(crests, 10u);
}

// Both normals of a vertex on a crest lead to places where the probe touches atoms, and no third probe covers it.
TEST(Crests, LieOnTwoProbesAndInNoThird) {
  size_t crests = 0, turned_normals = 0;
  for (const Atoms &atoms : molecules())
    for (double probe : {1.4, 0.9}) {
      const qses_settings s = hard(settings(0.3, probe));
      const HardSurface h = compute_hard(atoms, s);
      const Boundary boundary(atoms, probe);
      for (size_t k = 0; k < h.repeated.size(); ++k) {
        const Point x = point(h.surface.mesh.position(h.own + k));
        EXPECT_NEAR(boundary.nearest(x).distance, probe, 2e-4);
        ++crests;
        for (size_t v : {h.own + k, size_t(h.repeated[k])}) {
          const Point y = x + static_cast<double>(s.probe_radius) * point(h.surface.normal(v));
          turned_normals += std::abs(boundary.depth(y)) > 1e-3 ? 1 : 0;
        }
      }
    }
  EXPECT_GT(crests, 50u);
  EXPECT_LE(turned_normals, crests / 5);  // those that would point against a triangle
}

TEST(HardEdges, RepeatVerticesOfTheSmoothMesh) {
  size_t crests = 0;
  for (const Atoms &atoms : molecules())
    for (qses_vertex_layout layout : {QSES_VERTICES_SEPARATE, QSES_VERTICES_INTERLEAVED, QSES_VERTICES_COMPACT}) {
      qses_settings s = settings(0.3);
      s.patch_types = s.components = 1;
      const Context context;
      set_atoms(context, atoms);
      std::vector<uint32_t> colors(atoms.size());
      for (size_t i = 0; i < colors.size(); ++i) colors[i] = static_cast<uint32_t>(i * 2654435761u);
      expect_ok(qses_set_colors(context, reinterpret_cast<const uint8_t *>(colors.data()), colors.size()));
      const HardSurface smooth = compute_hard(context, s);
      EXPECT_EQ(smooth.repeated.size(), 0u);
      s.hard_edges = 1;
      const qses_mesh m = compute_view(context, s);
      s.vertex_layout = layout;
      const HardSurface h = layout == QSES_VERTICES_SEPARATE ? compute_hard(context, s) : HardSurface();
      const qses_mesh view = compute_view(context, s);
      ASSERT_EQ(view.vertex_count, m.vertex_count);
      ASSERT_EQ(view.repeated_count, m.repeated_count);
      crests += view.repeated_count;
      const size_t own = view.vertex_count - view.repeated_count;
      ASSERT_EQ(own, smooth.own);
      ASSERT_GT(smooth.components.size(), 0u);
      ASSERT_EQ(view.component_count, smooth.components.size());
      for (size_t k = 0; k < smooth.components.size(); ++k) {
        EXPECT_EQ(view.components[k].triangles, smooth.components[k].triangles);
        const qses_component &same = smooth.components[k];  // but for normals along which it is measured
        EXPECT_NEAR(view.components[k].area, same.area, 1e-3 * same.area);
        EXPECT_NEAR(view.components[k].volume, same.volume, 1e-3 * std::abs(same.volume));
      }
      const size_t step = view.vertex_bytes ? view.vertex_bytes / 4 : 3;
      for (size_t v = 0; v < view.vertex_count; ++v) {
        const size_t from = v < own ? v : view.repeated[v - own];
        if (v > own) {
          ASSERT_LT(view.repeated[v - own - 1], view.repeated[v - own]);
        }
        ASSERT_LT(from, own);
        for (size_t d = 0; d < 3; ++d)
          ASSERT_EQ(view.positions[step * v + d], smooth.surface.mesh.positions[3 * from + d]);
        ASSERT_EQ(view.owners[v], smooth.surface.mesh.owners[from]);
        ASSERT_EQ(view.patches[v], smooth.surface.patches[from]);
        ASSERT_EQ(std::memcmp(view.colors + 4 * v, &smooth.colors[from], 4), 0);
      }
      std::vector<uint8_t> used(view.vertex_count);
      for (size_t i = 0; i < smooth.surface.mesh.indices.size(); ++i) {
        const uint32_t v = view.indices[i];
        ASSERT_LT(v, view.vertex_count);
        ASSERT_EQ(v < own ? v : view.repeated[v - own], smooth.surface.mesh.indices[i]);
        used[v] = 1;
      }
      for (uint8_t one : used) ASSERT_EQ(one, 1);
      EXPECT_EQ(report_of(context).triangle_area, smooth.surface.report.triangle_area);
      if (layout != QSES_VERTICES_SEPARATE) continue;
      EXPECT_EQ(mesh_checks::manifold_fault(h.merged()), "");
      EXPECT_LT(mesh_checks::worst_normal_length(h.surface.mesh), 1e-5);
      for (size_t k = 0; k < h.repeated.size(); ++k)
        EXPECT_LT(dot(point(h.surface.normal(h.own + k)), point(h.surface.normal(h.repeated[k]))), 0.9999);
    }
  EXPECT_GT(crests, 20u);
}

TEST(HardEdges, FaceTheirTriangles) {
  for (const Atoms &atoms : molecules())
    for (double spacing : {0.5, 0.3})
      for (uint32_t with : {0u, 1u}) {
        qses_settings s = settings(spacing);
        (with ? s.hard_edges : s.creases) = 1;
        const Surface surface = compute(atoms, s);
        EXPECT_LE(static_cast<double>(corners_turned_away(surface.mesh)),
                  1e-4 * static_cast<double>(surface.mesh.triangle_count()) + 2)
            << atoms.size() << " atoms, " << spacing;
      }
}

TEST(HardEdges, AreTheSameBytesOnAnyThreadsAndInSlices) {
  const Atoms atoms = crambin();
  const HardSurface one = compute_hard(atoms, hard(settings(0.4)), 1);
  ASSERT_GT(one.repeated.size(), 0u);
  for (unsigned threads : {2u, 5u})
    for (uint32_t slice : {0u, 24u}) {
      qses_settings s = hard(settings(0.4));
      s.slice_size = slice;
      const HardSurface other = compute_hard(atoms, s, threads);
      EXPECT_EQ(other.repeated, one.repeated);
      EXPECT_EQ(other.surface.mesh.indices, one.surface.mesh.indices);
      EXPECT_EQ(other.surface.mesh.owners, one.surface.mesh.owners);
      EXPECT_EQ(other.surface.mesh.positions, one.surface.mesh.positions);
      EXPECT_EQ(other.surface.mesh.normals, one.surface.mesh.normals);
    }
}

// With a little memory the mesh of the GPU is made in pieces, in the host's memory.
TEST(HardEdges, AreTheSameWithALittleMemory) {
  const Atoms atoms = cluster(3000, 9);
  const HardSurface roomy = compute_hard(atoms, hard(settings(0.5)));
  const Context context(2, uint64_t(24) << 20);
  set_atoms(context, atoms);
  const HardSurface tight = compute_hard(context, hard(settings(0.5)));
  ASSERT_GT(tight.repeated.size(), 0u);
  EXPECT_EQ(tight.repeated, roomy.repeated);
  EXPECT_EQ(tight.surface.mesh.indices, roomy.surface.mesh.indices);
  EXPECT_EQ(tight.surface.mesh.positions, roomy.surface.mesh.positions);
  EXPECT_EQ(tight.surface.mesh.normals, roomy.surface.mesh.normals);
}

TEST(HardEdges, OfVisibleAtomsAreThoseOfTheirTriangles) {
  const Atoms atoms = crambin();
  const Context context;
  set_atoms(context, atoms);
  std::vector<uint8_t> visible(atoms.size());
  for (size_t i = 0; i < visible.size(); ++i) visible[i] = i % 3 != 0;
  expect_ok(qses_set_visible(context, visible.data(), visible.size()));
  const Surface smooth = copy_surface((compute_view(context, settings(0.4)), context));
  const HardSurface h = compute_hard(context, hard(settings(0.4)));
  ASSERT_GT(h.repeated.size(), 0u);
  EXPECT_EQ(h.merged().positions, smooth.mesh.positions);
  EXPECT_EQ(h.merged().indices, smooth.mesh.indices);
}

// Rounding may decide whether another probe covers a vertex by 0.1 milliÅ.
TEST(HardEdges, AreTheSameOnBothBackEnds) {
  if (tested_backend() == QSES_BACKEND_CPU) GTEST_SKIP() << "the back end under test is the CPU";
  const Context cpu(2, 0, QSES_BACKEND_CPU), gpu;
  size_t crests = 0, different = 0, vertices = 0, moved = 0;
  for (int k = 0; k < 16; ++k) {
    const Atoms atoms = molecules()[static_cast<size_t>(k % 4)];
    const qses_settings s = hard(settings(0.2 + 0.1 * (k / 4)));
    set_atoms(cpu, atoms);
    set_atoms(gpu, atoms);
    const HardSurface a = compute_hard(cpu, s), b = compute_hard(gpu, s);
    if (a.own != b.own || a.surface.mesh.indices.size() != b.surface.mesh.indices.size()) continue;
    std::vector<uint32_t> difference;
    std::set_symmetric_difference(a.repeated.begin(), a.repeated.end(), b.repeated.begin(), b.repeated.end(),
                                  std::back_inserter(difference));
    crests += a.repeated.size();
    different += difference.size();
    vertices += a.own;
    for (size_t v = 0; v < a.own; ++v)
      moved += length(point(a.surface.mesh.position(v)) - point(b.surface.mesh.position(v))) > 1e-3 ? 1 : 0;
  }
  EXPECT_GT(crests, 20u);  // so few signs differ that most meshes are alike
  EXPECT_LE(different, crests / 10 + 1);
  EXPECT_LE(moved, vertices / 1000);
}

TEST(HardEdges, AreNoneWhereThereAreNoCrests) {
  EXPECT_EQ(compute_hard(Atoms(), hard(settings())).repeated.size(), 0u);
  EXPECT_EQ(compute_hard(Atoms().add(0, 0, 0, 1.7), hard(settings())).repeated.size(), 0u);
  qses_settings s = hard(settings());
  s.method = QSES_METHOD_GRID;
  EXPECT_EQ(compute_hard(crambin(), s).repeated.size(), 0u);
}

}  // namespace
