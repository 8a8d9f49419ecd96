// SPDX-License-Identifier: MIT
// That every kind of difference between two forms of a surface is seen, and every kind of fault of a Gaussian surface.
#include "properties/property_shrink.h"

#include <gtest/gtest.h>

namespace {

using namespace properties;

// Of three atoms, two of which enclose nothing; and a shell with a cavity.
Case three_atoms() {
  Case c;
  c.settings = surface_fixture::settings(0.4);
  c.settings.creases = 1;
  c.atoms.add(0, 0, 0, 1.7).add(2.4, 0.3, 0, 1.52).add(0.5, 2.2, 0.4, 1.55);
  return c;
}

Case hollow_ball() {
  Case c;
  c.settings = surface_fixture::settings(0.9);
  const double golden = pi() * (3 - std::sqrt(5.0));
  constexpr int kAtoms = 120;
  for (int k = 0; k < kAtoms; ++k) {
    const double z = 1 - (2 * k + 1.0) / kAtoms, across = std::sqrt(1 - z * z);
    c.atoms.add(6 * across * std::cos(golden * k), 6 * across * std::sin(golden * k), 6 * z, 1.7);
  }
  return c;
}

Result computed(qses_context *context, const Case &c, const qses_settings &s, unsigned form) {
  surface_fixture::set_atoms(context, c.atoms);
  surface_fixture::expect_ok(Look(c.atoms.size(), form).set(context, c.atoms.size()));
  const qses_mesh mesh = surface_fixture::compute_view(context, s);
  return result_of(mesh, surface_fixture::report_of(context));
}

// A surface, and the same one in another form.
struct Pair {
  Case c;
  Result first, other;
  Pair(const Case &wanted, unsigned form) : c(wanted) {
    const Context context(1, 0, QSES_BACKEND_CPU);
    c.form = form;
    first = computed(context, c, settings_of_first(c.settings, form), 0);
    other = computed(context, c, settings_of_form(c.settings, form), form);
  }

  std::string difference_to(const Result &changed) const {
    Verdict v;
    FormComparison(c, first, changed, v).run();
    EXPECT_EQ(v.fault, v.sentence[0] ? Fault::kForm : Fault::kNone);
    return v.sentence;
  }
  // What is said of the other form after a change.
  template <class Change>
  std::string difference_after(Change change) const {
    EXPECT_EQ(difference_to(other), "");
    Result changed = other;
    change(changed);
    return difference_to(changed);
  }
  void expect(const char *what, const std::string &found) const {
    EXPECT_NE(found.find(what), std::string::npos) << "\"" << found << "\"";
  }
};

template <class T>
void flip_last_bit(T *value) {
  unsigned char bytes[sizeof(T)];
  std::memcpy(bytes, value, sizeof bytes);
  bytes[0] ^= 1;
  std::memcpy(value, bytes, sizeof bytes);
}

TEST(Forms, AreWithoutDifferenceWhereThereIsNone) {
  if (surface_fixture::tested_backend() != QSES_BACKEND_CPU) GTEST_SKIP() << "looks at meshes of the host";
  for (const Case &c : {three_atoms(), hollow_ball()})
    for (unsigned way = 1; way < kPastForms; way *= 2)
      for (unsigned more : {0u, unsigned(kHidden), unsigned(kReversed), unsigned(kHidden | kCompact | kReversed)}) {
        const Pair pair(c, way | more);
        EXPECT_EQ(pair.difference_to(pair.other), "");
      }
}

TEST(Forms, OfAllNamesAreChosen) {
  Random random(1);
  unsigned chosen = 0;
  size_t count = 0;
  for (int k = 0; k < 3000; ++k) {
    const unsigned form = choose_form(random);
    chosen |= form;
    count += form ? 1 : 0;
  }
  EXPECT_EQ(chosen, kPastForms - 1u);
  EXPECT_NEAR(static_cast<double>(count), 1000, 150);
  EXPECT_EQ(name_of_form(kReversed | kHidden | kOnBoth), "reversed, hidden atoms, on both");
}

TEST(Forms, WithOtherVerticesAreSeen) {
  for (unsigned layout : {unsigned(kColors), unsigned(kInterleaved), unsigned(kHidden), unsigned(kReversed)}) {
    const Pair p(three_atoms(), layout | kColors | kTexcoords | kOcclusion | kPatches | kComponentIds);
    p.expect("position of corner", p.difference_after([](Result &r) { flip_last_bit(&r.surface.mesh.positions[31]); }));
    p.expect("normal of corner", p.difference_after([](Result &r) { flip_last_bit(&r.surface.mesh.normals[31]); }));
    p.expect("owner of corner", p.difference_after([](Result &r) { flip_last_bit(&r.surface.mesh.owners[5]); }));
    p.expect("patch of corner", p.difference_after([](Result &r) { flip_last_bit(&r.surface.patches[5]); }));
    p.expect("color of corner", p.difference_after([](Result &r) { flip_last_bit(&r.colors[5]); }));
    p.expect("component id of", p.difference_after([](Result &r) { flip_last_bit(&r.component_ids[5]); }));
    for (size_t which : {size_t(10), size_t(11)})
      p.expect("texture coordinate", p.difference_after([=](Result &r) { flip_last_bit(&r.texcoords[which]); }));
  }
  const Pair compact(three_atoms(), kCompact);
  compact.expect("normal of", compact.difference_after([](Result &r) { r.packed_normals[5][0] ^= 2; }));
  compact.expect("normal of", compact.difference_after([](Result &r) { r.packed_normals[5][3] = 1; }));
  // What need not be the same must still be a normal.
  const Pair hard(three_atoms(), kHardEdges);
  hard.expect("normal of", hard.difference_after([](Result &r) { r.surface.mesh.normals[31] += 0.5f; }));
}

TEST(Forms, WithOtherTrianglesAreSeen) {
  for (unsigned winding : {unsigned(kColors), unsigned(kReversed)})
    for (unsigned shown : {0u, unsigned(kHidden), unsigned(kHardEdges)}) {
      const Pair p(three_atoms(), winding | shown);
      p.expect("of triangle 4", p.difference_after([](Result &r) {
        std::swap(r.surface.mesh.indices[12], r.surface.mesh.indices[14]);
      }));
      p.expect("of triangle 4", p.difference_after([](Result &r) { flip_last_bit(&r.surface.mesh.indices[13]); }));
      p.expect("is vertex", p.difference_after([](Result &r) { r.surface.mesh.indices[13] = r.vertex_count; }));
    }
}

TEST(Forms, ThatShowOtherPartsAreSeen) {
  const Pair inner(hollow_ball(), kOuterOnly), hidden(three_atoms(), kHidden);
  ASSERT_EQ(inner.first.components.size(), 2u);
  ASSERT_LT(inner.other.triangle_count, inner.first.triangle_count);
  ASSERT_LT(hidden.other.triangle_count, hidden.first.triangle_count);
  inner.expect("vertices", inner.difference_to(Pair(hollow_ball(), kColors).other));
  hidden.expect("vertices", hidden.difference_to(Pair(three_atoms(), kColors).other));
  hidden.expect("hidden", hidden.difference_after([](Result &r) { --r.surface.report.hidden_triangles; }));
  hidden.expect("box", hidden.difference_after([](Result &r) { flip_last_bit(&r.high[1]); }));
}

TEST(Forms, WithArraysThatNobodyAskedForAreSeen) {
  const Pair p(three_atoms(), kWithoutOwners);
  p.expect("owners", p.difference_to(Pair(three_atoms(), kReversed).other));
  p.expect("texcoords", Pair(three_atoms(), kTexcoords).difference_to(Pair(three_atoms(), kReversed).other));
  const Pair numbers(three_atoms(), kNumbersOnly);
  numbers.expect("positions", numbers.difference_to(Pair(three_atoms(), kReversed).other));
}

TEST(Forms, WithOtherNumbersAreSeen) {
  for (unsigned delivery : {0u, unsigned(kNumbersOnly)})
    for (unsigned summed : {0u, unsigned(kWithoutComponents)}) {
      const Pair p(three_atoms(), kReversed | kAtomAreas | delivery | summed);
      p.expect("area", p.difference_after([](Result &r) { r.surface.report.area *= 1 + 1e-8; }));
      p.expect("volume", p.difference_after([](Result &r) { r.surface.report.volume *= 1 + 1e-8; }));
      p.expect("triangles' area", p.difference_after([](Result &r) { r.surface.report.triangle_area *= 1 + 1e-8; }));
      p.expect("measured by",
               p.difference_after([](Result &r) { r.surface.report.measured_by = QSES_MEASURED_BY_ATOMS; }));
      p.expect("atom 1 has area", p.difference_after([](Result &r) { flip_last_bit(&r.atom_areas[1]); }));
    }
  const Pair p(hollow_ball(), kReversed);
  p.expect("component", p.difference_after([](Result &r) { r.components.pop_back(); }));
  p.expect("component 1", p.difference_after([](Result &r) { r.components[1].is_cavity = 0; }));
  p.expect("component 1", p.difference_after([](Result &r) { flip_last_bit(&r.components[1].volume); }));
  p.expect("component 0", p.difference_after([](Result &r) { flip_last_bit(&r.components[0].center[2]); }));
}

TEST(Forms, AreComparedWithWhatAddsUp) {
  const auto fault_of = [](const Result &r) {
    Verdict v;
    check_additions(r, v);
    return v.fault;
  };
  const Result good = Pair(hollow_ball(), kAtomAreas).first;
  EXPECT_EQ(fault_of(good), Fault::kNone);
  Result r = good;
  r.component_ids[7] ^= 1;
  EXPECT_EQ(fault_of(r), Fault::kComponents);
  r = good;
  for (uint32_t &id : r.component_ids) id = 1 - id;
  EXPECT_EQ(fault_of(r), Fault::kComponents);
  r = good;
  r.atom_areas[0] *= 1.0001;
  EXPECT_EQ(fault_of(r), Fault::kReport);
}

TEST(Picks, ThatAreWrongAreSeen) {
  Case c = three_atoms();
  c.settings.pickable = 1;
  const Context context(1, 0, QSES_BACKEND_CPU);
  const Result good = computed(context, c, c.settings, 0);
  const Kept kept(context);
  const auto fault_of = [&](const Result &r) {
    Verdict v;
    check_picks(c, r, kept, v);
    return v.fault;
  };
  EXPECT_EQ(fault_of(good), Fault::kNone);
  Result r = good;
  for (float &x : r.surface.mesh.positions) x *= 1.2f;  // the ray ends before what is found
  EXPECT_EQ(fault_of(r), Fault::kForm);
  r = good;
  for (uint32_t &owner : r.surface.mesh.owners) owner = (owner + 1) % 3;
  EXPECT_EQ(fault_of(r), Fault::kForm);
}

TEST(GaussianSurfaces, ThatAreWrongAreSeen) {
  Case c = three_atoms();
  c.settings.surface = QSES_SURFACE_GAUSSIAN;
  c.settings.creases = 0;
  const Context context(1, 0, QSES_BACKEND_CPU);
  const Result good = computed(context, c, c.settings, 0);
  const auto fault_of = [](const Case &of, const Result &r) {
    Verdict v;
    check_gaussian(of, r, v);
    return v.fault;
  };
  EXPECT_EQ(fault_of(c, good), Fault::kNone);
  for (double away : {2e-3, -2e-3}) {  // spacings
    Result r = good;
    for (size_t k = 3; k < 6; ++k)
      r.surface.mesh.positions[k] += static_cast<float>(away * 0.4) * r.surface.mesh.normals[k];
    EXPECT_EQ(fault_of(c, r), Fault::kOffSurface) << away;
  }
  Result r = good;
  const double turn = 0.03;
  for (size_t v = 0; v < r.surface.vertex_count(); ++v) {
    float *const n = &r.surface.mesh.normals[3 * v];
    const Point wanted{double(n[0]), double(n[1]), double(n[2])};
    const Point turned = std::cos(turn) * wanted + std::sin(turn) * exact_reference::perpendicular(wanted);
    n[0] = float(turned.x), n[1] = float(turned.y), n[2] = float(turned.z);
  }
  EXPECT_EQ(fault_of(c, r), Fault::kNormals);
  Case more = c;  // an atom that is missing in the mesh
  more.atoms.add(9, 0, 0, 1.8);
  Verdict v;
  check_sides_of_density(more, good, GaussianReference(more), v);
  EXPECT_EQ(v.fault, Fault::kMisplaced);
  Case other = c;
  other.settings.gaussian_isovalue = 0.49f;
  EXPECT_EQ(fault_of(other, good), Fault::kOffSurface);
}

// Bounds of the density around a place, and of its gradient, against places there.
TEST(GaussianSurfaces, HaveBoundsThatHold) {
  Case c = three_atoms();
  c.settings.gaussian_radius_scale = 0.5f;  // atoms end where others are
  const GaussianReference density(c);
  Random random(3);
  for (int k = 0; k < 3000; ++k) {
    const Point x = Point{1, 1, 0} + random.in_box(4);
    const double distance = random.log_uniform(1e-4, 1);
    const DensityAround a = density.around(x, distance);
    const DensityAround b = density.around(x + (distance * random.unit()) * random.direction(), 0);
    ASSERT_LE(a.least, b.least + 1e-12);
    ASSERT_GE(a.most, b.most - 1e-12);
    ASSERT_LE(length(a.gradient - b.gradient), a.gradient_play + 1e-12);
  }
}

TEST(Rows, HaveTheFormAndTheLevel) {
  Case c = three_atoms();
  c.form = kReversed | kHidden;
  EXPECT_NE(row_of(c).find("}}, 1, 4097},"), std::string::npos) << row_of(c);
  c.settings.creases = 0;
  EXPECT_NE(row_of(c).find("}}, 0, 4097},"), std::string::npos) << row_of(c);
  c.form = 0;
  EXPECT_NE(row_of(c).find("}}},"), std::string::npos) << row_of(c);
  c.settings.surface = QSES_SURFACE_GAUSSIAN;
  EXPECT_NE(row_of(c).find("}}, 0, 0, 1, 0.5},"), std::string::npos) << row_of(c);
}

// The atoms of a seed do not depend on the form that is asked for.
TEST(Generators, ChooseFormsGaussiansAndFrames) {
  size_t forms = 0, gaussians = 0, frames = 0;
  constexpr uint64_t kSeeds = 3000;
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Case c = make_case(seed);
    forms += c.form ? 1 : 0;
    frames += c.comparisons & kFrames ? 1 : 0;
    if (c.settings.surface != QSES_SURFACE_GAUSSIAN) continue;
    ++gaussians;
    ASSERT_TRUE(!c.settings.creases && !c.settings.patch_types && c.settings.method == QSES_METHOD_EXACT);
  }
  EXPECT_NEAR(static_cast<double>(forms), kSeeds / 3.0, 150);
  EXPECT_NEAR(static_cast<double>(gaussians), 0.06 * kSeeds, 60);
  EXPECT_NEAR(static_cast<double>(frames), 0.1 * kSeeds, 80);
}

}  // namespace
