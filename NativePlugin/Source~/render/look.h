// SPDX-License-Identifier: MIT
// How a surface looks in the light: in pictures, and by the same formulas in pages (page.js).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace quickses::render {

inline const glm::vec3 kLamp(-0.45f, 0.62f, 0.64f);  // from above, on the left, behind the eye
constexpr uint8_t kGrey = 190;                       // of what has no colour

// Linear light of what has a colour and a normal, seen from z. open: to the sky; lamp: how much of it is seen.
inline glm::vec3 look(glm::vec3 color, glm::vec3 normal, glm::vec3 to_lamp, float open, float lamp) {
  const glm::vec3 low_sky(0.78f, 0.74f, 0.72f), high_sky(0.92f, 0.97f, 1.05f), lamp_color(1.02f, 0.98f, 0.92f);
  const glm::vec3 sky = glm::mix(low_sky, high_sky, 0.5f + 0.5f * normal.y);
  const float lit = lamp * std::max(0.f, glm::dot(normal, to_lamp));
  const glm::vec3 half = glm::normalize(to_lamp + glm::vec3(0, 0, 1));
  const float shine = 0.05f * lamp * std::pow(std::max(0.f, glm::dot(normal, half)), 28.f) +
                      0.05f * open * std::pow(1 - std::clamp(normal.z, 0.f, 1.f), 4.f);
  return color * (sky * (0.82f * std::pow(std::max(0.f, open), 1.15f)) + lamp_color * (0.78f * lit)) + shine;
}

inline float linear_of(uint8_t srgb) {
  const float v = static_cast<float>(srgb) / 255;
  return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

// The light that a surface of a colour throws back: no channel all or nothing, or shades of pure colours look flat.
inline float pigment_of(uint8_t srgb) {
  constexpr float kPale = 0.85f, kPart = 0.2f;
  return linear_of(static_cast<uint8_t>(std::lround(glm::mix(static_cast<float>(srgb), 255 * kPale, kPart))));
}

// Highlights are rolled off.
inline glm::vec3 srgb_of(glm::vec3 linear) {
  for (int k = 0; k < 3; ++k) {
    float v = std::max(0.f, linear[k]);
    if (v > 0.6f) v = 0.6f + 0.4f * (1 - std::exp((0.6f - v) / 0.4f));
    linear[k] = v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
  }
  return linear;
}

}  // namespace quickses::render
