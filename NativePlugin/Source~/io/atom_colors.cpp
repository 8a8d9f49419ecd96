// SPDX-License-Identifier: MIT
// Colours of atoms from what a file says about them.
#include "io/atom_colors.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "io/residue_table.h"

namespace quickses::io {
namespace {

constexpr Rgba of_rgb(uint32_t rgb) {
  return {static_cast<uint8_t>(rgb >> 16), static_cast<uint8_t>(rgb >> 8), static_cast<uint8_t>(rgb), 255};
}

// As Jmol shows the elements (jmol.sourceforge.net/jscolors), which extends the colours of Corey, Pauling and Koltun's
// models. Atomic numbers 1 to 109.
constexpr uint32_t kJmol[] = {
    0xFFFFFF, 0xD9FFFF, 0xCC80FF, 0xC2FF00, 0xFFB5B5, 0x909090, 0x3050F8, 0xFF0D0D,  // H to O
    0x90E050, 0xB3E3F5, 0xAB5CF2, 0x8AFF00, 0xBFA6A6, 0xF0C8A0, 0xFF8000, 0xFFFF30,  // F to S
    0x1FF01F, 0x80D1E3, 0x8F40D4, 0x3DFF00, 0xE6E6E6, 0xBFC2C7, 0xA6A6AB, 0x8A99C7,  // Cl to Cr
    0x9C7AC7, 0xE06633, 0xF090A0, 0x50D050, 0xC88033, 0x7D80B0, 0xC28F8F, 0x668F8F,  // Mn to Ge
    0xBD80E3, 0xFFA100, 0xA62929, 0x5CB8D1, 0x702EB0, 0x00FF00, 0x94FFFF, 0x94E0E0,  // As to Zr
    0x73C2C9, 0x54B5B5, 0x3B9E9E, 0x248F8F, 0x0A7D8C, 0x006985, 0xC0C0C0, 0xFFD98F,  // Nb to Cd
    0xA67573, 0x668080, 0x9E63B5, 0xD47A00, 0x940094, 0x429EB0, 0x57178F, 0x00C900,  // In to Ba
    0x70D4FF, 0xFFFFC7, 0xD9FFC7, 0xC7FFC7, 0xA3FFC7, 0x8FFFC7, 0x61FFC7, 0x45FFC7,  // La to Gd
    0x30FFC7, 0x1FFFC7, 0x00FF9C, 0x00E675, 0x00D452, 0x00BF38, 0x00AB24, 0x4DC2FF,  // Tb to Hf
    0x4DA6FF, 0x2194D6, 0x267DAB, 0x266696, 0x175487, 0xD0D0E0, 0xFFD123, 0xB8B8D0,  // Ta to Hg
    0xA6544D, 0x575961, 0x9E4FB5, 0xAB5C00, 0x754F45, 0x428296, 0x420066, 0x007D00,  // Tl to Ra
    0x70ABFA, 0x00BAFF, 0x00A1FF, 0x008FFF, 0x0080FF, 0x006BFF, 0x545CF2, 0x785CE3,  // Ac to Cm
    0x8A4FE3, 0xA136D4, 0xB31FD4, 0xB31FBA, 0xB30DA6, 0xBD0D87, 0xC70066, 0xCC0059,  // Bk to Rf
    0xD1004F, 0xD90045, 0xE00038, 0xE6002E, 0xEB0026                                 // Db to Mt
};

uint8_t channel(double hue, double saturation) {
  const double place = 6 * (hue - std::floor(hue));  // a trapezium over a circle of 6
  const double full = std::clamp(place < 3 ? place : 4 - place, 0.0, 1.0);
  return static_cast<uint8_t>(std::lround(255 * (1 - saturation * (1 - full))));
}

// Hue from 0 (red) by 1/3 (green) and 2/3 (blue) to 1 (red again), of full value.
Rgba from_hue(double hue, double saturation) {
  return {channel(hue + 1.0 / 3, saturation), channel(hue, saturation), channel(hue - 1.0 / 3, saturation), 255};
}

Rgba mix(Rgba from, Rgba to, double part) {
  Rgba mixed;
  for (size_t i = 0; i < mixed.size(); ++i)
    mixed[i] = static_cast<uint8_t>(std::lround(from[i] + (to[i] - from[i]) * part));
  return mixed;
}

void put(Rgba color, size_t atom, uint8_t *rgba) { std::memcpy(rgba + 4 * atom, color.data(), color.size()); }

void color_by_element(const Structure &structure, uint8_t *rgba) {
  for (size_t i = 0; i < structure.atoms.size(); ++i) {
    const uint8_t element = structure.atoms[i].element;
    if (element >= 1 && element <= std::size(kJmol)) put(of_rgb(kJmol[element - 1]), i, rgba);
  }
}

void color_by_chain(const Structure &structure, uint8_t *rgba) {
  for (size_t i = 0; i < structure.atoms.size(); ++i) {
    const AtomInfo &atom = structure.atoms[i];
    if (!atom.chain.empty()) put(distinct_color(atom.chain_place), i, rgba);
  }
}

// action(atom, traits) for each atom. Ligands have none, whatever their name.
template <class Action>
void for_each_residue_name(const Structure &structure, const Action &action) {
  ResidueTraits traits;
  for (size_t i = 0; i < structure.atoms.size(); ++i) {
    const AtomInfo &atom = structure.atoms[i];
    if (i == 0 || atom.residue_name != structure.atoms[i - 1].residue_name) traits = traits_of(atom.residue_name);
    action(i, atom.is_of_polymer() ? traits : ResidueTraits());
  }
}

Rgba color_of(ResidueClass residue_class, Rgba other) {
  switch (residue_class) {
    case ResidueClass::kNonpolar:
      return of_rgb(0xF2F2F2);
    case ResidueClass::kPolar:
      return of_rgb(0x4DBD5F);
    case ResidueClass::kAcidic:
      return of_rgb(0xE5383B);
    case ResidueClass::kBasic:
      return of_rgb(0x3A6FE0);
    case ResidueClass::kPurine:
      return of_rgb(0xF0A030);
    case ResidueClass::kPyrimidine:
      return of_rgb(0x9B5DE5);
    case ResidueClass::kOther:
      break;
  }
  return other;
}

void color_by_hydropathy(const Structure &structure, uint8_t *rgba) {
  constexpr Rgba kHydrophilic = of_rgb(0x1E90FF), kBetween = of_rgb(0xFFFFFF), kHydrophobic = of_rgb(0xFF4500);
  for_each_residue_name(structure, [&](size_t i, const ResidueTraits &traits) {
    if (!traits.is_amino_acid()) return;
    const double strength = std::abs(traits.hydropathy) / kGreatestHydropathy;
    put(mix(kBetween, traits.hydropathy < 0 ? kHydrophilic : kHydrophobic, strength), i, rgba);
  });
}

void color_by_sequence(const Structure &structure, uint8_t *rgba) {
  for (size_t i = 0; i < structure.atoms.size(); ++i) {
    const double along = static_cast<double>(structure.atoms[i].along_chain);
    if (along >= 0) put(from_hue((1 - along) * 2 / 3, 0.85), i, rgba);  // from blue to red
  }
}

}  // namespace

Rgba distinct_color(size_t k) {
  constexpr double kGoldenSection = 0.6180339887498949;  // of the circle of hues, so that any number of them differ
  return from_hue(0.58 + std::fmod(static_cast<double>(k) * kGoldenSection, 1.0), 0.6);
}

void color_atoms(const Structure &structure, ColorScheme scheme, Rgba uniform, uint8_t *rgba) {
  for (size_t i = 0; i < structure.atoms.size(); ++i) put(uniform, i, rgba);
  switch (scheme) {
    case ColorScheme::kUniform:
      return;
    case ColorScheme::kElement:
      return color_by_element(structure, rgba);
    case ColorScheme::kChain:
      return color_by_chain(structure, rgba);
    case ColorScheme::kResidue:
      return for_each_residue_name(structure, [&](size_t i, const ResidueTraits &traits) {
        put(color_of(traits.residue_class, uniform), i, rgba);
      });
    case ColorScheme::kHydrophobicity:
      return color_by_hydropathy(structure, rgba);
    case ColorScheme::kSequence:
      return color_by_sequence(structure, rgba);
  }
}

}  // namespace quickses::io
