// SPDX-License-Identifier: MIT
// Positions are checked and copied several at a time: it must not matter where among them an atom is, nor how they lie.
#include "capi/atoms_in.h"
#include "parallel/error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <random>
#include <string>

using namespace quickses;

namespace {

constexpr size_t kMostAtoms = 41;
constexpr float kInf = std::numeric_limits<float>::infinity();

struct Given {
  std::vector<float> positions, radii;
  explicit Given(size_t count) : positions(3 * count), radii(count) {
    std::mt19937 random(static_cast<unsigned>(count) + 1);
    std::uniform_real_distribution<float> coordinate(-1e6f, 1e6f), radius(0.1f, 3.f);
    for (float &x : positions) x = coordinate(random);
    for (float &r : radii) r = radius(random);
  }
  size_t count() const { return radii.size(); }
};

// Who help with many.
CpuThreads *threads() {
  static CpuThreads four(4);
  return &four;
}

struct Copied {
  std::vector<Sphere> atoms;
  AtomBounds bounds;
};
Copied copy_by(CpuThreads *who, const Given &given) {
  Copied c{std::vector<Sphere>(given.count()), {}};
  c.bounds = copy_atoms(given.positions.data(), 0, given.radii.data(), given.count(), c.atoms.data(), who);
  return c;
}
Copied copy(const Given &given) { return copy_by(threads(), given); }
// Each position followed by so many other floats, which are no numbers.
Copied copy_apart(const Given &given, size_t others) {
  std::vector<float> apart;
  for (size_t i = 0; i < given.count(); ++i) {
    apart.insert(apart.end(), &given.positions[3 * i], &given.positions[3 * i] + 3);
    apart.insert(apart.end(), others, std::numeric_limits<float>::quiet_NaN());
  }
  Copied c{std::vector<Sphere>(given.count()), {}};
  c.bounds = copy_atoms(apart.data(), 12 + 4 * others, given.radii.data(), given.count(), c.atoms.data(), threads());
  return c;
}
// From among others, in another order.
Copied copy_indexed(const Given &given) {
  const size_t n = given.count();
  std::vector<float> among(6 * n, std::numeric_limits<float>::quiet_NaN());
  std::vector<uint32_t> indices(n);
  for (size_t i = 0; i < n; ++i) {
    indices[i] = static_cast<uint32_t>(2 * (n - 1 - i) + 1);
    std::copy_n(&given.positions[3 * i], 3, &among[3 * indices[i]]);
  }
  check_indices(indices.data(), n, 2 * n);
  Copied c{std::vector<Sphere>(n), {}};
  c.bounds = copy_indexed_atoms(among.data(), 0, indices.data(), given.radii.data(), n, c.atoms.data(), threads());
  return c;
}

void expect_copied(const Copied &copied, const Given &given) {
  glm::vec3 low(kInf), high(-kInf);
  for (size_t i = 0; i < given.count(); ++i) {
    for (int d = 0; d < 3; ++d) {
      const float x = given.positions[3 * i + static_cast<size_t>(d)];
      EXPECT_EQ(copied.atoms[i].center[d], x);
      low[d] = std::min(low[d], x);
      high[d] = std::max(high[d], x);
    }
    EXPECT_EQ(copied.atoms[i].radius, given.radii[i]);
  }
  if (given.count() == 0) low = high = glm::vec3(0.f);
  EXPECT_EQ(copied.bounds.low, low);
  EXPECT_EQ(copied.bounds.high, high);
}

template <class Copy>
void expect_refused(const Copy &copy, const Given &given, size_t atom) {
  try {
    copy(given);
    ADD_FAILURE() << "accepted";
  } catch (const Error &error) {
    EXPECT_NE(std::string(error.what()).find("position of atom " + std::to_string(atom) + " is"), std::string::npos)
        << error.what();
  }
}

TEST(AtomsIn, AreTheSameHoweverTheyLie) {
  for (size_t count = 0; count <= kMostAtoms; ++count) {
    SCOPED_TRACE(count);
    const Given given(count);
    expect_copied(copy(given), given);
    expect_copied(copy_apart(given, 0), given);
    expect_copied(copy_apart(given, 2), given);
    expect_copied(copy_indexed(given), given);
  }
}

TEST(AtomsIn, OneWrongCoordinateIsFoundWhereverItIs) {
  for (const size_t count : {size_t(1), size_t(4), size_t(7), kMostAtoms})
    for (const float wrong : {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::quiet_NaN(), kInf,
                              -kInf, std::nextafter(1e6f, kInf), -std::nextafter(1e6f, kInf)}) {
      Given given(count);
      for (size_t k = 0; k < given.positions.size(); ++k) {
        SCOPED_TRACE(testing::Message() << wrong << " as coordinate " << k << " of " << 3 * count);
        const float right = given.positions[k];
        given.positions[k] = wrong;
        expect_refused(copy, given, k / 3);
        expect_refused([](const Given &g) { return copy_apart(g, 1); }, given, k / 3);
        expect_refused(copy_indexed, given, k / 3);
        given.positions[k] = right;
      }
    }
}

// So many that they are written past the caches, and shared out among threads.
TEST(AtomsIn, MayBeMany) {
  Given given((size_t(1) << 17) + 5);
  const size_t count = given.count();
  for (const Copied &copied : {copy(given), copy_by(nullptr, given), copy_apart(given, 1), copy_indexed(given)}) {
    bool are_same = true;
    glm::vec3 low(kInf), high(-kInf);
    for (size_t i = 0; i < count; ++i) {
      are_same &= copied.atoms[i].radius == given.radii[i];
      for (int d = 0; d < 3; ++d) {
        const float x = given.positions[3 * i + static_cast<size_t>(d)];
        are_same &= copied.atoms[i].center[d] == x;
        low[d] = std::min(low[d], x);
        high[d] = std::max(high[d], x);
      }
    }
    EXPECT_TRUE(are_same);
    EXPECT_EQ(copied.bounds.low, low);
    EXPECT_EQ(copied.bounds.high, high);
  }
  for (const size_t atom : {count - 1, count - 7, count / 2, size_t(0)}) {
    given.positions[3 * atom + 1] = kInf;
    expect_refused(copy, given, atom);
  }
}

// Or are written past the caches by one thread, or not even that.
TEST(AtomsIn, AreSharedOutInWholeChunksOrNot) {
  for (const size_t count :
       {size_t(2047), size_t(2049), size_t(8193), size_t(16383), size_t(16384), size_t(16385), size_t(24576)}) {
    SCOPED_TRACE(count);
    Given given(count);
    const Copied alone = copy_by(nullptr, given);
    for (const Copied &copied : {copy(given), copy_apart(given, 1), copy_indexed(given)}) {
      EXPECT_EQ(std::memcmp(copied.atoms.data(), alone.atoms.data(), count * sizeof(Sphere)), 0);
      EXPECT_EQ(copied.bounds.low, alone.bounds.low);
      EXPECT_EQ(copied.bounds.high, alone.bounds.high);
    }
    for (const size_t atom :
         {size_t(0), std::min(count, size_t(8192)) - 1, std::min(count - 1, size_t(8192)), count - 1}) {
      const float right = given.positions[3 * atom];
      given.positions[3 * atom] = kInf;
      expect_refused(copy, given, atom);
      expect_refused([](const Given &g) { return copy_apart(g, 1); }, given, atom);
      expect_refused(copy_indexed, given, atom);
      given.positions[3 * atom] = right;
    }
  }
}

TEST(AtomsIn, OfSeveralWrongOnesTheFirstIsNamed) {
  Given given(kMostAtoms);
  for (size_t k = given.positions.size(); k-- > 0;) {
    given.positions[k] = k % 2 ? kInf : std::numeric_limits<float>::quiet_NaN();
    expect_refused(copy, given, k / 3);
  }
}

TEST(AtomsIn, CoordinatesAtTheBorderAreAccepted) {
  for (const float border : {1e6f, -1e6f}) {
    Given given(kMostAtoms);
    std::fill(given.positions.begin(), given.positions.end(), border);
    expect_copied(copy(given), given);
  }
}

AtomRadii radii_of(size_t count, float radius, const std::vector<float> &others) {
  std::vector<float> radii(count, radius);
  radii.insert(radii.begin() + static_cast<std::ptrdiff_t>(count / 2), others.begin(), others.end());
  return check_radii(radii.data(), radii.size());
}
void expect_radii(const AtomRadii &found, float largest, float usual, uint32_t large) {
  EXPECT_EQ(found.largest, largest);
  EXPECT_EQ(found.usual, usual);
  EXPECT_EQ(found.large, large);
}

TEST(Radii, FewThatAreMuchLargerThanAllOthersAreToldApart) {
  expect_radii(radii_of(1000, 1.7f, {32.f}), 32.f, 1.7f, 1);
  expect_radii(radii_of(1000, 1.7f, {32.f, 40.f, 31.f}), 40.f, 1.7f, 3);
  expect_radii(radii_of(1000, 1.7f, {100.f, 40.f, 9.f}), 100.f, 1.7f, 3);  // each much larger than the next
  expect_radii(radii_of(1000, 1.7f, std::vector<float>(32, 9.f)), 9.f, 1.7f, 32);
  expect_radii(radii_of(1000, 6.f, {100.f, 11.f}), 100.f, 11.f, 1);
}

TEST(Radii, AreAlikeWhereNothingWouldBeGained) {
  expect_radii(check_radii(nullptr, 0), 0.f, 0.f, 0);
  expect_radii(radii_of(1000, 1.7f, {}), 1.7f, 1.7f, 0);
  expect_radii(radii_of(1000, 1.7f, {8.f}), 8.f, 8.f, 0);                           // all look-ups are short
  expect_radii(radii_of(1000, 1.7f, std::vector<float>(33, 20.f)), 20.f, 20.f, 0);  // many
  expect_radii(radii_of(1000, 5.f, {9.9f}), 9.9f, 9.9f, 0);                         // less than twice as large
  expect_radii(radii_of(6, 1.7f, {50.f}), 50.f, 50.f, 0);                           // one of seven
  expect_radii(radii_of(7, 1.7f, {50.f}), 50.f, 1.7f, 1);                           // and of eight
  expect_radii(radii_of(0, 1.7f, std::vector<float>(100, 50.f)), 50.f, 50.f, 0);    // no others
}

}  // namespace
