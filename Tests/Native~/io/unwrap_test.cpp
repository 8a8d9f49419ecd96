// SPDX-License-Identifier: MIT
// Boxes, minimum images, and molecules made whole.
#include "io/unwrap.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <string>

#include "io/io_fixture.h"

namespace quickses::io {
namespace {

using Vector = Lattice::Vector;
using Positions = std::vector<float>;
using Elements = std::vector<uint8_t>;

constexpr uint8_t kHydrogen = 1, kCarbon = 6, kOxygen = 8, kSulfur = 16, kCalcium = 20;

struct BoxCase {
  const char *name;
  std::array<Vector, 3> vectors;
};

void PrintTo(const BoxCase &box, std::ostream *stream) { *stream << box.name; }

Vector operator+(const Vector &a, const Vector &b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vector operator-(const Vector &a, const Vector &b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector operator*(double s, const Vector &a) { return {s * a[0], s * a[1], s * a[2]}; }
double length(const Vector &a) { return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }

Vector position(const Positions &positions, size_t i) {
  return {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]};
}

void add(Positions &positions, const Vector &x) {
  for (double value : x) positions.push_back(static_cast<float>(value));
}

class Random {
 public:
  explicit Random(uint32_t seed) : engine_(seed) {}
  double uniform(double low, double high) { return low + (high - low) * (engine_() / 4294967296.0); }
  int integer(int low, int high) { return low + static_cast<int>(engine_() % static_cast<uint32_t>(high - low + 1)); }

  Vector unit() {
    for (;;) {
      const Vector v = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
      if (length(v) > 0.1 && length(v) < 1) return 1 / length(v) * v;
    }
  }

  Vector in_box(const Box &box) {
    return uniform(0, 1) * box.vectors[0] + uniform(0, 1) * box.vectors[1] + uniform(0, 1) * box.vectors[2];
  }

  // Moves each atom by some box vectors.
  void scatter(Positions &positions, const Box &box, int most) {
    for (size_t i = 0; i < positions.size() / 3; ++i) {
      Vector x = position(positions, i);
      for (const Vector &v : box.vectors) x = x + integer(-most, most) * v;
      for (int axis = 0; axis < 3; ++axis) positions[3 * i + axis] = static_cast<float>(x[axis]);
    }
  }

 private:
  std::mt19937 engine_;
};

// The shortest of d plus box vectors, by trying many.
double shortest(const Vector &d, const Box &box, int most) {
  double best = length(d);
  for (int i = -most; i <= most; ++i)
    for (int j = -most; j <= most; ++j)
      for (int k = -most; k <= most; ++k)
        best = std::min(best, length(d + i * box.vectors[0] + j * box.vectors[1] + k * box.vectors[2]));
  return best;
}

void expect_whole_multiples(const Positions &before, const Positions &after, const Box &box) {
  const Lattice lattice(box);
  for (size_t i = 0; i < before.size() / 3; ++i) {
    const Vector f = lattice.fractional(position(after, i) - position(before, i));
    for (double x : f) EXPECT_NEAR(x, std::round(x), 1e-4) << "atom " << i;
  }
}

class BoxTest : public ::testing::TestWithParam<BoxCase> {
 protected:
  Box box_ = Box{GetParam().vectors};
};

INSTANTIATE_TEST_SUITE_P(
    All, BoxTest,
    ::testing::Values(BoxCase{"right", {{{30, 0, 0}, {0, 20, 0}, {0, 0, 25}}}},
                      BoxCase{"small", {{{9, 0, 0}, {0, 10, 0}, {0, 0, 11}}}},
                      BoxCase{"dodecahedron", {{{40, 0, 0}, {0, 40, 0}, {20, 20, 28.284271}}}},
                      BoxCase{"octahedron", {{{40, 0, 0}, {13.33333, 37.71236, 0}, {-13.33333, 18.85618, 32.65986}}}},
                      BoxCase{"symmetric", {{{30, -6, -6}, {-6, 30, -6}, {-6, -6, 30}}}},
                      BoxCase{"left_handed", {{{0, 20, 3}, {25, 1, 0}, {4, -3, 30}}}}),
    [](const auto &info) { return std::string(info.param.name); });

// ---- boxes

TEST_P(BoxTest, MinimumImage) {
  const Lattice lattice(box_);
  Random random(1);
  for (int n = 0; n < 300; ++n) {
    Vector d = random.in_box(box_);
    for (const Vector &v : box_.vectors) d = d + random.integer(-3, 3) * v;
    const Vector image = lattice.minimum_image(d);
    EXPECT_NEAR(length(image), shortest(d, box_, 5), 1e-9);
    for (double x : lattice.fractional(image - d)) EXPECT_NEAR(x, std::round(x), 1e-9);
  }
}

TEST(LatticeTest, ShortVectorsInVerySkewedBoxes) {
  const Box box{{{{20, 0, 0}, {55, 20, 0}, {-47, 33, 20}}}};
  const Lattice lattice(box);
  Random random(2);
  for (int n = 0; n < 300; ++n) {
    const Vector d = random.uniform(0, 0.499 * lattice.min_width()) * random.unit();
    Vector far = d;
    for (const Vector &v : box.vectors) far = far + random.integer(-4, 4) * v;
    EXPECT_NEAR(length(lattice.minimum_image(far) - d), 0, 1e-9);
  }
}

TEST(LatticeTest, Widths) {
  const Lattice lattice(Box{{{{10, 0, 0}, {10, 20, 0}, {0, 0, 30}}}});
  EXPECT_NEAR(lattice.widths()[0], 10 * std::cos(std::atan(0.5)), 1e-12);
  EXPECT_NEAR(lattice.widths()[1], 20, 1e-12);
  EXPECT_NEAR(lattice.widths()[2], 30, 1e-12);
}

TEST(LatticeTest, NoBoxes) {
  EXPECT_FALSE(box_from_vectors({{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}}));
  EXPECT_FALSE(box_from_vectors({{{10, 0, 0}, {0, 10, 0}, {10, 10, 0}}}));
  EXPECT_FALSE(box_from_vectors({{{10, 0, 0}, {0, 10, 0}, {10, 10, 1e-6}}}));
  EXPECT_TRUE(box_from_vectors({{{10, 0, 0}, {0, 10, 0}, {10, 10, 0.1}}}));
  EXPECT_FALSE(box_from_vectors({{{1e-4, 0, 0}, {0, 1e-4, 0}, {0, 0, 1e-4}}}));
  EXPECT_FALSE(box_from_vectors({{{10, 0, 0}, {0, NAN, 0}, {0, 0, 10}}}));
  EXPECT_FALSE(box_from_vectors({{{10, 0, 0}, {0, INFINITY, 0}, {0, 0, 10}}}));
  EXPECT_TRUE(box_from_vectors({{{10, 0, 0}, {0, 10, 0}, {0, 0, -10}}}));
  EXPECT_FALSE(box_from_edges(10, 10, 10, 90, 90, 180));
  EXPECT_FALSE(box_from_edges(10, 10, 10, 90, 90, 200));
  EXPECT_FALSE(box_from_edges(10, 10, 10, 90, NAN, 90));
  EXPECT_FALSE(box_from_edges(10, 10, 10, 0, 90, 90));
  EXPECT_FALSE(box_from_edges(10, 10, 10, 120, 120, 121));  // more than a full turn
  EXPECT_FALSE(box_from_edges(10, 0, 10, 90, 90, 90));
  EXPECT_FALSE(box_from_edges(10, 2e7, 10, 90, 90, 90));  // longer than any file means
  EXPECT_TRUE(box_from_edges(10, 9e6, 10, 90, 90, 90));
}

// ---- bonds

// Compares with all pairs and images, in a box whose atoms lie in it.
void expect_all_bonds(const Box &box, size_t count, size_t least) {
  Random random(3);
  Positions positions;
  Elements elements;
  for (size_t i = 0; i < count; ++i) {
    add(positions, random.in_box(box));
    elements.push_back(i % 5 == 0 ? kOxygen : kCarbon);
  }
  size_t expected = 0;
  for (size_t i = 0; i < count; ++i)
    for (size_t j = i + 1; j < count; ++j) {
      const double radii = (elements[i] == kOxygen ? 0.66 : 0.73) + (elements[j] == kOxygen ? 0.66 : 0.73);
      expected += shortest(position(positions, i) - position(positions, j), box, 2) <= radii + 0.4;
    }
  ASSERT_GE(expected, least);
  random.scatter(positions, box, 2);
  EXPECT_EQ(Unwrapper(elements.data(), positions.data(), count, box).bond_count(), expected);
}

TEST_P(BoxTest, BondsAreAllPairsThatAreNear) { expect_all_bonds(box_, 500, 20); }

// One, two or three cells of the grid along a side: the same cell lies on several sides of another, and two atoms are
// near to several images of each other.
TEST(UnwrapTest, BondsInTinyBoxes) {
  expect_all_bonds(Box{{{{2.5, 0, 0}, {0, 2.6, 0}, {0, 0, 2.7}}}}, 60, 1000);
  expect_all_bonds(Box{{{{2.5, 0, 0}, {0, 4.5, 0}, {0, 0, 6.5}}}}, 60, 500);
  expect_all_bonds(Box{{{{4.5, 0, 0}, {1, 4.5, 0}, {0.5, -0.7, 6}}}}, 60, 300);
  expect_all_bonds(Box{{{{1.2, 0, 0}, {0, 1.3, 0}, {0, 0, 1.4}}}}, 5, 10);  // atoms are near to their own images
}

// Wherever the borders between cells are, and whichever atom is the largest.
TEST(UnwrapTest, LongBondsAreFoundEverywhere) {
  const Elements elements = {kHydrogen, kCarbon, kCarbon, kHydrogen};
  for (size_t axis = 0; axis < 3; ++axis) {
    Box box{{{{9, 0, 0}, {0, 9, 0}, {0, 0, 9}}}};
    box.vectors[axis][axis] = 28.3;
    for (int step = 0; step < 300; ++step) {
      Positions positions = {5, 5, 5, 1, 1, 1, 1, 1, 1, 7, 7, 7};
      positions[3 + axis] = 0.1f * static_cast<float>(step);
      positions[6 + axis] = positions[3 + axis] + 1.85f;
      EXPECT_EQ(Unwrapper(elements.data(), positions.data(), 4, box).bond_count(), 1u) << axis << " " << step;
    }
  }
}

// Next to the border, on its other side, but too near to it to be told from the far one.
TEST(UnwrapTest, BondsOfAtomsAtTheBorder) {
  const Box box{{{{20, 0, 0}, {0, 20, 0}, {0, 0, 20}}}};
  const Elements elements(3, kCarbon);
  for (size_t axis = 0; axis < 3; ++axis) {
    Positions positions(9, 1);
    positions[axis] = -1.5f;
    positions[3 + axis] = -1e-16f;
    positions[6 + axis] = 1.5f;
    const Unwrapper unwrapper(elements.data(), positions.data(), 3, box);
    EXPECT_EQ(unwrapper.bond_count(), 2u) << axis;
    EXPECT_EQ(unwrapper.molecule_count(), 1u) << axis;
  }
}

TEST(UnwrapTest, BondsDependOnElements) {
  const Box box{{{{20, 0, 0}, {0, 20, 0}, {0, 0, 20}}}};
  const auto is_bonded = [&](uint8_t a, uint8_t b, float distance) {
    const Elements elements = {a, b};
    const Positions positions = {19.5f, 1, 1, 19.5f + distance - 20, 1, 1};  // across the boundary
    return Unwrapper(elements.data(), positions.data(), 2, box).bond_count() == 1;
  };
  EXPECT_TRUE(is_bonded(kCarbon, kCarbon, 1.54f));
  EXPECT_FALSE(is_bonded(kCarbon, kCarbon, 2.0f));
  EXPECT_TRUE(is_bonded(kOxygen, kHydrogen, 0.96f));
  EXPECT_FALSE(is_bonded(kOxygen, kHydrogen, 1.6f));     // a hydrogen bond
  EXPECT_FALSE(is_bonded(kHydrogen, kHydrogen, 1.52f));  // of one molecule of water
  EXPECT_TRUE(is_bonded(0, kOxygen, 0.15f));             // a virtual site
  EXPECT_FALSE(is_bonded(255, kOxygen, 3.0f));           // no element at all
}

// ---- molecules

TEST_P(BoxTest, ChainsAreMadeWhole) {
  Random random(4);
  Positions chain;
  Vector x = random.in_box(box_);
  const Vector direction = 1 / length(box_.vectors[0]) * box_.vectors[0];
  for (int i = 0; i < 5; ++i, x = x + 1.5 * direction) add(chain, x);
  const Elements elements(5, kCarbon);
  Positions first = chain;
  random.scatter(first, box_, 1);
  const Unwrapper unwrapper(elements.data(), first.data(), 5, box_);
  EXPECT_EQ(unwrapper.bond_count(), 4u);
  EXPECT_EQ(unwrapper.molecule_count(), 1u);
  for (int frame = 0; frame < 20; ++frame) {
    Positions scattered = chain;
    random.scatter(scattered, box_, 3);
    Positions whole = scattered;
    unwrapper.apply(box_, whole.data());
    EXPECT_EQ(position(whole, 0), position(scattered, 0));  // the first atom stays
    expect_whole_multiples(scattered, whole, box_);
    for (size_t i = 0; i < 5; ++i)
      EXPECT_NEAR(length(position(whole, i) - position(whole, 0)), 1.5 * static_cast<double>(i), 1e-3);
  }
}

// Water, in the order O H H and in the order H O H, moving through the box.
TEST_P(BoxTest, WaterIsMadeWhole) {
  Random random(5);
  std::vector<Vector> places;
  while (places.size() < 8) {
    const Vector place = random.in_box(box_);
    const auto is_near = [&](const Vector &other) { return shortest(place - other, box_, 3) < 3.6; };
    if (std::none_of(places.begin(), places.end(), is_near)) places.push_back(place);
  }
  Positions positions;
  Elements elements;
  std::vector<size_t> oxygens;
  for (size_t m = 0; m < places.size(); ++m) {
    const Vector along = random.unit();
    Vector across = random.unit();
    const double dot = across[0] * along[0] + across[1] * along[1] + across[2] * along[2];
    across = across - dot * along;
    across = 1 / length(across) * across;
    const Vector h1 = places[m] + 0.5859 * along + 0.7572 * across, h2 = places[m] + 0.5859 * along - 0.7572 * across;
    oxygens.push_back(3 * m + m % 2);
    for (const Vector &x : m % 2 ? std::vector<Vector>{h1, places[m], h2} : std::vector<Vector>{places[m], h1, h2})
      add(positions, x);
    for (size_t i = 0; i < 3; ++i) elements.push_back(i == m % 2 ? kOxygen : kHydrogen);
  }
  random.scatter(positions, box_, 1);
  const Unwrapper unwrapper(elements.data(), positions.data(), elements.size(), box_);
  EXPECT_EQ(unwrapper.bond_count(), 16u);
  EXPECT_EQ(unwrapper.molecule_count(), 8u);
  for (int frame = 0; frame < 10; ++frame) {
    for (size_t m = 0; m < 8; ++m) {
      const Vector move = 2.0 * random.unit();
      for (size_t i = 9 * m; i < 9 * m + 9; ++i) positions[i] += static_cast<float>(move[i % 3]);
    }
    random.scatter(positions, box_, 1);
    Positions whole = positions;
    unwrapper.apply(box_, whole.data());
    expect_whole_multiples(positions, whole, box_);
    for (size_t m = 0; m < 8; ++m)
      for (size_t i = 3 * m; i < 3 * m + 3; ++i) {
        const double distance = length(position(whole, i) - position(whole, oxygens[m]));
        EXPECT_NEAR(distance, i == oxygens[m] ? 0 : 0.9574, 1e-3);
      }
  }
}

// The box changes with time: its vectors in the frame count, not those of the first frame.
TEST(UnwrapTest, BoxOfTheFrame) {
  const Elements elements = {kCarbon, kCarbon};
  const Box first{{{{20, 0, 0}, {0, 20, 0}, {0, 0, 20}}}}, later{{{{24, 0, 0}, {3, 22, 0}, {0, 0, 21}}}};
  const Positions start = {0.5f, 0.5f, 0.5f, 19.5f, 0.5f, 19.5f};
  const Unwrapper unwrapper(elements.data(), start.data(), 2, first);
  ASSERT_EQ(unwrapper.molecule_count(), 1u);
  Positions positions = {0.5f, 0.5f, 0.5f, 26.5f, 21.5f, 20.5f};  // -0.5, -0.5, -0.5 and all three vectors
  unwrapper.apply(later, positions.data());
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(positions[3 + axis], -0.5, 1e-5);
}

// An ion that joins both ends of a chain in the first frame and leaves later must not tear the chain, whichever of them
// come first.
TEST(UnwrapTest, IonsDoNotHoldMoleculesTogether) {
  const Box box{{{{30, 0, 0}, {0, 30, 0}, {0, 0, 30}}}};
  for (const size_t ion : {7u, 0u}) {
    Elements elements = {kOxygen, kCarbon, kCarbon, kCarbon, kCarbon, kCarbon, kOxygen};
    Positions positions;
    for (size_t i = 0; i < 7; ++i) {  // most of a ring with the ion in its middle
      const double turn = 0.7 * static_cast<double>(i);
      add(positions, {15 + 2.1 * std::cos(turn), 15 + 2.1 * std::sin(turn), 15});
    }
    elements.insert(elements.begin() + static_cast<std::ptrdiff_t>(ion), kCalcium);
    positions.insert(positions.begin() + static_cast<std::ptrdiff_t>(3 * ion), 3, 15.f);
    const Unwrapper unwrapper(elements.data(), positions.data(), elements.size(), box);
    EXPECT_EQ(unwrapper.molecule_count(), 1u);
    const size_t first = ion == 0 ? 1 : 0;
    for (double place = 1; place < 30; place += 2) {
      SCOPED_TRACE(place);
      Positions moved = positions;
      moved[3 * ion] = static_cast<float>(place);  // the ion goes through the box
      Positions whole = moved;
      unwrapper.apply(box, whole.data());
      for (size_t i = first; i < first + 7; ++i)
        EXPECT_NEAR(
            length((position(whole, i) - position(whole, first)) - (position(moved, i) - position(moved, first))), 0,
            1e-4);
    }
  }
}

// Both ends of a chain touch in the first frame: nearer to each other than atoms of sulfur that are bonded, but not for
// hydrogen. Later the chain is longer than half of the box.
TEST(UnwrapTest, ContactsDoNotTakeThePlaceOfLongBonds) {
  const Box box{{{{12, 0, 0}, {0, 20, 0}, {0, 0, 20}}}};
  const Elements elements = {kHydrogen, kSulfur, kSulfur, kSulfur, kSulfur, kHydrogen};
  const Positions ring = {4.525f, 2.469f, 5, 3.3f,  1.926f, 5, 4,      0,      5,
                          6.05f,  0,      5, 6.75f, 1.926f, 5, 5.525f, 2.469f, 5};
  const Unwrapper unwrapper(elements.data(), ring.data(), 6, box);
  EXPECT_EQ(unwrapper.bond_count(), 6u);
  EXPECT_EQ(unwrapper.molecule_count(), 1u);
  Positions chain;
  for (const double x : {0.0, 1.34, 3.39, 5.44, 7.49, 8.83}) add(chain, {x, 5, 5});
  Positions scattered = chain;
  Random(7).scatter(scattered, box, 2);
  unwrapper.apply(box, scattered.data());
  for (size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(length((position(scattered, i) - position(scattered, 0)) - (position(chain, i) - position(chain, 0))),
                0, 1e-4)
        << i;
}

// In a box of one cell the first two are near to each other on both sides. The nearer image counts, or the bonds of the
// third would come first.
TEST(UnwrapTest, OfSeveralImagesTheNearestCounts) {
  const Box box{{{{3, 0, 0}, {0, 5, 0}, {0, 0, 20}}}};
  const Elements elements(3, kCarbon);
  const Positions triangle = {0, 1, 5, 1.3f, 1, 5, 0.769f, 1, 6.403f};  // 1.3 and 1.7, 1.5, 1.6 apart
  const Unwrapper unwrapper(elements.data(), triangle.data(), 3, box);
  EXPECT_EQ(unwrapper.bond_count(), 3u);
  Positions straight = {0, 0.2f, 5, 0, 1.6f, 5, 0, 3, 5};  // the third is nearer to an image of the first
  unwrapper.apply(box, straight.data());
  EXPECT_EQ(straight, (Positions{0, 0.2f, 5, 0, 1.6f, 5, 0, 3, 5}));
}

TEST(UnwrapTest, AtomsThatNeedNotMoveKeepTheirBits) {
  const Box box{{{{20, 0, 0}, {0, 20, 0}, {0, 0, 20}}}};
  const Elements elements(2, kCarbon);
  const Positions before = {1, 1, 1, 1e-20f, -0.f, 1};
  const Unwrapper unwrapper(elements.data(), before.data(), 2, box);
  ASSERT_EQ(unwrapper.bond_count(), 1u);
  Positions after = before;
  unwrapper.apply(box, after.data());
  EXPECT_EQ(std::memcmp(before.data(), after.data(), 6 * sizeof(float)), 0);
}

// A sheet that is bonded to its own images can't be made whole, but stays what it is.
TEST(UnwrapTest, EndlessMolecules) {
  const Box box{{{{15, 0, 0}, {0, 20, 0}, {0, 0, 20}}}};
  const Elements elements(10, kCarbon);
  Positions positions;
  for (size_t i = 0; i < 10; ++i) add(positions, {1.5 * static_cast<double>(i), 10, 10});
  const Unwrapper unwrapper(elements.data(), positions.data(), 10, box);
  EXPECT_EQ(unwrapper.bond_count(), 10u);
  EXPECT_EQ(unwrapper.molecule_count(), 1u);
  Positions whole = positions;
  unwrapper.apply(box, whole.data());
  expect_whole_multiples(positions, whole, box);
}

TEST(UnwrapTest, NoAtomsAndNoBonds) {
  const Box box{{{{15, 0, 0}, {0, 20, 0}, {0, 0, 20}}}};
  Unwrapper(nullptr, nullptr, 0, box).apply(box, nullptr);
  const Elements elements(2, kCarbon);
  const Positions apart = {1, 1, 1, 8, 8, 8};
  EXPECT_EQ(Unwrapper(elements.data(), apart.data(), 2, box).molecule_count(), 2u);
}

TEST(UnwrapTest, RefusesCrowds) {
  const Box box{{{{15, 0, 0}, {0, 20, 0}, {0, 0, 20}}}};
  const Elements elements(200000, kCarbon);
  const Positions positions(600000, 1.0f);
  EXPECT_HAS(error_of(ErrorKind::kInput, [&] { Unwrapper(elements.data(), positions.data(), elements.size(), box); }),
             "on top of each other");
  // Not that many in any cell, but each has hundreds around it.
  Random random(6);
  Positions dense;
  const Box small{{{{14.5, 0, 0}, {0, 14.5, 0}, {0, 0, 14.5}}}};
  constexpr size_t kDense = 60000;
  for (size_t i = 0; i < kDense; ++i) add(dense, random.in_box(small));
  EXPECT_HAS(error_of(ErrorKind::kInput, [&] { Unwrapper(elements.data(), dense.data(), kDense, small); }),
             "on top of each other");
}

// Few atoms may be bonded to each other as they like.
TEST(UnwrapTest, TakesSmallCrowds) {
  constexpr size_t kCount = 1200;
  const Box box{{{{15, 0, 0}, {0, 20, 0}, {0, 0, 20}}}};
  const Unwrapper unwrapper(Elements(kCount, kCarbon).data(), Positions(3 * kCount, 1.0f).data(), kCount, box);
  EXPECT_EQ(unwrapper.bond_count(), kCount * (kCount - 1) / 2);
  EXPECT_EQ(unwrapper.molecule_count(), 1u);
}

// A box far larger than the atoms in it costs no more than another.
TEST(UnwrapTest, HugeBox) {
  const Box box{{{{1e6, 0, 0}, {0, 1e6, 0}, {0, 0, 1e6}}}};
  const Elements elements(3, kCarbon);
  Positions positions = {0.5f, 500000, 500000, 999999.25f, 500000, 500000, 500000, 500000, 500000};
  const Unwrapper unwrapper(elements.data(), positions.data(), 3, box);
  EXPECT_EQ(unwrapper.bond_count(), 1u);
  unwrapper.apply(box, positions.data());
  EXPECT_EQ(positions[3], -0.75f);
  // More cells than can be told apart, were they as small as elsewhere.
  const Box largest{{{{9e6, 0, 0}, {0, 9e6, 0}, {0, 0, 9e6}}}};
  for (size_t axis = 0; axis < 3; ++axis) {
    Positions pair = {0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f};
    pair[axis] = -0.5f;
    EXPECT_EQ(Unwrapper(elements.data(), pair.data(), 2, largest).bond_count(), 1u) << axis;
  }
}

}  // namespace
}  // namespace quickses::io
