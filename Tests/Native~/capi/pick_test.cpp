// SPDX-License-Identifier: MIT
// Picking in kept meshes: what all triangles by themselves say, with boxes and without.
#include "capi/kept_mesh_fixture.h"
#include "kept/kept_mesh.h"

using namespace kept_mesh_fixture;

namespace {

struct Ray {
  std::array<float, 3> origin, direction;
};

qses_hit pick(const qses_kept_mesh *kept, const Ray &ray, const std::vector<uint8_t> &visible = {}) {
  qses_hit hit;
  qses_hit_init(&hit);
  expect_ok(qses_kept_mesh_pick(kept, ray.origin.data(), ray.direction.data(),
                                visible.empty() ? nullptr : visible.data(), visible.size(), &hit));
  return hit;
}

std::array<double, 3> position_of(const qses_mesh &m, uint32_t vertex) {
  const size_t bytes = m.vertex_bytes ? m.vertex_bytes : 12;
  float p[3];
  std::memcpy(p, reinterpret_cast<const char *>(m.positions) + bytes * vertex, sizeof p);
  return {p[0], p[1], p[2]};
}

using Vector = std::array<double, 3>;
Vector operator-(const Vector &a, const Vector &b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector cross(const Vector &a, const Vector &b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Vector &a, const Vector &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// The smallest distance among all triangles, by Moeller and Trumbore; infinite: none. Those that are met within `edge`
// of their border count only if it is positive, and not if it is negative.
double plain_distance(const qses_mesh &m, const Ray &ray, const uint8_t *visible, double edge) {
  const Vector o = {ray.origin[0], ray.origin[1], ray.origin[2]},
               d = {ray.direction[0], ray.direction[1], ray.direction[2]};
  double nearest = std::numeric_limits<double>::infinity();
  for (uint32_t t = 0; t < m.triangle_count; ++t) {
    if (!is_shown(m, t, visible)) continue;
    const uint32_t *const corner = m.indices + 3 * size_t(t);
    const Vector a = position_of(m, corner[0]), ab = position_of(m, corner[1]) - a, ac = position_of(m, corner[2]) - a;
    const Vector p = cross(d, ac), q = cross(o - a, ab);
    const double det = dot(ab, p);
    if (det == 0) continue;
    const double v = dot(o - a, p) / det, w = dot(d, q) / det, distance = dot(ac, q) / det;
    if (v >= -edge && w >= -edge && v + w <= 1 + edge && distance >= 0) nearest = std::min(nearest, distance);
  }
  return nearest;
}

// A corner weighs as much as the part of the triangle that is opposite to it.
void expect_heaviest_corner(const qses_mesh &m, const qses_hit &hit) {
  const uint32_t *const corner = m.indices + 3 * size_t(hit.triangle);
  const Vector at = {hit.position[0], hit.position[1], hit.position[2]};
  const auto area = [](const Vector &a, const Vector &b, const Vector &c) {
    const Vector n = cross(b - a, c - a);
    return std::sqrt(dot(n, n));
  };
  double parts[3], most = 0, own = -1;
  for (size_t k = 0; k < 3; ++k) {
    parts[k] = area(at, position_of(m, corner[(k + 1) % 3]), position_of(m, corner[(k + 2) % 3]));
    most = std::max(most, parts[k]);
    if (hit.vertex == corner[k]) own = parts[k];
  }
  EXPECT_GE(own, most - 1e-5) << "of another corner, or of none";
}

// What is picked is on the ray and on the triangle, and nearest.
void expect_nearest(const qses_mesh &m, const Ray &ray, const qses_hit &hit, const std::vector<uint8_t> &visible = {}) {
  const uint8_t *const mask = visible.empty() ? nullptr : visible.data();
  const double surely = plain_distance(m, ray, mask, -1e-6), perhaps = plain_distance(m, ray, mask, 1e-6);
  if (!hit.found) {
    EXPECT_EQ(surely, std::numeric_limits<double>::infinity());
    return;
  }
  const double slack = 1e-4 * (1 + std::abs(perhaps));
  EXPECT_LE(hit.distance, surely + slack);
  EXPECT_GE(hit.distance, perhaps - slack);
  ASSERT_LT(hit.triangle, m.triangle_count);
  EXPECT_TRUE(is_shown(m, hit.triangle, mask));
  expect_heaviest_corner(m, hit);
  EXPECT_EQ(hit.owner, m.owners[hit.vertex]);
  double length = 0;
  for (size_t k = 0; k < 3; ++k) {
    const double along =
        static_cast<double>(ray.origin[k]) + static_cast<double>(hit.distance) * static_cast<double>(ray.direction[k]);
    EXPECT_NEAR(hit.position[k], along, 2e-3);
    length += static_cast<double>(hit.normal[k]) * static_cast<double>(hit.normal[k]);
  }
  EXPECT_NEAR(length, 1, 1e-5);
}

bool operator==(const qses_hit &a, const qses_hit &b) { return std::memcmp(&a, &b, sizeof a) == 0; }

// Rays that meet the box of the mesh from outside, and some from within.
std::vector<Ray> some_rays(const qses_mesh &m, unsigned seed, int count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1, 1);
  std::vector<Ray> rays;
  for (int n = 0; n < count; ++n) {
    Ray ray{};
    for (size_t k = 0; k < 3; ++k) {
      const float middle = 0.5f * (m.bounds_min[k] + m.bounds_max[k]),
                  half = 0.5f * (m.bounds_max[k] - m.bounds_min[k]);
      ray.origin[k] = middle + unit(random) * (n % 3 == 0 ? 0.7f : 4.f) * half;
      ray.direction[k] = (middle + 0.9f * unit(random) * half - ray.origin[k]) * (n % 2 ? 1.f : 1e-3f);
    }
    rays.push_back(ray);
  }
  return rays;
}

// Rays along the axes, some of them exactly through vertices and along the sides of the box.
std::vector<Ray> rays_along_axes(const qses_mesh &m) {
  std::vector<Ray> rays;
  for (uint32_t v = 0; v < m.vertex_count; v += m.vertex_count / 20 + 1) {
    const auto p = position_of(m, v);
    for (size_t axis = 0; axis < 3; ++axis)
      for (const float sign : {-1.f, 1.f}) {
        Ray ray{};
        for (size_t k = 0; k < 3; ++k) ray.origin[k] = static_cast<float>(p[k]);
        ray.origin[axis] = (sign > 0 ? m.bounds_min[axis] - 3.f : m.bounds_max[axis] + 3.f);
        ray.direction[axis] = sign;
        ray.direction[(axis + 1) % 3] = -0.f;
        rays.push_back(ray);
        ray.origin[(axis + 1) % 3] = m.bounds_max[(axis + 1) % 3];
        rays.push_back(ray);
      }
  }
  return rays;
}

// The mesh twice: with what makes picking fast, and without.
struct Both {
  Kept fast, plain;
  Both(qses_context *context, qses_settings s) {
    for (const auto &kept : {std::pair<Kept *, int>{&fast, 1}, {&plain, 0}}) {
      s.pickable = kept.second;
      compute_view(context, s);
      expect_ok(qses_keep(context, *kept.first));
    }
  }
};

TEST(Pick, FindsTheNearestTriangle) {
  const Context context;
  set_atoms(context, crambin());
  const Both both(context, settings(0.7));
  const qses_mesh mesh = both.fast.view();
  int met = 0;
  std::vector<Ray> rays = some_rays(mesh, 1, 300);
  const std::vector<Ray> axes = rays_along_axes(mesh);
  rays.insert(rays.end(), axes.begin(), axes.end());
  for (const Ray &ray : rays) {
    const qses_hit hit = pick(both.fast, ray);
    EXPECT_TRUE(hit == pick(both.plain, ray)) << "with and without boxes";
    expect_nearest(mesh, ray, hit);
    met += hit.found;
  }
  EXPECT_GT(met, 200);
  EXPECT_LT(met, static_cast<int>(rays.size()));
}

TEST(Pick, TrianglesOfHiddenAtomsLetRaysThrough) {
  const Context context;
  const Atoms atoms = crambin();
  set_atoms(context, atoms);
  const Both both(context, settings(0.7));
  const qses_mesh mesh = both.fast.view();
  int deeper = 0;
  for (const Ray &ray : some_rays(mesh, 2, 200)) {
    const std::vector<uint8_t> visible = some_visible(atoms.size(), static_cast<unsigned>(ray.origin[0] * 100));
    const qses_hit hit = pick(both.fast, ray, visible), whole = pick(both.fast, ray);
    EXPECT_TRUE(hit == pick(both.plain, ray, visible));
    expect_nearest(mesh, ray, hit, visible);
    deeper += whole.found && (!hit.found || hit.distance > whole.distance) ? 1 : 0;
    if (hit.found) {
      EXPECT_GE(hit.distance, whole.distance);
    }
  }
  EXPECT_GT(deeper, 20);
  EXPECT_FALSE(pick(both.fast, some_rays(mesh, 2, 1)[0], std::vector<uint8_t>(atoms.size(), 0)).found);
}

// However it was made and lies in memory.
TEST(Pick, IsTheSameInAllLayoutsAndPieces) {
  const Atoms atoms = cluster(1500, 5);
  const std::vector<uint8_t> visible = some_visible(atoms.size(), 3);
  const Context context;
  set_atoms(context, atoms);
  for (const bool masked : {false, true}) {
    expect_ok(qses_set_visible(context, masked ? visible.data() : nullptr, atoms.size()));
    qses_settings s = settings(0.5);
    s.patch_types = masked ? 1 : 0;
    const Both first(context, s);
    s.vertex_layout = QSES_VERTICES_INTERLEAVED;
    const Both interleaved(context, s);
    s.slice_size = 24;
    const Both in_slices(context, s);
    s.slice_size = 0;
    s.vertex_layout = QSES_VERTICES_COMPACT;
    const Both compact(context, s);
    s = settings(0.5);
    s.pickable = 1;
    const qses_size_estimate estimate = estimate_of(context, s);
    const Context small(2, estimate.smallest_budget);
    set_atoms(small, atoms);
    expect_ok(qses_set_visible(small, masked ? visible.data() : nullptr, atoms.size()));
    compute_view(small, s);
    const Kept in_pieces;
    expect_ok(qses_keep(small, in_pieces));
    for (const Ray &ray : some_rays(first.fast.view(), 4, 100)) {
      const qses_hit hit = pick(first.fast, ray);
      EXPECT_TRUE(hit == pick(first.plain, ray));
      EXPECT_TRUE(hit == pick(interleaved.fast, ray));
      EXPECT_TRUE(hit == pick(interleaved.plain, ray));
      EXPECT_TRUE(hit == pick(in_slices.fast, ray));
      EXPECT_TRUE(hit == pick(in_pieces, ray));
      const qses_hit rounded = pick(compact.fast, ray);
      EXPECT_TRUE(rounded == pick(compact.plain, ray));
      EXPECT_EQ(rounded.triangle, hit.triangle);
      EXPECT_EQ(rounded.distance, hit.distance);
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(rounded.normal[k], hit.normal[k], 0.01);
    }
  }
}

// A closed surface lets nothing out: also along edges, through corners, and in directions of next to no length.
TEST(Pick, NoRaySlipsOut) {
  const Context context;
  const Atoms atoms = crambin();
  set_atoms(context, atoms);
  for (const double spacing : {0.3, 0.7}) {
    qses_settings s = settings(spacing, 1.4, QSES_SURFACE_VDW);
    const Both both(context, s);
    const qses_mesh mesh = both.fast.view();
    std::mt19937 random(6);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (int n = 0; n < 600; ++n) {
      const auto center = atoms.center(random() % atoms.size());
      Ray ray{};
      for (size_t k = 0; k < 3; ++k) {
        ray.origin[k] = static_cast<float>(center[k]);
        ray.direction[k] = unit(random);
      }
      const auto target = position_of(mesh, static_cast<uint32_t>(random() % mesh.vertex_count));
      if (n % 3 == 1)
        for (size_t k = 0; k < 3; ++k) ray.direction[k] = static_cast<float>(target[k]) - ray.origin[k];
      if (n % 3 == 2) ray.direction[random() % 3] = 0;
      if (n % 5 == 0)
        for (float &d : ray.direction) d *= 1e-30f;
      const qses_hit hit = pick(both.fast, ray);
      ASSERT_TRUE(hit.found) << n;
      EXPECT_TRUE(hit == pick(both.plain, ray));
      if (n % 15 == 1) expect_nearest(mesh, ray, hit);
    }
  }
}

TEST(Pick, OddRaysAreFine) {
  const Context context;
  set_atoms(context, Atoms().add(0, 0, 0, 1.5));
  const Both both(context, settings(0.3, 1.4, QSES_SURFACE_VDW));
  const qses_mesh mesh = both.fast.view();
  // On the surface: met at once. Away from it, beside it, and from the other end of the world.
  const auto p = position_of(mesh, 0);
  Ray ray{{static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])}, {1, 0, 0}};
  EXPECT_EQ(pick(both.fast, ray).distance, 0.f);
  EXPECT_TRUE(pick(both.fast, ray) == pick(both.plain, ray));
  EXPECT_FALSE(pick(both.fast, {{5, 0, 0}, {1, 0, 0}}).found);
  EXPECT_FALSE(pick(both.fast, {{-5, 1.6f, 0}, {1, 0, 0}}).found);
  EXPECT_FALSE(pick(both.fast, {{1e38f, 1e38f, 1e38f}, {1, 0, 0}}).found);
  const qses_hit far = pick(both.fast, {{-1e6f, 0.1f, 0.1f}, {3e38f, 0, 0}});
  EXPECT_TRUE(far.found);
  const qses_hit tiny = pick(both.fast, {{-1e5f, 0, 0}, {1e-42f, 0, 0}});
  EXPECT_TRUE(tiny.found);
  EXPECT_EQ(tiny.distance, std::numeric_limits<float>::max());
  EXPECT_NEAR(tiny.position[0], -1.5, 0.03);
  const qses_hit hit = pick(both.fast, {{-10, 0.1f, 0.2f}, {2, 0, 0}});
  ASSERT_TRUE(hit.found);
  EXPECT_NEAR(hit.distance, 4.25, 0.02);
  EXPECT_NEAR(hit.position[0], -1.49, 0.03);
  EXPECT_LT(hit.normal[0], -0.95f) << "outward";
  const qses_hit inside = pick(both.fast, {{0, 0.1f, 0.2f}, {2, 0, 0}});
  ASSERT_TRUE(inside.found);
  EXPECT_GT(inside.normal[0], 0.95f) << "outward also from within";
}

TEST(Pick, EmptyMeshesAreMetNowhere) {
  const Kept kept;
  const Ray ray{{0, 0, 0}, {1, 0, 0}};
  EXPECT_FALSE(pick(kept, ray).found);
  const Context context;
  expect_ok(qses_set_atoms(context, nullptr, 0, nullptr, 0));
  qses_settings s = settings();
  s.pickable = 1;
  compute_view(context, s);
  expect_ok(qses_keep(context, kept));
  EXPECT_FALSE(pick(kept, ray).found);
  // All atoms hidden: triangles there were, but none is left.
  set_atoms(context, water());
  const std::vector<uint8_t> hidden(3, 0);
  expect_ok(qses_set_visible(context, hidden.data(), hidden.size()));
  compute_view(context, s);
  expect_ok(qses_keep(context, kept));
  const qses_hit hit = pick(kept, ray);
  qses_hit nothing;
  qses_hit_init(&nothing);
  EXPECT_TRUE(hit == nothing);
}

TEST(Pick, ClearedMeshesAreMetNowhereAndHaveNoAtoms) {
  const KeptSurface kept(water());
  const Ray ray{{0, 0, -9}, {0, 0, 1}};
  const std::vector<uint8_t> visible(3, 1);
  ASSERT_TRUE(pick(kept, ray, visible).found);
  qses_kept_mesh_clear(kept);
  EXPECT_FALSE(pick(kept, ray).found);
  qses_hit hit;
  qses_hit_init(&hit);
  expect_error(qses_kept_mesh_pick(kept, ray.origin.data(), ray.direction.data(), visible.data(), 3, &hit),
               QSES_INVALID_ARGUMENT, {"0 atoms"});
}

TEST(Pick, WrongArgumentsAreNamed) {
  const KeptSurface kept(water());
  const float origin[3] = {0, 0, 0}, direction[3] = {1, 0, 0};
  const std::vector<uint8_t> visible(3, 1);
  qses_hit hit;
  qses_hit_init(&hit);
  const auto ask = [&](const float *o, const float *d) { return qses_kept_mesh_pick(kept, o, d, nullptr, 0, &hit); };
  expect_error(qses_kept_mesh_pick(nullptr, origin, direction, nullptr, 0, &hit), QSES_INVALID_ARGUMENT, {"kept"});
  expect_error(ask(nullptr, direction), QSES_INVALID_ARGUMENT, {"origin"});
  expect_error(ask(origin, nullptr), QSES_INVALID_ARGUMENT, {"direction"});
  expect_error(qses_kept_mesh_pick(kept, origin, direction, nullptr, 0, nullptr), QSES_INVALID_ARGUMENT, {"hit"});
  expect_error(qses_kept_mesh_pick(kept, origin, direction, visible.data(), 2, &hit), QSES_INVALID_ARGUMENT,
               {"atom_count"});
  const float zero[3] = {0, -0.f, 0};
  expect_error(ask(origin, zero), QSES_INVALID_ARGUMENT, {"direction", "length"});
  for (int k = 0; k < 3; ++k)
    for (const float wrong : {kNan, kInf, -kInf}) {
      float bad[3] = {1, 1, 1};
      bad[k] = wrong;
      expect_error(ask(bad, direction), QSES_INVALID_ARGUMENT, {"origin"});
      expect_error(ask(origin, bad), QSES_INVALID_ARGUMENT, {"direction"});
    }
  hit.struct_size = 3;
  expect_error(ask(origin, direction), QSES_INVALID_ARGUMENT, {"qses_hit"});
}

// As on a sharp ridge: where those of the corners cancel each other, it is that of the nearest one, whichever it is.
TEST(Pick, OppositeNormals) {
  const float positions[] = {0, 0, 0, 4, 0, 0, 0, 4, 0}, n[] = {0, 0.6f, 0.8f};
  const uint32_t indices[] = {0, 1, 2}, owners[] = {5, 6, 7};
  qses_mesh m = empty_mesh();
  m.vertex_count = 3;
  m.triangle_count = 1;
  m.positions = positions;
  m.indices = indices;
  m.owners = owners;
  m.bounds_max[0] = m.bounds_max[1] = 4;
  for (uint32_t nearest = 0; nearest < 3; ++nearest)
    for (const float side : {1.f, -1.f}) {
      float normals[9];
      for (uint32_t k = 0; k < 9; ++k) normals[k] = k / 3 == nearest ? n[k % 3] : -n[k % 3];
      m.normals = normals;
      // The nearest one weighs as much as both others.
      const float origin[] = {nearest == 1 ? 2.f : 1.f, nearest == 2 ? 2.f : 1.f, 3 * side},
                  direction[] = {0, 0, -side};
      const qses_hit hit = quickses::pick(m, {}, origin, direction, nullptr);
      ASSERT_EQ(hit.found, 1);
      EXPECT_EQ(hit.distance, 3.f);
      EXPECT_EQ(hit.vertex, nearest);
      EXPECT_EQ(hit.owner, owners[nearest]);
      for (size_t k = 0; k < 3; ++k) EXPECT_NEAR(hit.normal[k], n[k], 1e-6f);
    }
}

// What is picked depends neither on how far away the eye is nor on what next to nothing a ray has along other axes.
TEST(Pick, RaysFromFarAway) {
  const Context context;
  set_atoms(context, crambin());
  const Both both(context, settings(0.7));
  const qses_mesh mesh = both.fast.view();
  std::mt19937 random(8);
  std::uniform_real_distribution<float> unit(-1, 1);
  int met = 0;
  for (int n = 0; n < 100; ++n) {
    const auto target = position_of(mesh, static_cast<uint32_t>(random() % mesh.vertex_count));
    Ray ray{};
    for (size_t k = 0; k < 3; ++k) {
      ray.origin[k] = 1e6f * unit(random);
      ray.direction[k] = static_cast<float>(target[k]) - ray.origin[k];
    }
    const qses_hit hit = pick(both.fast, ray);
    EXPECT_TRUE(hit == pick(both.plain, ray));
    const double surely = plain_distance(mesh, ray, nullptr, -1e-6), perhaps = plain_distance(mesh, ray, nullptr, 1e-6);
    if (!hit.found) {
      EXPECT_EQ(surely, std::numeric_limits<double>::infinity());
      continue;
    }
    // A float says where it is along such a ray to a tenth of an Å only: its place says more.
    ++met;
    Vector along, from;
    for (size_t k = 0; k < 3; ++k) {
      along[k] = ray.direction[k];
      from[k] = static_cast<double>(hit.position[k]) - ray.origin[k];
    }
    const double length = std::sqrt(dot(along, along)), distance = dot(from, along) / (length * length);
    const Vector beside = cross(from, along);
    EXPECT_LT(std::sqrt(dot(beside, beside)) / length, 1e-4) << "beside the ray";
    EXPECT_LT(distance * length, surely * length + 1e-3);
    EXPECT_GT(distance * length, perhaps * length - 1e-3);
    EXPECT_NEAR(hit.distance, distance, 1e-6);
    expect_heaviest_corner(mesh, hit);
  }
  EXPECT_GT(met, 50);
}

TEST(Pick, RaysAlongAnAxisButForNextToNothing) {
  const Context context;
  set_atoms(context, Atoms().add(0, 0, 0, 1.5));
  const Both both(context, settings(0.3, 1.4, QSES_SURFACE_VDW));
  for (size_t axis = 0; axis < 3; ++axis)
    for (const float next_to_nothing : {1e-12f, -1e-20f, 1e-30f}) {
      Ray ray{{0.1f, 0.1f, 0.1f}, {0, 0, 0}};
      ray.origin[axis] = -5;
      ray.origin[(axis + 1) % 3] = 0.2f;
      ray.direction[axis] = 1;
      const qses_hit expected = pick(both.plain, ray);
      ASSERT_TRUE(expected.found);
      for (size_t other : {axis + 1, axis + 2}) {
        Ray turned = ray;
        turned.direction[other % 3] = next_to_nothing;
        const qses_hit hit = pick(both.fast, turned);
        EXPECT_TRUE(hit == pick(both.plain, turned));
        ASSERT_TRUE(hit.found) << axis << other;
        EXPECT_EQ(hit.triangle, expected.triangle);
        EXPECT_EQ(hit.vertex, expected.vertex);
        EXPECT_NEAR(hit.distance, expected.distance, 1e-6);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(hit.position[k], expected.position[k], 1e-6);
      }
    }
}

}  // namespace
