// SPDX-License-Identifier: MIT
// CPU: the features around a place (stages/local_features.h), by its kernels.
#pragma once

#include "surface/cpu/cpu_kernels.h"

namespace quickses {

struct GatheredFeatures {
  LocalColumns &columns;
  const CpuKernels &kernels;

  bool gather(const FeatureView &f, const Vec3<float> &x, float around) {
    return kernels.gather_local_features(f, x, around, &columns);
  }
  int atom_count() const { return columns.atom_number; }
  uint32_t atom(int k) const { return columns.atoms[k]; }
  int arc_count() const { return columns.arc_number; }
  uint32_t arc(int k) const { return columns.arcs[k]; }
};

inline NearestArc nearest_arc(const FeatureView &, const GatheredFeatures &near_by, const Vec3<float> &x) {
  return near_by.kernels.nearest_local_arc(near_by.columns, x);
}

}  // namespace quickses
