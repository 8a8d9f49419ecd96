// SPDX-License-Identifier: MIT
// Molecules made whole across periodic boundaries: bonds of one frame by distance, found with a periodic cell
// grid; a spanning tree of each molecule; in every frame each atom is put next to its parent in the tree.
#include "io/unwrap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <gemmi/elem.hpp>
#include <numeric>

#include "io/disjoint_sets.h"
#include "io/error.h"

namespace quickses::io {
namespace {

using Vector = Lattice::Vector;

constexpr double kTolerance = 0.4;                 // Å, above the sum of covalent radii
constexpr int64_t kMaxCellsPerAxis = 1 << 20;      // three of them make a key of 60 bits
constexpr uint64_t kMaxPairsPerAtom = 500;         // in one cell; molecules need some 70 at most
constexpr uint64_t kMinPairsRefused = 10'000'000;  // small systems may do without a grid
constexpr uint64_t kMaxBondsPerAtom = 100;
constexpr float kMetalStretch = 100;  // makes bonds of metals the last ones

struct Bond {
  uint32_t a, b;
  float stretch;  // distance over the sum of radii; + kMetalStretch with a metal
};

bool comes_first(const Bond &x, const Bond &y) {
  if (x.stretch != y.stretch) return x.stretch < y.stretch;
  return x.a != y.a ? x.a < y.a : x.b < y.b;
}

gemmi::El element_of(uint8_t number) { return gemmi::El(number < uint8_t(gemmi::El::END) ? number : 0); }

// Finds pairs of atoms by cells of a grid that fills the box; the cells that have atoms are sorted by key.
class BondFinder {
 public:
  BondFinder(const uint8_t *elements, const float *positions, size_t atom_count, const Box &box) : box_(box) {
    float max_radius = 0;
    for (size_t i = 0; i < atom_count; ++i)
      max_radius = std::max(max_radius, gemmi::covalent_radius(element_of(elements[i])));
    const Lattice lattice(box);
    for (int axis = 0; axis < 3; ++axis) {
      const double fits = std::floor(lattice.widths()[axis] / ((2 * max_radius + kTolerance) * 1.001));
      cells_[axis] = fits < 1 ? 1 : static_cast<int64_t>(std::min<double>(fits, kMaxCellsPerAxis));
    }
    fill(elements, positions, atom_count, lattice);
  }

  std::vector<Bond> run() {
    check_density();
    for (size_t c = 0; c + 1 < starts_.size(); ++c) {
      test_within(c);
      for (int step = 14; step < 27; ++step) test_neighbor(c, {step / 9 - 1, step / 3 % 3 - 1, step % 3 - 1});
      if (bonds_.size() > kMinPairsRefused && bonds_.size() > kMaxBondsPerAtom * atoms_.size()) fail_crowded();
    }
    if (*std::min_element(cells_.begin(), cells_.end()) == 1) remove_doubles();
    return std::move(bonds_);
  }

 private:
  struct Atom {
    uint64_t key;  // of its cell
    uint32_t index;
    float radius;     // negative for metals
    Vector position;  // in the box
  };

  static uint64_t key_of(const std::array<int64_t, 3> &cell) {
    return static_cast<uint64_t>((cell[0] * kMaxCellsPerAxis + cell[1]) * kMaxCellsPerAxis + cell[2]);
  }

  void fill(const uint8_t *elements, const float *positions, size_t atom_count, const Lattice &lattice) {
    atoms_.resize(atom_count);
    for (size_t i = 0; i < atom_count; ++i) {
      Vector x = {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]};
      const Vector f = lattice.fractional(x);
      std::array<int64_t, 3> cell;
      for (int k = 0; k < 3; ++k) {
        const double whole = std::floor(f[k]);
        for (int axis = 0; axis < 3; ++axis) x[axis] -= whole * box_.vectors[k][axis];
        cell[k] = std::min(static_cast<int64_t>((f[k] - whole) * static_cast<double>(cells_[k])), cells_[k] - 1);
      }
      const gemmi::El element = element_of(elements[i]);
      const float radius = gemmi::covalent_radius(element);
      atoms_[i] = {key_of(cell), static_cast<uint32_t>(i), gemmi::is_metal(element) ? -radius : radius, x};
    }
    std::sort(atoms_.begin(), atoms_.end(),
              [](const Atom &a, const Atom &b) { return a.key != b.key ? a.key < b.key : a.index < b.index; });
    for (size_t i = 0; i < atom_count; ++i)
      if (i == 0 || atoms_[i].key != atoms_[i - 1].key) starts_.push_back(i);
    starts_.push_back(atom_count);
  }

  void check_density() const {
    uint64_t pairs = 0;
    for (size_t c = 0; c + 1 < starts_.size(); ++c) {
      const uint64_t count = starts_[c + 1] - starts_[c];
      pairs += count * count / 2;
    }
    if (pairs > kMinPairsRefused && pairs > kMaxPairsPerAtom * atoms_.size()) fail_crowded();
  }

  [[noreturn]] static void fail_crowded() {
    fail_input("too many atoms lie on top of each other in their box: no molecules can be found");
  }

  void test_within(size_t c) {
    for (size_t i = starts_[c]; i < starts_[c + 1]; ++i)
      for (size_t j = i + 1; j < starts_[c + 1]; ++j) test(atoms_[i], atoms_[j], {});
  }

  // The cell some steps away, which may lie in the next box; where a box has few cells, that is one met before, or the
  // cell itself: then with other images of its atoms.
  void test_neighbor(size_t c, const std::array<int64_t, 3> &step) {
    const uint64_t own = atoms_[starts_[c]].key;
    std::array<int64_t, 3> cell = {static_cast<int64_t>(own / kMaxCellsPerAxis / kMaxCellsPerAxis),
                                   static_cast<int64_t>(own / kMaxCellsPerAxis % kMaxCellsPerAxis),
                                   static_cast<int64_t>(own % kMaxCellsPerAxis)};
    Vector shift = {};
    for (int k = 0; k < 3; ++k) {
      cell[k] += step[k];
      const int boxes = cell[k] < 0 ? -1 : cell[k] >= cells_[k] ? 1 : 0;
      cell[k] -= boxes * cells_[k];
      for (int axis = 0; axis < 3; ++axis) shift[axis] += boxes * box_.vectors[k][axis];
    }
    const uint64_t key = key_of(cell);
    const auto at = std::lower_bound(starts_.begin(), starts_.end() - 1, key,
                                     [&](size_t start, uint64_t wanted) { return atoms_[start].key < wanted; });
    if (at == starts_.end() - 1 || atoms_[*at].key != key) return;
    for (size_t i = starts_[c]; i < starts_[c + 1]; ++i)
      for (size_t j = at[0]; j < at[1]; ++j)
        if (i != j) test(atoms_[i], atoms_[j], shift);
  }

  void test(const Atom &a, const Atom &b, const Vector &shift) {
    double squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double d = b.position[axis] + shift[axis] - a.position[axis];
      squared += d * d;
    }
    const double radii = std::abs(a.radius) + std::abs(b.radius), reach = radii + kTolerance;
    if (squared > reach * reach) return;
    const bool has_metal = a.radius < 0 || b.radius < 0;
    bonds_.push_back({std::min(a.index, b.index), std::max(a.index, b.index),
                      static_cast<float>(std::sqrt(squared) / radii) + (has_metal ? kMetalStretch : 0)});
  }

  // In boxes of one cell, atoms may be bonded to several images of the same atom.
  void remove_doubles() {
    std::sort(bonds_.begin(), bonds_.end(), [](const Bond &x, const Bond &y) {
      return x.a != y.a ? x.a < y.a : x.b != y.b ? x.b < y.b : x.stretch < y.stretch;
    });
    bonds_.erase(std::unique(bonds_.begin(), bonds_.end(),
                             [](const Bond &x, const Bond &y) { return x.a == y.a && x.b == y.b; }),
                 bonds_.end());
  }

  Box box_;
  std::array<int64_t, 3> cells_ = {1, 1, 1};
  std::vector<Atom> atoms_;     // sorted by cell
  std::vector<size_t> starts_;  // of the cells in atoms_, and the end
  std::vector<Bond> bonds_;
};

}  // namespace

Unwrapper::Unwrapper(const uint8_t *elements, const float *positions, size_t atom_count, const Box &box)
    : molecule_count_(atom_count) {
  std::vector<Bond> bonds = BondFinder(elements, positions, atom_count, box).run();
  bond_count_ = bonds.size();

  // The shortest tree, bonds of metals last: what only seems bonded, or bonded to an ion that will leave, never takes
  // the place of a covalent bond.
  std::sort(bonds.begin(), bonds.end(), comes_first);
  DisjointSets sets(atom_count);
  bonds.erase(std::remove_if(bonds.begin(), bonds.end(), [&](const Bond &bond) { return !sets.join(bond.a, bond.b); }),
              bonds.end());
  molecule_count_ = atom_count - bonds.size();

  std::vector<size_t> starts(atom_count + 1);  // of the neighbours of each atom in the tree
  for (const Bond &bond : bonds) ++starts[bond.a + 1], ++starts[bond.b + 1];
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  std::vector<uint32_t> neighbors(2 * bonds.size());
  std::vector<size_t> next(starts.begin(), starts.end() - 1);
  for (const Bond &bond : bonds) {
    neighbors[next[bond.a]++] = bond.b;
    neighbors[next[bond.b]++] = bond.a;
  }

  links_.reserve(bonds.size());
  std::vector<bool> is_reached(atom_count);
  for (uint32_t root = 0; root < atom_count; ++root) {
    if (is_reached[root]) continue;
    is_reached[root] = true;
    size_t done = links_.size();
    for (uint32_t atom = root;; atom = links_[done++].atom) {  // breadth first: links_ is the queue
      for (size_t k = starts[atom]; k < starts[atom + 1]; ++k) {
        if (is_reached[neighbors[k]]) continue;
        is_reached[neighbors[k]] = true;
        links_.push_back({neighbors[k], atom});
      }
      if (done == links_.size()) break;
    }
  }
}

void Unwrapper::apply(const Box &box, float *positions) const {
  const Lattice lattice(box);
  for (const Link &link : links_) {
    float *x = positions + 3 * link.atom;
    const float *parent = positions + 3 * link.parent;
    Vector d;
    for (int axis = 0; axis < 3; ++axis) d[axis] = static_cast<double>(x[axis]) - parent[axis];
    const Vector nearest = lattice.minimum_image(d);
    if (nearest == d) continue;  // most atoms: keep their bits
    for (int axis = 0; axis < 3; ++axis) x[axis] = static_cast<float>(parent[axis] + nearest[axis]);
  }
}

}  // namespace quickses::io
