// SPDX-License-Identifier: MIT
// Makes a case with a fault as small and plain as it can be with the same kind of fault, and prints it as a row of
// property_regressions.h.
#pragma once

#include "properties/property_isolation.h"

namespace properties {

inline Case without_atoms(const Case &c, size_t begin, size_t end) {
  Case out = c;
  out.atoms.positions.erase(out.atoms.positions.begin() + static_cast<std::ptrdiff_t>(3 * begin),
                            out.atoms.positions.begin() + static_cast<std::ptrdiff_t>(3 * end));
  out.atoms.radii.erase(out.atoms.radii.begin() + static_cast<std::ptrdiff_t>(begin),
                        out.atoms.radii.begin() + static_cast<std::ptrdiff_t>(end));
  return out;
}

inline float rounded(float value, int decimals) {
  const double scale = std::pow(10.0, decimals);
  return static_cast<float>(std::round(static_cast<double>(value) * scale) / scale + 0.0);  // + 0: not -0
}

class Shrinker {
 public:
  Shrinker(Runner &runner, int attempts = 400, double seconds = 20)
      : runner_(runner), attempts_(attempts), end_(Clock::now() + std::chrono::milliseconds(int(1000 * seconds))) {}

  // The fault is found anew; without one (it needed the cases before it) the case stays as it is.
  Case shrink(const Case &c, Verdict &verdict) {
    Case best = c;
    const Verdict alone = runner_.run(best, kSeconds);
    if (alone.fault != verdict.fault) return best;
    verdict = alone;
    for (size_t before = 0; before != kept_ + 1 && Clock::now() < end_;) {
      before = kept_ + 1;
      drop_atoms(best, verdict);
      plainer_settings(best, verdict);
      plainer_numbers(best, verdict);
    }
    return best;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr unsigned kSeconds = 10;

  bool keeps(Case &best, Verdict &verdict, const Case &candidate) {
    if (--attempts_ < 0 || Clock::now() > end_) return false;
    const Verdict v = runner_.run(candidate, kSeconds);
    if (v.fault != verdict.fault) return false;
    best = candidate;
    verdict = v;
    ++kept_;
    return true;
  }

  void drop_atoms(Case &best, Verdict &verdict) {
    for (size_t part = best.atoms.size() / 2; part > 0; part /= 2)
      for (size_t begin = 0; begin + part <= best.atoms.size();)
        if (!keeps(best, verdict, without_atoms(best, begin, begin + part))) begin += part;
  }

  template <class Change>
  void change(Case &best, Verdict &verdict, Change apply) {
    Case candidate = best;
    apply(candidate);
    if (std::memcmp(&candidate.settings, &best.settings, sizeof best.settings) != 0 ||
        candidate.comparisons != best.comparisons || candidate.form != best.form ||
        candidate.atoms.positions != best.atoms.positions || candidate.atoms.radii != best.atoms.radii)
      keeps(best, verdict, candidate);
  }

  void plainer_settings(Case &best, Verdict &verdict) {
    change(best, verdict, [](Case &c) { c.comparisons = 0; });
    for (unsigned bit = 1; bit < kPastComparisons; bit *= 2)
      change(best, verdict, [bit](Case &c) { c.comparisons &= ~bit; });
    change(best, verdict, [](Case &c) { c.form = 0; });
    for (unsigned bit = 1; bit < kPastForms; bit *= 2) change(best, verdict, [bit](Case &c) { c.form &= ~bit; });
    change(best, verdict, [](Case &c) { c.settings.creases = 0; });
    change(best, verdict, [](Case &c) { c.settings.gaussian_radius_scale = 1; });
    change(best, verdict, [](Case &c) { c.settings.gaussian_isovalue = 0.5f; });
    change(best, verdict, [](Case &c) { c.settings.patch_types = 0; });
    change(best, verdict, [](Case &c) { c.settings.relaxation_steps = 0; });
    change(best, verdict, [](Case &c) { c.settings.relaxation_steps = std::min(c.settings.relaxation_steps, 1u); });
    for (float probe : {1.4f, 1.f}) change(best, verdict, [probe](Case &c) { c.settings.probe_radius = probe; });
    for (float spacing : {0.5f, 1.f}) change(best, verdict, [spacing](Case &c) { c.settings.spacing = spacing; });
    for (int decimals = 0; decimals < 4; ++decimals) {
      change(best, verdict, [=](Case &c) { c.settings.probe_radius = rounded(c.settings.probe_radius, decimals); });
      change(best, verdict, [=](Case &c) {
        if (rounded(c.settings.spacing, decimals) > 0) c.settings.spacing = rounded(c.settings.spacing, decimals);
      });
    }
  }

  void plainer_numbers(Case &best, Verdict &verdict) {
    change(best, verdict, [](Case &c) {  // the first atom at the origin
      for (size_t k = c.atoms.positions.size(); k-- > 0;) c.atoms.positions[k] -= c.atoms.positions[k % 3];
    });
    for (int decimals = 0; decimals < 4; ++decimals) {
      change(best, verdict, [=](Case &c) {
        for (float &p : c.atoms.positions) p = rounded(p, decimals);
      });
      change(best, verdict, [=](Case &c) {
        for (float &r : c.atoms.radii) r = rounded(r, decimals);
      });
    }
    if (best.atoms.size() > 6) return;
    for (size_t k = 0; k < best.atoms.positions.size(); ++k)
      for (int decimals : {0, 1, 3})
        change(best, verdict, [=](Case &c) { c.atoms.positions[k] = rounded(c.atoms.positions[k], decimals); });
    for (size_t k = 0; k < best.atoms.size(); ++k)
      for (int decimals : {0, 1, 3})
        change(best, verdict, [=](Case &c) { c.atoms.radii[k] = rounded(c.atoms.radii[k], decimals); });
  }

  Runner &runner_;
  int attempts_;
  Clock::time_point end_;
  size_t kept_ = 0;
};

inline std::string number(float value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", static_cast<double>(value));
  return text;
}

inline std::string row_of(const Case &c) {
  constexpr const char *surfaces[] = {"kSes", "kSas", "kVdw", "kGaussian"};
  std::string row = "{\"" + c.family + "\", " + surfaces[c.settings.surface] + ", " +
                    (c.settings.method == QSES_METHOD_GRID ? "kGrid" : "kExact") + ", " +
                    number(c.settings.probe_radius) + ", " + number(c.settings.spacing) + ", " +
                    std::to_string(c.settings.relaxation_steps) + ", " + std::to_string(c.comparisons) + ", {";
  for (size_t i = 0; i < c.atoms.size(); ++i) {
    if (i >= 100) return row + " ... " + std::to_string(c.atoms.size()) + " atoms";
    row += i ? ", {" : "{";
    for (size_t d = 0; d < 3; ++d) row += number(c.atoms.positions[3 * i + d]) + ", ";
    row += number(c.atoms.radii[i]) + "}";
  }
  row += c.settings.creases ? "}, 1" : "}";
  const bool gaussian = c.settings.surface == QSES_SURFACE_GAUSSIAN;
  if (c.form || gaussian) row += (c.settings.creases ? ", " : ", 0, ") + std::to_string(c.form);
  if (gaussian) row += ", " + number(c.settings.gaussian_radius_scale) + ", " + number(c.settings.gaussian_isovalue);
  return row + "},";
}

}  // namespace properties
