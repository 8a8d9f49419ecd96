// SPDX-License-Identifier: MIT
// Any few atoms, on a grid where much is degenerate or as good as anywhere, with any settings: what must hold for
// random sets of atoms (properties/) must hold for these.
#include "fuzz/fuzz.h"
#include "properties/property_checker.h"

#include <algorithm>
#include <cmath>

namespace fuzz {
namespace {

using properties::Case;

void choose_settings(Choices *in, qses_settings *s) {
  s->surface = in->among({QSES_SURFACE_SES, QSES_SURFACE_SAS, QSES_SURFACE_VDW, QSES_SURFACE_GAUSSIAN});
  s->method = s->surface == QSES_SURFACE_SES && in->below(5) == 1 ? QSES_METHOD_GRID : QSES_METHOD_EXACT;
  s->probe_radius = in->among({1.4f, 0.f, 0.04f, 0.0625f, 0.75f, 3.f, 6.f, 12.f});
  s->spacing = in->among({1.f, 0.5f, 0.7f, 2.f, 3.f, 6.f, 0.3f, 1.5f});
  s->relaxation_steps = static_cast<uint32_t>(in->below(4));
  const bool has_sheets = s->method == QSES_METHOD_EXACT && s->surface != QSES_SURFACE_GAUSSIAN;
  s->creases = has_sheets && in->yes();
  s->patch_types = has_sheets && in->yes();
  s->components = 1;
}

void choose_atoms(Choices *in, surface_fixture::Atoms *atoms) {
  constexpr size_t kMost = 10;
  const bool is_on_grid = !in->yes();
  const auto number = [&](float low, float high, float step) {
    const float x = in->between(low, high);
    return is_on_grid ? std::round(x / step) * step : x;
  };
  while (in->left() > 0 && atoms->size() < kMost) {
    const float x = number(-8, 8, 0.25f), y = number(-8, 8, 0.25f), z = number(-8, 8, 0.25f);
    atoms->add(x, y, z, std::max(0.0625f, number(0, 4, 0.25f)));
  }
}

// So many cells of the lattice at the surface take milliseconds.
float affordable_spacing(const Case &c) {
  constexpr double kMostCells = 2500;
  const double reach = c.settings.surface == QSES_SURFACE_GAUSSIAN ? 4 : properties::inflation(c.settings);
  const double scale = c.settings.method == QSES_METHOD_GRID ? 4 : 1;
  return static_cast<float>(std::sqrt(scale * properties::rough_area(c.atoms, reach) / kMostCells));
}

}  // namespace

void try_surface(const uint8_t *data, size_t size) {
  static properties::Checker checker;
  Choices in(data, size);
  Case c;
  c.family = "fuzz";
  c.seed = in.byte();
  c.comparisons = in.yes() ? in.byte() % unsigned{properties::kPastComparisons} : 0;
  if (in.yes())
    for (int bytes = 0; bytes < 3; ++bytes) c.form = (c.form << 8 | in.byte()) % properties::kPastForms;
  qses_settings_init(&c.settings);
  choose_settings(&in, &c.settings);
  choose_atoms(&in, &c.atoms);
  c.settings.spacing = std::max(c.settings.spacing, affordable_spacing(c));
  const properties::Verdict verdict = checker.check(c);
  require(verdict.good(), verdict.sentence);
}

}  // namespace fuzz
