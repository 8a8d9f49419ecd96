// SPDX-License-Identifier: MIT
// First stage: the caller's atoms, moved into the centred frame and inflated by the probe.
#pragma once

#include "surface/geometry/lattice.h"
#include "surface/memory/atom_set.h"

#include <cmath>

namespace quickses {

struct CenteredAtomAt {
  const Sphere *given;
  double x, y, z;
  float scale, probe;  // radius times scale, and the probe
  QSES_HOST_DEVICE Sphere operator()(size_t i) const {
    const Sphere a = load(given + i);
    return {glm::vec3(static_cast<float>(static_cast<double>(a.center.x) - x),
                      static_cast<float>(static_cast<double>(a.center.y) - y),
                      static_cast<float>(static_cast<double>(a.center.z) - z)),
            scale * a.radius + probe};
  }
};

// The centred frame's origin: the brick corner nearest below the middle of the atoms.
inline Lattice center_lattice(const AtomBounds &bounds, float spacing) {
  Lattice lattice{};
  lattice.spacing = spacing;
  const double size = static_cast<double>(spacing) * kBrickEdge;
  double center[3];
  for (int d = 0; d < 3; ++d)
    center[d] =
        std::floor(0.5 * (static_cast<double>(bounds.low[d]) + static_cast<double>(bounds.high[d])) / size) * size;
  lattice.center_x = center[0];
  lattice.center_y = center[1];
  lattice.center_z = center[2];
  return lattice;
}

}  // namespace quickses
