// SPDX-License-Identifier: MIT
// Forms in which a surface can be asked for: what is delivered and how it lies in memory, not where the surface is.
#pragma once

#include "properties/property_random.h"
#include "surface/surface_fixture.h"

#include <string>
#include <vector>

namespace properties {

enum Form : unsigned {
  kReversed = 1,
  kInterleaved = 2,
  kCompact = 4,
  kWithoutOwners = 8,
  kColors = 16,
  kTexcoords = 32,
  kOcclusion = 64,
  kWithoutComponents = 128,
  kComponentIds = 256,
  kAtomAreas = 512,
  kHardEdges = 1024,
  kPickable = 2048,
  kHidden = 4096,  // some of the atoms
  kOuterOnly = 8192,
  kPatches = 16384,
  kNotMeasured = 32768,
  kInSlices = 65536,
  kNumbersOnly = 131072,  // QSES_DELIVERY_NONE
  kOnDevice = 262144,     // QSES_DELIVERY_DEVICE, and downloaded; this and the next one with CUDA only
  kOnBoth = 524288,       // QSES_DELIVERY_BOTH
  kPastForms = 1048576
};

constexpr const char *kFormNames[] = {"reversed",     "interleaved", "compact",       "without owners", "colors",
                                      "texcoords",    "occlusion",   "no components", "component ids",  "atom areas",
                                      "hard edges",   "pickable",    "hidden atoms",  "outer only",     "patches",
                                      "not measured", "in slices",   "numbers only",  "on the device",  "on both"};
static_assert(1u << sizeof kFormNames / sizeof *kFormNames == kPastForms, "one name for each");

inline std::string name_of_form(unsigned form) {
  std::string name;
  for (unsigned k = 0; 1u << k < kPastForms; ++k)
    if (form >> k & 1) name += (name.empty() ? "" : ", ") + std::string(kFormNames[k]);
  return name;
}

// A few things that are asked for together; 0: as the first mesh.
inline unsigned choose_form(Random &random) {
  if (!random.chance(1.0 / 3)) return 0;
  constexpr unsigned kWays = 17;  // those before kNumbersOnly
  unsigned form = 0;
  for (size_t n = random.count(1, 5); n > 0; --n) form |= 1u << random.below(kWays);
  const double where = random.unit();
  if (where < 0.1) form |= kNumbersOnly;
  if (where >= 0.1 && where < 0.4) form |= kOnDevice;
  if (where >= 0.4 && where < 0.5) form |= kOnBoth;
  return form;
}

// Settings without what this surface or back end has not.
inline qses_settings settings_of_form(const qses_settings &first, unsigned form) {
  const bool exact = first.method == QSES_METHOD_EXACT, gaussian = first.surface == QSES_SURFACE_GAUSSIAN,
             cuda = surface_fixture::tested_backend() == QSES_BACKEND_CUDA;
  const auto asks = [form](unsigned way) { return form & way ? 1 : 0; };
  qses_settings s = first;
  s.winding = form & kReversed ? QSES_WINDING_REVERSED : QSES_WINDING_OUTWARD;
  s.vertex_layout = form & kCompact       ? QSES_VERTICES_COMPACT
                    : form & kInterleaved ? QSES_VERTICES_INTERLEAVED
                                          : QSES_VERTICES_SEPARATE;
  s.without_owners = asks(kWithoutOwners);
  s.texcoords = asks(kTexcoords);
  s.occlusion = asks(kOcclusion);
  s.components = !asks(kWithoutComponents);
  s.component_ids = asks(kComponentIds);
  s.atom_areas = exact && asks(kAtomAreas);
  s.hard_edges = !gaussian && asks(kHardEdges);
  s.pickable = asks(kPickable);
  s.outer_only = asks(kOuterOnly);
  s.patch_types = exact && !gaussian && asks(kPatches);
  s.measure = !asks(kNotMeasured);
  if (form & kInSlices) s.slice_size = 16;
  s.delivery = form & kNumbersOnly ? QSES_DELIVERY_NONE
               : !cuda             ? QSES_DELIVERY_HOST
               : form & kOnDevice  ? QSES_DELIVERY_DEVICE
               : form & kOnBoth    ? QSES_DELIVERY_BOTH
                                   : QSES_DELIVERY_HOST;
  return s;
}

// Those of the first mesh, which has all that forms are compared with.
inline qses_settings settings_of_first(const qses_settings &wanted, unsigned form) {
  if (form == 0) return wanted;
  qses_settings s = wanted;
  s.components = s.component_ids = 1;
  const qses_settings other = settings_of_form(wanted, form);
  s.atom_areas = other.atom_areas;
  s.occlusion = other.occlusion;
  if (other.patch_types) s.patch_types = 1;
  return s;
}

// What the atoms give to their vertices: of each atom something else.
struct Look {
  std::vector<uint8_t> visible, colors;
  std::vector<float> texcoords;

  explicit Look(size_t atoms, unsigned form) {
    for (size_t i = 0; i < atoms; ++i) {
      const uint32_t hash = (static_cast<uint32_t>(i) + 1) * 2654435761u;
      if (form & kHidden) visible.push_back(hash >> 29 < 2 ? 0 : 1);
      if (form & kColors)
        for (int shift = 0; shift < 32; shift += 8) colors.push_back(static_cast<uint8_t>(hash >> shift));
      if (form & kTexcoords) {
        texcoords.push_back(static_cast<float>(i));
        texcoords.push_back(-0.5f * static_cast<float>(i));
      }
    }
  }
  bool shows(uint32_t atom) const { return visible.empty() || visible[atom]; }

  // Of the context's atoms.
  qses_status set(qses_context *context, size_t atoms) const {
    const auto data = [](const auto &values) { return values.empty() ? nullptr : values.data(); };
    qses_status status = qses_set_visible(context, data(visible), atoms);
    if (status == QSES_OK) status = qses_set_colors(context, data(colors), atoms);
    return status == QSES_OK ? qses_set_texcoords(context, data(texcoords), atoms) : status;
  }
};

}  // namespace properties
