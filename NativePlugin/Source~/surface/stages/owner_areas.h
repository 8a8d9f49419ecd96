// SPDX-License-Identifier: MIT
// Area of a mesh that belongs to each atom: a third of every triangle, bent along the normals of its vertices, to each
// of its corners' owners.
#pragma once

#include "parallel/atomics.h"
#include "surface/stages/triangle_measures.h"

namespace quickses {

// Sums as integers, so that they do not depend on the order.
struct AddOwnerAreas {
  MeshView mesh;
  double units;
  int64_t *sums;  // per atom, multiples of 1 / units
  QSES_HOST_DEVICE void operator()(size_t i) const {
    const uint32_t *const t = mesh.triangle(i);
    const double third = measure_triangle(mesh, i, {0.0, 0.0, 0.0}, true).area / 3.0;
    const int64_t share = static_cast<int64_t>(floor(rounded_product(third, units) + 0.5));
    const uint32_t a = mesh.owner(t[0]), b = mesh.owner(t[1]), c = mesh.owner(t[2]);
    if (a == b && b == c) {
      atomic_add(sums + a, 3 * share);
      return;
    }
    atomic_add(sums + a, share);
    atomic_add(sums + b, share);
    atomic_add(sums + c, share);
  }
};

struct StoreOwnerAreas {
  const int64_t *sums;
  double inverse_units;
  double *areas;
  QSES_HOST_DEVICE void operator()(size_t i) const {
    areas[i] = rounded_product(static_cast<double>(sums[i]), inverse_units);
  }
};

// areas: of all atoms, in the back end's memory. spacing: triangles are about that large.
template <class Executor>
void measure_owners(Executor &executor, const MeshView &mesh, size_t triangles, float spacing, size_t atoms,
                    double *areas) {
  const auto mark = executor.arena().mark();
  const Span<int64_t> sums = executor.template allocate_zeros<int64_t>(atoms);
  // All of them together fit, if they are not larger than sixteen squares of the lattice on average.
  int bits = 58;
  for (size_t k = triangles; k > 0; k >>= 1) --bits;
  const double h = static_cast<double>(spacing), units = std::ldexp(1.0, bits) / (h * h);
  executor.for_each(triangles, AddOwnerAreas{mesh, units, sums.data});
  executor.for_each(atoms, StoreOwnerAreas{sums.data, 1.0 / units, areas});
  executor.arena().rewind(mark);
}

}  // namespace quickses
