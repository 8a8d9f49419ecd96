// SPDX-License-Identifier: MIT
// Random atoms and settings for random_use_test.cpp, good ones and some that are to be refused.
#pragma once

#include "capi/random_use_meshes.h"

namespace random_use {

inline Atoms random_atoms(Random &random) {
  const double kind = random.unit();
  const size_t count = kind < 0.05 ? 0 : kind < 0.7 ? random.count(1, 40) : random.count(41, 300);
  const double edge = random.uniform(1.2, 2.6) * std::cbrt(static_cast<double>(count) + 1);
  Atoms atoms;
  for (size_t k = 0; k < count; ++k) {
    const properties::Point p = random.in_box(edge);
    atoms.add(p.x, p.y, p.z, random.uniform(1.0, 2.0));
  }
  return atoms;
}

// Atoms so far apart that the finest spacing is too fine for them.
inline Atoms wide_atoms() { return Atoms().add(-9e4, 0, 0, 1.5).add(9e4, 0, 0, 1.7).add(9e4, 1, 0, 1.2); }

inline Atoms moved(const Atoms &atoms, Random &random) {
  Atoms out = atoms;
  for (float &p : out.positions) p += static_cast<float>(random.uniform(-0.4, 0.4));
  return out;
}

// Settings that are allowed, and cheap.
inline qses_settings good_settings(Random &random, const Frame *frame) {
  qses_settings s;
  qses_settings_init(&s);
  s.surface = static_cast<qses_surface>(random.below(4));
  s.spacing = static_cast<float>(random.uniform(0.6, 1.6));
  s.probe_radius = random.chance(0.7) ? 1.4f : static_cast<float>(random.uniform(0, 3));
  s.relaxation_steps = static_cast<uint32_t>(random.below(3));
  s.slice_size = random.chance(0.2) ? static_cast<uint32_t>(random.count(8, 24)) : 0;
  s.winding = static_cast<qses_winding>(random.below(2));
  s.measure = random.chance(0.6);
  s.vertex_layout = static_cast<qses_vertex_layout>(random.below(3));
  s.texcoords = random.chance(0.2);
  s.components = random.chance(0.3);
  s.component_ids = random.chance(0.3);
  s.outer_only = random.chance(0.2);
  s.occlusion = random.chance(0.15);
  s.pickable = random.chance(0.3);
  s.without_owners = random.chance(0.15);
  if (random.chance(0.1)) s.delivery = QSES_DELIVERY_NONE;
  s.series = static_cast<uint32_t>(random.below(3));
  s.level_count = static_cast<uint32_t>(random.below(4));
  float level = 4.f;
  for (uint32_t k = 0; k < s.level_count; ++k) s.levels[k] = level *= static_cast<float>(random.uniform(0.4, 0.9));
  if (random.chance(0.3)) {  // lattices with a point in common
    s.spacing = 1.f;
    s.level_count = 2;
    s.levels[0] = 4.f;
    s.levels[1] = 2.f;
  }
  if (random.chance(0.2)) s.frame_budget_ms = random.chance(0.5) ? 1e-3f : 2.f;
  if (random.chance(0.3)) s.show_ms_per_mb = static_cast<float>(random.uniform(0, 20));
  const bool grid = random.chance(0.3), creases = random.chance(0.3), hard_edges = random.chance(0.3),
             patches = random.chance(0.3), areas = random.chance(0.3);
  if (grid && s.surface == QSES_SURFACE_SES) s.method = QSES_METHOD_GRID;
  s.hard_edges = hard_edges && s.surface != QSES_SURFACE_GAUSSIAN;
  s.creases = creases && s.surface != QSES_SURFACE_GAUSSIAN && s.method != QSES_METHOD_GRID;
  s.patch_types = patches && s.surface != QSES_SURFACE_GAUSSIAN && s.method != QSES_METHOD_GRID;
  s.atom_areas = areas && s.method != QSES_METHOD_GRID;
  if (random.chance(0.5) && frame && frame->is_wide) s.spacing = 0.001f;
  return s;
}

// One thing about them becomes wrong.
inline void spoil(qses_settings *s, Random &random) {
  switch (random.below(10)) {
    case 0:
      s->spacing = 0;
      break;
    case 1:
      s->spacing = kNan;
      break;
    case 2:
      s->probe_radius = -1;
      break;
    case 3:
      s->relaxation_steps = 101;
      break;
    case 4:
      s->level_count = QSES_MAX_LEVELS + 1;
      break;
    case 5:
      s->level_count = 2;
      s->levels[0] = s->levels[1] = 2;
      break;
    case 6:
      set_any(&s->surface, 4);
      break;
    case 7:
      s->struct_size = 6;
      break;
    case 8:
      s->frame_budget_ms = -1;
      break;
    default:
      s->slice_size = 7;
      break;
  }
}

// One thing about atoms that is to be refused.
inline void spoil(Atoms *atoms, Random &random) {
  const size_t k = static_cast<size_t>(random.below(atoms->size()));
  switch (random.below(6)) {
    case 0:
      atoms->positions[3 * k + 1] = kNan;
      break;
    case 1:
      atoms->positions[3 * k] = -kInf;
      break;
    case 2:
      atoms->positions[3 * k + 2] = 2e6f;
      break;
    case 3:
      atoms->radii[k] = 0;
      break;
    case 4:
      atoms->radii[k] = 101;
      break;
    default:
      atoms->radii[k] = kNan;
      break;
  }
}

inline std::string in_words(const qses_settings &s) {
  char text[320];
  int used = std::snprintf(text, sizeof text, "surface %d%s, spacing %g, layout %d, delivery %d, levels", s.surface,
                           s.method == QSES_METHOD_GRID ? " GRID" : "", static_cast<double>(s.spacing), s.vertex_layout,
                           s.delivery);
  for (uint32_t k = 0; k < std::min(s.level_count, 4u); ++k)
    used += std::snprintf(text + used, sizeof text - size_t(used), " %g", static_cast<double>(s.levels[k]));
  std::snprintf(text + used, sizeof text - size_t(used), "%s%s%s%s%s%s%s, budget %g ms", s.creases ? ", creases" : "",
                s.hard_edges ? ", hard_edges" : "", s.occlusion ? ", occlusion" : "",
                s.components ? ", components" : "", s.component_ids ? ", component_ids" : "",
                s.outer_only ? ", outer_only" : "", s.without_owners ? ", without_owners" : "",
                static_cast<double>(s.frame_budget_ms));
  return text;
}

}  // namespace random_use
