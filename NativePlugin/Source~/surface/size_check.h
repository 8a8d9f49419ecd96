// SPDX-License-Identifier: MIT
// Refuses a spacing that is hopelessly fine before any time is spent on it: a rough prediction of bytes from the
// exposed area of the inflated spheres, which the surface's own area is never far from.
#pragma once

#include "surface/projection.h"
#include "surface/run.h"

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

// Bytes per Å² / spacing²: 1.5 vertices of 28 bytes, 3 triangles of 12, and 344 bytes for each of the
// 1.8 / 64 bricks, as measured on proteins.
constexpr double kVerticesPerCell = 1.5;
constexpr double kBytesPerCell = kVerticesPerCell * 28 + 2 * kVerticesPerCell * 12 + 344 * 1.8 / 64;
// Coarser spacings are never refused here, and a prediction only if it fails by this factor.
constexpr float kCheckedSpacing = 0.25f;
constexpr double kCertainty = 1.5;

template <class R>
void refuse_hopeless_spacing(R &run, const FeatureView &features, uint64_t available_bytes) {
  const double h = static_cast<double>(run.parameters.spacing);
  if (run.parameters.spacing >= kCheckedSpacing) return;
  const double cells = run.executor.reduce(features.atoms.count, ExposedArea{features}) / (h * h);
  const double vertices = cells * kVerticesPerCell, bytes = cells * kBytesPerCell;
  if (2.0 * vertices > kCertainty * 4294967295.0) {
    char text[200];
    std::snprintf(text, sizeof text,
                  "spacing %g Å is too fine for this structure: about %.2g triangles, more than 32-bit indices can "
                  "name; about %.2g Å would do",
                  h, 2.0 * vertices, h * std::sqrt(2.0 * vertices / 4294967295.0));
    throw Error(QSES_TOO_FINE, text);
  }
  if (available_bytes > 0 && bytes > kCertainty * static_cast<double>(available_bytes)) {
    char text[200];
    std::snprintf(
        text, sizeof text,
        "spacing %g Å needs about %s of memory for this structure, but %s are available; about %.2g Å would do", h,
        describe_bytes(static_cast<uint64_t>(bytes)).c_str(), describe_bytes(available_bytes).c_str(),
        h * std::sqrt(bytes / static_cast<double>(available_bytes)));
    throw Error(QSES_OUT_OF_MEMORY, text);
  }
}

}  // namespace quickses
