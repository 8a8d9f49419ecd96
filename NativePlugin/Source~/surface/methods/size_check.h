// SPDX-License-Identifier: MIT
// Refuses a spacing that is hopelessly fine before any time is spent on it: a rough prediction of bytes from the
// exposed area of the inflated spheres, which the surface's own area is never far from.
#pragma once

#include "surface/methods/level_work.h"

#include <algorithm>
#include <cmath>

namespace quickses {

// Exposed area of an atom's inflated sphere, by the twelve corners of an icosahedron.
struct ExposedArea {
  FeatureView features;
  QSES_HOST_DEVICE double operator()(size_t i) const {
    const Sphere atom = features.atoms.items[i];
    const uint32_t k = static_cast<uint32_t>(i);
    if (features.cap_ranges[k].count == kBuriedAtom) return 0.0;
    const float a = 0.5257311f, b = 0.8506508f;
    int exposed = 0;
    for (int corner = 0; corner < 12; ++corner) {
      const float u = corner & 1 ? a : -a, v = corner & 2 ? b : -b;
      const Vec3<float> d = corner < 4   ? Vec3<float>(0.f, u, v)
                            : corner < 8 ? Vec3<float>(u, v, 0.f)
                                         : Vec3<float>(v, 0.f, u);
      exposed += is_exposed(features, k, d, 1.f) ? 1 : 0;
    }
    const double radius = static_cast<double>(atom.radius);
    return 4.0 * 3.14159265358979 * radius * radius * exposed / 12.0;
  }
};

// As measured on proteins: vertices per Å² / spacing², half as many as triangles, and per leaf that has any.
constexpr double kVerticesPerCell = 1.5, kVerticesPerLeaf = 14;
// Bricks of a surface of that area: those it passes, and those that arcs alone make active, within a probe radius of
// them. Measured on proteins, the more generous figures.
inline double guess_bricks(double atoms, double area, double spacing) {
  return (0.0254 * area + 0.07 * atoms / spacing) / (spacing * spacing);
}
// Coarser spacings are never refused here, and a prediction only if it fails by these factors.
constexpr float kCheckedSpacing = 0.25f;
constexpr double kCertainty = 1.5, kMemoryCertainty = 2;

// From the features, before any brick is looked for.
template <class Work>
SurfaceSize predict_size(Work &work) {
  const double h = static_cast<double>(work.parameters.spacing);
  const double area = work.executor.reduce(work.features.atoms.count, ExposedArea{work.features},
                                           64 + 6 * uint64_t(work.features.most_caps)),
               cells = area / (h * h);
  const double vertices = cells * kVerticesPerCell;
  return {guess_bricks(static_cast<double>(work.features.atoms.count), area, h), vertices, 2.0 * vertices,
          vertices / kVerticesPerLeaf};
}

// available: bytes; 0: not known. needed: of them, if the surface has the predicted size.
inline void refuse_hopeless_spacing(double spacing, const SurfaceSize &predicted, double needed, double available) {
  char text[240];
  constexpr auto kMostTriangles = static_cast<double>(kMostNumbered);
  const double would_do =
      spacing * std::sqrt(std::max(predicted.triangles / kMostTriangles, available > 0 ? needed / available : 0.0));
  if (predicted.triangles > kCertainty * kMostTriangles) {
    std::snprintf(text, sizeof text,
                  "spacing %g Å is too fine for this structure: about %.2g triangles, more than 32-bit indices can "
                  "name; about %.2g Å would do",
                  spacing, predicted.triangles, would_do);
    throw Error(QSES_TOO_FINE, text);
  }
  if (available > 0 && needed > kMemoryCertainty * available) {
    std::snprintf(text, sizeof text,
                  "spacing %g Å needs about %s of memory for this structure, but %s are available; about %.2g Å "
                  "would do",
                  spacing, describe_bytes(static_cast<uint64_t>(needed)).c_str(),
                  describe_bytes(static_cast<uint64_t>(available)).c_str(), would_do);
    throw Error(QSES_OUT_OF_MEMORY, text);
  }
}

}  // namespace quickses
