// SPDX-License-Identifier: MIT
// Exact area per atom and volume of SAS and VDW: closed forms, slices by brute force, and what must stay the same.
#include "surface/lee_richards.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace {

using namespace surface_fixture;

const double kPi = std::acos(-1.0);

struct Numbers {
  qses_report report;
  std::vector<double> areas;
};

qses_settings numbers_only(qses_surface surface, double probe = 1.4) {
  qses_settings s = settings(0.5, probe, surface);
  s.delivery = QSES_DELIVERY_NONE;
  s.atom_areas = 1;
  return s;
}

Numbers numbers(qses_context *context, const Atoms &atoms, const qses_settings &s) {
  set_atoms(context, atoms);
  const qses_mesh mesh = compute_view(context, s);
  EXPECT_EQ(mesh.atom_count, atoms.size());
  return {report_of(context), {mesh.atom_areas, mesh.atom_areas + mesh.atom_count}};
}
Numbers numbers(const Atoms &atoms, const qses_settings &s) {
  const Context context;
  return numbers(context, atoms, s);
}

// What holds of any atoms.
void expect_sane(const Numbers &n, const Atoms &atoms, double probe) {
  EXPECT_EQ(n.report.measured_by, QSES_MEASURED_BY_ATOMS);
  double sum = 0, largest = 0;
  for (size_t i = 0; i < atoms.size(); ++i) {
    const double r = static_cast<double>(atoms.radii[i]) + probe, whole = 4 * kPi * r * r;
    ASSERT_GE(n.areas[i], 0.0) << i;
    ASSERT_LE(n.areas[i], whole * (1 + 1e-6)) << i;
    sum += n.areas[i];
    largest = std::max(largest, whole * r / 3);
  }
  EXPECT_NEAR(n.report.area, sum, 1e-9 * sum);
  EXPECT_GE(n.report.volume, largest * (1 - 1e-5));  // at least that of the largest ball
}

void expect_slices(const Atoms &atoms, qses_surface surface, double probe, double tolerance) {
  SCOPED_TRACE(testing::Message() << "surface " << surface << " probe " << probe);
  const double p = surface == QSES_SURFACE_VDW ? 0.0 : static_cast<double>(static_cast<float>(probe));
  const Numbers n = numbers(atoms, numbers_only(surface, probe));
  expect_sane(n, atoms, p);
  const std::vector<double> expected = lee_richards::exposed_areas(atoms, p);
  for (size_t i = 0; i < atoms.size(); ++i) ASSERT_NEAR(n.areas[i], expected[i], tolerance) << "atom " << i;
}

double sphere_area(double r) { return 4 * kPi * r * r; }
double sphere_volume(double r) { return 4 * kPi / 3 * r * r * r; }
// Of the part of a ball beyond a plane at this distance from the centre.
double cap_area(double r, double along) { return 2 * kPi * r * (r - along); }
double cap_volume(double r, double along) { return kPi / 3 * (r - along) * (r - along) * (2 * r + along); }

// ---- closed forms

TEST(AtomMeasures, OneBall) {
  for (double r : {0.5, 1.7, 98.0}) {
    const Atoms atoms = Atoms().add(3, -2, 5, r);
    const Numbers n = numbers(atoms, numbers_only(QSES_SURFACE_SAS));
    const double radius = static_cast<double>(static_cast<float>(r) + 1.4f);
    EXPECT_NEAR(n.report.area, sphere_area(radius), 1e-12 * n.report.area);
    EXPECT_NEAR(n.report.volume, sphere_volume(radius), 1e-12 * n.report.volume);
  }
}

TEST(AtomMeasures, TwoBalls) {
  // From nearly within each other to nearly apart, of equal and unequal size.
  for (double r : {1.25, 2.0, 5.0})
    for (double part : {0.001, 0.02, 0.3, 0.7, 0.98, 0.9999}) {
      const double q = 1.25, low = r - q, d = low + part * (r + q - low);
      Atoms atoms = Atoms().add(0, 0, 0, r).add(d, 0, 0, q);
      const double apart = static_cast<double>(atoms.positions[3]);
      const double along = (apart * apart + r * r - q * q) / (2 * apart);
      if (r * r - along * along < 1e-4) continue;  // a circle that is hardly more than a point
      const double area[] = {sphere_area(r) - cap_area(r, along), sphere_area(q) - cap_area(q, apart - along)};
      const double volume = sphere_volume(r) - cap_volume(r, along) + sphere_volume(q) - cap_volume(q, apart - along);
      for (int turn = 0; turn < 3; ++turn) {
        const Atoms set = turn == 0 ? atoms : turned(atoms, 10.0 * turn, -20.0 * turn, 30);
        const Numbers n = numbers(set, numbers_only(QSES_SURFACE_VDW));
        for (size_t i = 0; i < 2; ++i) EXPECT_NEAR(n.areas[i], area[i], 5e-5) << r << " " << d;
        EXPECT_NEAR(n.report.volume, volume, 5e-5) << r << " " << d;
      }
    }
}

// Whose circle is cut into many short pieces.
TEST(AtomMeasures, TwoLargeBalls) {
  for (double r : {12.0, 97.0, 100.0})
    for (double d : {1.0, 3.0, 20.0}) {
      const Numbers n = numbers(Atoms().add(0, 0, 0, r).add(0, d, 0, r), numbers_only(QSES_SURFACE_VDW));
      const double area = sphere_area(r) - cap_area(r, d / 2), volume = sphere_volume(r) - cap_volume(r, d / 2);
      for (double found : n.areas) EXPECT_NEAR(found, area, 5e-7 * area) << r << " " << d;
      EXPECT_NEAR(n.report.volume, 2 * volume, 5e-7 * volume) << r << " " << d;
    }
}

// In a row, so that the middle one loses two caps that do not meet.
TEST(AtomMeasures, ThreeBallsInARow) {
  const Atoms atoms = Atoms().add(-2, 0, 0, 1.5).add(0, 0, 0, 1.5).add(2, 0, 0, 1.5);
  const Numbers n = numbers(turned(atoms, 5, 6, 7), numbers_only(QSES_SURFACE_VDW));
  const double whole = sphere_area(1.5), cap = cap_area(1.5, 1);
  EXPECT_NEAR(n.areas[0], whole - cap, 2e-5);
  EXPECT_NEAR(n.areas[1], whole - 2 * cap, 2e-5);
  EXPECT_NEAR(n.areas[2], whole - cap, 2e-5);
  EXPECT_NEAR(n.report.volume, 3 * sphere_volume(1.5) - 4 * cap_volume(1.5, 1), 2e-5);
}

// Of three balls around an axis each has the same, and the volume grows by the area.
TEST(AtomMeasures, VolumeGrowsByTheArea) {
  Atoms sets[] = {cluster(40, 5), cluster(300, 6), crambin()};
  const Context context;
  for (const Atoms &atoms : sets) {
    for (const double low : {0.5, 60.0}) {
      if (low > 1 && atoms.size() > 100) continue;
      double integral = 0, first = 0, last = 0;
      constexpr int kSteps = 16;  // of Simpson's rule
      const double high = low + 1;
      for (int k = 0; k <= kSteps; ++k) {
        const double probe = low + (high - low) * k / kSteps;
        const Numbers n = numbers(context, atoms, numbers_only(QSES_SURFACE_SAS, probe));
        integral += n.report.area * (k == 0 || k == kSteps ? 1 : k % 2 ? 4 : 2);
        (k == 0 ? first : last) = n.report.volume;
      }
      integral *= (high - low) / kSteps / 3;
      EXPECT_NEAR(last - first, integral, 2e-5 * (last - first));
    }
  }
}

// ---- brute force

TEST(AtomMeasures, OfClusters) {
  for (unsigned seed : {1u, 2u, 3u}) {
    expect_slices(cluster(100, seed), QSES_SURFACE_SAS, 1.4, 0.01);
    expect_slices(cluster(100, seed), QSES_SURFACE_VDW, 0, 0.01);
  }
  expect_slices(cluster(60, 4), QSES_SURFACE_SAS, 5.0, 0.02);
}
TEST(AtomMeasures, OfCrambin) {
  expect_slices(crambin(), QSES_SURFACE_SAS, 1.4, 0.01);
  expect_slices(crambin(), QSES_SURFACE_VDW, 0, 0.01);
}

// ---- degenerate sets

void expect_slices_everywhere(const Atoms &atoms) {
  // Turned at least, so that no slice lies in a plane of symmetry.
  for (qses_surface surface : {QSES_SURFACE_SAS, QSES_SURFACE_VDW}) {
    expect_slices(turned(atoms), surface, 1.4, 0.02);
    expect_slices(turned(atoms, 33.3, -87.1, 61.7), surface, 1.4, 0.02);
  }
}

TEST(AtomMeasures, BallsThatTouch) {
  expect_slices_everywhere(Atoms().add(0, 0, 0, 1.5).add(3, 0, 0, 1.5).add(0, 3.5, 0, 2));
  expect_slices_everywhere(Atoms().add(0, 0, 0, 1.5).add(5.8, 0, 0, 1.5));
}
TEST(AtomMeasures, BallsWithinOthers) {
  expect_slices_everywhere(Atoms().add(0, 0, 0, 2).add(0.5, 0, 0, 1.5).add(0.2, 0.1, 0, 0.5).add(0, 0, 0, 2));
  expect_slices_everywhere(Atoms().add(0, 0, 0, 1.7).add(0, 0, 0, 1.7).add(0, 0, 0, 1.7));
}
TEST(AtomMeasures, BallsThatHardlyLookOut) {
  for (double d : {0.5001, 0.501, 0.51}) expect_slices_everywhere(Atoms().add(0, 0, 0, 2).add(d, 0, 0, 1.5));
}
TEST(AtomMeasures, BallsThroughOneCircle) {
  // Centres on a line, radii so that all spheres pass through a circle about it.
  for (int count : {3, 4, 6}) {
    Atoms vdw, sas;
    for (int k = 0; k < count; ++k) {
      const double x = 0.5 * k - 0.7, r = std::sqrt(4 + x * x);
      vdw.add(x, 0, 0, r);
      sas.add(x, 0, 0, r - 1.4);
    }
    expect_slices(turned(vdw), QSES_SURFACE_VDW, 0, 0.02);
    expect_slices(turned(sas, 3, 4, 5), QSES_SURFACE_SAS, 1.4, 0.02);
    const Numbers n = numbers(vdw, numbers_only(QSES_SURFACE_VDW));
    const double first = std::sqrt(4 + 0.49), x = 0.5 * (count - 1) - 0.7, last = std::sqrt(4 + x * x);
    EXPECT_NEAR(n.areas[0], sphere_area(first) - cap_area(first, 0.7), 1e-3);
    EXPECT_NEAR(n.areas[size_t(count) - 1], sphere_area(last) - cap_area(last, x), 1e-3);
  }
}
TEST(AtomMeasures, Rings) {
  expect_slices_everywhere(ring(4, 1.8, 1.7));
  expect_slices_everywhere(ring(6, 1.39, 1.7));
  expect_slices_everywhere(ring(10, 3.6, 1.5));
}
TEST(AtomMeasures, Lattices) {
  expect_slices_everywhere(lattice(2, 1.5, 1.7));
  expect_slices_everywhere(lattice(3, 2.0, 1.7));
  expect_slices_everywhere(lattice(4, 3.0, 1.5));
}
TEST(AtomMeasures, HugeAndTinyBalls) {
  expect_slices(turned(Atoms().add(0, 0, 0, 60).add(61, 0, 0, 2).add(0, 60.5, 0, 1)), QSES_SURFACE_SAS, 1.4, 2.0);
  expect_slices(turned(Atoms().add(0, 0, 0, 0.01).add(0.015, 0, 0, 0.01).add(0, 0.012, 0, 0.01)), QSES_SURFACE_VDW, 0,
                1e-6);
}

// Whose largest cap is tiny: a large ball that small ones cover by and by.
TEST(AtomMeasures, BallThatManySmallOnesCover) {
  for (int count : {1, 5, 90, 1500, 1900, 2300, 2700}) {
    Atoms atoms = Atoms().add(0, 0, 0, 40);
    for (int k = 0; k < count; ++k) {
      const double z = 1 - (2 * k + 1.0) / count, turn = 2.399963 * k, s = std::sqrt(1 - z * z);
      atoms.add(40.2 * s * std::cos(turn), 40.2 * s * std::sin(turn), 40.2 * z, 1.5);
    }
    const Numbers n = numbers(turned(atoms), numbers_only(QSES_SURFACE_VDW));
    const std::vector<double> expected = lee_richards::exposed_areas(turned(atoms), 0, 1000);
    EXPECT_NEAR(n.areas[0], expected[0], 1e-3 * sphere_area(40)) << count;
  }
}

// Two that meet on a large ball's sphere just opposite to its largest cap, which is tiny.
TEST(AtomMeasures, BallWithABorderOppositeToItsLargestCap) {
  for (const double off : {0.0, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2}) {
    const Atoms atoms = Atoms().add(0, 0, 0, 10).add(0, off, 10.2, 1).add(0.3, 0.4, -10, 0.5).add(0.4, -0.3, -10, 0.5);
    for (const Atoms &set : {atoms, turned(atoms), turned(shifted(atoms, 0.3, 0, 0), 33.3, -87.1, 61.7)}) {
      const Numbers n = numbers(set, numbers_only(QSES_SURFACE_VDW));
      const std::vector<double> expected = lee_richards::exposed_areas(set, 0, 40000);
      for (size_t i = 0; i < set.size(); ++i) ASSERT_NEAR(n.areas[i], expected[i], 5e-6 * sphere_area(10)) << off;
    }
  }
}

// Beads on a ball, some of which barely meet: wherever borders lie, areas do not depend on how all is turned.
TEST(AtomMeasures, TurnedBeadsHaveTheSameAreas) {
  std::mt19937 random(13);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 40; ++k) {
    Atoms atoms = Atoms().add(0, 0, 0, 30);
    for (int i = 0; i < 40 + 5 * k; ++i) {
      const double x = normal(random), y = normal(random), z = normal(random), scale = 30.5 / std::hypot(x, y, z);
      atoms.add(x * scale, y * scale, z * scale, 2 + 0.1 * (i % 11));
    }
    const Numbers first = numbers(atoms, numbers_only(QSES_SURFACE_VDW));
    for (int turn = 1; turn < 5; ++turn) {
      const Numbers n = numbers(turned(atoms, 71.0 * turn, 40.0 + turn, 13.0 * turn), numbers_only(QSES_SURFACE_VDW));
      ASSERT_NEAR(n.areas[0], first.areas[0], 2e-5 * sphere_area(30)) << k << " " << turn;
      ASSERT_NEAR(n.report.area, first.report.area, 2e-5 * first.report.area) << k << " " << turn;
    }
  }
}

// ---- circles that nearly coincide

// Areas of all together, and of each from this one on: of atoms that are next to each other, rounding of their
// positions decides which has how much.
void expect_slices_in_all(const Atoms &atoms, qses_surface surface, size_t first, double tolerance) {
  const double p = surface == QSES_SURFACE_VDW ? 0.0 : static_cast<double>(1.4f);
  const Numbers n = numbers(atoms, numbers_only(surface));
  const std::vector<double> expected = lee_richards::exposed_areas(atoms, p);
  const double sum = std::accumulate(expected.begin(), expected.end(), 0.0);
  ASSERT_NEAR(n.report.area, sum, tolerance);
  for (size_t i = first; i < atoms.size(); ++i) ASSERT_NEAR(n.areas[i], expected[i], tolerance) << "atom " << i;
}

TEST(AtomMeasures, TwinsThatAThirdBarelyMeets) {
  for (double apart : {3e-5, 1e-4, 1e-3, 3e-3, 1e-2})
    for (double depth : {1e-5, 1e-4, 1e-3, 3e-3, 2e-2})
      for (int side = 0; side < 3; ++side) {  // across, aslant, along
        SCOPED_TRACE(testing::Message() << "apart " << apart << " depth " << depth << " side " << side);
        const double r = 1.55, q = 1.4, y = side == 0 ? 0.0 : side == 1 ? 0.6 : 1.0;
        const double first[3] = {0, 0, 0}, second[3] = {-apart * std::sqrt(1 - y * y), -apart * y, 0};
        const double third[3] = {0, r + q + 2.8 - depth, 0};
        for (int order = 0; order < 2; ++order) {
          const double *one = order ? second : first, *other = order ? first : second;
          const Atoms atoms = Atoms()
                                  .add(one[0], one[1], one[2], r)
                                  .add(other[0], other[1], other[2], r)
                                  .add(third[0], third[1], third[2], q);
          for (const Atoms &set : {atoms, turned(atoms), turned(shifted(atoms, -1, 2, 3))}) {
            const Numbers n = numbers(set, numbers_only(QSES_SURFACE_SAS));
            const double large = r + 1.4, small = q + 1.4;
            // The twins have a strip more than one of them, and lack what the third covers; it lacks as little.
            const double cap = 2 * kPi * large * depth;
            ASSERT_NEAR(n.areas[2], sphere_area(small), cap + 0.01);
            ASSERT_NEAR(n.areas[0] + n.areas[1], sphere_area(large), cap + 2 * kPi * large * apart + 0.01);
            ASSERT_NEAR(n.report.volume, sphere_volume(large) + sphere_volume(small),
                        kPi * large * large * apart + 0.02);
          }
        }
      }
}

TEST(AtomMeasures, CrowdsThatOthersBarelyMeet) {
  std::mt19937 random(11);
  const auto in = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  for (int k = 0; k < 150; ++k) {
    SCOPED_TRACE(k);
    const qses_surface surface = k % 2 ? QSES_SURFACE_VDW : QSES_SURFACE_SAS;
    const double p = k % 2 ? 0.0 : 1.4, crowd = std::pow(10, in(-4, -2));
    Atoms atoms;
    for (int i = 0; i < 2 + k % 3; ++i) atoms.add(in(-crowd, crowd), in(-crowd, crowd), in(-crowd, crowd), 1.7);
    const size_t first = atoms.size();
    for (int i = 0; i < 1 + k % 4; ++i) {
      const double z = in(-1, 1), turn = in(0, 2 * kPi), q = in(1.2, 1.8), s = std::sqrt(1 - z * z);
      const double distance = 1.7 + q + 2 * p - std::pow(10, in(-5, -1));
      atoms.add(distance * s * std::cos(turn), distance * s * std::sin(turn), distance * z, q);
    }
    expect_slices_in_all(atoms, surface, first, 0.03);
  }
}

TEST(AtomMeasures, BallsNearlyThroughOneCircle) {
  std::mt19937 random(12);
  const auto in = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  for (int k = 0; k < 150; ++k) {
    SCOPED_TRACE(k);
    const double off = k % 3 ? std::pow(10, in(-7, -3)) : 0.0;
    Atoms atoms;
    for (int i = 0; i < 3 + k % 4; ++i) {
      const double x = in(-1.5, 1.5), r = std::sqrt(4 + x * x);
      atoms.add(x, in(-off, off), in(-off, off), r + in(-off, off));
    }
    if (k % 2) atoms.add(0.2, 2.5, 0.3, 1.5);
    expect_slices_in_all(k % 5 ? turned(atoms) : atoms, QSES_SURFACE_VDW, 0, 0.03);
  }
}

// Circles so small that single precision has hardly a digit of their radius.
TEST(AtomMeasures, BallsThatBarelyMeet) {
  const Atoms sets[] = {Atoms().add(5.8999986, 0.0032, 0, 1.4).add(0, 0.0032, 0, 1.7).add(0, 0, 0, 1.7),
                        Atoms()
                            .add(6.8454504, 0.038259916, 0.265937865, 1.4)
                            .add(0.945451856, 0.038259916, 0.265937865, 1.7)
                            .add(-4.74141979, 0.0350473896, 0.265937865, 1.2)
                            .add(0.945451856, 0.0350473896, 0.265937865, 1.7),
                        Atoms()
                            .add(-2.00543284, -0.286913782, -6.5461669, 1.8)
                            .add(-1.54135561, -0.321423411, -0.764926136, 1.2)
                            .add(-5.30245543, -2.27496576, 2.24789834, 1.2)
                            .add(-1.98469126, -0.291635126, -5.94590664, 1.2)};
  for (const Atoms &atoms : sets) expect_slices_in_all(atoms, QSES_SURFACE_SAS, atoms.size(), 0.03);
}

// Of three balls that just close at one point, each lacks so little of a circle that one precision has no digit of it.
TEST(AtomMeasures, RingsThatJustClose) {
  for (const double reach : {2.92, 12.0, 29.2})
    for (int k = 0; k < 50; ++k) {
      SCOPED_TRACE(testing::Message() << "reach " << reach << " ring " << k);
      const double radius = reach - 1.4;
      const Atoms atoms = turned(ring(3, reach, radius), 0.1 * k, 0.3 * k, -0.2 * k);
      const Numbers n = numbers(atoms, numbers_only(QSES_SURFACE_SAS));
      const Numbers wider = numbers(turned(ring(3, reach, radius + 4e-6 * reach)), numbers_only(QSES_SURFACE_SAS));
      for (double area : n.areas) ASSERT_NEAR(area, wider.areas[0], 2.5e-4 * reach * reach);
    }
}

TEST(AtomMeasures, SameWhereverTheAtomsAre) {
  const Context context;
  for (qses_surface surface : {QSES_SURFACE_SAS, QSES_SURFACE_VDW}) {
    const qses_settings s = numbers_only(surface);
    const Numbers here = numbers(context, crambin(), s);
    for (const Atoms &atoms :
         {shifted(crambin(), 100, -200, 300), turned(crambin()), turned(crambin(), -512, 256, 64)}) {
      const Numbers there = numbers(context, atoms, s);
      EXPECT_NEAR(there.report.area, here.report.area, 1e-6 * here.report.area);
      EXPECT_NEAR(there.report.volume, here.report.volume, 1e-6 * here.report.volume);
      for (size_t i = 0; i < here.areas.size(); ++i) EXPECT_NEAR(there.areas[i], here.areas[i], 2e-3) << i;
    }
  }
}

TEST(AtomMeasures, SameWhateverTheSpacingAndTheMemory) {
  const Context context;
  const Atoms atoms = cluster(200, 9);
  qses_settings s = numbers_only(QSES_SURFACE_SAS);
  const Numbers first = numbers(context, atoms, s);
  for (double spacing : {0.3, 1.0, 0.001, 100.0}) {
    s.spacing = static_cast<float>(spacing);
    const Numbers other = numbers(context, atoms, s);
    EXPECT_NEAR(other.report.area, first.report.area, 5e-6 * first.report.area);  // the centre moves
  }
  s.spacing = 0.5f;
  s.delivery = QSES_DELIVERY_HOST;
  for (unsigned threads : {1u, 2u, 5u})
    for (uint64_t budget : {uint64_t(0), uint64_t(5) << 20}) {
      const Context one(threads, budget);
      const Numbers other = numbers(one, atoms, s);
      EXPECT_EQ(other.report.area, first.report.area);
      EXPECT_EQ(other.report.volume, first.report.volume);
      EXPECT_EQ(other.areas, first.areas);
    }
}

}  // namespace
