// SPDX-License-Identifier: MIT
// From where a molecule is looked at.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <optional>

namespace quickses::render {

// Atoms, as the surface sees them, or points.
struct Balls {
  const float *centers = nullptr;  // count x 3
  const float *radii = nullptr;    // null: 0
  size_t count = 0;
  float more = 0;  // to each radius: the probe of a solvent-accessible surface

  float radius(size_t i) const { return (radii ? radii[i] : 0) + more; }
};

// What is asked for.
struct View {
  std::optional<glm::vec3> toward;  // from the molecule to the eye
  std::optional<glm::vec3> up;
  float turn[2] = {0, 0};  // degrees: about the vertical, then about the horizontal, the top towards the eye
  float zoom = 1;
  float fill = 0.97f;  // of the picture, by the molecule
};

// A perspective from afar, in which what is seen fills the picture. The eye looks along -toward.
class Camera {
 public:
  Camera() = default;
  // Without a direction, the longest of the principal axes of the atoms lies along the longer side of the picture, and
  // the shortest points at the eye. There is at least one atom. seen: what has to be in the picture, at least one of
  // them: the atoms, or the surface's vertices where it lies outside of the atoms.
  Camera(const Balls &atoms, const Balls &seen, const View &view, bool is_tall);

  glm::vec3 right{1, 0, 0}, up{0, 1, 0}, toward{0, 0, 1};  // orthonormal, right-handed
  float distance = 6;                                      // of the eye from the middle
  glm::vec2 half{1, 1};                                    // of what has to be seen, in the plane through the middle

  // What the eye looks at: the same place of the molecule wherever its atoms have gone.
  glm::vec3 middle(const Balls &atoms) const;
  // Of the plane through the middle.
  float pixels_per_angstrom(glm::vec2 size) const;
  // How much larger than the part that has to be seen it is shown; 1 fills the picture.
  float enlargement() const { return filled_; }

 private:
  glm::vec3 offset_{0, 0, 0};  // of the middle from the mean of the centres
  float filled_ = 0.97f;
};

}  // namespace quickses::render
